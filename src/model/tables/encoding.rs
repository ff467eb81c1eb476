//! Real columns as a model can carry them: values that many rows share as categories, all others under a monotone
//! transform.
//!
//! A value a of at least [`ATOM`] of a column's known cells that its neighbours do not explain (no second floor, the standard
//! slope of a roof) is an *atom*: no density describes it. The column becomes two: a category (each atom, or `other`) and a real column that is missing at
//! atoms. The row's likelihood is then a probability at an atom and a density elsewhere,
//!
//! ```text
//! p(x) = P(atom a)                        where x = a
//! p(x) = P(other) p(z(x) | other) dz/dx   elsewhere
//! ```
//! so that models are to be compared by the mass of a small interval where atoms are. The transform z is
//! [`super::transform`]'s, chosen for each column by its training values alone.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Dataset;
use super::marginal::choose;
use super::transform::{Bounds, Tails, Transform};
use crate::conjugate::LinearPrior;
use crate::hierarchy::Group;
use crate::{Cell, Column, ModelError, Table};

/// Share of a column's known cells from which a value is an atom.
pub const ATOM: f64 = 0.05;
/// Rows that an atom has at least.
const LEAST_ROWS: f64 = 5.0;
/// Values on either side that say how frequent a value would be by its neighbours.
const NEIGHBOURS: usize = 5;
/// The category of cells that are at no atom.
const OTHER: &str = "other";

/// The form in which a real column enters a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Encoded {
    /// The column.
    pub column: String,
    /// Its atoms, ascending.
    pub atoms: Vec<f64>,
    /// Name of the column of its atoms.
    pub category: String,
    /// The transform of all other values.
    pub transform: Transform,
}

/// The form in which the real columns of a table enter a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Encoding {
    columns: Vec<Encoded>,
}

impl Encoding {
    /// Atoms and transforms of the real columns of `data`.
    ///
    /// Time is that of fitting small mixtures to at most 400 values of each column, some fifteen times.
    ///
    /// # Errors
    /// Those of the mixtures that choose a transform.
    ///
    /// # Examples
    /// ```
    /// use edifice_model::{Table, hierarchy::{Group, Priors}};
    /// use edifice_model::tables::{Dataset, encoding::Encoding};
    /// let area = (0..40).map(|i| Some(if i % 2 == 0 { 0.0 } else { 20.0 + i as f64 }));
    /// let table = Table::new().real("garage", area)?;
    /// let data = Dataset { table, groups: vec![Group::new("garage", &["garage"])] };
    /// let encoding = Encoding::learn(&data, &Priors::default().linear, 1)?;
    /// assert_eq!(encoding.columns()[0].atoms, [0.0]);
    /// # Ok::<(), edifice_model::ModelError>(())
    /// ```
    pub fn learn(data: &Dataset, prior: &LinearPrior, seed: u64) -> Result<Self, ModelError> {
        Ok(Self::learn_while(data, prior, seed, &|| true)?.0)
    }

    /// As [`Encoding::learn`], as long as `goes_on`, which is asked before each column: the number of columns that come later is
    /// returned besides; they have their atoms, and no transform.
    ///
    /// # Errors
    /// As [`Encoding::learn`].
    pub fn learn_while(
        data: &Dataset,
        prior: &LinearPrior,
        seed: u64,
        goes_on: &(dyn Fn() -> bool + Sync),
    ) -> Result<(Self, usize), ModelError> {
        let left = AtomicUsize::new(0);
        let table = &data.table;
        let reals: Vec<&Column> = (table.columns().iter())
            .filter(|c| c.categories().is_none())
            .collect();
        let columns = reals.into_par_iter().map(|column| {
            let values: Vec<f64> = (0..table.rows()).filter_map(|r| real(column, r)).collect();
            let atoms = atoms(&values);
            let others: Vec<f64> = values.into_iter().filter(|v| !atoms.contains(v)).collect();
            let transform = match others.is_empty() {
                true => Transform::IDENTITY,
                false if goes_on() => choose(&others, prior, seed)?,
                false => {
                    left.fetch_add(1, Ordering::Relaxed);
                    Transform::IDENTITY
                }
            };
            let mut category = format!("{} value", column.name());
            while table.column(&category).is_ok() {
                category.push('\'');
            }
            Ok(Encoded {
                column: column.name().to_owned(),
                atoms,
                category,
                transform,
            })
        });
        let columns = columns.collect::<Result<Vec<Encoded>, ModelError>>()?;
        Ok((Self { columns }, left.into_inner()))
    }

