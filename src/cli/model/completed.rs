//! Completed rows, as CSV or for programs.

use std::borrow::Cow;
use std::collections::BTreeMap;

use edifice_base::{Result, csv};
use edifice_io::building_csv::TextTable;
use edifice_model::{Cell, Column, Table};
use serde_json::Value;

use super::data::{json_of, text_of};
use crate::print::{self, Json};

/// Words for no and yes.
const WORDS: [[&str; 2]; 4] = [["no", "yes"], ["0", "1"], ["0.0", "1.0"], ["false", "true"]];

/// The printing of completed rows. As CSV a known cell is as the table has it, a drawn yes or no in the words of the known cells of its
/// column, and columns that the model does not know come first, as they are; for programs the rows are gathered into one line.
pub(super) struct Completed<'t> {
    text: &'t TextTable,
    /// The rows to be completed.
    known: &'t Table,
    /// Their places in the text.
    rows: &'t [usize],
    /// Columns of the text that the model does not know.
    passed: Vec<usize>,
    /// Words for no and yes by column, where they are not these.
    words: BTreeMap<String, [String; 2]>,
    json: Json,
    columns: Value,
    drawn: Vec<Value>,
    of: Vec<usize>,
}

impl<'t> Completed<'t> {
    /// For the rows `known` at the places `rows` of the text; all its columns but those of the model pass through if `passes`.
    pub(super) fn new(
        text: &'t TextTable,
        known: &'t Table,
        rows: &'t [usize],
        passes: bool,
        json: Json,
    ) -> Self {
        let mut passed: Vec<usize> = (0..text.header.len()).filter(|_| passes).collect();
        let mut words = BTreeMap::new();
        for column in known.columns() {
            let Some(c) = text.column(column.name()) else {
                continue;
            };
            passed.retain(|other| *other != c);
            let known = (0..rows.len()).filter(|&row| column.cell(row) != Cell::Missing);
            let texts = known.map(|row| text.cell(rows[row], c).trim());
            if let Some(own) = is_flag(column).then(|| spelling(texts)).flatten() {
                words.insert(column.name().to_owned(), own);
            }
        }
        Self {
            text,
            known,
            rows,
            passed,
            words,
            json,
            columns: Value::Null,
            drawn: Vec::new(),
            of: Vec::new(),
        }
    }

    /// Prints the header of draws as CSV, unless a line for programs was asked for.
    pub(super) fn header(&self, drawn: &Table) -> Result<()> {
        if self.json.is_asked() {
            return Ok(());
        }
        let passed = self.passed.iter().map(|&c| self.text.header[c].as_str());
        let own = drawn.columns().iter().map(Column::name);
        let names = passed.chain(own).map(|name| csv::cell(name).into_owned());
        print::line(&names.collect::<Vec<_>>().join(","))
    }

    /// Takes draws; `of` says which of the known rows each of them completes.
    pub(super) fn add(&mut self, drawn: &Table, of: impl Fn(usize) -> usize) -> Result<()> {
        if self.json.is_asked() {
            let mut value = json_of(drawn);
            self.columns = value["columns"].take();
            if let Value::Array(rows) = value["rows"].take() {
                self.of
                    .extend((0..rows.len()).map(|row| self.rows[of(row)]));
                self.drawn.extend(rows);
            }
            return Ok(());
        }
        for row in 0..drawn.rows() {
            let (place, own) = (self.rows[of(row)], drawn.columns().iter());
            let passed = self.passed.iter().map(|&c| self.text.cell(place, c).into());
            let own = own.map(|column| self.cell(column, row, of(row)));
            let cells = passed.chain(own);
            let cells = cells.map(|text: Cow<'_, str>| csv::cell(&text).into_owned());
            print::line(&cells.collect::<Vec<_>>().join(","))?;
        }
        Ok(())
    }

    /// A cell of a draw, which completes the known row `of`.
    fn cell<'a>(&'a self, column: &'a Column, row: usize, of: usize) -> Cow<'a, str> {
        let drawn = text_of(column, row);
        let known = self.known.column(column.name()).ok();
        let known = known.filter(|own| own.cell(of) != Cell::Missing);
        if let Some(c) = known.and_then(|own| self.text.column(own.name())) {
            let written = self.text.written(self.rows[of], c);
            // The name of a category may be a number with commas.
            return match written.trim() == drawn {
                true => written.into(),
                false => self.text.cell(self.rows[of], c).into(),
            };
        }
        match (self.words.get(column.name()), &*drawn) {
            (Some([no, _]), "no") => no.into(),
            (Some([_, yes]), "yes") => yes.into(),
            _ => drawn,
        }
    }

    /// Prints the line for programs, if it was asked for.
    pub(super) fn end(self) -> Result<()> {
        let line =
            serde_json::json!({ "columns": self.columns, "rows": self.drawn, "of": self.of });
        self.json.end(&line)
    }
}

/// True for a column of no and yes.
fn is_flag(column: &Column) -> bool {
    let names = column.categories().unwrap_or_default();
    let has = |word: &str| names.iter().any(|name| name == word);
    names.len() == 2 && has("no") && has("yes")
}

/// The words for no and yes that the first text goes by, in its case; `None` for a column without a text.
fn spelling<'t>(mut texts: impl Iterator<Item = &'t str>) -> Option<[String; 2]> {
    let first = texts.next()?;
    let lower = first.to_ascii_lowercase();
    let words = WORDS.iter().find(|words| words.contains(&lower.as_str()))?;
    let capital = first.starts_with(|c: char| c.is_ascii_uppercase());
    let all = first.chars().all(|c| c.is_ascii_uppercase());
    Some(words.map(|word| match word.split_at(1) {
        _ if all => word.to_ascii_uppercase(),
        (start, rest) if capital => start.to_ascii_uppercase() + rest,
        _ => word.to_owned(),
    }))
}
