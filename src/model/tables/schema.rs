//! The columns of each attribute of a table: `*.schema.json`.
//!
//! ```json
//! { "format": "edifice/attributes", "version": 1,
//!   "keep": { "Bldg Type": ["1Fam"] },
//!   "missing": ["", "NA"],
//!   "groups": [
//!     { "name": "bbox", "kind": "continuous", "columns": ["bbox_w", "bbox_d"] },
//!     { "name": "porch", "kind": "binary", "columns": ["porch_front", "porch_back"] },
//!     { "name": "roof", "kind": "category", "columns": ["roof_style"] } ] }
//! ```
//! `keep` leaves only rows with one of the listed texts; `missing` lists the texts that mean "not
//! known" (empty cells by default). Binary cells are 0/1, no/yes or false/true. Version 2 states exact relations
//! between columns ([`super::relations`]); without, they are sought where a model is learned.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::Dataset;
use super::categories::flag;
use super::relations::{Relation, Relations, find};
use crate::hierarchy::Group;
use crate::{ModelError, Table};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/attributes";
/// Version of schemas without relations.
pub const VERSION: u64 = 1;
/// Version of schemas that state them.
pub const RELATED_VERSION: u64 = 2;

/// The interpretation of the cells of a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Numbers: one vector-valued attribute with a hidden variable of its own.
    Continuous,
    /// Yes or no: a binary vector.
    Binary,
    /// One of a few texts; the categories are those that occur, in alphabetical order.
    Category,
}

/// One attribute and its columns.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SchemaGroup {
    /// Name of the attribute.
    pub name: String,
    /// The interpretation of its cells.
    pub kind: Kind,
    /// Names of its columns.
    pub columns: Vec<String>,
}

/// A schema. Columns that no group names are not read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Schema {
    /// Rows to keep, by column.
    #[serde(default)]
    pub keep: BTreeMap<String, Vec<String>>,
    /// Texts that mean "not known".
    #[serde(default = "empty_cell")]
    pub missing: Vec<String>,
    /// The attributes.
    pub groups: Vec<SchemaGroup>,
    /// The exact relations between columns; `None` where they are yet to be sought.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relations: Option<Vec<Relation>>,
}

fn empty_cell() -> Vec<String> {
    vec![String::new()]
}

