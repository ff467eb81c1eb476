//! Crates without unit tests, or without tests in their documentation, build no program for them; one that is added there does not go
//! unseen.

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

/// True if the manifest of a folder says this of its library.
fn says(folder: &Path, setting: &str) -> bool {
    let manifest = std::fs::read_to_string(root().join(folder).join("Cargo.toml"));
    let manifest = manifest.expect("a manifest");
    let library = manifest.split("[lib]").nth(1).unwrap_or_default();
    let library = library.split("\n[").next().unwrap_or_default();
    library.lines().any(|line| line == setting)
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

/// Files of the crates of which the manifest says this, with their text.
fn files(setting: &str) -> Vec<(PathBuf, String)> {
    let folders = folders();
    assert!(folders.len() > 30, "only {} crates", folders.len());
    let mut found = Vec::new();
    for folder in folders.iter().filter(|folder| says(folder, setting)) {
        let files = rust_files(&folder.to_string_lossy()).into_iter();
        found.extend(files.filter(|file| belongs(file, folder, &folders)));
    }
    let text = |file: PathBuf| {
        let text = std::fs::read_to_string(root().join(&file)).expect("readable");
        (file, text)
    };
    found.into_iter().map(text).collect()
}

/// True if a block of code of the documentation would be compiled as a test.
fn has_doc_test(text: &str) -> bool {
    let mut open = false;
    for line in text.lines().map(str::trim_start) {
        let comment = line.strip_prefix("///").or(line.strip_prefix("//!"));
        let Some(info) = comment.and_then(|c| c.trim().strip_prefix("```")) else {
            continue;
        };
        open = !open;
        let other = ["text", "ignore", "toml", "json", "sh", "csv"];
        if open && !other.iter().any(|language| info.starts_with(language)) {
            return true;
        }
    }
    false
}

#[test]
fn crates_without_unit_tests_have_none() {
    let mut files = files("test = false");
    assert!(says(Path::new(""), "test = false"));
    for name in ["src/lib.rs", "src/main.rs"] {
        let text = std::fs::read_to_string(root().join(name)).expect("readable");
        files.push((name.into(), text));
    }
    assert!(files.len() > 100, "only {} files", files.len());
    let tested = files.iter();
    let tested: Vec<&PathBuf> = tested
        .filter(|(_, text)| MARKS.iter().any(|mark| text.contains(mark)))
        .map(|(file, _)| file)
        .collect();
    assert!(
        tested.is_empty(),
        "unit tests in crates whose manifest says `test = false`: {tested:?}"
    );
}

#[test]
fn crates_without_tests_in_their_documentation_have_none() {
    assert!(has_doc_test("/// ```\n/// f();\n/// ```"));
    assert!(has_doc_test("    //! ```no_run\n//! f();"));
    assert!(!has_doc_test("/// ```text\n/// a\n/// ```\nfn f() {}"));
    let files = files("doctest = false");
    assert!(files.len() > 400, "only {} files", files.len());
    let tested = files.iter().filter(|(_, text)| has_doc_test(text));
    let tested: Vec<&PathBuf> = tested.map(|(file, _)| file).collect();
    assert!(
        tested.is_empty(),
        "tests in the documentation of crates whose manifest says `doctest = false`: {tested:?}"
    );
}
