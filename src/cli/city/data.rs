//! Reading cities and grammars.

use std::path::Path;

use edifice::grammar::instance::InstanceGrammar;
use edifice::io::city;
use edifice::shape::triangles::City;
use edifice::{Error, Result};

/// Reads a grammar.
pub fn grammar(path: &Path) -> Result<InstanceGrammar> {
    city::grammar_json::read(path)
}

/// Whether a file's name says that it holds a grammar.
pub fn is_grammar(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.ends_with(".city-grammar.json") || name.ends_with(".city-grammar.json.gz")
}

/// Reads a city, or derives it from a grammar.
pub fn city(path: &Path) -> Result<City> {
    if !is_grammar(path) {
        return city::read(path);
    }
    let grammar = grammar(path)?;
    let derivation = grammar.derive().map_err(|e| Error::content(path, e))?;
    Ok(derivation.city(&grammar))
}
