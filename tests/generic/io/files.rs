//! Files that people have: packed ones, numbers below zero, blended colours, JPEG, LabelMe, COCO, and
//! files of kinds that are not read.

use std::io::Write;
use std::path::Path;

use assert_cmd::Command;

fn edifice(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command.current_dir(folder).args(arguments).assert()
}

fn stderr(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

fn packed(text: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(text).unwrap();
    encoder.finish().unwrap()
}

const MATRIX: &str = "wall wall wall wall\nwall window window wall\nwall wall wall wall\n";

const LABELME: &str = include_str!("../../../fuzz/seeds/labelme/a.json");
const COCO: &str = include_str!("../../../fuzz/seeds/coco/a.json");
const VOC: &[u8] = include_bytes!("../../../fuzz/seeds/annotation_xml/voc.xml");
const POLYGONS: &[u8] = include_bytes!("../../../fuzz/seeds/annotation_xml/polygon.xml");
const XML: &[u8] = include_bytes!("../../../fuzz/seeds/cmp_xml/a.xml");
const HOUSES: &[u8] = include_bytes!("../../../fuzz/seeds/building_json/a.buildings.jsonl");

#[test]
fn every_text_format_is_read_packed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).unwrap();
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    write("m.txt", MATRIX.as_bytes());
    edifice(
        folder,
        &["facade", "convert", "m.txt", "-o", "f.facade.json"],
    )
    .success();
    write("l.json", LABELME.as_bytes());
    write("c.json", COCO.as_bytes());
    write("x.xml", XML);
    for name in ["m.txt", "f.facade.json", "l.json", "c.json", "x.xml"] {
        let gz = format!("{name}.gz");
        write(&gz, &packed(&read(name)));
        edifice(
            folder,
            &["facade", "convert", name, "-o", "plain.facade.json"],
        )
        .success();
        edifice(
            folder,
            &["facade", "convert", &gz, "-o", "packed.facade.json"],
        )
        .success();
        assert_eq!(
            read("plain.facade.json"),
            read("packed.facade.json"),
            "{name}"
        );
    }
    for name in ["g.cga", "g.grammar.json"] {
        edifice(folder, &["grammar", "infer", "m.txt.gz", "-o", name]).success();
        write(&format!("{name}.gz"), &packed(&read(name)));
        edifice(
            folder,
            &["grammar", "derive", name, "-o", "one.facade.json"],
        )
        .success();
        let gz = format!("{name}.gz");
        edifice(folder, &["grammar", "derive", &gz, "-o", "two.facade.json"]).success();
        assert_eq!(read("one.facade.json"), read("two.facade.json"));
        edifice(folder, &["grammar", "show", &gz, "--json"]).success();
    }
    write("map.json.gz", &packed(br#"{"a": 1, "b": 2}"#));
    write("n.txt", b"1 2\n1 2\n");
    edifice(
        folder,
        &[
            "facade",
            "convert",
            "n.txt",
            "--label-map",
            "map.json.gz",
            "-o",
            "n.svg",
        ],
    )
    .success();
    write("a.buildings.jsonl.gz", &packed(HOUSES));
    edifice(folder, &["building", "attributes", "a.buildings.jsonl.gz"]).success();
    let cut = packed(MATRIX.as_bytes());
    write("cut.txt.gz", &cut[..cut.len() - 6]);
    let assert = edifice(folder, &["facade", "convert", "cut.txt.gz", "-o", "y.svg"]).code(1);
    assert!(stderr(&assert).contains("cut.txt.gz: a damaged gzip file"));
}

#[test]
fn numbers_below_zero_are_named_by_the_map_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("a.txt", "-1 -1 0\n1 1 0\n");
    write("all.json", r#"{"void": -1, "wall": 0, "door": 1}"#);
    write("some.json", r#"{"wall": 0, "door": 1}"#);
    edifice(
        folder,
        &[
            "facade",
            "convert",
            "a.txt",
            "--label-map",
            "all.json",
            "-o",
            "b.txt",
        ],
    )
    .success();
    let text = std::fs::read_to_string(folder.join("b.txt")).unwrap();
    assert_eq!(text, "void void wall\ndoor door wall\n");
    for command in [
        &["facade", "convert"][..],
        &["grammar", "infer"],
        &["logic", "fit"],
    ] {
        let rest = ["a.txt", "--label-map", "some.json", "-o", "c.json"];
        let assert = edifice(folder, &[command, &rest].concat()).code(1);
        let expected = "a.txt: line 1, entry 1: unknown number -1: the label map does not name it";
        assert!(stderr(&assert).contains(expected), "{}", stderr(&assert));
    }
}

#[test]
fn blended_and_jpeg_colours_need_the_option() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let colour = |x, y| match (16..32).contains(&x) && (16..32).contains(&y) {
        true => image::Rgb([250, 2, 3]),
        false => image::Rgb([255, 255, 0]),
    };
    let image = image::RgbImage::from_fn(48, 48, colour);
    for name in ["a.png", "a.jpg", "a.jpeg", "unnamed.png"] {
        image.save(folder.join(name)).unwrap();
    }
    let map = r#"{"wall": [255, 255, 0], "window": [255, 0, 0]}"#;
    std::fs::write(folder.join("map.json"), map).unwrap();
    let assert = edifice(folder, &["facade", "convert", "a.png", "-o", "b.txt"]).code(1);
    assert!(stderr(&assert).contains("a.png: pixel (16, 31): unknown colour [250, 2, 3]"));
    let assert = edifice(folder, &["facade", "convert", "a.jpg", "-o", "b.txt"]).code(1);
    let text = stderr(&assert);
    assert!(
        text.contains("a.jpg: a JPEG, which blurs the colours of labels, is unsupported"),
        "{text}"
    );
    assert!(text.contains(".jpg with --nearest-colour"), "{text}");
    let nearest = |input: &str, output: &str| {
        let options = ["--nearest-colour", "--label-map", "map.json"];
        edifice(
            folder,
            &[&["facade", "convert", input, "-o", output], &options[..]].concat(),
        )
        .success()
    };
    let assert = nearest("a.png", "png.txt");
    let expected = "note: a.png: 1 colour is not in the label map; the furthest, [250, 2, 3] at pixel (16, 31), is 6.2 from that of window";
    assert!(stderr(&assert).contains(expected), "{}", stderr(&assert));
    for (input, output) in [("a.jpg", "jpg.txt"), ("a.jpeg", "jpeg.txt")] {
        let assert = nearest(input, output);
        assert!(stderr(&assert).contains("not in the label map; the furthest"));
        let [png, jpg] =
            ["png.txt", output].map(|n| std::fs::read_to_string(folder.join(n)).unwrap());
        assert_eq!(png, jpg);
    }
    for command in [["grammar", "infer"], ["logic", "fit"]] {
        let rest = [
            "a.jpg",
            "--nearest-colour",
            "--label-map",
            "map.json",
            "-o",
            "o.grammar.json",
        ];
        let assert = edifice(folder, &[&command[..], &rest].concat()).success();
        assert!(
            stderr(&assert).contains("the furthest"),
            "{}",
            stderr(&assert)
        );
    }
}

#[test]
fn annotations_are_element_layouts() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, bytes) in [("v.xml", VOC), ("p.xml", POLYGONS)] {
        std::fs::write(folder.join(name), bytes).unwrap();
    }
    for (from, to) in [("v.xml", "v.facade.json"), ("p.xml", "p.facade.json")] {
        edifice(folder, &["facade", "convert", from, "-o", to]).success();
        let same = edifice(folder, &["facade", "compare", to, from, "--json"]).success();
        let line = String::from_utf8_lossy(&same.get_output().stdout).into_owned();
        assert!(line.contains(r#""mean_f1":1.0"#), "{line}");
    }
    let text = std::fs::read_to_string(folder.join("v.facade.json")).unwrap();
    let window = r#"{ "label": "window", "x": 2.0, "y": 40.0, "width": 8.0, "height": 15.0 }"#;
    assert!(text.contains(window), "{text}");
    // Without a size that of the picture beside the file is taken; without both nothing is guessed.
    let text = String::from_utf8_lossy(VOC).replace("<width>40</width>", "");
    std::fs::write(folder.join("b.xml"), text).unwrap();
    let convert = ["facade", "convert", "b.xml", "-o", "b.facade.json"];
    let assert = edifice(folder, &convert).code(1);
    let expected = "b.xml: neither <size> nor <imagesize>";
    assert!(stderr(&assert).contains(expected), "{}", stderr(&assert));
    edifice(folder, &["facade", "convert", "v.xml", "-o", "b.png"]).success();
    edifice(folder, &convert).success();
}

#[test]
fn labelme_and_coco_are_element_layouts() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    write("l.json", LABELME);
    edifice(
        folder,
        &["facade", "convert", "l.json", "-o", "l.facade.json"],
    )
    .success();
    let text = read("l.facade.json");
    assert!(
        text.contains(
            r#"{ "label": "window", "x": 2.0, "y": 39.5, "width": 8.0, "height": 15.5 }"#
        ),
        "{text}"
    );
    assert!(
        text.contains(r#"{ "label": "door", "x": 20.0, "y": 0.0, "width": 10.0, "height": 20.0 }"#),
        "{text}"
    );
    // A tiling is what grammars need; a drawing lays the elements on a wall.
    let assert = edifice(folder, &["grammar", "infer", "l.json"]).code(1);
    assert!(
        stderr(&assert).contains("l.json: no region covers the place"),
        "{}",
        stderr(&assert)
    );
    edifice(folder, &["facade", "convert", "l.json", "-o", "l.png"]).success();
    edifice(folder, &["grammar", "infer", "l.png"]).success();

    let more = r#""images": [{"id": 8, "file_name": "b.jpg", "width": 9, "height": 9}, "#;
    write("c.json", &COCO.replacen("\"images\": [", more, 1));
    let assert = edifice(
        folder,
        &["facade", "convert", "c.json", "-o", "c.facade.json"],
    )
    .code(1);
    let expected = "c.json: images: 2 images, --image NAME picks one: b.jpg, a.jpg";
    assert!(stderr(&assert).contains(expected), "{}", stderr(&assert));
    edifice(
        folder,
        &[
            "facade",
            "convert",
            "c.json",
            "--image",
            "a",
            "-o",
            "c.facade.json",
        ],
    )
    .success();
    let text = read("c.facade.json");
    assert!(
        text.contains(r#""name": "a""#)
            && text.contains(r#""x": 2.0, "y": 39.5, "width": 8.0, "height": 15.0"#),
        "{text}"
    );
    let assert = edifice(
        folder,
        &[
            "facade",
            "convert",
            "c.json",
            "--image",
            "z",
            "-o",
            "d.facade.json",
        ],
    )
    .code(1);
    assert!(
        stderr(&assert).contains("--image: c.json has no image \"z\""),
        "{}",
        stderr(&assert)
    );
    for other in ["l.json", "l.png"] {
        let arguments = ["facade", "convert", other, "--image", "a", "-o", "d.svg"];
        let assert = edifice(folder, &arguments).code(1);
        let expected = format!("--image: {other} is no COCO file");
        assert!(stderr(&assert).contains(&expected), "{}", stderr(&assert));
    }
}

#[test]
fn other_kinds_are_called_unsupported() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let cases: [(&str, &[u8], &str); 7] = [
        (
            "a.gif",
            b"GIF89a",
            "a.gif: a .gif file is unsupported; facades are read from",
        ),
        ("a.svg", b"<svg/>", "a .svg file is unsupported"),
        ("a.tif.gz", b"II*\0", "a .tif file is unsupported"),
        ("a.dat", b"RIFF\0\0", "a binary .dat file is unsupported"),
        (
            "unnamed",
            b"\xff\xfe\0",
            "a binary file of this kind is unsupported",
        ),
        ("unnamed_jpeg", b"\xff\xd8\xff\xe0", "a JPEG, which blurs"),
        (
            "a.json",
            b"{\"widht\": 3}",
            "a.json: neither a facade (key \"format\") nor a file of LabelMe",
        ),
    ];
    for (name, bytes, expected) in cases {
        std::fs::write(folder.join(name), bytes).unwrap();
        let assert = edifice(folder, &["facade", "convert", name, "-o", "b.svg"]).code(1);
        assert!(
            stderr(&assert).contains(expected),
            "{name}: {}",
            stderr(&assert)
        );
    }
    std::fs::write(folder.join("a.dat"), MATRIX).unwrap();
    edifice(folder, &["facade", "convert", "a.dat", "-o", "b.svg"]).success();
}
