//! The surface of the library: the modules at the top of `edifice`, and foreign crates whose types are in signatures.

use std::collections::BTreeSet;

use crate::{has_word, root, rust_files};

/// Modules at the top of `edifice` at most.
const MOST: usize = 12;

#[test]
fn the_library_has_few_modules_at_its_top() {
    let text = std::fs::read_to_string(root().join("src/lib.rs")).expect("readable");
    let mut modules = BTreeSet::new();
    for line in text.lines() {
        let line = line.trim_end_matches(';').trim_end_matches(" {");
        if let Some(name) = line.strip_prefix("pub mod ") {
            modules.insert(name.to_owned());
        } else if let Some((_, name)) = line
            .split_once(" as ")
            .filter(|_| line.starts_with("pub use"))
        {
            modules.insert(name.to_owned());
        } else if let Some((_, names)) = line
            .split_once("::{")
            .filter(|_| line.starts_with("pub use"))
        {
            let names = names.trim_end_matches('}').split(", ");
            // Modules and functions are in lower case; `unwatched` is the one function.
            let lower = names.filter(|n| n.starts_with(char::is_lowercase) && *n != "unwatched");
            modules.extend(lower.map(str::to_owned));
        }
    }
    assert!(
        modules.contains("model") && modules.contains("rng"),
        "{modules:?}"
    );
    assert!(modules.len() <= MOST, "{modules:?}");
    for inner in ["cli", "editing", "experiments", "generators", "studio"] {
        assert!(!modules.contains(inner), "{inner} is in the surface");
    }
}

/// The folders of crates that others use as libraries.
fn libraries() -> Vec<String> {
    let mut found = Vec::new();
    for folder in ["src", "src/methods", "src/io"] {
        for entry in std::fs::read_dir(root().join(folder)).expect("listed") {
            let name = entry.expect("an entry").file_name();
            let place = format!("{folder}/{}", name.to_string_lossy());
            let inner = ["src/cli", "src/editing", "src/studio"].contains(&place.as_str());
            if !inner && root().join(&place).join("Cargo.toml").exists() {
                found.push(place);
            }
        }
    }
    found
}

/// The signatures of public functions: from `pub fn` to the body.
fn signatures(code: &str) -> impl Iterator<Item = &str> {
    let starts = code.match_indices("pub fn ").map(|(at, _)| &code[at..]);
    starts.map(|rest| rest.split(['{', ';']).next().unwrap_or_default())
}

#[test]
fn foreign_types_in_signatures_are_handed_on() {
    let all = libraries();
    assert!(all.len() >= 12, "{all:?}");
    let mut faults = Vec::new();
    for library in &all {
        let page = std::fs::read_to_string(root().join(library).join("mod.rs")).expect("readable");
        for path in rust_files(library) {
            let tests = path.components().any(|c| c.as_os_str() == "tests");
            let inner = all
                .iter()
                .any(|other| other.len() > library.len() && path.starts_with(other));
            let own = !tests && !inner;
            let text = std::fs::read_to_string(root().join(&path)).expect("readable");
            let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            for signature in signatures(code).filter(|_| own) {
                let shows = |words: &[&str]| words.iter().any(|w| has_word(signature, w));
                let wanted = [
                    ("rand", shows(&["Rng"])),
                    ("nalgebra", shows(&["DMatrix", "DVector"])),
                ];
                for (name, _) in wanted.iter().filter(|(_, shown)| *shown) {
                    if !page.contains(&format!("\npub use {name};")) {
                        faults.push(format!("{library} does not hand on {name}: {signature}"));
                    }
                }
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
