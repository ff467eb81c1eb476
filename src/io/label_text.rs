//! Label images as text: a matrix of labels or numbers, one row a line, the top row first.
//!
//! Entries are separated by blanks, tabs or commas; blank lines are skipped. A label has no blanks
//! or commas in it. Each entry is a square of one unit. Numbers may be negative, and written as whole
//! numbers or with a point (`2`, `-1`, `2.000e+00`).

use std::collections::HashMap;
use std::path::Path;

use super::label_map::{Key, LabelMap};
use super::raster::Raster;
use super::{file_stem, read_bytes};
use edifice_base::{Error, Result};
use edifice_shape::{Facade, LabelGrid};

/// Reads a text matrix. With a `map`, numbers are looked up in it; other entries are labels.
///
/// # Errors
/// Names the file, and the line and entry of a number that the map does not name, or of a row that
/// is longer or shorter than the first.
pub fn read(path: &Path, map: Option<&LabelMap>) -> Result<LabelGrid> {
    parse(&read_bytes(path)?, path, map)
}

/// Parses a text matrix; `path` names the grid, and the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path, map: Option<&LabelMap>) -> Result<LabelGrid> {
    let text = std::str::from_utf8(bytes).map_err(|e| Error::content(path, e))?;
    let mut names: HashMap<String, u16> = HashMap::new();
    let mut rows: Vec<Vec<u16>> = Vec::new();
    for (line, content) in (1..).zip(text.lines()) {
        let entries = content
            .split([' ', '\t', ',', '\r'])
            .filter(|e| !e.is_empty());
        let mut row = Vec::new();
        for (entry, word) in (1..).zip(entries) {
            let place = || format!("line {line}, entry {entry}");
            let label = match map {
                Some(map) if word.parse::<f64>().is_ok() => named(map, word).ok_or_else(|| {
                    let message = format!("unknown number {word}: the label map does not name it");
                    Error::input(path, place(), message)
                })?,
                _ => word,
            };
            let next = names.len();
            let number = match names.get(label) {
                Some(&number) => number,
                None => {
                    let number = u16::try_from(next)
                        .map_err(|_| Error::input(path, place(), "more than 65536 labels"))?;
                    names.insert(label.to_string(), number);
                    number
                }
            };
            row.push(number);
        }
        if row.is_empty() {
            continue;
        }
        if let Some(first) = rows.first().filter(|first| first.len() != row.len()) {
            let message = format!("{} entries, the first row has {}", row.len(), first.len());
            return Err(Error::input(path, format!("line {line}"), message));
        }
        rows.push(row);
    }
    let Some(columns) = rows.first().map(Vec::len) else {
        return Err(Error::content(path, "the matrix is empty"));
    };
    let mut labels: Vec<(String, u16)> = names.into_iter().collect();
    labels.sort_unstable_by_key(|&(_, number)| number);
    let grid = LabelGrid {
        name: file_stem(path),
        unit: "px".into(),
        xs: (0..=columns).map(|x| x as f64).collect(),
        ys: (0..=rows.len()).map(|y| y as f64).collect(),
        labels: labels.into_iter().map(|(name, _)| name).collect(),
        cells: rows.iter().rev().flatten().copied().collect(),
    };
    Ok(grid.merged())
}

/// A label that cannot stand in a text matrix.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the label {0:?} has a blank or a comma in it, which a text matrix cannot hold")]
pub struct UnfitLabel(pub String);

/// The matrix of a layout, sampled as [`Raster`] says.
///
/// # Errors
/// [`UnfitLabel`] for a label with a blank or a comma in it.
pub fn to_string(facade: &Facade) -> Result<String, UnfitLabel> {
    let raster = Raster::new(facade);
    let unfit = |label: &&String| label.contains([' ', '\t', ',', '\r', '\n']);
    if let Some(label) = raster.labels.iter().find(unfit) {
        return Err(UnfitLabel(label.clone()));
    }
    let mut out = String::new();
    for row in raster.rows() {
        for (column, &label) in row.iter().enumerate() {
            if column > 0 {
                out.push(' ');
            }
            out.push_str(&raster.labels[label as usize]);
        }
        out.push('\n');
    }
    Ok(out)
}

/// The label of a number; `None` for one that the map does not name, and for one that is not whole.
fn named<'m>(map: &'m LabelMap, word: &str) -> Option<&'m str> {
    let whole = |v: f64| v.fract() == 0.0 && v.abs() < 2f64.powi(53);
    let written = || word.parse().ok().filter(|&v| whole(v)).map(|v| v as i64);
    let id = word.parse().ok().or_else(written)?;
    map.find(Key::Id(id))
        .and_then(|position| map.names().nth(position.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_line_is_the_top_row() {
        let text = b"sky sky\n\nwall, door\r\n";
        let grid = parse(text, "a.txt".as_ref(), None).unwrap();
        assert_eq!(grid.labels, ["door", "sky", "wall"]);
        assert_eq!(grid.cells, [2, 0, 1, 1]);
        let map = LabelMap::cmp();
        let grid = parse(b"2 3\n2 2", "a.txt".as_ref(), Some(&map)).unwrap();
        assert_eq!(grid.labels, ["facade", "window"]);
        assert_eq!(grid.cells, [0, 0, 0, 1]);
        let map = LabelMap::parse(br#"{"void": -1, "wall": 0}"#, "m".as_ref()).unwrap();
        let text = b"-1 0 +0.0\n-1.000e+00 0.0e0 other";
        let grid = parse(text, "a.txt".as_ref(), Some(&map)).unwrap();
        assert_eq!(grid.labels, ["other", "void", "wall"]);
        assert_eq!(grid.cells, [1, 2, 0, 1, 2, 2]);
    }

    #[test]
    fn bad_matrices_name_their_place() {
        let map = LabelMap::cmp();
        let cases: [(&[u8], &str); 8] = [
            (
                b"1 -1",
                "line 1, entry 2: unknown number -1: the label map does not name it",
            ),
            (b"1 1.5", "line 1, entry 2: unknown number 1.5"),
            (b"1 nan", "line 1, entry 2: unknown number nan"),
            (
                b"1 99999999999999999999",
                "entry 2: unknown number 99999999999999999999",
            ),
            (b"a a\na", "line 2: 1 entries, the first row has 2"),
            (b"1 1\n1 99", "line 2, entry 2: unknown number 99"),
            (b"\n \n", "a.txt: the matrix is empty"),
            (b"\xff", "invalid utf-8"),
        ];
        for (bytes, expected) in cases {
            let message = parse(bytes, "a.txt".as_ref(), Some(&map))
                .unwrap_err()
                .to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
