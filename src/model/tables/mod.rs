//! Any table: its columns as typed attributes, models learned from it, compared on rows that they have not seen.
//!
//! | module | what |
//! | --- | --- |
//! | [`schema`] | which columns are which attributes, written by hand or guessed |
//! | [`relations`] | exact relations between columns: copies, sums, products |
//! | [`encoding`] | values that many rows share as categories, the others transformed |
//! | [`given`] | evidence in words |
//! | [`transform`] | monotone transforms of a real column |
//! | [`table_model`] | a hierarchical model with the schema that it reads tables by |
//! | [`joined`] | real columns that share hidden variables: all, those of a group, or none, by the highest score |
//! | [`categories`] | which category a text means |
//! | [`bins`] | real columns as categories, by description length |
//! | [`kernels`] | a kernel density over mixed columns, a peer |
//! | [`mixture`] | a Gaussian mixture over mixed columns, the baseline |
//! | [`compare`] | held-out likelihoods of models on the same splits |
//!
//! Texts become numbers and categories here; the models themselves are in [`crate`].

pub mod bins;
pub mod categories;
pub mod compare;
pub mod encoding;
pub mod given;
mod grouping;
mod guess;
pub mod joined;
pub mod kernels;
pub mod learn;
mod marginal;
pub mod mixture;
pub mod relations;
pub mod schema;
pub mod table_model;
pub mod transform;

use crate::hierarchy::Group;
use crate::{ModelError, Table};

/// A table and its attributes.
#[derive(Debug, Clone)]
pub struct Dataset {
    /// One thing (a house, say) a row.
    pub table: Table,
    /// The groups of columns that belong together.
    pub groups: Vec<Group>,
}

impl Dataset {
    /// The given rows.
    pub fn select(&self, rows: &[usize]) -> Self {
        Self {
            table: self.table.select(rows),
            groups: self.groups.clone(),
        }
    }

    /// Number of attributes of real columns.
    pub fn real_groups(&self) -> usize {
        let real = |name: &String| {
            let column = self.table.columns().iter().find(|c| c.name() == name);
            column.is_some_and(|c| c.categories().is_none())
        };
        let first = self.groups.iter().filter_map(|g| g.columns.first());
        first.filter(|name| real(name)).count()
    }

    /// All attributes but one.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] when a group names a column that the table lacks.
    pub fn without(&self, attribute: &str) -> Result<Self, ModelError> {
        let mut groups = self.groups.clone();
        groups.retain(|g| g.name != attribute);
        let columns = groups.iter().flat_map(|g| &g.columns);
        let columns: Vec<&str> = columns.map(String::as_str).collect();
        Ok(Self {
            table: self.table.only(&columns)?,
            groups,
        })
    }
}