    /// The columns, in the order of the table that was learned from.
    pub fn columns(&self) -> &[Encoded] {
        &self.columns
    }

    fn of(&self, column: &str) -> Option<&Encoded> {
        self.columns.iter().find(|c| c.column == column)
    }

    /// The attributes of encoded tables: a column of atoms stands after the attribute of its column.
    pub fn groups(&self, groups: &[Group]) -> Vec<Group> {
        let mut all = Vec::new();
        for group in groups {
            all.push(group.clone());
            let encoded = group.columns.iter().filter_map(|name| self.of(name));
            let with_atoms = encoded.filter(|e| !e.atoms.is_empty());
            all.extend(with_atoms.map(|e| Group::new(&e.category, &[&e.category])));
        }
        all
    }

    /// The table as models read it.
    ///
    /// # Errors
    /// [`ModelError::Kind`] for a categorical column where a real one was learned, [`ModelError::NotFinite`] for a value that
    /// is too large to be transformed.
    pub fn encode(&self, table: &Table) -> Result<Table, ModelError> {
        let rows = 0..table.rows();
        let mut out = Table::new();
        for column in table.columns() {
            let Some(encoded) = self.of(column.name()) else {
                out = copied(out, column, table.rows())?;
                continue;
            };
            if column.categories().is_some() {
                return Err(ModelError::Kind {
                    column: encoded.column.clone(),
                    got: "categorical",
                    expected: "real",
                });
            }
            let cells: Vec<Option<f64>> = rows.clone().map(|row| real(column, row)).collect();
            let others = cells.iter().map(|cell| {
                let value = cell.filter(|v| !encoded.atoms.contains(v))?;
                Some(encoded.transform.forward(value).0)
            });
            out = out.real(&encoded.column, others)?;
            if !encoded.atoms.is_empty() {
                let names = encoded.names();
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                let codes = cells.iter().map(|cell| cell.map(|v| encoded.code(v)));
                out = out.codes(&encoded.category, &names, codes)?;
            }
        }
        Ok(out)
    }

    /// `Σ log dz/dx` over the cells of each row that are known and at no atom: what a log density of an encoded row lacks.
    pub fn log_slopes(&self, table: &Table) -> Vec<f64> {
        let mut out = vec![0.0; table.rows()];
        for column in table.columns() {
            let Some(encoded) = self.of(column.name()) else {
                continue;
            };
            for (row, sum) in out.iter_mut().enumerate() {
                let value = real(column, row).filter(|v| !encoded.atoms.contains(v));
                *sum += value.map_or(0.0, |v| encoded.transform.forward(v).1);
            }
        }
        out
    }

    /// Complete encoded rows in the table's own columns.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] for a column that `encoded` lacks, [`ModelError::NotFinite`].
    pub fn decode(&self, encoded: &Table) -> Result<Table, ModelError> {
        let mut out = Table::new();
        let companions: Vec<&str> = self.columns.iter().map(|c| &c.category[..]).collect();
        for column in encoded.columns() {
            let Some(own) = self.of(column.name()) else {
                if !companions.contains(&column.name()) {
                    out = copied(out, column, encoded.rows())?;
                }
                continue;
            };
            let category = match own.atoms.is_empty() {
                true => None,
                false => Some(encoded.column(&own.category)?),
            };
            let cells = (0..encoded.rows()).map(|row| {
                let code = category.map(|c| c.cell(row));
                match code {
                    Some(Cell::Code(code)) if code > 0 => own.atoms.get(code - 1).copied(),
                    _ => real(column, row).map(|z| own.transform.inverse(z)),
                }
            });
            out = out.real(&own.column, cells.collect::<Vec<_>>())?;
        }
        Ok(out)
    }

    /// Checks what was read from a file.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`].
    pub(super) fn check(&self) -> Result<(), ModelError> {
        for c in &self.columns {
            let rising = c.atoms.is_sorted_by(|a, b| a < b);
            if !(c.transform.valid() && rising && c.atoms.iter().all(|a| a.is_finite())) {
                let place = format!("encoding of `{}`", c.column);
                return Err(ModelError::corrupt(place, "a parameter is out of range"));
            }
        }
        Ok(())
    }
}

