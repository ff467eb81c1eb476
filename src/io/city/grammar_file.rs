//! Grammars of cities by the names of their files: `.city-grammar.json` ([`grammar_json`]), also as `.gz`, and
//! `.city-grammar.bin` ([`compact`]).

use std::path::Path;

use super::{compact, grammar_json};
use edifice_base::{Error, Result};
use edifice_grammar::instance::InstanceGrammar;
use edifice_io::write_atomic;

/// True if a file's name says that it holds a grammar.
pub fn is_grammar(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let endings = [".json", ".json.gz", ".bin"];
    endings
        .iter()
        .any(|e| name.ends_with(&format!(".city-grammar{e}")))
}

/// True if a file's name says that its grammar is compact.
pub fn is_compact(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "bin")
}

/// Reads a grammar and checks that it derives.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<InstanceGrammar> {
    match is_compact(path) {
        true => compact::read(path),
        false => grammar_json::read(path),
    }
}

/// The bytes of a grammar in a file of this name.
///
/// # Errors
/// [`Error::Content`] on a grammar that is not sound.
pub fn to_bytes(grammar: &InstanceGrammar, path: &Path) -> Result<Vec<u8>> {
    match is_compact(path) {
        true => compact::to_bytes(grammar).map_err(|e| Error::content(path, e)),
        false => {
            let packed = path.extension().is_some_and(|e| e == "gz");
            grammar_json::to_bytes(grammar, packed).map_err(|e| Error::content(path, e))
        }
    }
}

/// Writes a grammar, whole or not at all.
///
/// # Errors
/// As [`to_bytes`], and [`Error::Io`] when the file cannot be written.
pub fn write(grammar: &InstanceGrammar, path: &Path) -> Result<()> {
    write_atomic(path, &to_bytes(grammar, path)?)
}
