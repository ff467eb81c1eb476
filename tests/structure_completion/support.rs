//! Helpers that the tests of the completion commands share.

// Each test file uses a part of it.
#![allow(dead_code)]

use std::path::Path;

use assert_cmd::Command;

pub(crate) fn edifice(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::cargo_bin("edifice").expect("the program");
    command.current_dir(folder).args(words);
    command
}

pub(crate) fn output(folder: &Path, words: &[&str]) -> String {
    let done = edifice(folder, words).assert().success();
    String::from_utf8_lossy(&done.get_output().stdout).into_owned()
}

pub(crate) fn messages(folder: &Path, words: &[&str]) -> String {
    let done = edifice(folder, words).assert().success();
    String::from_utf8_lossy(&done.get_output().stderr).into_owned()
}

pub(crate) fn complaint(folder: &Path, words: &[&str], code: i32) -> String {
    let done = edifice(folder, words).assert().failure().code(code);
    String::from_utf8_lossy(&done.get_output().stderr).into_owned()
}

pub(crate) fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).expect("JSON")
}

pub(crate) fn read(path: &Path) -> serde_json::Value {
    json(&std::fs::read_to_string(path).expect("a file"))
}

pub(crate) fn shipped(name: &str) -> String {
    format!(
        "{}/datasets/facade_grammar/layouts/{name}.facade.json",
        env!("CARGO_MANIFEST_DIR")
    )
}

/// A partial layout of a few windows with ids; `extra` regions and keys are put in.
pub(crate) fn partial(folder: &Path, regions: &str, keys: &str) {
    let windows: Vec<String> = (0..9)
        .map(|k| {
            let (x, y) = (10.25 + 40.0 * f64::from(k % 3), 60.5 + 50.0 * f64::from(k / 3));
            format!("{{ \"label\": \"window\", \"x\": {x}, \"y\": {y}, \"width\": 20.125, \"height\": 30.5, \"id\": \"w{k}\" }}")
        })
        .collect();
    let text = format!(
        "{{ \"format\": \"edifice/facade\", \"version\": 1, \"name\": \"p\", \"unit\": \"px\", \"width\": 240, \"height\": 220,\n\"regions\": [ {}{regions} ]{keys} }}",
        windows.join(",\n")
    );
    std::fs::write(folder.join("p.facade.json"), text).expect("written");
}
