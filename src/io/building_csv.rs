//! Houses as a CSV table of text cells, plain or gzipped (`*.csv`, `*.csv.gz`).

use std::path::Path;

use super::packed::unpacked;
use super::read_bytes;
use edifice_base::{Error, Result};

/// Most cells of a table: a compressed one may have half as many as bytes, each a text of its own.
const MOST_CELLS: usize = 1 << 24;

/// A CSV file: its header and its rows, all of the header's length.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextTable {
    /// Names of the columns.
    pub header: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

/// Reads a CSV file with a header line.
///
/// # Errors
/// Names the file and the line of a row that is malformed or has too few or too many cells; a file
/// without rows is an error too.
pub fn read(path: &Path) -> Result<TextTable> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a table; `path` only names the file in errors.
///
/// # Errors
/// As [`read`]; [`Error::Content`] for a compressed table of more than 256 MB, or one of more than
/// 16 million cells.
pub fn parse(bytes: &[u8], path: &Path) -> Result<TextTable> {
    let text = unpacked(bytes.to_vec(), path)?;
    let at = |e: csv::Error| {
        let line = e.position().map_or(1, csv::Position::line);
        Error::input(path, format!("line {line}"), e)
    };
    let mut reader = csv::Reader::from_reader(text.as_slice());
    let header = reader.headers().map_err(at)?;
    let header: Vec<String> = header.iter().map(str::to_owned).collect();
    let most_rows = MOST_CELLS / header.len().max(1);
    let mut rows = Vec::new();
    for record in reader.records() {
        if rows.len() == most_rows {
            let message = format!("the table has more than {MOST_CELLS} cells");
            return Err(Error::content(path, message));
        }
        rows.push(record.map_err(at)?.iter().map(str::to_owned).collect());
    }
    if rows.is_empty() {
        return Err(Error::content(path, "the table has no rows"));
    }
    Ok(TextTable { header, rows })
}
