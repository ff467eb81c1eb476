//! Split grammars as JSON: `*.grammar.json`, format `edifice/grammar`, version 1.
//!
//! ```json
//! { "format": "edifice/grammar", "version": 1, "axiom": "Facade", "unit": "px", "width": 400.0, "height": 600.0,
//!   "rules": [
//!     { "symbol": "Facade", "op": "split",  "axis": "y", "successors": [ { "symbol": "wall", "size": 40.0 }, { "symbol": "Floor", "size": 560.0 } ] },
//!     { "symbol": "Floor",  "op": "repeat", "axis": "x", "successors": [ { "symbol": "Bay", "size": 50.0 } ] } ] }
//! ```
//! - `"relative": true` beside a `size` makes it a weight; a size in `columns` or `rows` is then
//!   written `{ "size": 3.0, "relative": true }` instead of a number.
//! - `"weight"` stands in the rules of a stochastic grammar only.
//! - `"name"` names the facade when it is not called as the axiom.
//! - A joint grammar lists its facades: `"facades": [ { "name": "a", "symbol": "A", "width": 4.0,
//!   "height": 6.0 }, ... ]`; `axiom`, `width` and `height` then repeat the first.
//!
//! The reader is strict about all of this and about the grammar itself
//! ([`check`]); keys that it does not know are ignored at the top and refused
//! in rules, where they are more likely a slip.

use std::path::Path;

use serde::Deserialize;

use super::json::{check_header, number, parse_json, quoted};
use super::{read_bytes, write_atomic};
use edifice_base::{Error, Result};
use edifice_grammar::{Grammar, Operation, Rule, Size, Start, Successor, check};
use edifice_shape::Axis;

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/grammar";
/// The version written, and the only one read.
pub const VERSION: u64 = 1;

/// Reads a grammar from a file.
///
/// # Errors
/// Names the file and the JSON path, or the line and column, of what is wrong.
pub fn read(path: &Path) -> Result<Grammar> {
    parse(&read_bytes(path)?, path)
}

/// Writes a grammar to a file, whole or not at all.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written.
pub fn write(grammar: &Grammar, path: &Path) -> Result<()> {
    write_atomic(path, to_string(grammar).as_bytes())
}

/// Parses the bytes of a grammar file; `path` only names the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Grammar> {
    check_header(bytes, path, FORMAT, VERSION)?;
    let file: File = parse_json(bytes, path)?;
    let first = Start {
        name: file.name.unwrap_or_else(|| file.axiom.clone()),
        symbol: file.axiom,
        width: file.width,
        height: file.height,
    };
    let starts = match file.facades {
        None => vec![first],
        Some(facades) => {
            let repeats = facades.first().is_some_and(|f| {
                (&f.symbol, f.width, f.height) == (&first.symbol, first.width, first.height)
            });
            if !repeats {
                let message = "axiom, width and height must repeat the first of the facades";
                return Err(Error::input(path, "facades[0]", message));
            }
            let start = |f: FileStart| Start {
                name: f.name,
                symbol: f.symbol,
                width: f.width,
                height: f.height,
            };
            facades.into_iter().map(start).collect()
        }
    };
    let rules = file.rules.into_iter().enumerate().map(|(index, rule)| {
        rule.into_rule().map_err(|(field, message)| {
            Error::input(path, format!("rules[{index}].{field}"), message)
        })
    });
    let grammar = Grammar {
        unit: file.unit,
        starts,
        rules: rules.collect::<Result<_>>()?,
    };
    check(&grammar).map_err(|e| Error::content(path, e))?;
    Ok(grammar)
}

/// The text of a grammar file, one rule a line. Numbers read back to the same bits.
pub fn to_string(grammar: &Grammar) -> String {
    // A value never has no start; one without would be refused when read back.
    let Some(first) = grammar.starts.first() else {
        return String::new();
    };
    let mut out = format!(
        "{{ \"format\": \"{FORMAT}\", \"version\": {VERSION}, \"axiom\": {},",
        quoted(&first.symbol)
    );
    if grammar.starts.len() == 1 && first.name != first.symbol {
        out += &format!(" \"name\": {},", quoted(&first.name));
    }
    out += &format!(
        " \"unit\": {}, \"width\": {}, \"height\": {},\n",
        quoted(&grammar.unit),
        number(first.width),
        number(first.height)
    );
    if grammar.starts.len() > 1 {
        let start = |s: &Start| {
            format!(
                "{{ \"name\": {}, \"symbol\": {}, \"width\": {}, \"height\": {} }}",
                quoted(&s.name),
                quoted(&s.symbol),
                number(s.width),
                number(s.height)
            )
        };
        let starts: Vec<String> = grammar.starts.iter().map(start).collect();
        out += &format!("  \"facades\": [\n    {} ],\n", starts.join(",\n    "));
    }
    let rules: Vec<String> = grammar.rules.iter().map(rule_text).collect();
    out += "  \"rules\": [";
    if !rules.is_empty() {
        out += &format!("\n    {}", rules.join(",\n    "));
    }
    out + " ] }\n"
}

