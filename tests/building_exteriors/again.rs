//! A run into a folder that has houses of an earlier one: what is the same is left as it is, all else is made.

use std::path::Path;

use assert_cmd::Command;

/// Standard output and the messages of a command that succeeds.
fn edifice(folder: &Path, args: &[&str]) -> (String, String) {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command.arg("building").args(args).current_dir(folder);
    let output = command.assert().success().get_output().clone();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (text(output.stdout), text(output.stderr))
}

fn table(folder: &Path, count: usize) {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors/houses.buildings.jsonl");
    let text = std::fs::read_to_string(shipped).unwrap();
    let lines: Vec<&str> = text.lines().take(count).collect();
    std::fs::write(folder.join("few.buildings.jsonl"), lines.join("\n")).unwrap();
    let (csv, _) = edifice(folder, &["attributes", "few.buildings.jsonl"]);
    std::fs::write(folder.join("few.csv"), csv).unwrap();
}

#[test]
fn only_the_same_house_with_all_its_files_is_left_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    table(folder.path(), 2);
    let out = folder.path().join("out");
    let build = |more: &[&str]| {
        let args = [&["build", "few.csv", "-o", "out", "--json"][..], more].concat();
        edifice(folder.path(), &args)
    };
    let read = |name: &str| std::fs::read(out.join(name)).unwrap();
    let (first, messages) = build(&["--format", "json"]);
    assert!(!messages.contains("already"), "{messages}");
    let house = read("house_0001.building.json");

    // The same again: nothing is made, and each house still has its line.
    let (again, messages) = build(&["--format", "json"]);
    assert!(messages.contains("2 were there already"), "{messages}");
    assert_eq!(again, first);
    // Another format is written, a file that was deleted too.
    let (_, messages) = build(&["--format", "json,obj"]);
    assert!(!messages.contains("already"), "{messages}");
    let surface = read("house_0001.obj");
    std::fs::remove_file(out.join("house_0001.mtl")).unwrap();
    let (_, messages) = build(&["--format", "obj"]);
    assert!(messages.contains("1 were there already"), "{messages}");
    assert!(out.join("house_0001.mtl").is_file());
    // Other roofs, and other houses to take boxes from, are other houses; what was not asked for anew is not taken for theirs.
    let (_, messages) = build(&["--format", "json", "--roof", "merged"]);
    assert!(!messages.contains("already"), "{messages}");
    let (_, messages) = build(&["--format", "json,obj", "--roof", "merged"]);
    assert!(!messages.contains("already"), "{messages}");
    let (_, messages) = build(&["--format", "json", "--database", "few.buildings.jsonl"]);
    assert!(!messages.contains("already"), "{messages}");
    // A report of an older program tells nothing.
    build(&["--format", "json,obj"]);
    assert_eq!(read("house_0001.building.json"), house);
    assert_eq!(read("house_0001.obj"), surface);
    let report = out.join("house_0001.report.json");
    let mut older: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap();
    older.as_object_mut().unwrap().remove("made_from").unwrap();
    std::fs::write(&report, older.to_string()).unwrap();
    let (_, messages) = build(&["--format", "json,obj"]);
    assert!(messages.contains("1 were there already"), "{messages}");
}

#[test]
fn houses_of_equal_names_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let complaint = |args: &[&str]| {
        let mut command = Command::cargo_bin("edifice").unwrap();
        command.arg("building").args(args).current_dir(&folder);
        let output = command.assert().code(1).get_output().stderr.clone();
        String::from_utf8(output).unwrap()
    };
    let rows = "name,bbox.w\na,12\nh,12\nh,13\n";
    std::fs::write(folder.path().join("t.csv"), rows).unwrap();
    let message = complaint(&["build", "t.csv", "-o", "out"]);
    let named = message.contains("row 3") && message.contains("\"h\" is the name of row 2 too");
    assert!(named, "{message}");
    table(folder.path(), 1);
    let path = folder.path().join("few.buildings.jsonl");
    let one = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("{one}\n{one}\n")).unwrap();
    let args = [
        "complete",
        "made",
        "few.buildings.jsonl",
        "-n",
        "1",
        "-o",
        "out",
    ];
    let message = complaint(&args);
    assert!(
        message.contains("another house of the file has this name"),
        "{message}"
    );
    assert!(!folder.path().join("out").exists());
}

/// Options that would be passed over in silence are refused.
#[test]
fn completed_houses_are_not_chosen_among() {
    for option in [
        &["--most-probable"][..],
        &["--groups", "bbox"],
        &["--schema", "s"],
    ] {
        let mut command = Command::cargo_bin("edifice").unwrap();
        let args = [
            "building",
            "complete",
            "made",
            "h.buildings.jsonl",
            "-o",
            "out",
        ];
        let output = command
            .args(args)
            .args(option)
            .assert()
            .code(2)
            .get_output()
            .clone();
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains("cannot be used with"), "{message}");
    }
}
