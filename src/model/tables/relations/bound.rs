//! Completion of rows in which a determined column is known, and several of its terms are not.
//!
//! With y known and the terms of a set m missing, one term p of m is what the relation and the others make it. Candidates of the others are
//! drawn from the model without the relation, and one is chosen with weight
//!
//! ```text
//! w = p(x_p | all other columns) |dx_p / dy|
//! ```
//! (sampling-importance-resampling, Rubin 1987): as the candidates grow, draws of the model given the known cells, y among them. Each draw keeps the
//! relation exactly, whatever their number.
//!
//! # Deviations and readings
//! - Values that many rows share have a density of their own only in the candidates: a solved term does not fall on one.

use super::apply::{Relations, number};
use super::{Form, Relation};
use crate::{ModelError, Table};

/// A relation whose determined column is known, while several of its terms are missing.
#[derive(Debug)]
pub struct Bound<'a> {
    relation: &'a Relation,
    /// The term that is solved for.
    pivot: usize,
    /// The known number.
    known: f64,
}

impl<'a> Relations<'a> {
    /// The relations of `row` of `given` that bind several missing terms; `reduced` is the same row, reduced.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] where two of them share all their missing terms.
    pub fn bound(
        self,
        given: &Table,
        reduced: &Table,
        row: usize,
    ) -> Result<Vec<Bound<'a>>, ModelError> {
        let known = |table: &Table, name: &str| {
            let column = table.column(name).ok()?;
            number(column, row)
        };
        let mut open = Vec::new();
        for relation in self.0 {
            let Some(y) = known(given, &relation.column) else {
                continue;
            };
            let terms = relation.terms().iter().enumerate();
            let missing = terms.filter(|(_, (name, _))| known(reduced, name).is_none());
            let missing: Vec<usize> = missing.map(|(at, _)| at).collect();
            if !missing.is_empty() {
                open.push((relation, y, missing));
            }
        }
        let mut bound = Vec::new();
        for (at, (relation, known, missing)) in open.iter().enumerate() {
            let shared = |term: &usize| {
                let name = &relation.terms()[*term].0;
                let others = open.iter().enumerate().filter(|(other, _)| *other != at);
                let mut names = others.flat_map(|(_, (other, ..))| other.terms());
                names.any(|(other, _)| other == name)
            };
            let Some(&pivot) = missing.iter().rev().find(|term| !shared(term)) else {
                let problem = format!(
                    "cannot be completed from this alone ({}): give one of its terms",
                    relation.said()
                );
                return Err(ModelError::parameter(&relation.column, problem));
            };
            bound.push(Bound {
                relation,
                pivot,
                known: *known,
            });
        }
        Ok(bound)
    }
}

impl Bound<'_> {
    /// Name of the column that is solved for.
    pub fn pivot(&self) -> &str {
        &self.relation.terms()[self.pivot].0
    }

    /// The solved number of each candidate, with the logarithm of `|dx_p / dy|` up to a constant; `None` where there is none.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] for a term that the candidates lack.
    pub fn solved(&self, candidates: &Table) -> Result<Vec<Option<(f64, f64)>>, ModelError> {
        let mut columns = Vec::new();
        for (name, _) in self.relation.terms() {
            columns.push((name, candidates.column(name)?));
        }
        let rows = (0..candidates.rows()).map(|row| {
            let x = |name: &str| {
                let (_, column) = columns.iter().find(|(other, _)| *other == name)?;
                number(column, row)
            };
            let found = self.relation.solved(self.pivot, self.known, x)?;
            let slope = match &self.relation.form {
                Form::Product { .. } => found.ln(),
                _ => 0.0,
            };
            found.is_finite().then_some((found, slope))
        });
        Ok(rows.collect())
    }
}
