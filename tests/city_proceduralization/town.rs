//! The town that ships, from the command line: budgets of bytes and of likeness, what is kept of it, and what is taken away.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use edifice::io::city::grammar_file;
use edifice_editing::city_proceduralization::edit;

fn shipped() -> PathBuf {
    let path = "datasets/city_proceduralization/town.city-grammar.json";
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Runs a command in `folder`; exit code, what it printed, and messages.
fn run(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("edifice").unwrap();
    let output = command.arg("city").args(args).current_dir(folder).output();
    let output = output.unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let messages = text(output.stderr);
    assert!(!messages.contains("panicked"), "{messages}");
    (output.status.code().unwrap(), text(output.stdout), messages)
}

/// The object that a command ends with.
fn ended(folder: &Path, args: &[&str]) -> serde_json::Value {
    let (code, out, messages) = run(folder, args);
    assert_eq!(code, 0, "{args:?}: {messages}");
    serde_json::from_str(out.lines().last().unwrap()).unwrap()
}

/// A folder with the town as triangles.
fn town() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let shipped = shipped().to_string_lossy().into_owned();
    let args = ["derive", &shipped, "-o", "town.obj"];
    assert_eq!(run(folder.path(), &args).0, 0);
    folder
}

#[test]
fn a_budget_is_met_wherever_some_number_of_templates_meets_it() {
    let folder = town();
    let made = |more: &[&str]| {
        let args = [&["proceduralize", "town.obj", "--json"][..], more].concat();
        ended(
            folder.path(),
            &[&args[..], &["-o", "o.city-grammar.json"]].concat(),
        )
    };
    let bytes = |made: &serde_json::Value| made["bytes"].as_u64().unwrap();
    let iou = |made: &serde_json::Value| made["iou"].as_f64().unwrap();
    let usual = made(&[]);
    // What the default has is within reach.
    let most = bytes(&usual) + 200;
    let within = made(&["--bytes", &most.to_string()]);
    assert!(bytes(&within) <= most && iou(&within) > 0.95, "{within}");
    let like = made(&["--iou", "0.99"]);
    assert!(
        iou(&like) >= 0.99 && bytes(&like) <= bytes(&usual),
        "{like}"
    );
    let least = made(&["--iou", "0"]);
    assert!(
        bytes(&least) <= bytes(&made(&["--templates", "1"])),
        "{least}"
    );
    let args = [
        "proceduralize",
        "town.obj",
        "-o",
        "none.city-grammar.json",
        "--bytes",
        "100",
    ];
    let (code, _, messages) = run(folder.path(), &args);
    let told = format!("the smallest found is {} bytes, with ", bytes(&least));
    assert!(code == 1 && messages.contains(&told), "{told}: {messages}");
    assert!(!folder.path().join("none.city-grammar.json").exists());
}

/// Without identifiers a building is what a rule with parameters puts down, in every count.
#[test]
fn buildings_without_identifiers_are_counted_alike() {
    let folder = town();
    let made = ended(
        folder.path(),
        &[
            "proceduralize",
            "town.obj",
            "--keep",
            "shape",
            "-o",
            "s.city-grammar.json",
            "--json",
        ],
    );
    let shown = ended(folder.path(), &["show", "s.city-grammar.json", "--json"]);
    let derived = ended(
        folder.path(),
        &["derive", "s.city-grammar.json", "-o", "s.obj", "--json"],
    );
    let args = [
        "draw",
        "s.city-grammar.json",
        "-o",
        "s.png",
        "--width",
        "80",
        "--json",
    ];
    let drawn = ended(folder.path(), &args);
    let again = ended(
        folder.path(),
        &["draw", "s.obj", "-o", "t.png", "--width", "80", "--json"],
    );
    for found in [&shown, &derived, &drawn, &again] {
        assert_eq!(found["buildings"], made["buildings"], "{found}");
    }
    for key in [
        "rules",
        "terminals",
        "non_terminals",
        "escapes",
        "residuals",
    ] {
        assert_eq!(made[key], shown[key], "{key}");
    }
}

#[test]
fn a_building_that_nothing_is_left_of_goes() {
    let grammar = grammar_file::read(&shipped()).unwrap();
    for template in &grammar.templates {
        let asked = format!("remove {}", template.symbol).parse().unwrap();
        let edited = edit(&grammar, &[asked], true).unwrap();
        let after = edited.derive().unwrap();
        let left: BTreeSet<usize> = after.instances.iter().filter_map(|i| i.building).collect();
        assert_eq!(left.len(), after.buildings.len(), "{}", template.symbol);
    }
}

#[test]
fn a_place_that_is_not_found_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let cube = "o a\nv 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv 0 0 9\nv 9 0 9\nv 9 9 9\nv 0 9 9\n\
                f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    std::fs::write(path("one.obj"), cube).unwrap();
    let view = r#"{"format":"edifice/city-view","version":1,"unit":"m","buildings":[
        {"width":9,"depth":9,"height":9},{"width":12,"depth":9,"height":9}]}"#;
    std::fs::write(path("v.json"), view).unwrap();
    let args = ["locate", "one.obj", "--view", "v.json"];
    let (code, out, messages) = run(folder.path(), &args);
    assert!(code == 0 && out.is_empty(), "{out}");
    assert!(messages.contains("no place matches"), "{messages}");
    let args = ["draw", "one.obj", "-o", "none/a.png"];
    let (code, _, messages) = run(folder.path(), &args);
    assert!(
        code == 1 && messages.contains("there is no folder none"),
        "{messages}"
    );
}

/// Buildings of one height have one class, and the legend no empty ones.
#[test]
fn a_legend_has_no_classes_without_room() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::new();
    for k in 0..6 {
        let x = 20 * k;
        text += &format!("o b{k}\n");
        for (dx, dy, z) in [(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0)] {
            text += &format!("v {} {dy} {z}\nv {} {dy} {}\n", x + dx, x + dx, z + 9);
        }
        let corner = |i: usize| 8 * k + i;
        for face in [
            [1, 7, 5, 3],
            [2, 4, 6, 8],
            [1, 3, 4, 2],
            [3, 5, 6, 4],
            [5, 7, 8, 6],
            [7, 1, 2, 8],
        ] {
            text += &format!("f {}\n", face.map(|i| corner(i).to_string()).join(" "));
        }
    }
    std::fs::write(folder.path().join("c.obj"), text).unwrap();
    let args = [
        "draw", "c.obj", "--colour", "height", "--width", "640", "-o", "c.png",
    ];
    let (code, _, messages) = run(folder.path(), &args);
    assert_eq!(code, 0, "{messages}");
    let picture = image::open(folder.path().join("c.png")).unwrap().to_rgb8();
    let colours: BTreeSet<[u8; 3]> = picture.pixels().map(|p| p.0).collect();
    assert!(
        colours.contains(&[0xfe, 0xf0, 0xb5]),
        "the class that there is"
    );
    for empty in [
        [0xfd, 0xcc, 0x7a],
        [0xf7, 0x96, 0x4b],
        [0xe0, 0x52, 0x3a],
        [0xae, 0x1c, 0x4e],
    ] {
        assert!(!colours.contains(&empty), "{empty:?}");
    }
}
