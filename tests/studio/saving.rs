//! Saving: whole files or none, never over what another program wrote, never with `--read-only`.

use std::path::Path;

use edifice::studio::{Open, Settings};
use serde_json::json;

use crate::socket::Server;

const FACADE: &str = r#"{ "format": "edifice/facade", "version": 1, "name": "f", "unit": "m", "width": 9, "height": 9,
    "regions": [ { "label": "window", "x": 1, "y": 1, "width": 1, "height": 1 } ] }"#;

fn file(folder: &Path) -> std::path::PathBuf {
    let path = folder.join("f.facade.json");
    std::fs::write(&path, FACADE).expect("written");
    path
}

fn edited(path: &Path) -> Open {
    let mut open = Open::file(path).expect("opens");
    let command = json!({"do": "edit", "edits": ["move #0=2,2"]});
    open.edit(&[command]).expect("can be done");
    open
}

#[test]
fn a_file_and_its_script_are_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = file(folder.path());
    let mut open = edited(&path);
    assert_eq!(open.save(false).expect("saved"), ["f.facade.json", "f.sh"]);
    let saved = std::fs::read(&path).expect("there");
    assert_eq!(saved, open.document.state().bytes().expect("bytes"));
    assert!(String::from_utf8_lossy(&saved).contains("\"x\": 2"));
    let names = std::fs::read_dir(folder.path()).expect("listed");
    assert_eq!(names.count(), 2);
    // Again, without a question: it is this document's own file.
    assert!(open.save(false).is_ok());
}

#[test]
fn what_another_program_wrote_is_not_replaced_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = file(folder.path());
    // Two studios on one file.
    let (mut one, mut two) = (edited(&path), edited(&path));
    one.edit(&[json!({"do": "edit", "edits": ["add door@4,0,1,2"]})])
        .expect("can be done");
    assert!(one.save(false).is_ok());
    let kept = std::fs::read(&path).expect("there");
    let message = two.save(false).expect_err("refused").to_string();
    assert!(message.contains("changed by another program"), "{message}");
    assert_eq!(std::fs::read(&path).expect("there"), kept);
    assert!(two.save(true).is_ok());
}

#[test]
fn a_folder_that_is_gone_loses_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut open = edited(&file(folder.path()));
    let own = open.document.state().bytes().expect("bytes");
    folder.close().expect("removed");
    let message = open.save(false).expect_err("no folder").to_string();
    assert!(message.contains("cannot write"), "{message}");
    assert_eq!(open.document.state().bytes().expect("bytes"), own);
}

#[test]
fn a_studio_that_may_only_read_does_not_write() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = file(folder.path());
    let server = Server::start(&Settings {
        files: vec![path.clone()],
        read_only: true,
        ..Settings::default()
    });
    let commands =
        "{\"commands\": [{\"do\": \"edit\", \"edits\": [\"move #0=2,2\"]}], \"revision\": 0}";
    assert_eq!(
        server.page("POST /api/documents/d1/edit", commands).status,
        200
    );
    let refused = server.page("POST /api/documents/d1/save", "{\"overwrite\": true}");
    assert_eq!(refused.status, 403, "{}", refused.text);
    assert_eq!(std::fs::read_to_string(&path).expect("there"), FACADE);
    assert_eq!(std::fs::read_dir(folder.path()).expect("listed").count(), 1);
}
