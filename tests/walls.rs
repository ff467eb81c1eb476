//! Imports run down only: each part of the crate sees those below it, and no method sees another.

use std::path::{Path, PathBuf};

/// Each part and what it may import from the crate, besides itself.
const WALLS: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("rng", &[]),
    ("file", &["error"]),
    ("model", &["error", "rng"]),
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
            "error", "rng", "model", "optim", "cluster", "grammar", "shape", "scene", "layout",
        ],
    ),
    (
        "experiments",
        &[
            "error", "rng", "file", "grammar", "io", "methods", "report", "shape", "model",
            "optim", "cluster", "scene", "layout",
        ],
    ),
];

#[test]
fn imports_run_down_only() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut faults = Vec::new();
    let mut seen = 0;
    for (part, allowed) in WALLS {
        let home = match *part {
            "experiments" => root.join("experiments"),
            part => root.join("src").join(part),
        };
        let mut files = rust_files(&home);
        files.extend(Some(home.with_extension("rs")).filter(|f| f.is_file()));
        assert!(!files.is_empty(), "no source for {part}");
        for file in files {
            let text = code(&std::fs::read_to_string(&file).expect("source is readable"));
            let place = file
                .strip_prefix(root)
                .unwrap_or(&file)
                .display()
                .to_string();
            seen += 1;
            for import in imports(&text) {
                if import != *part && !allowed.contains(&import.as_str()) {
                    faults.push(format!("{place}: {part} imports {import}"));
                }
            }
            faults.extend(other_methods(&place, &text));
        }
    }
    assert!(seen > 20, "only {seen} files found");
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn the_parser_of_imports_sees_every_form() {
    let text = code(
        "use crate::io::{self, x};\nuse crate::{Error, report::{Row, Table}, rng};\n\
         fn f() { crate::model::run() }\n/// [`crate::optim`]\n// crate::cluster\n\
         #[cfg(test)]\nmod tests { use crate::methods; }\n",
    );
    assert_eq!(imports(&text), ["io", "error", "report", "rng", "model"]);
}

/// Methods that a file of another method names.
fn other_methods(place: &str, text: &str) -> Vec<String> {
    let Some(own) = place
        .strip_prefix("src/methods/")
        .and_then(|p| p.split_once('/'))
    else {
        return Vec::new();
    };
    [
        "facade_grammar",
        "procedural_logic",
        "structure_completion",
        "building_exteriors",
        "city_proceduralization",
    ]
    .iter()
    .filter(|slug| **slug != own.0)
    .filter(|slug| text.contains(&format!("{slug}::")))
    .map(|slug| format!("{place}: imports the method {slug}"))
    .collect()
}

/// Source without comments and without its module of tests.
fn code(text: &str) -> String {
    let tests = (text.find("#[cfg(test)]\nmod tests"))
        .or_else(|| text.find("#[cfg(all(test, feature = \"io\"))]\nmod tests"));
    let text = &text[..tests.unwrap_or(text.len())];
    text.lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// The crate's parts that a source names, in order; `Error` and `Result` are those of `error`.
fn imports(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices("crate::") {
        let before = text[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '$') {
            continue;
        }
        let rest = &text[at + "crate::".len()..];
        match rest.strip_prefix('{') {
            Some(list) => found.extend(top_names(list)),
            None => found.push(name(rest)),
        }
    }
    found
        .into_iter()
        .map(|part| match part.as_str() {
            "Error" | "Result" => "error".to_string(),
            _ => part,
        })
        .collect()
}

/// The first name of each entry of a braced list, whose own braces may nest.
fn top_names(list: &str) -> Vec<String> {
    let (mut depth, mut start, mut names) = (0, 0, Vec::new());
    for (i, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            ',' if depth == 0 => {
                names.push(name(&list[start..i]));
                start = i + 1;
            }
            '}' if depth == 0 => {
                names.push(name(&list[start..i]));
                break;
            }
            '}' => depth -= 1,
            _ => {}
        }
    }
    names.retain(|n| !n.is_empty());
    names
}

fn name(text: &str) -> String {
    let word = |c: &char| c.is_alphanumeric() || *c == '_';
    text.trim_start().chars().take_while(word).collect()
}

/// Rust files below a folder; modules of tests may look over the walls.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let Ok(entries) = std::fs::read_dir(folder) else {
        return files;
    };
    for path in entries.filter_map(|e| e.ok().map(|e| e.path())) {
        let is_tests = path.file_stem().is_some_and(|stem| stem == "tests");
        if path.is_dir() && !is_tests {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") && !is_tests {
            files.push(path);
        }
    }
    files.sort();
    files
}
