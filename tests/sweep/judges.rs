//! Commands that judge alone, describe data and the program itself.

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use serde_json::Value;

use crate::cases::cases;

fn edifice(folder: &Path, words: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command.env_remove("EDIFICE_DATA");
    command.current_dir(folder).args(words).assert()
}

/// The JSON object of the last line.
fn told(assert: &assert_cmd::assert::Assert) -> Value {
    let text = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    serde_json::from_str(text.lines().last().unwrap()).unwrap()
}

fn said(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

fn layouts() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar/layouts")
}

#[test]
fn layouts_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let layout = |windows: &[f64]| {
        let regions: Vec<String> = windows
            .iter()
            .map(|x| format!(r#"{{"label":"window","x":{x},"y":1,"width":2,"height":2}}"#))
            .collect();
        format!(
            r#"{{"format":"edifice/facade","version":1,"name":"a","unit":"px","width":20,"height":5,"regions":[{}]}}"#,
            regions.join(",")
        )
    };
    std::fs::write(path.join("t.facade.json"), layout(&[0.0, 10.0])).unwrap();
    std::fs::write(path.join("p.facade.json"), layout(&[0.5])).unwrap();
    let words = [
        "facade",
        "compare",
        "t.facade.json",
        "p.facade.json",
        "t.facade.json",
        "--json",
    ];
    let found = told(&edifice(path, &words).success());
    let first = &found["predictions"][0];
    assert!((first["f1"]["0.5"].as_f64().unwrap() - 2.0 / 3.0).abs() < 1e-12);
    assert_eq!(first["f1"]["0.65"], 0.0);
    assert_eq!(found["predictions"][1]["mean_f1"], 1.0);
    let other = layout(&[0.0]).replace("\"height\":5", "\"height\":6");
    std::fs::write(path.join("q.facade.json"), other).unwrap();
    let words = ["facade", "compare", "t.facade.json", "q.facade.json"];
    assert!(said(&edifice(path, &words).failure().code(1)).contains("outline"));
}

#[test]
fn grammars_are_judged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let facade = layouts().join("cottage_1.facade.json");
    let facade = facade.to_str().unwrap();
    edifice(path, &["grammar", "infer", facade, "-o", "g.grammar.json"]).success();
    let words = [
        "grammar",
        "evaluate",
        "g.grammar.json",
        facade,
        "--bound",
        "--json",
    ];
    let found = told(&edifice(path, &words).success());
    assert_eq!(found["derives_back"], true);
    assert_eq!(found["pixel_error"][0], 0.0);
    assert!(found["bound"].as_f64().unwrap() <= found["cost"].as_f64().unwrap() + 1e-9);
    let text = std::fs::read_to_string(path.join("g.grammar.json")).unwrap();
    std::fs::write(
        path.join("h.grammar.json"),
        text.replace("\"wall\"", "\"door\""),
    )
    .unwrap();
    let words = ["grammar", "evaluate", "h.grammar.json", facade, "--json"];
    let found = told(&edifice(path, &words).failure().code(1));
    assert_eq!(found["derives_back"], false);
    assert!(found["pixel_error"][0].as_f64().unwrap() > 0.1);
}

#[test]
fn rankings_are_judged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let names = ["cottage_1", "cottage_2", "terrace_a"];
    let mut facades: Vec<String> = Vec::new();
    let mut ranking = String::from("query,facade,distance\n");
    for query in names {
        let file = layouts().join(format!("{query}.facade.json"));
        facades.push(file.to_string_lossy().into_owned());
        for facade in names.iter().filter(|name| **name != query) {
            ranking += &format!("{query},{facade},1.5\n");
        }
    }
    std::fs::write(path.join("r.csv"), &ranking).unwrap();
    let mut words = vec!["logic", "evaluate", "r.csv"];
    words.extend(facades.iter().map(String::as_str));
    words.push("--json");
    let found = told(&edifice(path, &words).success());
    assert!(found["queries"].is_number(), "{found}");
    std::fs::write(path.join("r.csv"), ranking.replace("1.5", "NaN")).unwrap();
    assert!(said(&edifice(path, &words).failure().code(1)).contains("`NaN`"));
}

#[test]
fn houses_are_compared() {
    let houses = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors/houses.buildings.jsonl");
    let text = std::fs::read_to_string(houses).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let few: Vec<&str> = text.lines().take(3).collect();
    std::fs::write(
        folder.path().join("a.buildings.jsonl"),
        few.join("\n") + "\n",
    )
    .unwrap();
    let words = [
        "building",
        "compare",
        "a.buildings.jsonl",
        "a.buildings.jsonl",
        "--json",
    ];
    let found = told(&edifice(folder.path(), &words).success());
    assert_eq!(found["houses"][2]["max_z"], 0.0);
    assert_eq!(found["houses"][0]["watertight"], true);
}

