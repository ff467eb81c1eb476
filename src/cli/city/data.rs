//! Reading cities and grammars.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_grammar::instance::InstanceGrammar;
use edifice_io::city;
pub(super) use edifice_io::city::grammar_file::is_grammar;
use edifice_shape::triangles::City;

use crate::print;

/// Reads a grammar.
pub(super) fn grammar(path: &Path) -> Result<InstanceGrammar> {
    city::grammar_file::read(path)
}

/// Reads a city, or derives it from a grammar.
pub(super) fn city(path: &Path) -> Result<City> {
    if !is_grammar(path) {
        let city = city::read(path)?;
        city.notes.iter().for_each(|note| print::message(note));
        return Ok(city);
    }
    derived(&grammar(path)?, path)
}

/// Derives the city of a grammar that was read from `path`.
pub(super) fn derived(grammar: &InstanceGrammar, path: &Path) -> Result<City> {
    let derivation = grammar.derive().map_err(|e| Error::content(path, e))?;
    let mut city = derivation.city(grammar);
    city::paint_parts(&mut city).map_err(|e| Error::content(path, e))?;
    Ok(city)
}