impl Encoded {
    /// Its atoms and its transform in words; `None` where the column enters as it is.
    pub fn said(&self) -> Option<String> {
        let mut parts = Vec::new();
        if !self.atoms.is_empty() {
            let atoms: Vec<String> = self.atoms.iter().map(f64::to_string).collect();
            parts.push(format!("{} as `{}`", atoms.join(", "), self.category));
        }
        match self.transform.bounds {
            Bounds::None => {}
            Bounds::Positive { offset } => {
                parts.push(format!("log(1 + x / {})", rounded(offset)));
            }
            Bounds::Share { offset } => {
                parts.push(format!("log((x + {offset}) / (1 - x + {offset}))"));
            }
        }
        if let Some(Tails { centre, scale }) = self.transform.tails {
            let [centre, scale] = [centre, scale].map(rounded);
            parts.push(format!("tails from {centre} +- {scale}"));
        }
        (!parts.is_empty()).then(|| format!("{}: {}", self.column, parts.join("; ")))
    }

    /// The categories: `other`, then the atoms.
    fn names(&self) -> Vec<String> {
        let atoms = self.atoms.iter().map(f64::to_string);
        std::iter::once(OTHER.to_owned()).chain(atoms).collect()
    }

    fn code(&self, value: f64) -> usize {
        let atom = self.atoms.iter().position(|a| *a == value);
        atom.map_or(0, |i| i + 1)
    }
}

/// A number of any size, with four places behind the point or, where it is small or large, behind the first digit.
fn rounded(x: f64) -> String {
    match x == 0.0 || (1e-2..1e7).contains(&x.abs()) {
        true => format!("{x:.4}"),
        false => format!("{x:.4e}"),
    }
}

fn real(column: &Column, row: usize) -> Option<f64> {
    match column.cell(row) {
        Cell::Real(value) => Some(value),
        _ => None,
    }
}

/// Adds a column as it is.
pub(super) fn copied(table: Table, column: &Column, rows: usize) -> Result<Table, ModelError> {
    let cells = (0..rows).map(|row| column.cell(row));
    match column.categories() {
        None => table.real(
            column.name(),
            cells.map(|cell| match cell {
                Cell::Real(value) => Some(value),
                _ => None,
            }),
        ),
        Some(names) => {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let codes = cells.map(|cell| match cell {
                Cell::Code(code) => Some(code),
                _ => None,
            });
            table.codes(column.name(), &names, codes)
        }
    }
}

/// The atoms among the values of a column, ascending. Some values are always left to the real column.
fn atoms(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut counted: Vec<(f64, f64)> = Vec::new();
    for &value in &sorted {
        match counted.last_mut() {
            Some((last, count)) if *last == value => *count += 1.0,
            _ => counted.push((value, 1.0)),
        }
    }
    let n = values.len() as f64;
    let frequent = |count: f64| count >= (ATOM * n).max(LEAST_ROWS);
    let mut atoms: Vec<(f64, f64)> = (0..counted.len())
        .filter(|&at| frequent(counted[at].1) && stands_out(&counted, at, n))
        .map(|at| counted[at])
        .collect();
    if atoms.len() == counted.len() {
        // The rarest stays a number, so that there is a density to give to a value not seen before.
        atoms.sort_by(|a, b| b.1.total_cmp(&a.1));
        atoms.pop();
    }
    let mut atoms: Vec<f64> = atoms.into_iter().map(|(value, _)| value).collect();
    atoms.sort_by(f64::total_cmp);
    atoms
}

/// True if value `at` (of ascending values with their counts, n in all) is more frequent than the values around it
/// explain, by the score: with e expected from the density of its neighbours, a Poisson count of c gains
/// `c log(c / e) - (c - e)` nats, to be more than log n. Values that are equal only since they were rounded do not stand out.
fn stands_out(counted: &[(f64, f64)], at: usize, n: f64) -> bool {
    let mut gaps: Vec<f64> = counted.windows(2).map(|w| w[1].0 - w[0].0).collect();
    gaps.sort_by(f64::total_cmp);
    let Some(&usual) = gaps.get(gaps.len() / 2) else {
        return true;
    };
    let (first, last) = (
        at.saturating_sub(NEIGHBOURS),
        (at + NEIGHBOURS).min(counted.len() - 1),
    );
    let count = counted[at].1;
    let around = counted[first..=last].iter().map(|(_, count)| count);
    let others = around.sum::<f64>() - count;
    let expected = others / (counted[last].0 - counted[first].0) * usual;
    count > expected && count * (count / expected).ln() - (count - expected) > n.ln()
}
