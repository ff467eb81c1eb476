//! `edifice building` on attributes that no house can have: exit code 1, both columns and the bound named, nothing written;
//! and the same bytes for any number of threads.

use std::path::Path;

use assert_cmd::Command;

use crate::cases::cases;

fn edifice(folder: &Path, args: &[&str], threads: &str) -> (i32, String) {
    let mut command = Command::cargo_bin("edifice").unwrap();
    let output = command
        .arg("building")
        .args(args)
        .current_dir(folder)
        .env("RAYON_NUM_THREADS", threads)
        .output()
        .unwrap();
    let messages = String::from_utf8(output.stderr).unwrap();
    assert!(!messages.contains("panicked"), "{messages}");
    (output.status.code().unwrap(), messages)
}

fn shipped() -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors/houses.buildings.jsonl");
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Attributes of some shipped houses as a table: header and rows.
fn table(folder: &Path, count: usize) -> (Vec<String>, Vec<Vec<String>>) {
    let houses = shipped()[..count].join("\n");
    std::fs::write(folder.join("few.buildings.jsonl"), houses).unwrap();
    let mut command = Command::cargo_bin("edifice").unwrap();
    let output = command
        .args(["building", "attributes", "few.buildings.jsonl"])
        .current_dir(folder)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
    let mut lines = text.lines().map(cells);
    (lines.next().unwrap(), lines.collect())
}

#[test]
fn contradictory_attributes_are_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let (header, rows) = table(folder.path(), 30);
    let at = |name: &str| header.iter().position(|h| h == name).unwrap();
    let has = |row: &&Vec<String>, name: &str| row[at(name)].parse::<f64>().unwrap() > 0.0;
    let row = rows
        .iter()
        .find(|r| has(r, "garage.w") && has(r, "porch.front.w"))
        .unwrap();
    let place = |name: &str| row[at(name)].clone();
    // Changed columns, and what the message must name.
    type Case<'a> = (Vec<(&'a str, String)>, Vec<&'a str>);
    let one = |name: &'static str, value: &str| vec![(name, value.to_owned())];
    let cases: Vec<Case> = vec![
        (
            one("garage.x", "0.99"),
            vec!["garage.x", "garage.w", "bbox.w"],
        ),
        (
            one("porch.front.y", "0.001"),
            vec!["porch.front.y", "porch.front.d", "bbox.d"],
        ),
        (
            vec![
                ("porch.front.x", place("garage.x")),
                ("porch.front.y", place("garage.y")),
            ],
            vec!["garage and porch.front overlap by", " m x "],
        ),
        (one("bdry", "3.5"), vec!["bdry = 3.5", "bcr", "bbox.w"]),
        (one("bcr", "1.2"), vec!["bcr is 1.2", "at most 1"]),
        (one("far", "3.3"), vec!["far = 3.3", "bcr / arf.0"]),
        (
            one("wwr.left", "0.95"),
            vec!["wwr.left is 0.95", "at most 0.9"],
        ),
        (one("garage.h", "40"), vec!["garage.h = 40", "bbox.h"]),
        (
            one("symmetry.back", "1.5"),
            vec!["symmetry.back is 1.5", "at most 1"],
        ),
        (one("bbox.w", "-3"), vec!["bbox.w is -3", "above zero"]),
        (
            vec![
                ("arf.0", "0.3".into()),
                ("arf.1", "0.7".into()),
                ("arf.2", "0".into()),
            ],
            vec!["arf.1 = 0.7", "arf.0 = 0.3"],
        ),
        (
            one("bbox.h", "40"),
            vec!["bbox.h = 40", "storeys of", "1.8 to 8 m"],
        ),
    ];
    for (changes, words) in cases {
        let mut bad = row.clone();
        for (name, value) in &changes {
            bad[at(name)].clone_from(value);
        }
        // A good house before the bad one: it must not be written either.
        let text = [&header, row, &bad].map(|r| r.join(",")).join("\n");
        std::fs::write(folder.path().join("bad.csv"), text).unwrap();
        let (code, message) = edifice(folder.path(), &["build", "bad.csv", "-o", "out"], "2");
        assert_eq!(code, 1, "{changes:?}: {message}");
        for word in words {
            assert!(message.contains(word), "{word:?} in {message}");
        }
        assert!(!folder.path().join("out").exists(), "{changes:?}");
    }
}

