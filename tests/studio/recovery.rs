//! The program is killed with unsaved work, and the next one offers it.

use std::path::Path;

use edifice_editing::history::Document;
use edifice_editing::open;
use edifice_editing::work::Work;
use edifice_studio::{Open, Settings};
use serde_json::{Value, json};

use crate::client::Api;
use crate::crash::{Process, large};

/// Kills a studio; nothing of it goes on.
fn kill(mut process: Process) {
    process.child.kill().expect("killed");
    process.child.wait().expect("ended");
}

/// The body of an answer as JSON.
fn json_of(answer: &str) -> Value {
    let body = answer.split("\r\n\r\n").nth(1).unwrap_or_default();
    serde_json::from_str(body).unwrap_or_else(|e| panic!("{e}: {answer}"))
}

/// The unsaved work that a studio offers.
fn offered(process: &Process) -> Vec<Value> {
    let all = json_of(&process.ask("/api/documents", ""));
    all["unsaved"].as_array().expect("a list").clone()
}

#[test]
fn killed_with_unsaved_work_it_loses_nothing_that_was_answered() {
    let folder = tempfile::tempdir().expect("a folder");
    let state = tempfile::tempdir().expect("a folder");
    let path = large(folder.path(), 12);
    let before = std::fs::read(&path).expect("there");
    let process = Process::start_in(&[], &path, state.path());
    let edits = [
        "move #0=0.25,0.25",
        "move #1=1.25,0.25",
        "move #2=2.25,0.25",
        "move #3=3.25,0.25",
    ];
    for (revision, edit) in edits.iter().enumerate() {
        let answer = process.edit(revision, edit);
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    }
    process.post("undo", "{}");
    let shown = json_of(&process.ask("/api/documents/d1", ""));
    kill(process);
    assert_eq!(std::fs::read(&path).expect("there"), before);
    // Half a line is what a kill in the middle of a write leaves.
    let journal = Path::new("edifice/studio");
    let journals = std::fs::read_dir(state.path().join(journal))
        .expect("listed")
        .flatten();
    let journal = journals
        .map(|e| e.path())
        .find(|p| p.to_string_lossy().ends_with(".jsonl"));
    let mut text = std::fs::read(journal.as_ref().expect("one")).expect("there");
    text.extend_from_slice(b"{\"did\":[{\"do\"");
    std::fs::write(journal.expect("one"), text).expect("written");

    // The file may change or go: the document began from what it was.
    std::fs::write(&path, "{}").expect("written");
    let other = large(state.path(), 2);
    let process = Process::start_in(&[], &other, state.path());
    let offers = offered(&process);
    assert_eq!(offers.len(), 1, "{offers:?}");
    assert_eq!(
        (&offers[0]["name"], &offers[0]["edits"]),
        (&json!("f"), &json!(4))
    );
    // Another studio does not offer what this one holds.
    let second = Process::start_in(&[], &other, state.path());
    assert!(offered(&second).is_empty());
    let id = offers[0]["id"].as_str().expect("an id");
    let again = json_of(&process.ask(&format!("/api/unsaved/{id}/open"), "{}"));
    assert_eq!(again["view"], shown["view"]);
    assert_eq!(
        (&again["unsaved"], &again["redo"]),
        (&json!(true), &json!(true))
    );
    assert_eq!(again["log"], shown["log"]);
    assert!(offered(&process).is_empty());
    // It goes on in the same journal.
    let more = json!({"commands": [{"do": "edit", "edits": ["move #4=4.25,0.25"]}], "revision": again["revision"]});
    process.ask("/api/documents/d2/edit", &more.to_string());
    // The file is another one now: it is not replaced unasked.
    let refused = process.ask("/api/documents/d2/save", "{}");
    assert!(refused.starts_with("HTTP/1.1 409"), "{refused}");
    kill(process);
    let process = Process::start_in(&[], &other, state.path());
    assert_eq!(offered(&process)[0]["edits"], 5);
}

