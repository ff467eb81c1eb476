//! Layouts and partial layouts from the command line.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_editing::structure_completion;
use edifice_io as io;
use edifice_shape::{AnnotatedFacade, Rect};
use edifice_structure_completion::layout::Layout;
use edifice_structure_completion::layout::extract;

use crate::reading::{self, Reading};

/// A rectangle `x,y,w,h` as an argument.
pub(super) fn rect(text: &str) -> std::result::Result<Rect, String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|part| {
            part.trim()
                .parse()
                .map_err(|_| format!("{part:?} is not a number"))
        })
        .collect::<std::result::Result<_, _>>()?;
    let [x, y, width, height] = numbers[..] else {
        return Err(format!(
            "{} numbers, expected x,y,width,height",
            numbers.len()
        ));
    };
    if !numbers.iter().all(|v| v.is_finite()) || width <= 0.0 || height <= 0.0 {
        return Err("expected finite numbers, and a width and height above zero".into());
    }
    Ok(Rect::new(x, y, width, height))
}

/// A layout of elements with its annotations. Layouts of elements stay as they are; elements are taken out of
/// tilings, label pictures and CMP files.
pub(super) fn annotated(path: &Path, reading: &Reading) -> Result<AnnotatedFacade> {
    let source = reading::source(path, &reading.options()?)?;
    structure_completion::annotated(source, &io::read_bytes(path)?, path)
}

/// Whole layouts to learn from: files, and the facade files of folders.
pub(super) fn layouts(inputs: &[PathBuf], reading: &Reading) -> Result<Vec<Layout>> {
    let options = reading.options()?;
    let mut layouts = Vec::new();
    for input in inputs {
        for path in files(input)? {
            let source = reading::source(&path, &options)?.labelled()?;
            layouts.push(extract::elements(&source).map_err(|e| Error::content(&path, e))?);
        }
    }
    Ok(layouts)
}

/// The file, or the facade files of a folder by name.
fn files(path: &Path) -> Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let fail = |e| Error::io(path, "read", e);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path).map_err(fail)? {
        let file = entry.map_err(fail)?.path();
        let name = file.to_string_lossy().to_lowercase();
        let facade = [".facade.json", ".facade.json.gz", ".xml", ".png"];
        // The painted labels beside a CMP file show the same facade.
        let painted = name.ends_with(".png") && file.with_extension("xml").exists();
        if facade.iter().any(|ending| name.ends_with(ending)) && !painted {
            files.push(file);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(Error::content(
            path,
            "no .facade.json, .xml or .png in the folder",
        ));
    }
    Ok(files)
}
