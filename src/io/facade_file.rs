//! Facades in whatever format: the format is told by the file's extension, then by its content.

use std::path::Path;

use super::{LabelMap, cmp_xml, draw, facade_json, label_image, label_text, pixels, read_bytes};
use crate::file::write_atomic;
use crate::shape::{Facade, LabelGrid, decompose};
use crate::{Error, Result};

/// Longer side of CMP facades whose image is missing, in units.
const CMP_SIDE: f64 = 1000.0;

/// What readers need to know beside the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Meaning of colours and numbers in label images and text matrices; without it those of ECP,
    /// Graz and CMP are known.
    pub label_map: Option<LabelMap>,
    /// Width and height of a CMP facade, in pixels, when no PNG of its name stands beside the XML.
    pub size: Option<(f64, f64)>,
}

/// The content of a facade file.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// A facade layout: rectangles.
    Layout(Facade),
    /// A label picture.
    Picture(LabelGrid),
    /// Overlapping rectangles of CMP, with the width and height of their image.
    Cmp(cmp_xml::CmpFacade, f64, f64),
}

enum Format {
    Json,
    Png,
    Text,
    Xml,
}

fn format_of(path: &Path, bytes: &[u8]) -> Format {
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    match extension.as_str() {
        "json" => Format::Json,
        "png" => Format::Png,
        "txt" | "csv" => Format::Text,
        "xml" => Format::Xml,
        _ if bytes.starts_with(b"\x89PNG") => Format::Png,
        _ => match bytes.iter().find(|b| !b.is_ascii_whitespace()) {
            Some(b'{') => Format::Json,
            Some(b'<') => Format::Xml,
            _ => Format::Text,
        },
    }
}

/// Reads a facade file of any format: `.facade.json`, `.png`, `.txt`, `.xml`.
///
/// # Errors
/// Names the file and the place of what is wrong.
pub fn read_source(path: &Path, options: &ReadOptions) -> Result<Source> {
    let bytes = read_bytes(path)?;
    let map = options.label_map.as_ref();
    Ok(match format_of(path, &bytes) {
        Format::Json => Source::Layout(facade_json::parse(&bytes, path)?),
        Format::Png => Source::Picture(label_image::parse(&bytes, path, map)?),
        Format::Text => Source::Picture(label_text::parse(&bytes, path, map)?),
        Format::Xml => {
            let (width, height) = cmp_size(path, options)?;
            Source::Cmp(cmp_xml::parse(&bytes, path)?, width, height)
        }
    })
}

/// Reads a facade layout from a file of any format. Label pictures are [decomposed](decompose) into
/// tilings; facade JSON is given as it is, tiling or not.
///
/// # Errors
/// As [`read_source`].
pub fn read_facade(path: &Path, options: &ReadOptions) -> Result<Facade> {
    let grid = match read_source(path, options)? {
        Source::Layout(facade) => return Ok(facade),
        Source::Picture(grid) => grid,
        Source::Cmp(cmp, width, height) => cmp.label_grid(width, height)?,
    };
    let decomposition = decompose(&grid).map_err(|e| Error::content(path, e))?;
    Ok(decomposition.facade)
}

/// Reads a label picture from a file of any format; facade JSON must be a tiling.
///
/// # Errors
/// As [`read_source`], and gaps or overlaps of a layout.
pub fn read_label_grid(path: &Path, options: &ReadOptions) -> Result<LabelGrid> {
    match read_source(path, options)? {
        Source::Layout(facade) => {
            let grid = LabelGrid::from_facade(&facade, None);
            Ok(grid.map_err(|e| Error::content(path, e))?.merged())
        }
        Source::Picture(grid) => Ok(grid),
        Source::Cmp(cmp, width, height) => cmp.label_grid(width, height),
    }
}

/// Size of a CMP facade: of the PNG beside it, else as asked for, else a square.
fn cmp_size(path: &Path, options: &ReadOptions) -> Result<(f64, f64)> {
    let png = path.with_extension("png");
    match std::fs::read(&png) {
        Ok(bytes) => pixels::size(&bytes).map_err(|e| Error::content(&png, e)),
        Err(_) => Ok(options.size.unwrap_or((CMP_SIDE, CMP_SIDE))),
    }
}

/// Writes a facade in the format that the extension asks for: `.json`, `.svg`, `.png` (a label image
/// in the colours of ECP), `.txt` (a matrix of labels).
///
/// # Errors
/// [`Error::Option`] for another extension; [`Error::Content`] when a label cannot stand in a matrix;
/// [`Error::Io`] when the file cannot be written.
pub fn write_facade(facade: &Facade, path: &Path) -> Result<()> {
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    let bytes = match extension.as_str() {
        "json" => facade_json::to_string(facade).into_bytes(),
        "svg" => draw::svg(facade).into_bytes(),
        "png" => draw::png(facade).map_err(|e| Error::content(path, e))?,
        "txt" => label_text::to_string(facade)
            .map_err(|e| Error::content(path, e))?
            .into_bytes(),
        _ => {
            let message = format!(
                "unknown facade format {:?}, expected .facade.json, .svg, .png or .txt",
                path.display().to_string()
            );
            return Err(Error::option("output", message));
        }
    };
    write_atomic(path, &bytes)
}
