//! The sources that the program is built from, for the keys of results and for what reports say of themselves: `OUT_DIR/sources.rs`, a value of
//! `edifice_frame::Sources` with digests of the sources of each crate of this workspace and the commit.
//!
//! A crate's digest is SHA-256 over the names and bytes of the files of its folder (without its tests and without the folders of other
//! crates), and its row names the crates of this workspace that it is built on. Of a package from a registry, whose neighbours are
//! not here, the table is empty: its sources are those of its version.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

type Anyway<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Anyway<()> {
    let here = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR")?);
    let root = here.join("..");
    let mut rows = String::new();
    let manifest = root.join("Cargo.toml");
    println!("cargo::rerun-if-changed=build.rs");
    if let Ok(text) = std::fs::read_to_string(&manifest) {
        println!("cargo::rerun-if-changed={}", manifest.display());
        let lock = root.join("Cargo.lock");
        let locked = std::fs::read_to_string(&lock).unwrap_or_default();
        println!("cargo::rerun-if-changed={}", lock.display());
        let crates = crates(&root, &text)?;
        for (name, folder) in &crates {
            println!("cargo::rerun-if-changed={}", folder.display());
            let others: Vec<&PathBuf> = crates.values().filter(|f| *f != folder).collect();
            let needs = needs(&std::fs::read_to_string(folder.join("Cargo.toml"))?);
            let digest = digest(&files(folder, &others)?, folder)?;
            rows += &format!("({name:?}, {digest:?}, &{needs:?}),\n");
        }
        rows += &format!(
            "(\"Cargo.lock\", \"{}\", &[]),\n",
            hex(&Sha256::digest(foreign(&locked)))
        );
    }
    let (commit, dirty) = match manifest.is_file() && root.join(".git").exists() {
        true => commit(&root),
        false => (None, None),
    };
    let out = PathBuf::from(std::env::var("OUT_DIR")?).join("sources.rs");
    let value = format!("Sources {{ crates: &[\n{rows}], commit: {commit:?}, dirty: {dirty:?} }}");
    std::fs::write(out, value)?;
    Ok(())
}

/// The commit that the sources were built from, and if they differ from it; nothing where git does not answer. A commit alone
/// builds nothing anew: the program says which one its sources were last built at.
fn commit(root: &Path) -> (Option<String>, Option<bool>) {
    let git = |arguments: &[&str]| {
        let mut command = std::process::Command::new("git");
        let output = command.arg("-C").arg(root).args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    // A version control that cannot be asked is as good as none.
    let Some(commit) = git(&["rev-parse", "HEAD"]) else {
        return (None, None);
    };
    let sources = [
        "status",
        "--porcelain",
        "--",
        "src",
        "experiments",
        "datasets",
        "Cargo.toml",
        "Cargo.lock",
    ];
    let changed = git(&sources);
    (Some(commit), changed.map(|files| !files.is_empty()))
}

/// Name and folder of each member of the workspace.
fn crates(root: &Path, manifest: &str) -> Anyway<BTreeMap<String, PathBuf>> {
    let mut crates = BTreeMap::new();
    let members = manifest.split("members = [").nth(1).unwrap_or_default();
    let members = members.split(']').next().unwrap_or_default();
    for member in members.split('"').skip(1).step_by(2) {
        let folder = root.join(member);
        let text = std::fs::read_to_string(folder.join("Cargo.toml"))?;
        let name = text.lines().find_map(|line| line.strip_prefix("name = "));
        let name = name.unwrap_or_default().trim().trim_matches('"').to_owned();
        crates.insert(name, folder);
    }
    Ok(crates)
}

/// Names of the crates of this workspace that a manifest depends on, those of its tests left out.
fn needs(manifest: &str) -> Vec<String> {
    let mut section = "";
    let mut needs = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            section = line.trim();
        }
        let end = line.find(['.', ' ', '=']).unwrap_or(line.len());
        if section == "[dependencies]" && line.starts_with("edifice-") {
            needs.push(line[..end].to_owned());
        }
    }
    needs
}

/// The lockfile without the entries of this workspace, whose sources have digests of their own.
fn foreign(locked: &str) -> String {
    let entries = locked.split("\n\n");
    let from_elsewhere: Vec<&str> = entries.filter(|e| e.contains("\nsource = ")).collect();
    from_elsewhere.join("\n\n")
}

/// Files below a folder, in order of name, without hidden ones, tests, and the folders of other crates.
fn files(folder: &Path, others: &[&PathBuf]) -> Anyway<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let skipped = ["tests", "tests.rs", "target", "README.md", "examples"];
            if name.starts_with('.') || skipped.contains(&&*name) {
                continue;
            }
            if path.is_dir() {
                if !others.contains(&&path) {
                    open.push(path);
                }
            } else {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

fn digest(files: &[PathBuf], folder: &Path) -> Anyway<String> {
    let mut hash = Sha256::new();
    for file in files {
        hash.update(file.strip_prefix(folder)?.to_string_lossy().as_bytes());
        hash.update([0]);
        hash.update(std::fs::read(file)?);
        hash.update([0]);
    }
    Ok(hex(&hash.finalize()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}
