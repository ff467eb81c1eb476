//! The kinds of JSON files that are told by their names, so that none is written under the name of another.

use std::path::Path;

use edifice_base::{Error, Result};

/// The words before `.json` in the names of files of one kind (`FORMATS.md`).
const KINDS: [&str; 15] = [
    "building",
    "city",
    "city-grammar",
    "completion",
    "encoded",
    "facade",
    "grammar",
    "grid",
    "houses",
    "knapsack",
    "library",
    "logic",
    "made-city",
    "schema",
    "table-model",
];

/// Refuses a file name that says another kind of JSON file than `own`.
///
/// # Errors
/// [`Error::Option`].
pub(crate) fn check(path: &Path, own: &str) -> Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_lowercase();
    let stem = name.strip_suffix(".json");
    let said = stem.and_then(|stem| Some(stem.rsplit_once('.')?.1));
    match said.filter(|said| *said != own && KINDS.contains(said)) {
        None => Ok(()),
        Some(said) => {
            let message = format!(
                "{:?} is the name of a .{said}.json, expected .{own}.json",
                path.display().to_string()
            );
            Err(Error::option("output", message))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_other_kinds_are_refused() {
        for fine in [
            "a.facade.json",
            "a.json",
            "facade.json",
            "a.b.json",
            "a.grammar.svg",
            "grammar.json",
        ] {
            assert!(check(fine.as_ref(), "facade").is_ok(), "{fine}");
        }
        for wrong in ["a.grammar.json", "dir/a.Library.JSON", ".grammar.json"] {
            let message = check(wrong.as_ref(), "facade").unwrap_err().to_string();
            assert!(message.contains("expected .facade.json"), "{message}");
        }
    }
}
