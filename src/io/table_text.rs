//! The text of tables before it is cut into cells: what is no CSV, which separator it has, and numbers written with commas.
//!
//! A separator is looked for where the header line has no comma: among `;`, tab and `|` the one that stands in the header and equally often in
//! each of the first lines (outside of quotes), or that a first line names (`sep=;`). A column whose known cells are all numbers, some of them with commas, is read with
//! points: decimal commas (`1,5`), thousands (`1,234` in a table separated by commas, `1.234,5` elsewhere). Where every such number could be either
//! (`1,234` in a table separated by something else), the column is refused: the reader would guess.

use std::collections::BTreeMap;
use std::path::Path;

use edifice_base::csv::MISSING;
use edifice_base::{Error, Result};

/// Lines that a separator is judged by.
const LINES: usize = 100;
/// Separators that a table may have instead of the comma.
const OTHERS: [char; 3] = [';', '\t', '|'];

/// Refuses files that are no text of a table, by name.
///
/// # Errors
/// [`Error::Content`] for Parquet, Arrow, ARFF, SQLite, HDF5 and zip files (Excel's), UTF-16 text, HTML and JSON, and an empty file.
pub(crate) fn refuse(bytes: &[u8], path: &Path) -> Result<()> {
    let starts: [(&[u8], &str); 8] = [
        (b"PAR1", "a Parquet file"),
        (b"ARROW1", "an Arrow file"),
        (b"FEA1", "a Feather file"),
        (b"PK\x03\x04", "a zip file (an Excel workbook?)"),
        (b"SQLite format 3\0", "an SQLite database"),
        (b"\x89HDF", "an HDF5 file"),
        (b"\xff\xfe", "UTF-16 text"),
        (b"\xfe\xff", "UTF-16 text"),
    ];
    let refused = |kind: &str| {
        let message =
            format!("{kind}, not a table as CSV: save it as CSV in UTF-8, a header line first");
        Err(Error::content(path, message))
    };
    if let Some((_, kind)) = starts.iter().find(|(start, _)| bytes.starts_with(start)) {
        return refused(kind);
    }
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 16)]);
    let text = text.trim_start_matches('\u{feff}');
    // ARFF may begin with comments.
    let first = text.lines().map(str::trim);
    let first = first
        .into_iter()
        .find(|l| !l.is_empty() && !l.starts_with('%'));
    let Some(first) = first else {
        return match text.trim().is_empty() {
            true => Err(Error::content(path, "the file is empty")),
            false => Ok(()),
        };
    };
    let lower = first.to_ascii_lowercase();
    match () {
        () if lower.starts_with("@relation") => refused("an ARFF file"),
        () if lower.starts_with("<!doctype") || lower.starts_with("<html") => {
            refused("a page of HTML")
        }
        () if first == "{"
            || first == "["
            || first.starts_with("{\"")
            || first.starts_with("[{") =>
        {
            refused("JSON")
        }
        () => Ok(()),
    }
}

/// The separator of a table, and the bytes of a line in front of the header that only names it (`sep=;`, written by spreadsheets).
///
/// # Errors
/// [`Error::Content`] where cells are separated by blanks, and where a comma and another mark stand in each line equally often.
pub(crate) fn separator(text: &[u8], path: &Path) -> Result<(u8, usize)> {
    let text = String::from_utf8_lossy(&text[..text.len().min(1 << 20)]);
    if let Some((mark, length)) = named(&text) {
        return Ok((mark, length));
    }
    let lines = unquoted(&text);
    let count = |line: &str, c: char| line.matches(c).count();
    let Some(header) = lines.first() else {
        return Ok((b',', 0));
    };
    let fits = |c: char| {
        let expected = count(header, c);
        expected > 0 && lines.iter().all(|l| count(l, c) == expected)
    };
    let others = OTHERS.into_iter().filter(|c| fits(*c));
    let found = others.max_by_key(|c| count(header, *c));
    match found {
        Some(mark) if fits(',') => {
            let message = format!(
                "cells may be separated by ',' or by {mark:?}, which stand in every line equally often: put texts with either in quotes"
            );
            Err(Error::content(path, message))
        }
        _ if header.contains(',') => Ok((b',', 0)),
        Some(mark) => Ok((mark as u8, 0)),
        None if are_parted_by_blanks(&lines) => {
            let message = "cells seem to be separated by blanks: save the table as CSV";
            Err(Error::content(path, message))
        }
        None => Ok((b',', 0)),
    }
}

/// A first line that only names the separator, and its length.
fn named(text: &str) -> Option<(u8, usize)> {
    let line = text.lines().next()?;
    let mark = line
        .trim_start_matches('\u{feff}')
        .trim_end_matches('\r')
        .strip_prefix("sep=")?;
    let mark = mark
        .chars()
        .next()
        .filter(|c| *c == ',' || OTHERS.contains(c))?;
    let length = text.find('\n')? + 1;
    Some((mark as u8, length))
}

