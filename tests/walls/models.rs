//! The models of the model crate: none imports another, and what they share imports none of them.

use crate::{root, rust_files};

const MODELS: [&str; 4] = ["factor_graph", "gmm", "hierarchy", "network"];
const SHARED_BY_MODELS: [&str; 11] = [
    "chunks",
    "conjugate",
    "elimination",
    "em",
    "error",
    "gaussian",
    "graph",
    "information",
    "linalg",
    "standardize",
    "table",
];

#[test]
fn models_do_not_know_each_other() {
    let mut faults = Vec::new();
    let mut seen = 0;
    for path in rust_files("src/model") {
        let place = path.to_string_lossy().into_owned();
        let own = place.split('/').nth(2).expect("below src/model");
        let own = own.trim_end_matches(".rs");
        if !MODELS.contains(&own) && !SHARED_BY_MODELS.contains(&own) {
            continue;
        }
        seen += 1;
        let text = std::fs::read_to_string(root().join(&path)).expect("readable");
        for line in text.lines().filter(|l| !l.trim_start().starts_with("//")) {
            for other in MODELS.iter().filter(|other| **other != own) {
                if line.contains(&format!("crate::{other}::"))
                    || line.contains(&format!("super::{other}::"))
                {
                    faults.push(format!("{place}: {own} imports {other}: {}", line.trim()));
                }
            }
        }
    }
    assert!(seen > 40, "only {seen} files of models found");
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