/// Values that no house can have are refused where they are read, by the name of what was written, before anything is drawn.
#[test]
fn impossible_evidence_is_refused_by_its_own_name() {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets");
    let path = |name: &str| data.join(name).to_string_lossy().into_owned();
    let model = path("building_exteriors/real.houses.json");
    let cases = [
        ("bbox.w=-3", vec!["bbox.w is -3", "above zero"]),
        ("bcr=-1", vec!["bcr is -1", "at most 1"]),
        ("arf.2=0.9", vec!["arf.2 is 0.9", "from 0 to 1/3"]),
        ("arf.1=0.7", vec!["arf.1 is 0.7", "from 0 to 1/2"]),
        ("arf.0=0.2", vec!["arf.0 is 0.2", "from 1/3 to 1"]),
        ("bbox.h=1", vec!["bbox.h = 1", "1.00 m on 1 floors"]),
        ("bbox.h=30", vec!["bbox.h = 30", "10.00 m on 3 floors"]),
    ];
    for (given, words) in cases {
        let sample = ["sample", &model, "-n", "2", "--given", given];
        let generate = ["generate", "-n", "2", "--given", given, "-o", "out"];
        let (column, value) = given.split_once('=').unwrap();
        std::fs::write(folder.path().join("t.csv"), format!("{column}\n{value}\n")).unwrap();
        let build = ["build", "t.csv", "-o", "out"];
        let complete = ["complete", &model, "t.csv", "-n", "2"];
        for args in [&sample[..], &generate, &build, &complete] {
            let (code, message) = edifice(folder.path(), args, "1");
            assert_eq!(code, 1, "{args:?}: {message}");
            for word in &words {
                assert!(message.contains(word), "{args:?}: {word:?} in {message}");
            }
            assert!(!message.contains("bdry"), "{args:?}: {message}");
            let place = args[0] == "sample" || args[0] == "generate" || message.contains("row 1");
            assert!(place, "{args:?}: {message}");
        }
    }
    // Two shares say the third.
    let shares = ["--given", "arf.1=0.5", "--given", "arf.2=0.3"];
    let args = [&["sample", &model][..], &shares].concat();
    let (code, message) = edifice(folder.path(), &args, "1");
    let named = message.contains("arf.1 = 0.5 is more than arf.0");
    assert!(code == 1 && named, "{message}");
    // A footprint is contradicted by what is given, not by what follows from both.
    let plot = path("building_exteriors/plot.geojson");
    let given = ["--given", "bbox.w=40", "-o", "out"];
    let args = [&["generate", "-n", "1", "--footprint", &plot][..], &given].concat();
    let (code, message) = edifice(folder.path(), &args, "1");
    let named = message.contains("bbox.w = 40 is given, the footprint has");
    assert!(code == 1 && named, "{message}");
    assert!(!folder.path().join("out").exists());
}

/// Small and odd values are possible ones: nothing panics on them, and what is taken for sampled is repaired.
#[test]
fn odd_values_are_drawn_around() {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/building_exteriors");
    let model = data.join("real.houses.json").to_string_lossy().into_owned();
    for given in ["bbox.w=0.5", "arf.2=0.338", "arf.1=0.5", "bbox.d=0.01"] {
        let sample = ["sample", &model, "-n", "20", "--given", given];
        let (code, message) = edifice(folder.path(), &sample, "1");
        assert_eq!(code, 0, "{given}: {message}");
    }
    std::fs::write(folder.path().join("t.csv"), "bbox.w,bcr\n-3,-1\n").unwrap();
    let build = ["build", "t.csv", "--repair", "-o", "out"];
    let (code, message) = edifice(folder.path(), &build, "1");
    assert_eq!(code, 0, "{message}");
}

