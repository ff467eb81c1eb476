//! Facades in whatever format: the format is told by the file's extension, then by its content.

use std::path::Path;

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::nearest_colour::NearestColours;
use super::packed::{extension, read_bytes};
use super::pixels::JPEG_MAGIC;
use super::{
    LabelMap, annotation_xml, cmp_xml, coco, draw, facade_json, json, json_kind, label_image,
    label_text, labelme, pixels,
};
use edifice_base::file::write_atomic;
use edifice_base::{Error, Result};
use edifice_shape::{Facade, LabelGrid, Labelled, decompose};

/// Longer side of CMP facades whose image is missing, in units.
const CMP_SIDE: f64 = 1000.0;

/// The options of readers, beside the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Meaning of colours and numbers in label images and text matrices; without it those of ECP,
    /// Graz and CMP are known in images, and numbers in text matrices are labels themselves.
    pub label_map: Option<LabelMap>,
    /// True if a colour of an image that the label map does not name takes the label of the nearest colour; otherwise
    /// it is an error. JPEG images are read only so.
    pub nearest_colour: bool,
    /// The image of a COCO file that is meant, if it has several.
    pub image: Option<String>,
    /// Width and height of a CMP facade or of an annotation without a size, in pixels, when no PNG of its name stands beside
    /// the XML.
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

impl Source {
    /// The facade in one of its two forms; the rectangles of CMP are a layout.
    ///
    /// # Errors
    /// As [`cmp_xml::CmpFacade::layout`].
    pub fn labelled(self) -> Result<Labelled> {
        Ok(match self {
            Source::Layout(facade) => Labelled::Layout(facade),
            Source::Picture(grid) => Labelled::Picture(grid),
            Source::Cmp(cmp, width, height) => Labelled::Layout(cmp.layout(width, height)?),
        })
    }
}

/// A file of a kind that is not read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{kind} is unsupported; facades are read from .facade.json, LabelMe and COCO JSON, label images (.png; .jpg with --nearest-colour), text matrices (.txt, .csv), CMP rectangles and annotations of Pascal VOC and eTRIMS (.xml), each text also as .gz"
)]
pub(crate) struct Unsupported {
    /// The kind of the file, as far as it can be told.
    pub kind: String,
}

enum Format {
    Json,
    Png,
    Jpeg,
    Text,
    Xml,
}

/// The format that the extension says, or else the first bytes.
fn format_of(path: &Path, bytes: &[u8]) -> Result<Format, Unsupported> {
    let extension = extension(path);
    let unsupported = |kind: String| Err(Unsupported { kind });
    Ok(match extension.as_str() {
        "json" => Format::Json,
        "png" => Format::Png,
        "jpg" | "jpeg" => Format::Jpeg,
        "txt" | "csv" => Format::Text,
        "xml" => Format::Xml,
        "svg" | "html" | "pdf" | "gif" | "bmp" | "tif" | "tiff" | "webp" | "heic" | "npy"
        | "npz" | "mat" | "zip" | "obj" | "glb" | "gltf" | "cga" => {
            return unsupported(format!("a .{extension} file"));
        }
        _ if bytes.starts_with(b"\x89PNG") => Format::Png,
        _ if bytes.starts_with(JPEG_MAGIC) => Format::Jpeg,
        _ => match bytes.iter().find(|b| !b.is_ascii_whitespace()) {
            Some(b'{') => Format::Json,
            Some(b'<') => Format::Xml,
            _ if is_text(bytes) => Format::Text,
            _ if extension.is_empty() => return unsupported("a binary file of this kind".into()),
            _ => return unsupported(format!("a binary .{extension} file")),
        },
    })
}

/// True if the bytes are text: no control characters, but for those of lines and tabs.
fn is_text(bytes: &[u8]) -> bool {
    let control = |b: &u8| b.is_ascii_control() && !matches!(b, b'\n' | b'\r' | b'\t');
    !bytes.iter().any(control) && std::str::from_utf8(bytes).is_ok()
}

/// Reads a facade file of any format: facade, LabelMe and COCO JSON, `.png`, `.jpg`, `.txt`, `.xml`,
/// and the text formats gzipped.
///
/// # Errors
/// Names the file and the place of what is wrong; other kinds of files are called unsupported.
pub fn read_source(path: &Path, options: &ReadOptions) -> Result<Source> {
    Ok(read_noted(path, options)?.0)
}

