//! Houses as a CSV table of text cells, plain or gzipped (`*.csv`, `*.csv.gz`).

use std::collections::BTreeMap;
use std::path::Path;

use super::packed::unpacked;
use super::read_bytes;
use super::table_text::{points, refuse, separator};
use edifice_base::{Error, Result};

/// Most cells of a table: a compressed one may have half as many as bytes, each a text of its own.
const MOST_CELLS: usize = 1 << 24;

/// A CSV file: its header and its rows, all of the header's length.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextTable {
    /// Names of the columns, without blanks around them.
    pub header: Vec<String>,
    /// Cells, row by row; numbers with points.
    pub rows: Vec<Vec<String>>,
    /// The cells of columns of numbers with commas as the file has them, by the place of the column.
    pub commas: BTreeMap<usize, Vec<String>>,
    /// A sentence for each way in which the file was not plain CSV: another separator, decimal commas, columns without a name.
    pub notes: Vec<String>,
}

impl TextTable {
    /// Place of the column of this name, whatever blanks are around it.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|own| own == name.trim())
    }

    /// A cell, with points in numbers; empty where there is none.
    pub fn cell(&self, row: usize, column: usize) -> &str {
        let cell = self.rows.get(row).and_then(|cells| cells.get(column));
        cell.map_or("", String::as_str)
    }

    /// A cell as the file has it, with commas in numbers.
    pub fn written(&self, row: usize, column: usize) -> &str {
        match self.commas.get(&column).and_then(|cells| cells.get(row)) {
            Some(cell) => cell,
            None => self.cell(row, column),
        }
    }
}

/// Reads a CSV file with a header line. The separator may be `;`, a tab or `|` as well, and numbers may have decimal commas; both are
/// found, and said in the notes.
///
/// # Errors
/// Names the file and the line of a row that is malformed or has too few or too many cells; a file
/// without rows is an error too, as are two columns of one name, numbers that could be read in two ways, and files of other formats
/// (Parquet, ARFF, JSON, ...), each by its name.
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
    refuse(&text, path)?;
    let (mark, skipped) = separator(&text, path)?;
    let mut reader = csv::ReaderBuilder::new();
    let mut reader = reader.delimiter(mark).from_reader(&text[skipped..]);
    let header = reader.headers().map_err(at)?;
    let mut header: Vec<String> = header.iter().map(str::to_owned).collect();
    let mut notes = Vec::new();
    if mark != b',' {
        notes.push(format!("cells are separated by {:?}", char::from(mark)));
    }
    names(&mut header, &mut notes, path)?;
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
    let (more, commas) = points(&header, &mut rows, mark, path)?;
    notes.extend(more);
    Ok(TextTable {
        header,
        rows,
        commas,
        notes,
    })
}

/// Takes blanks away from around names, gives nameless columns a name, and refuses a name that stands twice.
fn names(header: &mut [String], notes: &mut Vec<String>, path: &Path) -> Result<()> {
    if header.iter().all(|name| name.trim().parse::<f64>().is_ok()) {
        notes.push(
            "the first line is taken for the names of the columns, though all are numbers"
                .to_owned(),
        );
    }
    for (i, name) in header.iter_mut().enumerate() {
        *name = name.trim().to_owned();
        if name.is_empty() {
            *name = format!("column_{}", i + 1);
            notes.push(format!(
                "column {} has no name: it is called `{name}`",
                i + 1
            ));
        }
    }
    let mut seen = BTreeMap::new();
    for (i, name) in header.iter().enumerate() {
        if let Some(before) = seen.insert(name, i + 1) {
            let message = format!(
                "the header has `{name}` twice, as columns {before} and {}",
                i + 1
            );
            return Err(Error::content(path, message));
        }
    }
    Ok(())
}
