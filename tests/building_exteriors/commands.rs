//! `edifice building` from end to end, on few houses.

use std::path::{Path, PathBuf};

use assert_cmd::Command;

fn edifice(args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command.arg("building").args(args);
    command
}

fn text(command: &mut Command) -> String {
    let output = command.assert().success().get_output().stdout.clone();
    String::from_utf8(output).unwrap()
}

fn complaint(command: &mut Command, code: i32) -> String {
    let output = command.assert().code(code).get_output().stderr.clone();
    String::from_utf8(output).unwrap()
}

/// The first `count` shipped houses.
fn database(folder: &Path, count: usize) -> PathBuf {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors/houses.buildings.jsonl");
    let text = std::fs::read_to_string(shipped).unwrap();
    let lines: Vec<&str> = text.lines().take(count).collect();
    let path = folder.join("few.buildings.jsonl");
    std::fs::write(&path, lines.join("\n")).unwrap();
    path
}

#[test]
fn learn_show_sample_complete_evaluate() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let houses = database(folder.path(), 16);
    let houses = houses.to_string_lossy();
    let table = text(&mut edifice(&["attributes", &houses]));
    assert_eq!(table.lines().count(), 17);
    assert_eq!(table.lines().next().unwrap().split(',').count(), 49);

    let learn = |to: &str, threads: &str| {
        let args = [
            "learn",
            &houses,
            "-o",
            to,
            "--max-styles",
            "3",
            "--max-kinds",
            "3",
            "--json",
        ];
        text(edifice(&args).env("RAYON_NUM_THREADS", threads))
    };
    let model = path("a.houses.json");
    assert!(learn(&model, "1").contains("\"styles\":"));
    learn(&path("b.houses.json"), "3");
    let read = |name: &str| std::fs::read(path(name)).unwrap();
    assert!(
        read("a.houses.json") == read("b.houses.json"),
        "same seed, same bytes"
    );

    let shown = text(&mut edifice(&["show", &model, "--svg", &path("n.svg")]));
    assert!(shown.contains("lateral edges") && shown.contains("garage: "));
    let svg = std::fs::read_to_string(path("n.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("garage"));

    let sample = [
        "sample",
        &model,
        "-n",
        "3",
        "--given",
        "garage=none",
        "--given",
        "roof.hip=yes",
    ];
    let samples = text(&mut edifice(&sample));
    assert_eq!(samples, text(&mut edifice(&sample)));
    let names: Vec<&str> = samples.lines().next().unwrap().split(',').collect();
    let at = |name: &str| names.iter().position(|n| *n == name).unwrap();
    for line in samples.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!((cells[at("garage.w")], cells[at("roof.hip")]), ("0", "yes"));
        assert!(cells.iter().all(|c| !c.is_empty() && *c != "NaN"));
    }

    let keep = [
        "complete",
        &model,
        &houses,
        "--keep",
        "bbox,garage",
        "-n",
        "1",
    ];
    assert_eq!(text(&mut edifice(&keep)).lines().count(), 17);
    let evaluate = [
        "evaluate",
        &houses,
        "--splits",
        "1",
        "--models",
        "ours,gmm",
        "--max-styles",
        "2",
        "--max-kinds",
        "2",
    ];
    let whole = text(&mut edifice(&evaluate));
    assert_eq!(whole.lines().count(), 3);

    // Losses of a former evaluation are taken, and only those of the same settings.
    let kept = folder.path().join("losses.jsonl");
    let kept_name = kept.to_string_lossy().into_owned();
    let resume = [&evaluate[..], &["--resume", &kept_name]].concat();
    assert_eq!(text(&mut edifice(&resume)), whole);
    let first = std::fs::read_to_string(&kept).unwrap();
    assert_eq!(first.lines().count(), 2);
    let (own, rest) = first.split_once('\n').unwrap();
    let mut own: serde_json::Value = serde_json::from_str(own).unwrap();
    own["value"] = 1000.5.into();
    let other = format!("{own}\n{rest}");
    std::fs::write(&kept, &other).unwrap();
    assert!(text(&mut edifice(&resume)).contains(",1,1000.5"));
    assert_eq!(std::fs::read_to_string(&kept).unwrap(), other);
    let seeded = [&resume[..], &["--seed", "2"]].concat();
    assert!(!text(&mut edifice(&seeded)).contains(",1,1000.5"));
    assert_eq!(std::fs::read_to_string(&kept).unwrap().lines().count(), 4);
}

#[test]
fn two_houses_still_answer() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder
        .path()
        .join("m.houses.json")
        .to_string_lossy()
        .into_owned();
    let houses = database(folder.path(), 2);
    let args = [
        "learn",
        &houses.to_string_lossy(),
        "-o",
        &model,
        "--max-styles",
        "2",
    ];
    text(&mut edifice(&args));
    let samples = text(&mut edifice(&["sample", &model, "-n", "2"]));
    assert_eq!(samples.lines().count(), 3);
}

#[test]
fn bad_input_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_string_lossy().into_owned()
    };
    let out = folder.path().join("m.json").to_string_lossy().into_owned();
    let csv = path("t.csv", "a,b\n1,2\n1,3\n1,5\n");
    assert!(complaint(&mut edifice(&["learn", &csv, "-o", &out]), 1).contains("--schema"));
    let schema = |column: &str| {
        format!(
            r#"{{"format":"edifice/attributes","version":1,"groups":[{{"name":"g","kind":"continuous","columns":["{column}"]}}]}}"#
        )
    };
    let constant = path("c.schema.json", &schema("a"));
    let args = [
        "learn",
        &csv,
        "--schema",
        &constant,
        "-o",
        &out,
        "--refuse-constant",
    ];
    let message = complaint(&mut edifice(&args), 1);
    assert!(message.contains("`a` is constant"), "{message}");
    let empty = path("e.csv", "a,b\n,2\n,3\n");
    let args = ["learn", &empty, "--schema", &constant, "-o", &out];
    let message = complaint(&mut edifice(&args), 1);
    assert!(message.contains("`a` has no observed value"), "{message}");
    let corrupt = path("x.houses.json", "{\"format\":");
    let message = complaint(&mut edifice(&["show", &corrupt]), 1);
    assert!(message.contains("corrupt model"), "{message}");
    complaint(&mut edifice(&["sample"]), 2);
}

/// Surfaces that need not be closed are not called so.
#[test]
fn sets_of_surfaces_are_not_called_closed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.city.json");
    let text = r#"{"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],"translate":[0,0,0]},
        "CityObjects":{"h":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"3","boundaries":[[[0,1,2]]],
        "semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0]}}]}},
        "vertices":[[0,0,0],[5000,0,0],[0,5000,0]]}"#;
    std::fs::write(&path, text).unwrap();
    let output = edifice(&["check", &path.to_string_lossy()])
        .assert()
        .success();
    let messages = String::from_utf8(output.get_output().stderr.clone()).unwrap();
    let told = "0 closed, one shell each, 1 sets of surfaces, which need not be closed";
    assert!(messages.contains(told), "{messages}");
}