fn rule_text(rule: &Rule) -> String {
    let mut out = format!("{{ \"symbol\": {}, ", quoted(&rule.symbol));
    if let Some(weight) = rule.weight {
        out += &format!("\"weight\": {}, ", number(weight));
    }
    out += &format!("\"op\": \"{}\", ", rule.operation.name());
    let list = |successors: &[&Successor]| {
        let texts: Vec<String> = successors.iter().map(|s| successor_text(s)).collect();
        format!("\"successors\": [ {} ]", texts.join(", "))
    };
    let line = |axis: &Axis, successors: &[&Successor]| {
        format!("\"axis\": \"{}\", {}", axis.name(), list(successors))
    };
    out += &match &rule.operation {
        Operation::Split { axis, successors } | Operation::Repeat { axis, successors } => {
            line(axis, &successors.iter().collect::<Vec<_>>())
        }
        Operation::RepeatAba { axis, a, b } => line(axis, &[a, b]),
        Operation::SymSplit {
            axis,
            successors,
            center,
        } => format!(
            "{}, \"center\": {center}",
            line(axis, &successors.iter().collect::<Vec<_>>())
        ),
        Operation::GridSplit {
            columns,
            rows,
            cells,
        } => {
            let sizes = |sizes: &[Size]| {
                let texts: Vec<String> = sizes.iter().map(|&s| grid_size_text(s)).collect();
                texts.join(", ")
            };
            let row = |row: &Vec<String>| {
                let texts: Vec<String> = row.iter().map(|s| quoted(s)).collect();
                format!("[ {} ]", texts.join(", "))
            };
            let cells: Vec<String> = cells.iter().map(row).collect();
            format!(
                "\"columns\": [ {} ], \"rows\": [ {} ], \"cells\": [ {} ]",
                sizes(columns),
                sizes(rows),
                cells.join(", ")
            )
        }
    };
    out + " }"
}

fn successor_text(successor: &Successor) -> String {
    format!(
        "{{ \"symbol\": {}, {} }}",
        quoted(&successor.symbol),
        size_text(successor.size)
    )
}

fn size_text(size: Size) -> String {
    match size {
        Size::Absolute(v) => format!("\"size\": {}", number(v)),
        Size::Relative(v) => format!("\"size\": {}, \"relative\": true", number(v)),
    }
}

fn grid_size_text(size: Size) -> String {
    match size {
        Size::Absolute(v) => number(v),
        Size::Relative(_) => format!("{{ {} }}", size_text(size)),
    }
}

#[derive(Deserialize)]
struct File {
    axiom: String,
    name: Option<String>,
    unit: String,
    width: f64,
    height: f64,
    facades: Option<Vec<FileStart>>,
    rules: Vec<FileRule>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileStart {
    name: String,
    symbol: String,
    width: f64,
    height: f64,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Op {
    Split,
    Repeat,
    RepeatAba,
    SymSplit,
    GridSplit,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileRule {
    symbol: String,
    weight: Option<f64>,
    op: Op,
    axis: Option<Axis>,
    successors: Option<Vec<FileSuccessor>>,
    center: Option<bool>,
    columns: Option<Vec<FileSize>>,
    rows: Option<Vec<FileSize>>,
    cells: Option<Vec<Vec<String>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileSuccessor {
    symbol: String,
    size: f64,
    #[serde(default)]
    relative: bool,
}

#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number or { \"size\": ..., \"relative\": true }"
)]
enum FileSize {
    Number(f64),
    Object(SizeObject),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SizeObject {
    size: f64,
    #[serde(default)]
    relative: bool,
}

fn size(value: f64, relative: bool) -> Size {
    match relative {
        true => Size::Relative(value),
        false => Size::Absolute(value),
    }
}

impl From<FileSize> for Size {
    fn from(file: FileSize) -> Self {
        match file {
            FileSize::Number(v) => Size::Absolute(v),
            FileSize::Object(o) => size(o.size, o.relative),
        }
    }
}

impl From<FileSuccessor> for Successor {
    fn from(file: FileSuccessor) -> Self {
        Self {
            symbol: file.symbol,
            size: size(file.size, file.relative),
        }
    }
}

/// A key of a rule, and what is wrong with it.
type Wrong = (&'static str, &'static str);

impl FileRule {
    /// The rule, when exactly the keys of its operation are there.
    fn into_rule(self) -> std::result::Result<Rule, Wrong> {
        let grid = matches!(self.op, Op::GridSplit);
        let alien = [
            ("axis", self.axis.is_some() && grid),
            ("successors", self.successors.is_some() && grid),
            ("columns", self.columns.is_some() && !grid),
            ("rows", self.rows.is_some() && !grid),
            ("cells", self.cells.is_some() && !grid),
            (
                "center",
                self.center.is_some() && !matches!(self.op, Op::SymSplit),
            ),
        ];
        if let Some((field, _)) = alien.into_iter().find(|(_, wrong)| *wrong) {
            return Err((field, "this operation has no such key"));
        }
        let sizes = |sizes: Vec<FileSize>| sizes.into_iter().map(Size::from).collect();
        let operation = if grid {
            Operation::GridSplit {
                columns: sizes(there(self.columns, "columns")?),
                rows: sizes(there(self.rows, "rows")?),
                cells: there(self.cells, "cells")?,
            }
        } else {
            let axis = there(self.axis, "axis")?;
            let successors = there(self.successors, "successors")?;
            let mut successors: Vec<Successor> =
                successors.into_iter().map(Successor::from).collect();
            match self.op {
                Op::Split | Op::GridSplit => Operation::Split { axis, successors },
                Op::Repeat => Operation::Repeat { axis, successors },
                Op::SymSplit => Operation::SymSplit {
                    axis,
                    successors,
                    center: self.center.unwrap_or(false),
                },
                Op::RepeatAba => match (successors.pop(), successors.pop(), successors.pop()) {
                    (Some(b), Some(a), None) => Operation::RepeatAba { axis, a, b },
                    _ => return Err(("successors", "repeat_aba takes exactly two successors")),
                },
            }
        };
        Ok(Rule {
            symbol: self.symbol,
            weight: self.weight,
            operation,
        })
    }
}

fn there<T>(value: Option<T>, field: &'static str) -> std::result::Result<T, Wrong> {
    value.ok_or((field, "missing, the operation needs it"))
}
