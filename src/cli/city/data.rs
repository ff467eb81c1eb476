//! Reading cities and grammars.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_grammar::instance::InstanceGrammar;
use edifice_io_city as city;
use edifice_io_city::compact::DICTIONARY;
pub(super) use edifice_io_city::grammar_file::is_grammar;
use edifice_shape::triangles::City;

use crate::print;

/// Reads a grammar.
pub(super) fn grammar(path: &Path) -> Result<InstanceGrammar> {
    city::grammar_file::read(path)
}

/// The grammars of a country's tiles in a folder, by name.
fn tiles(folder: &Path) -> Result<Vec<PathBuf>> {
    let fail = |e| Error::io(folder, "read", e);
    let listed = std::fs::read_dir(folder).map_err(fail)?;
    let paths: std::io::Result<Vec<PathBuf>> = listed.map(|e| Ok(e?.path())).collect();
    let mut paths = paths.map_err(fail)?;
    paths.retain(|p| is_grammar(p) && p.file_name().is_none_or(|n| n != DICTIONARY));
    paths.sort();
    Ok(paths)
}

/// True if what is there derives its buildings: a grammar, or a folder of grammars.
pub(super) fn is_derived(path: &Path) -> bool {
    is_grammar(path) || path.is_dir()
}

/// Bytes of a file, or of the grammars in a folder with their dictionary.
pub(super) fn bytes(path: &Path) -> Result<u64> {
    let size = |path: &Path| {
        let found = std::fs::metadata(path).map_err(|e| Error::io(path, "read", e))?;
        Ok(found.len())
    };
    if !path.is_dir() {
        return size(path);
    }
    let mut sum = size(&path.join(DICTIONARY))?;
    for tile in tiles(path)? {
        sum += size(&tile)?;
    }
    Ok(sum)
}

/// Reads a city, or derives it from a grammar, or from those of all tiles in a folder.
pub(super) fn city(path: &Path) -> Result<City> {
    if path.is_dir() {
        let mut whole = City::default();
        for (k, tile) in tiles(path)?.iter().enumerate() {
            let own = derived(&grammar(tile)?, tile)?;
            match k {
                0 => whole = own,
                _ => whole.merge(own),
            }
        }
        return Ok(whole);
    }
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
