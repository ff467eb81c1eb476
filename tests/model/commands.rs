//! `edifice model` from files to files.

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use edifice::model::network::Network;

fn edifice(words: &[&str]) -> Command {
    let mut command = Command::cargo_bin("edifice").expect("the program");
    command.arg("model").args(words);
    command
}

fn output(words: &[&str]) -> String {
    let done = edifice(words).assert().success();
    String::from_utf8_lossy(&done.get_output().stdout).into_owned()
}

fn complaint(words: &[&str]) -> String {
    let done = edifice(words).assert().failure().code(1);
    String::from_utf8_lossy(&done.get_output().stderr).into_owned()
}

fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

#[test]
fn a_network_is_shown_and_goes_to_json_and_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let asia = file("datasets/model/asia.bif");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let [asia, json, bif] = [
        asia.to_string_lossy().into_owned(),
        path("a.json"),
        path("b.bif"),
    ];
    let shown = output(&["show", &asia]);
    assert_eq!(shown.lines().count(), 8);
    assert!(
        shown.contains("either: yes, no, given lung, tub") || shown.contains("given tub, lung"),
        "{shown}"
    );
    output(&["convert", &asia, "-o", &json]);
    output(&["convert", &json, "-o", &bif]);
    let network = |path: &str| Network::from_bif(&std::fs::read_to_string(path).expect("a file"));
    assert_eq!(
        network(&asia).expect("ASIA"),
        network(&bif).expect("ASIA again")
    );
    let line: serde_json::Value =
        serde_json::from_str(&output(&["show", &json, "--json"])).expect("JSON");
    assert_eq!(line["variables"].as_array().expect("a list").len(), 8);
    assert!(
        complaint(&["convert", &asia, "-o", &path("a.txt")])
            .contains("expected .bif, .xmlbif, .json")
    );
}

#[test]
fn a_logic_model_is_shown_and_other_files_are_named() {
    let logic = file("fuzz/seeds/logic_model/a.logic.json")
        .to_string_lossy()
        .into_owned();
    assert!(output(&["show", &logic]).contains(" rules"));
    let line: serde_json::Value =
        serde_json::from_str(&output(&["show", &logic, "--json"])).expect("JSON");
    assert!(line["rules"].as_u64().is_some_and(|rules| rules > 0));
    assert!(complaint(&["convert", &logic, "-o", "x.bif"]).contains("expected a Bayesian network"));
    let houses = file("fuzz/seeds/houses_model/a.houses.json")
        .to_string_lossy()
        .into_owned();
    let text = complaint(&["show", &houses]);
    assert!(
        text.contains("unknown format \"edifice/building_model\""),
        "{text}"
    );
}
