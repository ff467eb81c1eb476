//! Saving: whole files or none, never over what another program wrote, never with `--read-only`.

use std::path::Path;

use edifice_studio::{Open, Settings};
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
fn a_foreign_script_is_not_replaced_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = file(folder.path());
    let script = folder.path().join("f.sh");
    let mine = "#!/bin/sh\necho mine\n";
    std::fs::write(&script, mine).expect("written");
    let message = edited(&path).save(false).expect_err("refused").to_string();
    assert!(message.starts_with("f.sh exists"), "{message}");
    assert_eq!(std::fs::read_to_string(&script).expect("there"), mine);
    assert_eq!(std::fs::read_to_string(&path).expect("there"), FACADE);
    // Asked, it is replaced; the studio's own script of another time needs no question.
    assert!(edited(&path).save(true).is_ok());
    let first = std::fs::read(&script).expect("there");
    let mut again = Open::file(&path).expect("opens");
    again
        .edit(&[json!({"do": "edit", "edits": ["move #0=3,3"]})])
        .expect("can be done");
    assert!(again.save(false).is_ok());
    assert_ne!(std::fs::read(&script).expect("there"), first);
    // One line of somebody makes it his.
    let mut own = std::fs::read_to_string(&script).expect("there");
    own.push_str("echo mine\n");
    std::fs::write(&script, &own).expect("written");
    assert!(edited(&path).save(false).is_err());
    assert_eq!(std::fs::read_to_string(&script).expect("there"), own);
}

#[test]
fn two_studios_on_one_file_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = file(folder.path());
    let settings = Settings {
        files: vec![path.clone()],
        ..Settings::default()
    };
    let servers = [Server::start(&settings), Server::start(&settings)];
    let edit = |server: &Server, x: usize| {
        let edits = format!(
            "{{\"commands\": [{{\"do\": \"edit\", \"edits\": [\"move #0={x},2\"]}}], \"revision\": 0}}"
        );
        assert_eq!(
            server.page("POST /api/documents/d1/edit", &edits).status,
            200
        );
    };
    edit(&servers[0], 3);
    edit(&servers[1], 5);
    let save = "POST /api/documents/d1/save";
    assert_eq!(servers[0].page(save, "{}").status, 200);
    let first = std::fs::read(&path).expect("there");
    let refused = servers[1].page(save, "{}");
    assert_eq!(refused.status, 409, "{}", refused.text);
    assert!(
        refused.text.contains("changed by another program"),
        "{}",
        refused.text
    );
    assert_eq!(std::fs::read(&path).expect("there"), first);
    // Neither lost its edit: the second may replace the file, and then the first is told.
    assert_eq!(servers[1].page(save, "{\"overwrite\": true}").status, 200);
    assert_ne!(std::fs::read(&path).expect("there"), first);
    assert_eq!(servers[0].page(save, "{}").status, 409);
    assert!(
        servers[0]
            .page("GET /api/documents/d1", "")
            .text
            .contains("\"x\":3")
    );
}

#[cfg(unix)]
#[test]
fn nothing_is_written_through_a_link() {
    use std::os::unix::fs::symlink;

    let folder = tempfile::tempdir().expect("a folder");
    let outside = tempfile::tempdir().expect("a folder");
    let secret = outside.path().join("profile");
    std::fs::write(&secret, "mine").expect("written");
    // A link in the place of the script, then of the file.
    for name in ["f.sh", "f.facade.json"] {
        let mut open = edited(&file(folder.path()));
        let place = folder.path().join(name);
        let _ = std::fs::remove_file(&place);
        symlink(&secret, &place).expect("a link");
        for overwrite in [false, true] {
            let message = open.save(overwrite).expect_err("refused").to_string();
            assert!(
                message.contains(name) && message.contains("link"),
                "{message}"
            );
        }
        assert_eq!(std::fs::read_to_string(&secret).expect("there"), "mine");
        std::fs::remove_file(&place).expect("removed");
    }
    // A link in the place of the folder.
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).expect("a folder");
    let mut open = edited(&file(&inner));
    std::fs::rename(&inner, folder.path().join("moved")).expect("moved");
    symlink(outside.path(), &inner).expect("a link");
    let message = open.save(true).expect_err("refused").to_string();
    assert!(message.contains("link"), "{message}");
    assert_eq!(
        std::fs::read_dir(outside.path()).expect("listed").count(),
        1
    );
    // A file that was opened by a link is saved where it is.
    let real = file(outside.path());
    let link = folder.path().join("by.facade.json");
    symlink(&real, &link).expect("a link");
    let mut open = edited(&link);
    assert_eq!(open.save(false).expect("saved"), ["f.facade.json", "f.sh"]);
    assert!(
        std::fs::symlink_metadata(&link)
            .expect("there")
            .is_symlink()
    );
    assert!(
        std::fs::read_to_string(&real)
            .expect("there")
            .contains("\"x\": 2")
    );
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
