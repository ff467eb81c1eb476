//! Documents to begin with: shipped data, and an empty facade to draw on.

use std::path::Path;
use std::sync::Arc;

pub use super::example::{Example, Source};
use super::work::Work;
use super::{EDITORS, State, open};
use edifice_base::{Error, Result};
use edifice_datasets::shipped_bytes;

/// All of them, those of one editor after those of another.
pub fn examples() -> impl Iterator<Item = &'static Example> {
    EDITORS.iter().flat_map(|e| e.examples)
}

/// No example has this id.
#[derive(Debug, thiserror::Error)]
#[error("there is no example {0:?}")]
pub struct NoExample(pub String);

/// Opens an example.
///
/// # Errors
/// [`NoExample`]; a test keeps all of them readable.
pub fn example(id: &str, work: &Work) -> Result<Arc<dyn State>> {
    let found = examples().find(|e| e.id == id);
    let example = found.ok_or_else(|| Error::method(NoExample(id.to_owned())))?;
    match example.source {
        Source::File(path) => open(Path::new(path), shipped_bytes(path)?, work),
        Source::Line(path, line, name) => {
            let mut lines = shipped_bytes(path)?.split(|b| *b == b'\n');
            let name = format!("{name}.building.json");
            open(Path::new(&name), lines.nth(line).unwrap_or_default(), work)
        }
        Source::Text(name, text) => open(Path::new(name), text.as_bytes(), work),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_opens_in_its_editor_and_shows() {
        for e in examples() {
            let state = example(e.id, &Work::default()).unwrap();
            assert_eq!(state.kind(), e.kind, "{}", e.id);
            assert!(state.view().unwrap().is_object(), "{}", e.id);
            assert!(!state.bytes().unwrap().is_empty());
        }
        assert!(example("none", &Work::default()).is_err());
    }
}
