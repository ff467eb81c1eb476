//! Crates without unit tests build no program for them, and a unit test that is added to one does not go unseen.

use std::path::{Path, PathBuf};

use crate::{root, rust_files};

/// Marks of a test among a crate's own sources.
const MARKS: [&str; 3] = ["#[test]", "proptest!", "cfg(test)"];

/// Folders of the crates of the workspace, but for the root's.
fn folders() -> Vec<PathBuf> {
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).expect("a manifest");
    let members = manifest.split("default-members").next().expect("members");
    let quoted = members.split('"').skip(1).step_by(2);
    let known = quoted.filter(|m| root().join(m).join("Cargo.toml").is_file());
    known.map(PathBuf::from).collect()
}

/// True if a library builds no program of unit tests.
fn is_untested(folder: &Path) -> bool {
    let manifest = std::fs::read_to_string(root().join(folder).join("Cargo.toml"));
    let manifest = manifest.expect("a manifest");
    let library = manifest.split("[lib]").nth(1).unwrap_or_default();
    let library = library.split("\n[").next().unwrap_or_default();
    library.lines().any(|line| line == "test = false")
}

/// True if a file belongs to a crate, and not to one in a folder below it or to its tests, benches and examples.
fn belongs(file: &Path, folder: &Path, folders: &[PathBuf]) -> bool {
    let below = folders.iter().filter(|other| *other != folder);
    let other = below
        .filter(|other| other.starts_with(folder))
        .any(|other| file.starts_with(other));
    let apart = ["tests", "benches", "examples"].map(|name| folder.join(name));
    !other && !apart.iter().any(|name| file.starts_with(name))
}

#[test]
fn crates_without_unit_tests_have_none() {
    let folders = folders();
    assert!(folders.len() > 30, "only {} crates", folders.len());
    let mut seen = 0;
    let mut faults = Vec::new();
    let mut own = vec![
        ("src/lib.rs".into(), Path::new("src")),
        ("src/main.rs".into(), Path::new("src")),
    ];
    let untested = folders.iter().filter(|folder| is_untested(folder));
    for folder in untested {
        let files = rust_files(&folder.to_string_lossy()).into_iter();
        let files = files.filter(|file| belongs(file, folder, &folders));
        own.extend(files.map(|file| (file, folder.as_path())));
    }
    assert!(
        is_untested(Path::new("")),
        "the root's own tests are in tests"
    );
    for (file, folder) in own {
        seen += 1;
        let text = std::fs::read_to_string(root().join(&file)).expect("readable");
        if MARKS.iter().any(|mark| text.contains(mark)) {
            let (file, folder) = (file.display(), folder.display());
            faults.push(format!(
                "{file}: a unit test, which {folder}/Cargo.toml does not build"
            ));
        }
    }
    assert!(seen > 100, "only {seen} files of crates without unit tests");
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
