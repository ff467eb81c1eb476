//! The facades that the experiments run on.

use std::path::Path;

use crate::Result;
use crate::grammar::Grammar;
use crate::io;
use crate::methods::facade_grammar::synthetic;
use crate::shape::Facade;
use crate::{Error, file};

/// Seed of the shipped layouts.
pub const LAYOUT_SEED: u64 = 1;

/// Writes the made layouts and their grammars into a folder, as they ship in
/// `datasets/facade_grammar/layouts`.
///
/// # Errors
/// [`Error::Io`] when a file cannot be written.
pub fn write_layouts(folder: &Path, seed: u64) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
    for (name, bytes) in layout_files(seed)? {
        file::write_atomic(&folder.join(name), &bytes)?;
    }
    Ok(())
}

/// Name and content of each file of the made layouts.
///
/// # Errors
/// [`Error::Method`] if a made grammar did not derive.
pub fn layout_files(seed: u64) -> Result<Vec<(String, Vec<u8>)>> {
    let made = synthetic::layouts(seed).map_err(Error::method)?;
    let mut files = Vec::new();
    for one in &made {
        let name = &one.facade.name;
        let facade = io::facade_json::to_string(&one.facade);
        let grammar = io::grammar_json::to_string(&one.grammar);
        files.push((format!("{name}.facade.json"), facade.into_bytes()));
        files.push((format!("{name}.grammar.json"), grammar.into_bytes()));
    }
    Ok(files)
}

/// A facade with the grammar it was derived from.
pub struct Known {
    /// The facade.
    pub facade: Facade,
    /// Its grammar.
    pub grammar: Grammar,
}
