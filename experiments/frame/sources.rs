//! Digests of the sources that a result depends on: the version of a program says nothing where its code has changed.
//!
//! The build script of the program (`experiments/build.rs`) writes a row per crate of the workspace: its name, SHA-256 of its sources, the crates
//! that it is built on. They are a value that the program hands on: were they part of this crate, each change of a source would compile
//! all experiments anew. A study depends on the crates of its method with all that those are built on, on its own part of the experiments
//! (question and judge) and of the generators, and on the versions of all foreign crates (`Cargo.lock`). A comment counts as a change; tests do not.

use std::collections::BTreeSet;

use sha2::{Digest, Sha256};

use super::provenance::hex;

/// The sources that a program was built from.
#[derive(Debug)]
pub struct Sources {
    /// Of each crate: name, digest, and the names of the crates that it is built on.
    pub crates: &'static [(&'static str, &'static str, &'static [&'static str])],
    /// The commit of the sources; none where no version control could be asked.
    pub commit: Option<&'static str>,
    /// True if files differed from the commit; none as above.
    pub dirty: Option<bool>,
}

impl Sources {
    /// Digest of some crates with all that they are built on, of a part of the experiments (a paper's slug, or `generic`), and of the versions
    /// of foreign crates.
    ///
    /// Of a program that was built from a package of a registry, where no sources of neighbours lie, the version stands for them.
    pub fn digest(&self, crates: &[&str], part: &str) -> String {
        let mut wanted: BTreeSet<&str> = BTreeSet::new();
        let mut open: Vec<&str> = crates.to_vec();
        while let Some(name) = open.pop() {
            if wanted.insert(name)
                && let Some(row) = self.crates.iter().find(|row| row.0 == name)
            {
                open.extend(row.2);
            }
        }
        let part = part.replace('_', "-");
        let parts = ["experiments", "generators"].map(|room| format!("edifice-{room}-{part}"));
        let mut hash = Sha256::new();
        hash.update(env!("CARGO_PKG_VERSION"));
        for (name, digest, _) in self.crates {
            if wanted.contains(name)
                || *name == "Cargo.lock"
                || parts.iter().any(|part| part == name)
            {
                hash.update(name);
                hash.update([0]);
                hash.update(digest);
                hash.update([0]);
            }
        }
        hex(&hash.finalize()[..16])
    }

    /// Digest of what a paper's artefacts depend on: its method and all that this is built on, the readers and the layouts, its own experiments,
    /// and the versions of foreign crates.
    pub fn of_paper(&self, slug: &str) -> String {
        let method = format!("edifice-{}", slug.replace('_', "-"));
        self.digest(&[&method, "edifice-io", "edifice-layout"], slug)
    }
}
