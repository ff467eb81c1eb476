//! Digests of the sources that a result depends on: the version of a program says nothing where its code has changed.
//!
//! The build script (`experiments/build.rs`) writes a row per crate of the workspace: its name, SHA-256 of its sources, the crates that it is built
//! on. A study depends on the crates of its method with all that those are built on, on its own part of the experiments (question and judge) and of the generators, and
//! on the versions of all foreign crates (`Cargo.lock`). A comment counts as a change; tests do not.

use std::collections::BTreeSet;

use sha2::{Digest, Sha256};

use crate::frame::provenance::hex;

/// Name, digest, and the crates it is built on.
type Row = (&'static str, &'static str, &'static [&'static str]);

const TABLE: &[Row] = include!(concat!(env!("OUT_DIR"), "/sources.rs"));

/// Digest of some crates with all that they are built on, of a part of the experiments, and of the versions of foreign crates.
///
/// Of a program that was built from a package of a registry, where no sources of neighbours lie, the version stands for them.
pub(crate) fn digest(crates: &[&str], part: &str) -> String {
    let mut wanted: BTreeSet<&str> = BTreeSet::new();
    let mut open: Vec<&str> = crates.to_vec();
    while let Some(name) = open.pop() {
        if wanted.insert(name)
            && let Some(row) = TABLE.iter().find(|row| row.0 == name)
        {
            open.extend(row.2);
        }
    }
    let parts = ["experiments", "experiments/generators"].map(|room| format!("{room}/{part}"));
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    for (name, digest, _) in TABLE {
        if wanted.contains(name) || *name == "Cargo.lock" || parts.iter().any(|part| part == name) {
            hash.update(name);
            hash.update([0]);
            hash.update(digest);
            hash.update([0]);
        }
    }
    hex(&hash.finalize()[..16])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_do_not_share_a_digest() {
        let grammar = digest(&["edifice-facade-grammar"], "facade_grammar");
        let logic = digest(&["edifice-procedural-logic"], "procedural_logic");
        assert_ne!(grammar, logic);
        assert_eq!(
            grammar,
            digest(&["edifice-facade-grammar"], "facade_grammar")
        );
    }

    #[test]
    fn a_crate_stands_on_what_it_is_built_on() {
        let row = |name: &str| TABLE.iter().find(|row| row.0 == name);
        let grammar = row("edifice-facade-grammar").unwrap();
        assert!(grammar.2.contains(&"edifice-grammar"), "{:?}", grammar.2);
        for part in [
            "experiments/facade_grammar",
            "experiments/generic",
            "experiments/generators/facade_grammar",
            "Cargo.lock",
        ] {
            assert!(row(part).is_some(), "{part}");
        }
    }
}
