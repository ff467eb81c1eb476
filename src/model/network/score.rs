//! Rows of a table as evidence, and how likely they are.

use rayon::prelude::*;

use super::super::elimination::Mode;
use super::super::error::ModelError;
use super::super::table::{Cell, Table};
use super::Network;
use super::evidence::{Asked, Known};

impl Network {
    /// `log p(row)` of every row, nats: columns carry the variables' names (`name[i]` for the coordinates of a vector);
    /// variables without a column are hidden, and summed or integrated out like missing cells.
    ///
    /// # Errors
    /// A column of the wrong kind, an unseen category, a row of probability zero: each names column and row.
    pub fn log_likelihood(&self, data: &Table) -> Result<Vec<f64>, ModelError> {
        let rows = self.table_rows(data)?;
        let log = |(i, row): (usize, Known)| {
            let question = self.question(row, Asked::Evidence)?;
            let tree = self.tree(&question, Mode::Sum);
            tree.map(|t| t.total).map_err(|e| e.in_row(i))
        };
        rows.into_par_iter().enumerate().map(log).collect()
    }

    /// Every row as evidence, in the columns' own units.
    pub(super) fn table_rows(&self, data: &Table) -> Result<Vec<Known>, ModelError> {
        if data.rows() == 0 {
            return Err(ModelError::Empty { what: "rows" });
        }
        let empty = Known {
            discrete: vec![None; self.nodes.len()],
            soft: Vec::new(),
            real: vec![f64::NAN; self.width],
        };
        let mut rows = vec![empty; data.rows()];
        for (n, node) in self.nodes.iter().enumerate() {
            if node.is_discrete() {
                let Ok(column) = data.column(&node.name) else {
                    continue;
                };
                for (i, row) in rows.iter_mut().enumerate() {
                    row.discrete[n] = match (column.cell(i), column.categories()) {
                        (Cell::Code(c), Some(names)) => {
                            let found = node.categories.iter().position(|k| *k == names[c]);
                            Some(found.ok_or_else(|| ModelError::UnseenCategory {
                                column: node.name.clone(),
                                row: i,
                                category: names[c].clone(),
                            })?)
                        }
                        (Cell::Missing, Some(_)) => None,
                        _ => return Err(kind(&node.name, "real", "categorical")),
                    };
                }
            }
            for (i, c) in node.coordinates.clone().enumerate() {
                let name = self.column_name(n, i);
                let Ok(column) = data.column(&name) else {
                    continue;
                };
                if column.categories().is_some() {
                    return Err(kind(&name, "categorical", "real"));
                }
                for (r, row) in rows.iter_mut().enumerate() {
                    if let Cell::Real(v) = column.cell(r) {
                        row.real[c] = v;
                    }
                }
            }
        }
        Ok(rows)
    }
}

fn kind(column: &str, got: &'static str, expected: &'static str) -> ModelError {
    ModelError::Kind {
        column: column.to_owned(),
        got,
        expected,
    }
}
