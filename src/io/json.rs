//! The common parts of all JSON formats: errors that name the place, and the keys `format` and `version`.

use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

use edifice_base::{Error, Result};

/// A text as JSON.
pub(super) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// A number as JSON; it reads back to the same bits.
pub(super) fn number(value: f64) -> String {
    serde_json::Value::from(value).to_string()
}

/// Parses a whole JSON file into `T`, with the JSON path, line and column in errors.
///
/// # Errors
/// [`Error::Input`] for malformed JSON, wrong types, missing or duplicate keys, numbers that do not
/// fit, and text after the value.
pub fn parse_json<T: DeserializeOwned>(bytes: &[u8], path: &Path) -> Result<T> {
    // Keeping track of the place more than doubles the time; it is needed only where something is wrong.
    if let Ok(value) = serde_json::from_slice(bytes) {
        return Ok(value);
    }
    let mut json = serde_json::Deserializer::from_slice(bytes);
    let value = serde_path_to_error::deserialize(&mut json).map_err(|e| {
        let place = match e.path().to_string() {
            unknown if unknown == "." || unknown.contains('?') => {
                format!("line {}, column {}", e.inner().line(), e.inner().column())
            }
            place => place,
        };
        Error::input(path, place, e.into_inner())
    })?;
    json.end().map_err(|e| {
        let place = format!("line {}, column {}", e.line(), e.column());
        Error::input(path, place, e)
    })?;
    Ok(value)
}

/// Checks the keys `format` and `version` before anything else, so that a file of another kind is
/// called that, and not "missing field".
///
/// # Errors
/// [`Error::Input`] at `format` or `version`.
pub fn check_header(bytes: &[u8], path: &Path, format: &str, version: u64) -> Result<()> {
    check_versions(bytes, path, format, version..=version)
}

/// As [`check_header`], for a format of which several versions are read.
///
/// # Errors
/// Names what is unknown and what was expected.
pub fn check_versions(
    bytes: &[u8],
    path: &Path,
    format: &str,
    versions: std::ops::RangeInclusive<u64>,
) -> Result<()> {
    let header: Header = parse_json(bytes, path)?;
    if header.format != format {
        let found = header.format;
        let message = format!("unknown format {found:?}, expected {format:?}");
        return Err(Error::input(path, "format", message));
    }
    if !versions.contains(&header.version) {
        let found = header.version;
        let (first, last) = (versions.start(), versions.end());
        let expected = match first == last {
            true => last.to_string(),
            false => format!("{first} to {last}"),
        };
        let message = format!("unknown version {found}, expected {expected}");
        return Err(Error::input(path, "version", message));
    }
    Ok(())
}

#[derive(Deserialize)]
struct Header {
    format: String,
    version: u64,
}
