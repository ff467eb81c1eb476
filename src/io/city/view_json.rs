//! The view that somebody has of a city, as JSON: format `edifice/city-view`, version 1.
//!
//! ```json
//! { "format": "edifice/city-view", "version": 1, "unit": "m", "buildings": [
//!     { "width": 31.5, "depth": 18, "height": 64, "solid": 0.8 }, { "width": 12, "depth": 9.5, "height": 20 } ] }
//! ```
//! Buildings near each other, in any order: width and depth of the smallest rectangle around the plan, height, and,
//! where it is known, the share of that box that is solid.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::CityError;
use edifice_base::{Error, Result};
use edifice_io::json::{check_header, parse_json};
use edifice_io::read_bytes;

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/city-view";
/// The version written, and the only one read.
pub const VERSION: u64 = 1;

/// A building as it is seen, in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ViewBuilding {
    /// Width.
    pub width: f64,
    /// Depth.
    pub depth: f64,
    /// Height.
    pub height: f64,
    /// Share of the box that is solid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solid: Option<f64>,
}

#[derive(Deserialize)]
struct File {
    unit: String,
    buildings: Vec<ViewBuilding>,
}

/// Reads a view.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<Vec<ViewBuilding>> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a view; `path` only names the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Vec<ViewBuilding>> {
    check_header(bytes, path, FORMAT, VERSION)?;
    let file: File = parse_json(bytes, path)?;
    if file.unit != "m" {
        let text = format!("{:?}, expected \"m\"", file.unit);
        return Err(Error::input(path, "unit", text));
    }
    if file.buildings.is_empty() {
        return Err(Error::content(
            path,
            CityError::Format("no buildings".to_owned()),
        ));
    }
    for (i, b) in file.buildings.iter().enumerate() {
        for (key, v) in [("width", b.width), ("depth", b.depth), ("height", b.height)] {
            if !(v > 0.0 && v < 1e5) {
                let place = format!("buildings[{i}].{key}");
                return Err(Error::input(path, place, CityError::Coordinate(v)));
            }
        }
        if let Some(v) = b.solid.filter(|v| !(0.0..=1.0).contains(v)) {
            let place = format!("buildings[{i}].solid");
            let text = format!("{v} is no share between 0 and 1");
            return Err(Error::input(path, place, CityError::Format(text)));
        }
    }
    Ok(file.buildings)
}