#[test]
fn houses_of_four_floors_and_bad_footprints_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut house: serde_json::Value = serde_json::from_str(&shipped()[0]).unwrap();
    let floor = house["floor_height"].as_f64().unwrap();
    house["boxes"][0]["height"] = serde_json::json!(4.0 * floor);
    std::fs::write(folder.path().join("high.building.json"), house.to_string()).unwrap();
    let args = ["variations", "high.building.json", "-o", "out"];
    let (code, message) = edifice(folder.path(), &args, "1");
    assert_eq!(code, 1);
    assert!(
        message.contains("4 floors") && message.contains("at most 3"),
        "{message}"
    );
    assert!(!folder.path().join("out").exists());

    let houses = shipped()[..25].join("\n");
    std::fs::write(folder.path().join("few.buildings.jsonl"), houses).unwrap();
    let learn = [
        "learn",
        "few.buildings.jsonl",
        "-o",
        "m.houses.json",
        "--max-styles",
        "2",
        "--max-kinds",
        "2",
    ];
    assert_eq!(edifice(folder.path(), &learn, "2").0, 0);
    for (ring, word) in [
        (
            "[[0,0],[9,0],[9,9],[4,9],[4,-5],[0,-5],[0,0]]",
            "cross or touch",
        ),
        (
            "[[0,0],[9,0],[9,9],[4.5,13],[0,9],[0,0]]",
            "must be rectilinear",
        ),
    ] {
        let text = format!(r#"{{"type":"Polygon","coordinates":[{ring}]}}"#);
        std::fs::write(folder.path().join("f.geojson"), text).unwrap();
        let args = [
            "generate",
            "m.houses.json",
            "-n",
            "1",
            "--footprint",
            "f.geojson",
            "-o",
            "out",
        ];
        let (code, message) = edifice(folder.path(), &args, "1");
        assert_eq!(code, 1, "{message}");
        assert!(message.contains(word), "{message}");
        assert!(!folder.path().join("out").exists());
    }
    // Given columns alone can contradict each other, and a frozen box the given width.
    let given = [
        "generate",
        "m.houses.json",
        "--given",
        "bbox.w=10",
        "--given",
        "garage.x=0.95",
        "--given",
        "garage.w=4",
        "-n",
        "1",
        "-o",
        "out",
    ];
    let (code, message) = edifice(folder.path(), &given, "1");
    assert_eq!(code, 1, "{message}");
    assert!(
        message.contains("garage.x") && message.contains("bbox.w"),
        "{message}"
    );
    let one = shipped()[0].clone();
    std::fs::write(folder.path().join("one.building.json"), one).unwrap();
    let frozen = [
        "complete",
        "m.houses.json",
        "one.building.json",
        "--given",
        "bbox.w=6",
        "-o",
        "out",
    ];
    let (code, message) = edifice(folder.path(), &frozen, "1");
    assert_eq!(code, 1, "{message}");
    assert!(message.contains("outside 0 to 6 m (bbox.w)"), "{message}");
    assert!(!folder.path().join("out").exists());
}

/// All files of a folder but measured seconds.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    files.sort();
    let read = files.iter().map(|path| {
        let mut bytes = std::fs::read(path).unwrap();
        if path.to_string_lossy().ends_with("report.json") {
            let mut report: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
            report["seconds"] = serde_json::Value::Null;
            bytes = report.to_string().into_bytes();
        }
        (
            path.file_name().unwrap().to_string_lossy().into_owned(),
            bytes,
        )
    });
    read.collect()
}

#[test]
fn one_and_two_threads_write_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let houses = 1 + cases(2);
    let (header, rows) = table(folder.path(), houses);
    let lines: Vec<String> = std::iter::once(&header)
        .chain(&rows)
        .map(|r| r.join(","))
        .collect();
    std::fs::write(folder.path().join("t.csv"), lines.join("\n")).unwrap();
    let build = |to: &str, threads: &str| {
        let args = [
            "build",
            "t.csv",
            "-o",
            to,
            "--format",
            "json,obj,glb,svg,png",
            "--street",
        ];
        let (code, message) = edifice(folder.path(), &args, threads);
        assert_eq!(code, 0, "{message}");
        contents(&folder.path().join(to))
    };
    let (one, two) = (build("one", "1"), build("two", "2"));
    assert_eq!(one.len(), houses * 7 + 2);
    for (a, b) in one.iter().zip(&two) {
        assert!(a == b, "{}", a.0);
    }
    let vary = |to: &str, threads: &str| {
        std::fs::write(folder.path().join("v.building.json"), &shipped()[2]).unwrap();
        let many = houses.to_string();
        let args = ["variations", "v.building.json", "-n", &many, "-o", to];
        assert_eq!(edifice(folder.path(), &args, threads).0, 0);
        contents(&folder.path().join(to))
    };
    assert!(vary("v1", "1") == vary("v2", "2"));
}