#[test]
fn data_is_described_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let found = told(&edifice(path, &["data", "list", "--json"]).success());
    let sets = found["sets"].as_array().unwrap();
    assert!(sets.len() >= 14);
    assert!(
        sets.iter()
            .all(|set| set["files"] == 0 && set["citation"] != "")
    );
    let missing = told(&edifice(path, &["data", "check", "ecp2011", "--json"]).success());
    assert_eq!(missing["sets"][0]["state"], "missing");
    let wrong = edifice(path, &["data", "check", "ecp2012"]).failure();
    assert!(said(&wrong).contains("did you mean `ecp2011`?"));
    let mine = path.join("mine");
    std::fs::create_dir(&mine).unwrap();
    let from = layouts().join("cottage_1.facade.json");
    std::fs::copy(from, mine.join("a.facade.json")).unwrap();
    edifice(
        path,
        &["data", "describe", "mine", "--files", "*.facade.json"],
    )
    .success();
    let text = std::fs::read_to_string(mine.join("croissant.json")).unwrap();
    let croissant: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(croissant["distribution"][0]["name"], "a.facade.json");
    let whole = told(&edifice(path, &["data", "check", "mine/dataset.toml", "--json"]).success());
    assert_eq!(whole["sets"][0]["state"], "whole");
    std::fs::write(mine.join("b.facade.json"), "{}").unwrap();
    edifice(path, &["data", "check", "mine/dataset.toml"])
        .failure()
        .code(1);
}

/// Writes a picture of windows on a wall in the colours of ECP and Graz.
fn windows(folder: &Path, name: &str, floors: u32, columns: u32) {
    let picture = image::RgbImage::from_fn(20 * columns, 30 * floors, |x, y| {
        let window = (5..15).contains(&(x % 20)) && (8..24).contains(&(y % 30));
        image::Rgb(if window { [255, 0, 0] } else { [255, 255, 0] })
    });
    picture.save(folder.join(format!("{name}.png"))).unwrap();
}

#[test]
fn tables_run_on_facades_of_ones_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for (name, floors, columns) in [("a", 3, 4), ("b", 3, 4), ("c", 4, 3), ("d", 4, 5)] {
        windows(path, name, floors, columns);
    }
    for (paper, artefact) in [
        ("facade_grammar", "table_1"),
        ("procedural_logic", "figure_4"),
        ("structure_completion", "completion"),
    ] {
        let words = [
            "reproduce",
            paper,
            "--only",
            artefact,
            "--budget",
            "smoke",
            "--dataset",
            "mine=*.png",
            "--out",
            "r",
        ];
        edifice(path, &words).success();
        let table = path.join(format!("r/{paper}/{artefact}.csv"));
        let text = std::fs::read_to_string(table).unwrap();
        assert!(text.contains(",mine,"), "{paper}: {text}");
    }
}

/// Label images that are alike: there is none to learn from.
#[test]
fn three_pictures_that_are_alike_are_completed_by_what_ships() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for name in ["a", "b", "c"] {
        windows(path, name, 3, 4);
    }
    let text = completed(path, "mine=*.png");
    assert!(text.contains(",mine,"), "{text}");
    let page = std::fs::read_to_string(path.join("r/structure_completion/completion.md"));
    assert!(
        page.unwrap()
            .contains("the model that ships completed them")
    );
}

/// Layouts that are irregular are out of scope; they are all there is.
#[test]
fn layouts_that_are_out_of_scope_are_completed() {
    let folder = tempfile::tempdir().unwrap();
    let kinds = if cases(2) == 2 { "[bh]" } else { "b" };
    let pattern = format!("mine={}/{kinds}*_[14].facade.json", layouts().display());
    let text = completed(folder.path(), &pattern);
    assert!(text.contains(",mine,"), "{text}");
    assert!(text.lines().count() > 100, "{text}");
}

/// The rows of the artefact `completion` on a set of one's own.
fn completed(path: &Path, dataset: &str) -> String {
    let words = "reproduce structure_completion --only completion --budget smoke --out r --dataset";
    let mut words: Vec<&str> = words.split(' ').collect();
    words.push(dataset);
    edifice(path, &words).success();
    std::fs::read_to_string(path.join("r/structure_completion/completion.csv")).unwrap()
}

#[test]
fn wrong_names_are_wrong_usage() {
    let folder = tempfile::tempdir().unwrap();
    for (words, expected) in [
        (
            vec!["reproduce", "facade_gramar"],
            "did you mean `facade_grammar`?",
        ),
        (
            vec!["reproduce", "facade_grammar", "--only", "tabel_1"],
            "did you mean `table_1`?",
        ),
        (
            vec!["reproduce", "facade_grammar", "--dataset", "mine"],
            "is not NAME=GLOB",
        ),
    ] {
        let failed = edifice(folder.path(), &words).failure().code(2);
        assert!(
            said(&failed).contains(expected),
            "{words:?}: {}",
            said(&failed)
        );
    }
}

#[test]
fn completions_and_manual_pages() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish"] {
        let done = edifice(folder.path(), &["completions", shell]).success();
        let text = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
        assert!(text.contains("reproduce"), "{shell}");
        std::fs::write(folder.path().join(shell), &text).unwrap();
        // Where the shell is here, it reads them.
        let read = std::process::Command::new(shell)
            .arg("-n")
            .arg(folder.path().join(shell))
            .output();
        if let Ok(read) = read {
            assert!(read.status.success(), "{shell}");
        }
    }
    edifice(folder.path(), &["man", "-o", "man"]).success();
    let page = std::fs::read_to_string(folder.path().join("man/edifice-grammar-infer.1"));
    assert!(page.unwrap().contains(".TH"));
}