/// The first lines that are not blank, without what stands in quotes.
fn unquoted(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let (mut line, mut quoted) = (String::new(), false);
    for c in text.chars() {
        match c {
            '"' => quoted = !quoted,
            '\n' if !quoted => {
                lines.push(std::mem::take(&mut line));
                if lines.len() == LINES {
                    break;
                }
            }
            c if !quoted => line.push(c),
            _ => {}
        }
    }
    if !line.is_empty() && lines.len() < LINES {
        lines.push(line);
    }
    lines.retain(|l| !l.trim().is_empty());
    lines
}

/// True if every line has the same number of words, more than one, and one of its columns of words has only numbers below the header.
fn are_parted_by_blanks(lines: &[String]) -> bool {
    let words: Vec<Vec<&str>> = lines
        .iter()
        .map(|l| l.split_whitespace().collect())
        .collect();
    let Some((header, rows)) = words.split_first() else {
        return false;
    };
    let all_numbers = |c: usize| rows.iter().all(|r| r[c].parse::<f64>().is_ok());
    header.len() > 1
        && !rows.is_empty()
        && rows.iter().all(|r| r.len() == header.len())
        && (0..header.len()).any(all_numbers)
}

/// A number with commas.
#[derive(Clone, Copy, PartialEq)]
enum Commas {
    /// None: `1.5`.
    Plain,
    /// Its comma can only be decimal: `1,5`, `0,125`, `1.234,5`.
    Decimal,
    /// Its commas can only part thousands: `1,234.5`, `1,234,567`.
    Thousands,
    /// Either: `1,234`.
    Either,
}

/// The role of the commas in a number; `None` for what is none.
fn commas(text: &str) -> Option<Commas> {
    let body = text.strip_prefix(['-', '+']).unwrap_or(text);
    if !body.contains(',') {
        return text
            .parse::<f64>()
            .is_ok_and(f64::is_finite)
            .then_some(Commas::Plain);
    }
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    let grouped = |s: &str, mark: char| {
        let mut parts = s.split(mark);
        let first = parts.next().is_some_and(|p| digits(p) && p.len() <= 3);
        first && parts.all(|p| digits(p) && p.len() == 3)
    };
    let (whole, part) = match body.rsplit_once('.') {
        // `1,234.5`: the point is decimal.
        Some((whole, part)) if whole.contains(',') => {
            let fine = grouped(whole, ',') && digits(part);
            return fine.then_some(Commas::Thousands);
        }
        // `1.234,5`: the comma is decimal.
        Some(_) => {
            let (whole, part) = body.split_once(',')?;
            return (grouped(whole, '.') && digits(part)).then_some(Commas::Decimal);
        }
        None => body.split_once(',')?,
    };
    if part.contains(',') {
        return grouped(body, ',').then_some(Commas::Thousands);
    }
    if !digits(whole) || !digits(part) {
        return None;
    }
    let either = part.len() == 3 && whole.len() <= 3 && !whole.starts_with('0');
    Some(if either {
        Commas::Either
    } else {
        Commas::Decimal
    })
}

/// Cells of columns by the place of the column.
type Columns = BTreeMap<usize, Vec<String>>;

/// Rewrites the numbers of columns that are written with commas; returns a sentence for each such column, and for each of which
/// most known cells are numbers, but not all; and the cells of rewritten columns as they were, by the place of the column.
///
/// # Errors
/// [`Error::Content`] for a column that could be read in two ways.
pub(crate) fn points(
    header: &[String],
    rows: &mut [Vec<String>],
    separator: u8,
    path: &Path,
) -> Result<(Vec<String>, Columns)> {
    let mut notes = Vec::new();
    let mut before = Columns::new();
    for (c, name) in header.iter().enumerate() {
        let cells = rows.iter().filter_map(|r| r.get(c)).map(|t| t.trim());
        let known: Vec<&str> = cells.filter(|t| !MISSING.contains(t)).collect();
        let kinds: Vec<Commas> = known.iter().filter_map(|t| commas(t)).collect();
        if kinds.len() < known.len() {
            notes.extend(mixed(name, &known, kinds.len()));
            continue;
        }
        let has = |kind| kinds.contains(&kind);
        let decimal = match (
            has(Commas::Decimal),
            has(Commas::Thousands),
            has(Commas::Either),
        ) {
            (false, false, false) => continue,
            // Both `1,5` and `1,234.5`: no number format has both.
            (true, true, _) => continue,
            (true, false, _) => true,
            (false, true, _) => false,
            // Quoted `"1,234"` between commas parts thousands.
            (false, false, true) if separator == b',' => false,
            (false, false, true) => {
                let message = format!(
                    "column `{name}`: numbers like \"1,234\" may have a decimal comma or parted thousands: write them with points"
                );
                return Err(Error::content(path, message));
            }
        };
        let cells = rows.iter().map(|r| r.get(c).cloned().unwrap_or_default());
        before.insert(c, cells.collect());
        for cell in rows.iter_mut().filter_map(|r| r.get_mut(c)) {
            let text = cell.trim();
            if MISSING.contains(&text) {
                continue;
            }
            *cell = match decimal {
                true if text.contains(',') => text.replace('.', "").replace(',', "."),
                true => text.to_owned(),
                false => text.replace(',', ""),
            };
        }
        let what = if decimal {
            "decimal commas"
        } else {
            "commas between thousands"
        };
        notes.push(format!("column `{name}`: numbers with {what}"));
    }
    Ok((notes, before))
}

