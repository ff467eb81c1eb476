//! Imports run down only: each part of the crate sees those below it, and no method sees another. Deleting a method breaks
//! nothing else.

mod slugs;
mod source;

use std::path::Path;

use source::{Source, sources};

/// Each part and what it may import from the crate, besides itself.
const WALLS: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("rng", &[]),
    ("file", &["error"]),
    ("model", &["error", "rng"]),
    ("tables", &["error", "rng", "model"]),
    ("optim", &["error", "rng"]),
    ("cluster", &["error", "rng"]),
    ("report", &["error", "rng", "file"]),
    ("shape", &["error", "rng"]),
    ("scene", &["error", "rng", "shape"]),
    ("layout", &["error", "rng", "shape", "optim", "grammar"]),
    ("grammar", &["error", "rng", "shape"]),
    ("io", &["error", "file", "grammar", "shape", "scene"]),
    (
        "methods",
        &[
            "error", "rng", "model", "tables", "optim", "cluster", "grammar", "shape", "scene",
            "layout",
        ],
    ),
    (
        "experiments",
        &[
            "error", "rng", "file", "grammar", "io", "methods", "report", "shape", "model",
            "tables", "optim", "cluster", "scene", "layout",
        ],
    ),
    (
        "editing",
        &[
            "error",
            "rng",
            "file",
            "grammar",
            "io",
            "methods",
            "shape",
            "model",
            "tables",
            "scene",
            "layout",
            "experiments",
        ],
    ),
    ("studio", &["error", "file", "io", "editing"]),
    // `main.rs` sees `cli` alone; `cli` sees the whole library.
    ("main", &["cli"]),
    (
        "cli",
        &[
            "error",
            "rng",
            "file",
            "grammar",
            "io",
            "methods",
            "report",
            "shape",
            "model",
            "tables",
            "optim",
            "cluster",
            "scene",
            "layout",
            "experiments",
            "editing",
            "studio",
        ],
    ),
];

/// The models of `model`: none imports another, and what they share imports none of them.
const MODELS: [&str; 4] = ["factor_graph", "gmm", "hierarchy", "network"];
const SHARED_BY_MODELS: [&str; 12] = [
    "chunks",
    "conjugate",
    "elimination",
    "em",
    "error",
    "gaussian",
    "graph",
    "information",
    "kmeans",
    "linalg",
    "standardize",
    "table",
];

/// The sources of the library, the experiments and the commands.
fn all() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = sources(root, "src");
    all.extend(sources(root, "experiments"));
    assert!(all.len() > 100, "only {} files found", all.len());
    all
}

#[test]
fn imports_run_down_only() {
    let mut faults = Vec::new();
    for source in all() {
        let part = source.module.first().map_or("main", String::as_str);
        if matches!(part, "lib" | "bin") {
            continue;
        }
        let wall = WALLS.iter().find(|(name, _)| *name == part);
        let Some((_, allowed)) = wall else {
            faults.push(format!("{}: no wall is known of {part}", source.place));
            continue;
        };
        for import in source.imports() {
            let to = import[0].as_str();
            if to != part && !allowed.contains(&to) {
                faults.push(format!("{}: {part} imports {to}", source.place));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn models_do_not_know_each_other() {
    let mut faults = Vec::new();
    for source in all() {
        let (Some("model"), Some(own)) = (
            source.module.first().map(String::as_str),
            source.module.get(1).map(String::as_str),
        ) else {
            continue;
        };
        if !MODELS.contains(&own) && !SHARED_BY_MODELS.contains(&own) {
            continue;
        }
        for import in source.imports() {
            let (part, to) = (&import[0], import.get(1).map_or("", String::as_str));
            if part == "model" && to != own && MODELS.contains(&to) {
                faults.push(format!("{}: {own} imports {to}", source.place));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn no_method_imports_another() {
    let mut faults = Vec::new();
    for source in all().iter().filter(|source| {
        source.module[..]
            .first()
            .is_some_and(|part| part == "methods")
    }) {
        let own = source.module.get(1);
        for import in source.imports() {
            if import[0] == "methods" && own.is_some() && import.get(1) != own {
                faults.push(format!("{}: imports {}", source.place, import.join("::")));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn the_parser_of_imports_sees_every_form() {
    let text = "use crate::io::{self, x};\nuse crate::{Error, report::{Row, Table}, rng};\n\
         fn f() { crate::model::run(\"crate::text\") }\n/// [`crate::optim`]\n// crate::cluster\n\
         use super::super::shape::{Rect, grid::Cell};\nuse self::inner::A;\nuse super::b::C;\nuse edifice::file;\n\
         let c = '\"'; let d = r#\"crate::raw\"#; fn g<'a>(x: &'a str) { super::d() }\n\
         #[cfg(test)]\nmod tests { use crate::methods; }\n";
    let source = Source::new("src/methods/some/part.rs", text);
    assert_eq!(source.module, ["methods", "some", "part"]);
    let found: Vec<String> = source
        .imports()
        .iter()
        .map(|path| path.join("::"))
        .collect();
    let expected = [
        "io",
        "io::x",
        "error",
        "report::Row",
        "report::Table",
        "rng",
        "model::run",
        "methods::shape::Rect",
        "methods::shape::grid::Cell",
        "methods::some::part::inner::A",
        "methods::some::b::C",
        "file",
        "methods::some::d",
    ];
    for path in expected {
        assert!(found.contains(&path.to_owned()), "{path} not in {found:?}");
    }
    assert_eq!(found.len(), expected.len(), "{found:?}");
}