/// Why a table does not fit a schema.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SchemaError {
    /// A column of the schema is not in the table.
    #[error("the table has no column `{column}`")]
    UnknownColumn {
        /// The column.
        column: String,
    },
    /// A cell is not a finite number.
    #[error("row {row}, column `{column}`: {text:?} is not a finite number")]
    NotANumber {
        /// Row of the table, the first is 1.
        row: usize,
        /// The column.
        column: String,
        /// The text found.
        text: String,
    },
    /// A cell is neither yes nor no.
    #[error("row {row}, column `{column}`: {text:?} is neither 0/1, no/yes nor false/true")]
    NotBinary {
        /// Row of the table, the first is 1.
        row: usize,
        /// The column.
        column: String,
        /// The text found.
        text: String,
    },
    /// A column of many different texts.
    #[error(
        "column `{column}` looks like free text ({different} different texts in {cells} cells): a schema can leave it out"
    )]
    FreeText {
        /// The column.
        column: String,
        /// Number of different texts.
        different: usize,
        /// Number of cells with a text.
        cells: usize,
    },
    /// A column without a value.
    #[error("column `{column}` has no value: a schema can leave it out")]
    NoValues {
        /// The column.
        column: String,
    },
    /// No row is left after `keep`.
    #[error("no row has the values that `keep` asks for")]
    NothingKept,
    /// The model layer refuses the table.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl Schema {
    /// The attributes as groups of columns.
    pub fn groups(&self) -> Vec<Group> {
        let groups = self.groups.iter().map(|g| Group {
            name: g.name.clone(),
            columns: g.columns.clone(),
        });
        groups.collect()
    }

    /// The text of the file.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] when JSON cannot say it.
    pub fn to_json(&self) -> Result<String, ModelError> {
        #[derive(Serialize)]
        struct Stored<'a> {
            format: &'static str,
            version: u64,
            #[serde(flatten)]
            schema: &'a Schema,
        }
        let stored = Stored {
            format: FORMAT,
            version: match self.relations {
                None => VERSION,
                Some(_) => RELATED_VERSION,
            },
            schema: self,
        };
        let text = serde_json::to_string_pretty(&stored);
        text.map_err(|e| ModelError::corrupt("the schema", e.to_string()))
    }

    /// The rows of a table that are kept, from 0, ascending.
    ///
    /// # Errors
    /// [`SchemaError::UnknownColumn`]; [`SchemaError::NothingKept`] where none is.
    pub fn kept(&self, header: &[String], rows: &[Vec<String>]) -> Result<Vec<usize>, SchemaError> {
        let mut kept: Vec<usize> = (0..rows.len()).collect();
        for (column, values) in &self.keep {
            let c = place(header, column)?;
            kept.retain(|&r| rows[r].get(c).is_some_and(|text| values.contains(text)));
        }
        match kept.is_empty() {
            true => Err(SchemaError::NothingKept),
            false => Ok(kept),
        }
    }

    /// Reads the cells of a table by this schema: those of the rows that are [kept](Self::kept), one after the other.
    ///
    /// # Errors
    /// [`SchemaError`] names the column and the row.
    pub fn read(&self, header: &[String], rows: &[Vec<String>]) -> Result<Dataset, SchemaError> {
        let kept = self.kept(header, rows)?;
        let mut table = Table::new();
        for group in &self.groups {
            for column in &group.columns {
                let c = place(header, column)?;
                let cells: Vec<(usize, Option<&str>)> = kept
                    .iter()
                    .map(|&r| (r + 1, self.cell(rows[r].get(c).map_or("", String::as_str))))
                    .collect();
                table = add(table, group.kind, column, &cells)?;
            }
        }
        Ok(Dataset {
            table,
            groups: self.groups(),
        })
    }

    /// The exact relations between columns; none where they are not stated.
    ///
    /// # Errors
    /// As [`Relations::new`].
    pub fn relations(&self) -> Result<Relations<'_>, ModelError> {
        Relations::new(self.relations.as_deref().unwrap_or_default())
    }

    /// The schema with the relations of its table stated, sought unless they are: `None` where there are none.
    pub fn related(mut self, data: &Dataset) -> Self {
        let relations = self.relations.unwrap_or_else(|| find(&data.table));
        self.relations = (!relations.is_empty()).then_some(relations);
        self
    }

    fn cell<'t>(&self, text: &'t str) -> Option<&'t str> {
        let text = text.trim();
        (!self.missing.iter().any(|m| m == text)).then_some(text)
    }
}

/// The place of a column in a header, whatever blanks are around either name.
fn place(header: &[String], column: &str) -> Result<usize, SchemaError> {
    let place = header.iter().position(|h| h.trim() == column.trim());
    place.ok_or_else(|| SchemaError::UnknownColumn {
        column: column.to_owned(),
    })
}

/// Adds a column of the given kind; cells come with their row, the first is 1.
fn add(
    table: Table,
    kind: Kind,
    column: &str,
    cells: &[(usize, Option<&str>)],
) -> Result<Table, SchemaError> {
    match kind {
        Kind::Continuous => {
            let mut values = Vec::with_capacity(cells.len());
            for &(row, text) in cells {
                let number = |text: &str| match text.parse() {
                    Ok(value) if f64::is_finite(value) => Ok(value),
                    _ => Err(SchemaError::NotANumber {
                        row,
                        column: column.to_owned(),
                        text: text.to_owned(),
                    }),
                };
                values.push(text.map(number).transpose()?);
            }
            Ok(table.real(column, values)?)
        }
        Kind::Binary => {
            let mut values = Vec::with_capacity(cells.len());
            for &(row, text) in cells {
                let read = |text: &str| {
                    flag(text).ok_or_else(|| SchemaError::NotBinary {
                        row,
                        column: column.to_owned(),
                        text: text.to_owned(),
                    })
                };
                values.push(text.map(read).transpose()?);
            }
            Ok(table.binary(column, values)?)
        }
        Kind::Category => {
            let texts = cells.iter().filter_map(|(_, text)| *text);
            let mut different = BTreeSet::new();
            different.extend(texts);
            let categories: Vec<&str> = different.into_iter().collect();
            let values = cells.iter().map(|(_, text)| *text);
            Ok(table.categorical(column, &categories, values)?)
        }
    }
}
