//! Deleting a method breaks nothing else: only its own files name it, and a few registries, one line each.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{has_word, root, rust_files};

/// The crate that judges the proofs of facade grammars.
const SMALLEST: &str = "tests/smallest_grammar";

/// Files of a method that do not have its name: its commands, and programs that serve it alone.
const OWN: &[(&str, &str)] = &[
    ("facade_grammar", "src/cli/grammar/evaluate.rs"),
    ("facade_grammar", "src/cli/grammar/infer.rs"),
    ("facade_grammar", "src/cli/tolerance.rs"),
    ("facade_grammar", "src/cli/grammar/merge.rs"),
    ("facade_grammar", "examples/exact_search.rs"),
    ("facade_grammar", "examples/make_layouts.rs"),
    ("facade_grammar", SMALLEST),
    ("procedural_logic", "src/cli/logic"),
    ("building_exteriors", "src/cli/building"),
    ("structure_completion", "src/cli/facade/"),
    ("structure_completion", "examples/model_layout.rs"),
    ("city_proceduralization", "src/cli/city"),
];

/// Lists of methods: what is dropped with a method are single lines.
const REGISTRIES: &[&str] = &[
    "src/lib.rs",
    "src/cli/mod.rs",
    "src/editing/mod.rs",
    "experiments/mod.rs",
    "experiments/peers/mod.rs",
];

