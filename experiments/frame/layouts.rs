//! The layouts that ship with the project, which several papers' experiments run on.

use std::path::{Path, PathBuf};

use super::Context;
use edifice_base::{Error, Result};
use edifice_io::{LabelMap, facade_json};
use edifice_shape::Facade;

/// Labels of the matrices of the Paris Art Deco Facades Dataset.
const ART_DECO: &str = r#"{"door": 0, "shop": 1, "balcony": 2, "window": 3, "wall": 4, "sky": 5, "roof": 6, "unlabelled": -1}"#;

/// The label map of the Paris Art Deco Facades Dataset.
///
/// # Errors
/// None, as a test reads it.
pub fn art_deco() -> Result<LabelMap> {
    LabelMap::parse(ART_DECO.as_bytes(), Path::new("Art Deco"))
}

/// Name of the facade of Wu et al. 2014, Fig. 9: facade (i) of their Table 1.
pub const FIGURE_9: &str = "wu2014_fig9";

/// The folder of the shipped layouts, with its digest recorded.
pub fn folder(ctx: &mut Context) -> Result<PathBuf> {
    ctx.shipped("facade_grammar")
}

/// Facade (i) first, then the 34 made layouts by name, from a folder like
/// `datasets/facade_grammar`.
///
/// # Errors
/// [`Error::Io`] and the reader's errors.
pub fn read_all(folder: &Path) -> Result<Vec<Facade>> {
    let mut paths = vec![folder.join(format!("{FIGURE_9}.facade.json"))];
    paths.extend(made(folder)?);
    paths.iter().map(|path| facade_json::read(path)).collect()
}

/// The files of the made layouts, by name.
///
/// # Errors
/// [`Error::Io`].
pub fn made(folder: &Path) -> Result<Vec<PathBuf>> {
    files(&folder.join("layouts"), ".facade.json")
}

/// Files of a folder whose names have this ending, by name.
///
/// # Errors
/// [`Error::Io`].
pub fn files(folder: &Path, ending: &str) -> Result<Vec<PathBuf>> {
    let fail = |e| Error::io(folder, "read", e);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        if path.to_string_lossy().ends_with(ending) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