/// A sentence for a column of which so many known cells are numbers, if they are most of them: it will be read as categories or text.
fn mixed(name: &str, known: &[&str], numbers: usize) -> Option<String> {
    let first = known.iter().find(|t| commas(t).is_none())?;
    (2 * numbers > known.len()).then(|| {
        format!(
            "column `{name}`: {numbers} of {} known cells are numbers, but not {first:?}: the column is no number unless a schema calls that missing",
            known.len()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::super::building_csv::parse;
    use super::*;

    fn read(text: &str) -> Result<super::super::building_csv::TextTable> {
        parse(text.as_bytes(), Path::new("table.csv"))
    }

    fn cells(text: &str) -> Vec<Vec<String>> {
        let table = read(text).unwrap();
        std::iter::once(table.header).chain(table.rows).collect()
    }

    #[test]
    fn odd_tables_are_read_as_they_are_meant() {
        let meant = [["a", "b"], ["1.5", "x"], ["2.5", "y"]].map(|r| r.map(str::to_owned).to_vec());
        for text in [
            "a,b\n1.5,x\n2.5,y\n",
            "a,b\r\n1.5,x\r\n2.5,y",
            "\u{feff}a,b\n1.5,x\n2.5,y\n",
            "a;b\n1.5;x\n2.5;y\n",
            "a;b\n1,5;x\n2,5;y\n",
            "a\tb\n1.5\tx\n2.5\ty\n",
            "a|b\n1.5|x\n2.5|y\n",
            "\"a\",\"b\"\n\"1.5\",\"x\"\n\"2.5\",\"y\"\n",
            "\"a\";\"b\"\n\"1,5\";\"x\"\n\"2,5\";\"y\"\n",
        ] {
            assert_eq!(cells(text), meant, "{text:?}");
        }
        assert_eq!(
            cells("a,b\n\"1,234\",x\n\"12,345.5\",y\n")[1..],
            [["1234", "x"], ["12345.5", "y"]]
        );
        assert_eq!(
            cells("a;b\n1.234,5;x\n0,5;y\n")[1..],
            [["1234.5", "x"], ["0.5", "y"]]
        );
        // Commas within texts are no numbers, and a quoted separator is none.
        assert_eq!(cells("a,b\n\"1, 2\",x\n\"3, 4\",y\n")[1][0], "1, 2");
        assert_eq!(cells("a;b\n\"x;y\";1\nz;2\n")[1], ["x;y", "1"]);
        // One column stays one.
        assert_eq!(cells("a\n1\n2\n").len(), 3);
    }

    #[test]
    fn what_is_no_table_is_refused_by_name() {
        for (text, said) in [
            ("", "empty"),
            ("\n \n", "empty"),
            ("a,b\n", "no rows"),
            ("PAR1\u{0}\u{0}", "Parquet"),
            (
                "% comment\n@RELATION iris\n@attribute a numeric\n@data\n1\n",
                "ARFF",
            ),
            ("<!DOCTYPE html>\n<p>", "HTML"),
            ("[{\"a\": 1}]", "JSON"),
            ("a,b,a\n1,2,3\n", "twice"),
            (
                "a;b\n1,234;x\n2,345;y\n",
                "decimal comma or parted thousands",
            ),
            ("a,b\n1,2,3\n", "line 2"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(said), "{text:?}: {error}");
        }
    }

    #[test]
    fn what_was_read_otherwise_than_as_plain_csv_is_said() {
        assert!(read("a,b\n1,2\n").unwrap().notes.is_empty());
        let notes = read("a;b\n1,5;2\n").unwrap().notes.join("\n");
        assert!(
            notes.contains("separated by ';'")
                && notes.contains("column `a`: numbers with decimal commas"),
            "{notes}"
        );
        let notes = read("1,2\n3,4\n").unwrap().notes.join("\n");
        assert!(notes.contains("first line"), "{notes}");
        let table = read(",b\n1,2\n").unwrap();
        assert_eq!(table.header, ["column_1", "b"]);
        assert!(table.notes[0].contains("has no name"), "{:?}", table.notes);
    }
}