/// The list of another paper's artefacts is one, too: there may be artefacts that compare two papers.
fn is_registry(place: &str) -> bool {
    let artefacts = |slug: &String| place == format!("experiments/{slug}/mod.rs");
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

/// The methods: the folders of `src/methods`.
fn slugs() -> Vec<String> {
    let folders = std::fs::read_dir(root().join("src/methods")).expect("listed");
    let name = |entry: std::io::Result<std::fs::DirEntry>| {
        let name = entry.expect("an entry").file_name();
        name.to_string_lossy().into_owned()
    };
    let mut slugs: Vec<String> = folders.map(name).collect();
    slugs.sort();
    assert!(slugs.len() >= 3, "{slugs:?}");
    slugs
}

/// True if a line names a method: its slug, a crate of it, the library of such a crate or the crate that judges its proofs.
fn names(line: &str, slug: &str) -> bool {
    if is_own(slug, SMALLEST) && (line.contains(SMALLEST) || line.contains("edifice-smallest-")) {
        return true;
    }
    let dashed = slug.replace('_', "-");
    let of_crate = |kind: &str| {
        [
            format!("edifice_{}{slug}", kind.replace('-', "_")),
            format!("edifice-{kind}{dashed}"),
        ]
    };
    let mut known = ["", "experiments-", "generators-"]
        .into_iter()
        .flat_map(of_crate);
    has_word(line, slug)
        || known.any(|name| has_word(line, &name))
        || line.contains(&format!("src/methods/{slug}"))
}

#[test]
fn only_its_own_files_name_a_method() {
    let mut faults = Vec::new();
    for path in ["src", "experiments", "benches", "examples"]
        .iter()
        .flat_map(|folder| rust_files(folder))
    {
        let place = path.to_string_lossy().into_owned();
        let text = std::fs::read_to_string(root().join(&path)).expect("readable");
        // The tests of a file stand at its end.
        let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
        for slug in slugs() {
            if is_own(&slug, &place) || is_registry(&place) {
                continue;
            }
            let lines = code.lines().filter(|l| !l.trim_start().starts_with("//"));
            let crate_of = format!("edifice_{slug}");
            for line in
                lines.filter(|l| has_word(l, &crate_of) || l.contains(&format!("methods::{slug}")))
            {
                faults.push(format!("{place}: names {slug}: {}", line.trim()));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// Slow: checks the library, the experiments and the studio once for each method. `.ci/full` runs it. The command line is left
/// out: a method's commands are part of it.
///
/// One copy serves all methods, changed in place as a person would: only crates that name a method are checked again.
#[test]
#[ignore = "compiles the library once for each method"]
fn the_library_compiles_without_each_method() {
    let temporary = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let copy = temporary.join("without_a_method");
    // A folder of its own: cargo would take the copy's crates for those of this build, as they stand in the same places.
    let target = temporary.join("without");
    for slug in slugs() {
        update(&copy, &tree_without(&slug));
        let output = Command::new(env!("CARGO"))
            .current_dir(&copy)
            .args([
                "check",
                "--lib",
                "--quiet",
                "--offline",
                "--no-default-features",
            ])
            .args(["--features", "io,report", "-p", "edifice"])
            .args([
                "-p",
                "edifice-experiments",
                "-p",
                "edifice-studio",
                "--target-dir",
            ])
            .arg(&target)
            .output()
            .expect("cargo runs");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "without {slug}:\n{errors}");
    }
    std::fs::remove_dir_all(copy).expect("removed");
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

/// The files of the tree, by their places, without those of a method and the lines that name it in registries.
fn tree_without(slug: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut tree = BTreeMap::new();
    for folder in [
        "src",
        "experiments",
        "datasets",
        "benches",
        "examples",
        SMALLEST,
    ] {
        add_folder(slug, Path::new(folder), &mut tree);
    }
    for file in ["Cargo.lock", "README.md"] {
        let bytes = std::fs::read(root().join(file)).expect("readable");
        tree.insert(PathBuf::from(file), bytes);
    }
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).expect("readable");
    let manifest = manifest_without(slug, &manifest).into_bytes();
    tree.insert(PathBuf::from("Cargo.toml"), manifest);
    tree
}

/// Makes a folder hold the files of the tree and no others; what is there with the same bytes is not written.
fn update(copy: &Path, tree: &BTreeMap<PathBuf, Vec<u8>>) {
    for place in files_below(copy, Path::new("")) {
        if !tree.contains_key(&place) {
            std::fs::remove_file(copy.join(place)).expect("removed");
        }
    }
    for (place, bytes) in tree {
        let file = copy.join(place);
        if std::fs::read(&file).is_ok_and(|known| known == *bytes) {
            continue;
        }
        std::fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        std::fs::write(file, bytes).expect("written");
    }
}

/// The files below a folder, relative to it; none if it is not there.
fn files_below(copy: &Path, folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(copy.join(folder)).into_iter().flatten() {
        let entry = entry.expect("an entry");
        let place = folder.join(entry.file_name());
        match entry.path().is_dir() {
            true => found.extend(files_below(copy, &place)),
            false => found.push(place),
        }
    }
    found
}

/// A manifest without the targets of the method, which are paragraphs, and the lines that name it.
fn manifest_without(slug: &str, manifest: &str) -> String {
    let kept = manifest
        .split("\n\n")
        .filter(|paragraph| !paragraph.starts_with("[[") || !names_own(slug, paragraph));
    let kept: Vec<String> = kept
        .map(|paragraph| {
            let lines = paragraph.lines().filter(|line| !names(line, slug));
            lines.collect::<Vec<_>>().join("\n")
        })
        .collect();
    kept.join("\n\n")
}

fn add_folder(slug: &str, folder: &Path, tree: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in std::fs::read_dir(root().join(folder)).expect("listed") {
        let entry = entry.expect("an entry");
        let place = folder.join(entry.file_name());
        let name = place.display().to_string();
        if is_own(slug, &name) {
            continue;
        }
        if entry.path().is_dir() {
            add_folder(slug, &place, tree);
            continue;
        }
        let text = || std::fs::read_to_string(entry.path()).expect("readable");
        let bytes = if name.ends_with("Cargo.toml") {
            manifest_without(slug, &text()).into_bytes()
        } else if is_registry(&name) {
            let text = text();
            let kept = text
                .lines()
                .filter(|line| !names(line, slug) || line.starts_with("//!"));
            kept.collect::<Vec<_>>().join("\n").into_bytes()
        } else {
            std::fs::read(entry.path()).expect("readable")
        };
        tree.insert(place, bytes);
    }
}