/// As [`read_source`], with what [`ReadOptions::nearest_colour`] changed.
///
/// # Errors
/// As [`read_source`].
pub fn read_noted(path: &Path, options: &ReadOptions) -> Result<(Source, Option<NearestColours>)> {
    let bytes = read_bytes(path)?;
    let map = options.label_map.as_ref();
    let format = format_of(path, &bytes).map_err(|e| Error::content(path, e))?;
    if let (Some(_), false) = (&options.image, matches!(format, Format::Json)) {
        return Err(no_images(path));
    }
    let source = match format {
        Format::Json => json(&bytes, path, options)?,
        Format::Png | Format::Jpeg if options.nearest_colour => {
            let (grid, nearest) = label_image::parse_nearest(&bytes, path, map)?;
            return Ok((Source::Picture(grid), nearest));
        }
        Format::Png => Source::Picture(label_image::parse(&bytes, path, map)?),
        Format::Jpeg => {
            let kind = "a JPEG, which blurs the colours of labels,".into();
            return Err(Error::content(path, Unsupported { kind }));
        }
        Format::Text => Source::Picture(label_text::parse(&bytes, path, map)?),
        Format::Xml if annotation_xml::is_annotation(&bytes) => {
            let beside = size_beside(path, options)?;
            Source::Layout(annotation_xml::parse(&bytes, path, beside)?)
        }
        Format::Xml => {
            let (width, height) = size_beside(path, options)?.unwrap_or((CMP_SIDE, CMP_SIDE));
            Source::Cmp(cmp_xml::parse(&bytes, path)?, width, height)
        }
    };
    Ok((source, None))
}

/// The error for an image asked of a file that is one facade.
fn no_images(path: &Path) -> Error {
    let message = format!("{} is no COCO file", path.display());
    Error::option("--image", message)
}

/// The keys that tell kinds of JSON files apart.
#[derive(Deserialize)]
struct Keys {
    format: Option<IgnoredAny>,
    shapes: Option<IgnoredAny>,
    annotations: Option<IgnoredAny>,
}

/// A layout from JSON of any kind.
fn json(bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<Source> {
    let keys: Keys = json::parse_json(bytes, path)?;
    let coco = keys.format.is_none() && keys.shapes.is_none() && keys.annotations.is_some();
    if options.image.is_some() && !coco {
        return Err(no_images(path));
    }
    let facade = match keys {
        Keys {
            format: Some(_), ..
        } => facade_json::parse(bytes, path)?,
        Keys {
            shapes: Some(_), ..
        } => labelme::parse(bytes, path)?,
        Keys {
            annotations: Some(_),
            ..
        } => coco::parse(bytes, path, options.image.as_deref())?,
        _ => {
            let message = "neither a facade (key \"format\") nor a file of LabelMe (\"shapes\") or COCO (\"annotations\")";
            return Err(Error::content(path, message));
        }
    };
    Ok(Source::Layout(facade))
}

impl Source {
    /// The layout; label pictures are [decomposed](decompose) into tilings, layouts are given as they
    /// are, tiling or not. `path` names the file in errors.
    ///
    /// # Errors
    /// [`Error::Content`] for a picture that cannot be decomposed.
    pub fn facade(self, path: &Path) -> Result<Facade> {
        let grid = match self {
            Source::Layout(facade) => return Ok(facade),
            Source::Picture(grid) => grid,
            Source::Cmp(cmp, width, height) => cmp.label_grid(width, height)?,
        };
        let decomposition = decompose(&grid).map_err(|e| Error::content(path, e))?;
        Ok(decomposition.facade)
    }

    /// The label picture; a layout must be a tiling. `path` names the file in errors.
    ///
    /// # Errors
    /// [`Error::Content`] for gaps or overlaps of a layout.
    pub fn label_grid(self, path: &Path) -> Result<LabelGrid> {
        match self {
            Source::Layout(facade) => {
                let grid = LabelGrid::from_facade(&facade, None);
                Ok(grid.map_err(|e| Error::content(path, e))?.merged())
            }
            Source::Picture(grid) => Ok(grid),
            Source::Cmp(cmp, width, height) => cmp.label_grid(width, height),
        }
    }
}

/// Reads a facade layout from a file of any format, as [`Source::facade`].
///
/// # Errors
/// As [`read_source`] and [`Source::facade`].
pub fn read_facade(path: &Path, options: &ReadOptions) -> Result<Facade> {
    read_source(path, options)?.facade(path)
}

/// Reads a label picture from a file of any format, as [`Source::label_grid`].
///
/// # Errors
/// As [`read_source`] and [`Source::label_grid`].
pub fn read_label_grid(path: &Path, options: &ReadOptions) -> Result<LabelGrid> {
    read_source(path, options)?.label_grid(path)
}

/// Size of the image that an XML file tells of: of the PNG beside it, else as asked for.
fn size_beside(path: &Path, options: &ReadOptions) -> Result<Option<(f64, f64)>> {
    let packed = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("gz"));
    let plain = match packed {
        true => path.with_extension(""),
        false => path.to_path_buf(),
    };
    let png = plain.with_extension("png");
    match std::fs::read(&png) {
        Ok(bytes) => {
            let size = pixels::size(&bytes).map_err(|e| Error::content(&png, e))?;
            Ok(Some(size))
        }
        Err(_) => Ok(options.size),
    }
}

/// Writes a facade in the format that the extension asks for: `.json`, `.svg`, `.png` (a label image
/// in the colours of ECP), `.txt` (a matrix of labels).
///
/// # Errors
/// [`Error::Option`] for another extension, and for an ending of other files, such as `.grammar.json`; [`Error::Content`] when a label cannot stand in a matrix;
/// [`Error::Io`] when the file cannot be written.
pub fn write_facade(facade: &Facade, path: &Path) -> Result<()> {
    json_kind::check(path, "facade")?;
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
