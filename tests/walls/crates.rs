//! The dependencies among the crates of the workspace, drawn in `ARCHITECTURE.md`: the picture is made from `cargo metadata`,
//! so that a new arrow is seen by whoever reads the change.
//!
//! `EDIFICE_DRAW_HOUSE=1 cargo test --test walls` writes the picture anew.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use crate::root;

const BEGIN: &str = "<!-- house: drawn by tests/walls/crates.rs -->\n";
const END: &str = "<!-- end of the house -->";

/// The crates of the workspace, each with those that it depends on (not for tests), and its folder.
fn crates() -> BTreeMap<String, (String, BTreeSet<String>)> {
    let output = Command::new(env!("CARGO"))
        .current_dir(root())
        .args([
            "metadata",
            "--format-version",
            "1",
            "--no-deps",
            "--offline",
        ])
        .output()
        .expect("cargo runs");
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let folder = |package: &serde_json::Value| {
        let manifest = std::path::Path::new(package["manifest_path"].as_str().expect("a path"));
        let folder = manifest.parent().expect("a folder");
        let inside = folder.strip_prefix(root()).expect("in the workspace");
        inside.to_string_lossy().replace('\\', "/")
    };
    let mut found = BTreeMap::new();
    for package in packages {
        let dependencies = package["dependencies"].as_array().expect("dependencies");
        let ours = dependencies
            .iter()
            .filter(|d| d["kind"].is_null())
            .filter_map(|d| d["name"].as_str())
            .filter(|name| name.starts_with("edifice"))
            .map(str::to_owned);
        let name = package["name"].as_str().expect("a name").to_owned();
        found.insert(name, (folder(package), ours.collect()));
    }
    found
}

/// The crates from the bottom up: a crate stands above all that it depends on.
fn floors(crates: &BTreeMap<String, (String, BTreeSet<String>)>) -> Vec<Vec<String>> {
    let mut floors: Vec<Vec<String>> = Vec::new();
    let mut placed = BTreeSet::new();
    while placed.len() < crates.len() {
        let ready = crates
            .iter()
            .filter(|(name, (_, below))| !placed.contains(*name) && below.is_subset(&placed));
        let floor: Vec<String> = ready.map(|(name, _)| name.clone()).collect();
        assert!(!floor.is_empty(), "a circle among {crates:?}");
        placed.extend(floor.iter().cloned());
        floors.push(floor);
    }
    floors
}

/// The dependencies of a crate that no other of its dependencies implies.
fn direct(crates: &BTreeMap<String, (String, BTreeSet<String>)>, name: &str) -> BTreeSet<String> {
    fn below(
        crates: &BTreeMap<String, (String, BTreeSet<String>)>,
        name: &str,
        found: &mut BTreeSet<String>,
    ) {
        for next in &crates[name].1 {
            if found.insert(next.clone()) {
                below(crates, next, found);
            }
        }
    }
    let all = &crates[name].1;
    let mut implied = BTreeSet::new();
    for next in all {
        below(crates, next, &mut implied);
    }
    all.difference(&implied).cloned().collect()
}

fn short(name: &str) -> &str {
    name.strip_prefix("edifice-").unwrap_or(name)
}

/// The house in words, top floor first: each crate with its folder and the crates that it stands on.
fn drawn() -> String {
    let crates = crates();
    let mut lines = vec!["```text".to_owned()];
    for (height, floor) in floors(&crates).iter().enumerate().rev() {
        lines.push(format!("floor {height}"));
        for name in floor {
            let folder = &crates[name].0;
            let folder = if folder.is_empty() { "." } else { folder };
            let below = direct(&crates, name);
            let below: Vec<&str> = below.iter().map(|b| short(b)).collect();
            let on = if below.is_empty() {
                String::new()
            } else {
                format!(" on {}", below.join(", "))
            };
            lines.push(
                format!("  {:<42}{folder:<44}{on}", short(name))
                    .trim_end()
                    .to_owned(),
            );
        }
    }
    lines.push("```\n".to_owned());
    lines.join("\n")
}

#[test]
fn the_picture_of_the_house_is_true() {
    let path = root().join("ARCHITECTURE.md");
    let page = std::fs::read_to_string(&path).expect("readable");
    let (before, rest) = page.split_once(BEGIN).expect("the picture begins");
    let (picture, after) = rest.split_once(END).expect("the picture ends");
    let drawn = drawn();
    if std::env::var_os("EDIFICE_DRAW_HOUSE").is_some() {
        std::fs::write(&path, format!("{before}{BEGIN}{drawn}{END}{after}")).expect("written");
        return;
    }
    assert_eq!(
        picture, drawn,
        "a dependency changed: EDIFICE_DRAW_HOUSE=1 cargo test --test walls draws the house anew"
    );
}

#[test]
fn no_method_depends_on_another_and_only_the_top_sees_commands_and_sockets() {
    let crates = crates();
    let is_method = |name: &String| crates[name].0.starts_with("src/methods/");
    for (name, (_, below)) in crates.iter().filter(|(name, _)| is_method(name)) {
        assert!(!below.iter().any(is_method), "{name} depends on a method");
    }
    for (of, above) in [
        ("edifice-experiments", vec!["edifice-cli"]),
        ("edifice-editing", vec!["edifice-cli", "edifice-studio"]),
        ("edifice-studio", vec!["edifice-cli"]),
        ("edifice-cli", vec!["edifice"]),
    ] {
        let found = crates.iter().filter(|(_, (_, below))| below.contains(of));
        let found: Vec<&str> = found.map(|(name, _)| name.as_str()).collect();
        assert_eq!(found, above, "who depends on {of}");
    }
    for (generic, sibling) in [("model", "optim"), ("optim", "model")] {
        let below = &crates[&format!("edifice-{generic}")].1;
        assert!(!below.contains(&format!("edifice-{sibling}")));
    }
}
