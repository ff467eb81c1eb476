//! Bytes to values and back: every file format of facades, grammars, buildings and scenes. Cities have a crate of their own, `edifice-io-city`.
//!
//! Readers check everything at the door and name the file and the place of what is wrong; bytes that are in no file are
//! parsed at [`IN_NO_FILE`]. Writers
//! go through [`write_atomic`], so that a failed run leaves nothing half-written. [`read_facade`] and
//! [`write_facade`] tell the format by the file name. Every text format is also read gzipped.

mod annotation;
pub mod annotation_xml;
pub mod building_csv;
pub mod building_json;
pub mod cmp_xml;
pub mod coco;
pub mod detailed_cityjson;
pub mod detailed_gltf;
pub mod detailed_ifc;
pub mod draw;
mod facade_file;
pub mod facade_json;
pub mod footprint;
pub mod glb_container;
pub mod gltf;
mod gltf_document;
mod gltf_error;
pub mod grammar_cga;
mod grammar_file;
pub mod grammar_json;
pub mod grammar_library_json;
pub mod json;
mod json_kind;
pub mod label_image;
pub mod label_map;
pub mod label_text;
pub mod labelme;
pub mod lattice_npz;
pub mod nearest_colour;
mod packed;
pub mod palette;
pub mod photograph;
pub mod pixels;
pub mod raster;
pub mod reference_system;
pub mod scene_png;
pub mod scene_svg;
pub mod surface_obj;
mod table_text;
mod xml_place;

use std::path::Path;

pub use edifice_base::file::write_atomic;
pub use facade_file::{
    ReadOptions, Source, read_facade, read_label_grid, read_noted, read_source, write_facade,
};
pub use grammar_file::{read_grammar, write_grammar, written_as_json};
pub use label_map::LabelMap;
pub use packed::{extension, read_bytes};

/// The path of bytes that are in no file: errors then tell the place in the bytes alone, and what a reader would look for beside
/// its file is sought in the working folder.
///
/// # Examples
/// ```
/// use edifice_io::{IN_NO_FILE, facade_json};
/// let error = facade_json::parse(b"{", IN_NO_FILE.as_ref()).unwrap_err();
/// assert!(error.to_string().starts_with("line 1"), "{error}");
/// ```
pub const IN_NO_FILE: &str = "";

/// Name of a facade or a city that carries none: the file name up to its first dot.
pub fn file_stem(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match name.split('.').next() {
        Some(stem) if !stem.is_empty() => stem.to_string(),
        _ => name.into_owned(),
    }
}