#[test]
fn what_was_saved_closed_or_discarded_is_not_offered() {
    let folder = tempfile::tempdir().expect("a folder");
    let state = tempfile::tempdir().expect("a folder");
    let path = large(folder.path(), 4);
    let process = Process::start_in(&[], &path, state.path());
    process.edit(0, "move #0=0.25,0.25");
    assert!(process.post("save", "{}").starts_with("HTTP/1.1 200"));
    kill(process);
    let process = Process::start_in(&[], &path, state.path());
    assert!(offered(&process).is_empty());
    process.edit(0, "move #0=0.5,0.25");
    assert!(process.post("close", "{}").starts_with("HTTP/1.1 409"));
    assert!(
        process
            .post("close", "{\"discard\": true}")
            .starts_with("HTTP/1.1 200")
    );
    assert!(
        process
            .ask("/api/documents/d1", "")
            .starts_with("HTTP/1.1 404")
    );
    kill(process);
    let process = Process::start_in(&[], &path, state.path());
    assert!(offered(&process).is_empty());
    process.edit(0, "move #0=0.25,0.5");
    kill(process);
    let process = Process::start_in(&[], &path, state.path());
    let id = offered(&process)[0]["id"]
        .as_str()
        .expect("an id")
        .to_owned();
    process.ask(&format!("/api/unsaved/{id}/discard"), "{}");
    kill(process);
    let left = std::fs::read_dir(state.path().join("edifice/studio")).expect("listed");
    assert_eq!(left.count(), 0);
}

#[test]
fn a_recovered_example_is_what_its_commands_make_of_it() {
    let state = tempfile::tempdir().expect("a folder");
    let settings = Settings {
        state: Some(state.path().to_path_buf()),
        ..Settings::default()
    };
    let commands = json!([{"do": "edit", "edits": ["move d1=10.2,0"]}, {"do": "complete", "count": 2, "seed": 3}]);
    let shown = {
        let api = Api::new(&settings);
        let opened = api.post("/api/documents", json!({"example": "four"}));
        let id = opened["id"].as_str().expect("an id").to_owned();
        api.edit(&id, commands)
    };
    // Of a studio that only reads, nothing is offered and nothing is removed.
    let reads = Api::new(&Settings {
        read_only: true,
        ..settings.clone()
    });
    assert_eq!(reads.get("/api/documents")["unsaved"], json!([]));
    let api = Api::new(&settings);
    let id = api.get("/api/documents")["unsaved"][0]["id"]
        .as_str()
        .expect("offered")
        .to_owned();
    let again = api.post(&format!("/api/unsaved/{id}/open"), json!({}));
    assert_eq!(again["view"], shown["view"]);
}

#[test]
fn a_closed_document_is_gone_and_the_others_keep_their_ids() {
    let api = Api::new(&Settings::default());
    for _ in 0..3 {
        api.post("/api/documents", json!({"example": "four"}));
    }
    api.post("/api/documents/d2/close", json!({}));
    let listed = api.get("/api/documents");
    let ids: Vec<&str> = listed["documents"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|d| d["id"].as_str())
        .collect();
    assert_eq!(ids, ["d1", "d3"]);
    let opened = api.post("/api/documents", json!({"example": "four"}));
    assert_eq!(opened["id"], "d4");
}

/// Facades in one unit are merged with each other, and nothing else.
#[test]
fn only_what_can_be_merged_says_so() {
    let grammar = |unit: &str| {
        let text = format!(
            "{{ \"format\": \"edifice/facade\", \"version\": 1, \"name\": \"f\", \"unit\": \"{unit}\", \"width\": 2, \"height\": 1,
             \"regions\": [ {{ \"label\": \"wall\", \"x\": 0, \"y\": 0, \"width\": 2, \"height\": 1 }} ] }}"
        );
        open(
            Path::new("f.facade.json"),
            text.as_bytes(),
            &Work::default(),
        )
        .expect("opens")
    };
    for unit in ["m", "px"] {
        let document = Document::new(grammar(unit));
        assert_eq!(document.state().kind(), "grammar");
        assert_eq!(document.state().merges_in(), Some(unit));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let partial = Open::file(&large(folder.path(), 4)).expect("opens");
    assert_eq!(partial.summary("d1")["mergesIn"], Value::Null);
}
