//! Buildings as JSON: `*.building.json`, format `edifice/building`, version 1, and databases of
//! buildings: `*.buildings.jsonl`, one such object a line.
//!
//! ```json
//! { "format": "edifice/building", "version": 1, "name": "house_001", "unit": "m", "floor_height": 2.9,
//!   "boxes": [ { "style": "garage", "x": 2.9, "y": 3.1, "width": 5.8, "depth": 6.2, "height": 2.8,
//!                "roof": { "style": "gable", "pitch": 30.0, "ridge": "x" } } ],
//!   "facades": [ { "side": "front", "start": 0.0, "base": 0.0, "width": 5.8, "height": 2.8,
//!                  "elements": [ { "style": "sash", "x": 1.0, "y": 0.9, "width": 1.2, "height": 1.4 } ] } ],
//!   "special": [ "chimney" ] }
//! ```
//! `x`, `y` of a box are its centre; those of an element its lower-left corner on its piece. Box
//! styles: main, garage, porch; roofs: flat, gable, hip, shed, cone; elements: sash, sliding,
//! casement, bay, fixed, door; special: chimney, tower. `facades` and `special` may be left out: a
//! side without facade pieces was not observed.

use std::path::Path;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::json::{check_header, parse_json};
use super::packed::extension;
use super::{read_bytes, write_atomic};
use edifice_base::{Error, Result};
use edifice_shape::{Building, FacadePiece, MassBox, Special};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/building";
/// The version written, and the only one read.
pub const VERSION: u64 = 1;

#[derive(Serialize, Deserialize)]
struct File {
    #[serde(default)]
    format: String,
    #[serde(default)]
    version: u64,
    name: String,
    unit: String,
    floor_height: f64,
    boxes: Vec<MassBox>,
    #[serde(default)]
    facades: Vec<FacadePiece>,
    #[serde(default)]
    special: Vec<Special>,
}

impl File {
    fn is_ours(&self) -> bool {
        self.format == FORMAT && self.version == VERSION
    }
}

/// Reads one building, or a database of buildings, one JSON object a line when the name of the
/// file ends in `.jsonl` or `.jsonl.gz`.
///
/// # Errors
/// Names the file and the line or JSON path of what is wrong; a database without buildings is an
/// error too.
pub fn read(path: &Path) -> Result<Vec<Building>> {
    let bytes = read_bytes(path)?;
    if extension(path) == "jsonl" {
        return parse_lines(&bytes, path);
    }
    Ok(vec![parse(&bytes, path)?])
}

/// Writes one building, indented.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written.
pub fn write(building: &Building, path: &Path) -> Result<()> {
    let text = to_string(building).map_err(|e| Error::content(path, e))?;
    write_atomic(path, text.as_bytes())
}

/// The text of one building, indented.
///
/// # Errors
/// None that a checked building has.
pub fn to_string(building: &Building) -> serde_json::Result<String> {
    serde_json::to_string_pretty(&file(building)).map(|text| format!("{text}\n"))
}

/// Writes a database, one building a line.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written.
pub fn write_lines(buildings: &[Building], path: &Path) -> Result<()> {
    let mut text = String::new();
    for building in buildings {
        let line = serde_json::to_string(&file(building)).map_err(|e| Error::content(path, e))?;
        text.push_str(&line);
        text.push('\n');
    }
    write_atomic(path, text.as_bytes())
}

fn file(building: &Building) -> File {
    File {
        format: FORMAT.into(),
        version: VERSION,
        name: building.name.clone(),
        unit: building.unit.clone(),
        floor_height: building.floor_height,
        boxes: building.boxes.clone(),
        facades: building.facades.clone(),
        special: building.special.clone(),
    }
}

/// Parses the bytes of one building; `path` only names the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Building> {
    let f = serde_json::from_slice(bytes).ok().filter(File::is_ours);
    let f = match f {
        Some(f) => f,
        // Something is wrong: the header is to be blamed first.
        None => {
            check_header(bytes, path, FORMAT, VERSION)?;
            parse_json(bytes, path)?
        }
    };
    Building::new(
        f.name,
        f.unit,
        f.floor_height,
        f.boxes,
        f.facades,
        f.special,
    )
    .map_err(|e| Error::content(path, e))
}

/// Parses the bytes of a database; empty lines are skipped.
///
/// # Errors
/// As [`read`], with the line.
pub fn parse_lines(bytes: &[u8], path: &Path) -> Result<Vec<Building>> {
    let lines = bytes.split(|&b| b == b'\n').enumerate();
    let lines: Vec<_> = lines
        .filter(|(_, line)| !line.iter().all(u8::is_ascii_whitespace))
        .collect();
    let buildings = lines
        .par_iter()
        .map(|(i, line)| parse(line, path).map_err(|e| at_line(e, i + 1)));
    // The first error in the file's order, not in that of the threads.
    let buildings: Vec<Result<Building>> = buildings.collect();
    let buildings = buildings.into_iter().collect::<Result<Vec<_>>>()?;
    if buildings.is_empty() {
        return Err(Error::content(path, "the database has no buildings"));
    }
    Ok(buildings)
}

/// Puts the line of the database in front of the place inside it.
fn at_line(error: Error, line: usize) -> Error {
    match error {
        Error::Input {
            path,
            place,
            source,
        } => {
            let place = format!("line {line}, {}", place.trim_start_matches("line 1, "));
            Error::input(&path, place, source)
        }
        Error::Content { path, source } => Error::input(&path, format!("line {line}"), source),
        other => other,
    }
}
