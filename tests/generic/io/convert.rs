//! `edifice facade convert` from outside: formats, exit codes, messages, nothing half-written; and what else reads facades as it does.

use std::path::Path;

use assert_cmd::Command;

fn edifice(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command.current_dir(folder).args(arguments).assert()
}

fn convert(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    edifice(folder, &[&["facade", "convert"], arguments].concat())
}

fn stderr(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

const MATRIX: &str = "wall wall wall wall\nwall window window wall\nwall wall wall wall\n";
const VOC: &[u8] = include_bytes!("../../../fuzz/seeds/annotation_xml/voc.xml");

#[test]
fn every_format_leads_to_every_other() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("a.txt"), MATRIX).unwrap();
    convert(folder, &["a.txt", "-o", "b.facade.json"]).success();
    convert(folder, &["b.facade.json", "-o", "b.png"]).success();
    convert(folder, &["b.png", "-o", "c.txt"]).success();
    convert(folder, &["b.png", "-o", "c.svg"]).success();
    convert(folder, &["c.txt", "-o", "d.json", "--elements"]).success();
    assert_eq!(
        std::fs::read_to_string(folder.join("c.txt")).unwrap(),
        MATRIX
    );
    let elements = std::fs::read_to_string(folder.join("d.json")).unwrap();
    assert!(elements.contains("window") && !elements.contains("wall"));
    std::fs::write(
        folder.join("map.json"),
        r#"{"wall": [255, 255, 0], "glass": [255, 0, 0]}"#,
    )
    .unwrap();
    convert(folder, &["b.png", "-o", "e.txt", "--label-map", "map.json"]).success();
    assert!(
        std::fs::read_to_string(folder.join("e.txt"))
            .unwrap()
            .contains("glass")
    );
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("a.txt"), MATRIX).unwrap();
    for output in ["x.png", "x.svg", "x.facade.json"] {
        convert(folder, &["a.txt", "-o", output]).success();
        let first = std::fs::read(folder.join(output)).unwrap();
        convert(folder, &["a.txt", "-o", output, "--regularize", "0.5"]).success();
        assert_eq!(std::fs::read(folder.join(output)).unwrap(), first);
    }
}

#[test]
fn bad_input_is_named_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("a.txt"), "wall wall\nwall\n").unwrap();
    std::fs::write(folder.join("a.png"), "no image").unwrap();
    std::fs::write(folder.join("a.json"), "{\"format\": \"edifice/facade\"").unwrap();
    std::fs::write(folder.join("good.txt"), MATRIX).unwrap();
    let cases: [(&[&str], &str); 8] = [
        (&["a.txt", "-o", "b.json"], "a.txt: line 2"),
        (&["a.png", "-o", "b.json"], "a.png: not a readable PNG"),
        (&["a.json", "-o", "b.json"], "a.json: line 1"),
        (&["none.png", "-o", "b.json"], "none.png: cannot read"),
        (&["good.txt", "-o", "b.gif"], "unknown facade format"),
        (&["good.txt", "-o", "no/b.json"], "no/b.json: cannot write"),
        (
            &["good.txt", "-o", "b.json", "--regularize", "-1"],
            "--regularize: the tolerance is -1",
        ),
        (
            &["good.txt", "-o", "b.json", "--label-map", "a.json"],
            "a.json: format: expected a colour",
        ),
    ];
    for (arguments, expected) in cases {
        let assert = convert(folder, arguments).code(1);
        let message = stderr(&assert);
        assert!(message.contains(expected), "{arguments:?}: {message}");
        assert_eq!(
            std::fs::read_dir(folder).unwrap().count(),
            4,
            "{arguments:?}"
        );
    }
    convert(folder, &["good.txt"]).code(2);
}

#[test]
fn help_shows_an_example() {
    let assert = convert(Path::new("."), &["--help"]).success();
    let text = String::from_utf8(assert.get_output().stdout.clone()).unwrap();
    assert!(
        text.contains("Examples:\n  edifice facade convert datasets/examples/facade.png"),
        "{text}"
    );
}

#[test]
fn numbers_without_a_map_are_labels_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("a.txt", "2 2 3\n-1 2 3\n");
    write("map.json", r#"{"void": -1, "wall": 2, "door": 3}"#);
    write("named.txt", "wall 2 3\nwall 2 3\n");
    for command in [
        ["facade", "convert"],
        ["grammar", "infer"],
        ["logic", "fit"],
    ] {
        let told = |rest: &[&str]| {
            let rest = [&command[..], rest, &["-o", "o.json"]].concat();
            stderr(&edifice(folder, &rest).success())
        };
        let text = told(&["a.txt"]);
        let expected =
            "warning: a.txt: the labels are numbers (-1, 2, 3); --label-map says what they mean";
        assert!(text.contains(expected), "{text}");
        for fine in [&["a.txt", "--label-map", "map.json"][..], &["named.txt"]] {
            assert!(!told(fine).contains("the labels are numbers"), "{fine:?}");
        }
    }
}

#[test]
fn boxes_on_a_wall_are_tilings_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("v.xml"), VOC).unwrap();
    for command in [["grammar", "infer"], ["logic", "fit"]] {
        let arguments = [command[0], command[1], "v.xml", "-o", "v.json"];
        let assert = edifice(folder, &arguments).code(1);
        let text = stderr(&assert);
        assert!(text.contains("; --wall makes a tiling of boxes"), "{text}");
        edifice(folder, &[&arguments[..], &["--wall"]].concat()).success();
    }
    let convert = [
        "facade",
        "convert",
        "v.xml",
        "--wall",
        "-o",
        "w.facade.json",
    ];
    edifice(folder, &convert).success();
    let facade = edifice::io::facade_json::read(&folder.join("w.facade.json")).unwrap();
    assert_eq!(facade.check_tiling(), Ok(()));
    assert_eq!((facade.width, facade.unit.as_str()), (40.0, "px"));
    // The picture that `convert` draws says the same.
    edifice(folder, &["facade", "convert", "v.xml", "-o", "v.txt"]).success();
    edifice(
        folder,
        &["facade", "convert", "w.facade.json", "-o", "w.txt"],
    )
    .success();
    let [drawn, tiled] = ["v.txt", "w.txt"].map(|n| std::fs::read(folder.join(n)).unwrap());
    assert!(drawn == tiled);
    // What is cleaned must be a picture.
    let clean = [
        "facade",
        "convert",
        "v.xml",
        "--clean",
        "-o",
        "c.facade.json",
    ];
    let text = stderr(&edifice(folder, &clean).code(1));
    assert!(text.contains("; --wall makes a tiling of boxes"), "{text}");
    edifice(folder, &[&clean[..], &["--wall"]].concat()).success();
}
