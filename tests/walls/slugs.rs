//! Deleting a method breaks nothing else: only its own files name it, and a few registries, one line each.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::source::{Source, has_word, sources};

/// Files of a method that do not have its name: its commands, and programs that serve it alone.
const OWN: &[(&str, &str)] = &[
    ("facade_grammar", "src/cli/grammar/infer.rs"),
    ("facade_grammar", "src/cli/grammar/merge.rs"),
    ("facade_grammar", "examples/exact_search.rs"),
    ("facade_grammar", "examples/make_layouts.rs"),
    ("procedural_logic", "src/cli/logic"),
    ("building_exteriors", "src/cli/building"),
    ("structure_completion", "src/cli/facade/"),
    ("city_proceduralization", "src/cli/city"),
];

/// Lists of methods: what is dropped with a method are single lines.
const REGISTRIES: &[&str] = &[
    "src/methods/mod.rs",
    "src/cli/mod.rs",
    "src/editing/mod.rs",
    "experiments/mod.rs",
    "experiments/peers.rs",
];

/// The list of another paper's artefacts is one, too: there may be artefacts that compare two papers.
fn is_registry(place: &str) -> bool {
    let artefacts = |slug: &String| place == format!("experiments/{slug}.rs");
    REGISTRIES.contains(&place) || slugs().iter().any(artefacts)
}

/// True if a file goes with the method.
fn is_own(slug: &str, place: &str) -> bool {
    let named = place.split(['/', '.']).any(|part| {
        part == slug
            || part
                .strip_prefix(slug)
                .is_some_and(|rest| rest.starts_with('_'))
    });
    let listed = |(of, path): &(&str, &str)| *of == slug && place.starts_with(path);
    named || OWN.iter().any(listed)
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The methods, as `src/methods/mod.rs` lists them.
fn slugs() -> Vec<String> {
    let text = std::fs::read_to_string(root().join("src/methods/mod.rs")).expect("readable");
    let slug = |line: &str| Some(line.strip_prefix("pub mod ")?.strip_suffix(';')?.to_owned());
    let slugs: Vec<String> = text.lines().filter_map(slug).collect();
    assert!(slugs.len() >= 3, "{slugs:?}");
    slugs
}

#[test]
fn only_its_own_files_name_a_method() {
    let folders = ["src", "experiments", "benches", "examples"];
    let all: Vec<Source> = folders.iter().flat_map(|f| sources(root(), f)).collect();
    let mut faults = Vec::new();
    for slug in slugs() {
        let strangers = all
            .iter()
            .filter(|source| !is_own(&slug, &source.place) && !is_registry(&source.place));
        let naming = strangers.filter(|source| source.names(&slug));
        faults.extend(naming.map(|source| format!("{}: names {slug}", source.place)));
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// Slow: checks the library once for each method. `.ci/run` runs it.
#[test]
#[ignore = "compiles the library once for each method"]
fn the_library_compiles_without_each_method() {
    for slug in slugs() {
        let copy = copy_without(&slug);
        // The dependencies are those of this build.
        let target = Path::new(env!("CARGO_TARGET_TMPDIR"))
            .parent()
            .expect("a folder");
        let output = Command::new(env!("CARGO"))
            .current_dir(&copy)
            .args(["check", "--lib", "--quiet", "--offline", "--target-dir"])
            .arg(target)
            .output()
            .expect("cargo runs");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "without {slug}:\n{errors}");
        std::fs::remove_dir_all(copy).expect("removed");
    }
}

/// True if a target of the manifest is one of the method's.
fn names_own(slug: &str, target: &str) -> bool {
    let stem = |path: &str| Path::new(path).file_stem()?.to_str().map(str::to_owned);
    let programs = OWN
        .iter()
        .filter(|(of, path)| *of == slug && path.ends_with(".rs"));
    let mut names = programs.filter_map(|(_, path)| stem(path));
    has_word(target, slug) || names.any(|name| has_word(target, &name))
}

/// A copy of the tree without the files of a method and the lines that name it in registries.
fn copy_without(slug: &str) -> PathBuf {
    let copy = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("without_{slug}"));
    if copy.exists() {
        std::fs::remove_dir_all(&copy).expect("removed");
    }
    for folder in ["src", "experiments", "datasets", "benches", "examples"] {
        copy_folder(slug, Path::new(folder), &copy);
    }
    for file in ["Cargo.lock", "README.md"] {
        std::fs::copy(root().join(file), copy.join(file)).expect("copied");
    }
    // The targets of the method go, paragraph by paragraph.
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).expect("readable");
    let kept: Vec<&str> = manifest
        .split("\n\n")
        .filter(|paragraph| !paragraph.starts_with("[[") || !names_own(slug, paragraph))
        .collect();
    std::fs::write(copy.join("Cargo.toml"), kept.join("\n\n")).expect("written");
    copy
}

fn copy_folder(slug: &str, folder: &Path, copy: &Path) {
    std::fs::create_dir_all(copy.join(folder)).expect("made");
    for entry in std::fs::read_dir(root().join(folder)).expect("listed") {
        let entry = entry.expect("an entry");
        let place = folder.join(entry.file_name());
        let name = place.display().to_string();
        if is_own(slug, &name) {
            continue;
        }
        if entry.path().is_dir() {
            copy_folder(slug, &place, copy);
        } else if is_registry(&name) {
            let text = std::fs::read_to_string(entry.path()).expect("readable");
            let kept = text
                .lines()
                .filter(|line| !has_word(line, slug) || line.starts_with("//!"));
            let kept: Vec<&str> = kept.collect();
            std::fs::write(copy.join(&place), kept.join("\n")).expect("written");
        } else {
            std::fs::copy(entry.path(), copy.join(&place)).expect("copied");
        }
    }
}
