//! Grammars in whatever format: JSON or CGA, told by the file's extension, then by its content.

use std::path::Path;

use super::packed::extension;
use super::{grammar_cga, grammar_json, json_kind, read_bytes};
use edifice_base::{Error, Result};
use edifice_grammar::Grammar;

/// True if the extension, or else the first character, says JSON rather than CGA.
fn is_json(path: &Path, bytes: &[u8]) -> bool {
    match extension(path).as_str() {
        "json" => true,
        "cga" => false,
        _ => bytes.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'{'),
    }
}

/// Reads a grammar: `.grammar.json` or `.cga`, plain or gzipped.
///
/// # Errors
/// Names the file and the place of what is wrong.
pub fn read_grammar(path: &Path) -> Result<Grammar> {
    let bytes = read_bytes(path)?;
    match is_json(path, &bytes) {
        true => grammar_json::parse(&bytes, path),
        false => grammar_cga::parse(&bytes, path),
    }
}

/// Writes a grammar in the format that the extension asks for.
///
/// # Errors
/// As [`written_as_json`]; [`Error::Io`] when the file cannot be written.
pub fn write_grammar(grammar: &Grammar, path: &Path) -> Result<()> {
    match written_as_json(path)? {
        true => grammar_json::write(grammar, path),
        false => grammar_cga::write(grammar, path),
    }
}

/// True if a grammar of this name is written as JSON, false if as CGA.
///
/// # Errors
/// [`Error::Option`] for another extension, and for an ending of other files, such as `.library.json`.
pub fn written_as_json(path: &Path) -> Result<bool> {
    json_kind::check(path, "grammar")?;
    let written = path.extension().unwrap_or_default().to_string_lossy();
    match written.to_lowercase().as_str() {
        "json" => Ok(true),
        "cga" => Ok(false),
        _ => {
            let path = path.display().to_string();
            let message =
                format!("unknown grammar format {path:?}, expected .grammar.json or .cga");
            Err(Error::option("output", message))
        }
    }
}
