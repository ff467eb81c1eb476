//! Relations applied to tables: determined columns taken away, and computed again.

use std::collections::BTreeMap;

use super::{Form, Relation};
use crate::tables::Dataset;
use crate::tables::encoding::copied;
use crate::{Cell, Column, ModelError, Table};

/// Codes of a column by row, with the names of its categories.
type Coded = (Vec<String>, Vec<Option<usize>>);

/// The relations of a table: determined columns do not determine others.
#[derive(Debug, Clone, Copy)]
pub struct Relations<'a>(pub(super) &'a [Relation]);

impl<'a> Relations<'a> {
    /// Relations as a file states them, checked.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] for a column determined twice or by itself, a determined column that determines another, a coefficient that is
    /// zero or not finite, a factor that is not positive.
    pub fn new(list: &'a [Relation]) -> Result<Self, ModelError> {
        let determined: Vec<&String> = list.iter().map(|r| &r.column).collect();
        for (at, relation) in list.iter().enumerate() {
            let fails = |problem: &str| {
                let place = format!("relation of `{}`", relation.column);
                Err(ModelError::corrupt(place, problem))
            };
            if determined[..at].contains(&&relation.column) {
                return fails("the column is determined twice");
            }
            let numbers = relation.terms().iter().map(|(_, a)| *a);
            let number = match &relation.form {
                Form::Copy { .. } => 0.0,
                Form::Sum { constant, .. } => *constant,
                Form::Product { factor, .. } if *factor <= 0.0 => f64::NAN,
                Form::Product { factor, .. } => *factor,
            };
            if !number.is_finite() || numbers.clone().any(|a| a == 0.0 || !a.is_finite()) {
                return fails("a number is out of range");
            }
            let copied = match &relation.form {
                Form::Copy { of } => Some(of),
                _ if relation.terms().is_empty() => return fails("there are no terms"),
                _ => None,
            };
            let names: Vec<&String> = (relation.terms().iter().map(|(name, _)| name))
                .chain(copied)
                .collect();
            if names.iter().any(|name| determined.contains(name)) {
                return fails("a column that is determined determines another");
            }
            if (1..names.len()).any(|i| names[..i].contains(&names[i])) {
                return fails("a column is named twice");
            }
        }
        Ok(Self(list))
    }

    /// The table without determined columns; missing cells that a relation determines are filled before.
    ///
    /// # Errors
    /// [`ModelError::Contradiction`] for a row that breaks a relation.
    pub fn reduce(self, table: &Table) -> Result<Table, ModelError> {
        if self.0.is_empty() {
            return Ok(table.clone());
        }
        let mut numbers = self.numbers(table);
        self.fill(&mut numbers, table.rows());
        self.check(&numbers, table.rows())?;
        let mut copies = self.copies(table)?;
        let mut out = Table::new();
        for column in table.columns() {
            let name = column.name();
            if self.determines(name) {
                continue;
            }
            out = match (numbers.remove(name), copies.remove(name)) {
                (Some(cells), _) => out.real(name, cells)?,
                (_, Some((names, codes))) => coded(out, name, &names, codes)?,
                _ => copied(out, column, table.rows())?,
            };
        }
        // Columns that the table lacks.
        for (name, cells) in numbers {
            // A table without columns has no rows.
            let needed = out.columns().is_empty() || cells.iter().any(Option::is_some);
            if needed && !self.determines(&name) {
                out = out.real(&name, cells)?;
            }
        }
        for (name, (names, codes)) in copies {
            out = coded(out, &name, &names, codes)?;
        }
        Ok(out)
    }

    /// The rows without determined columns.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn reduce_dataset(self, data: &Dataset) -> Result<Dataset, ModelError> {
        let mut groups = data.groups.clone();
        for group in &mut groups {
            group.columns.retain(|name| !self.determines(name));
        }
        groups.retain(|group| !group.columns.is_empty());
        Ok(Dataset {
            table: self.reduce(&data.table)?,
            groups,
        })
    }

    /// Complete rows with their determined columns, at the end.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] for a copied column that the table lacks, [`ModelError::NotFinite`] for a number that overflows.
    pub fn restore(self, table: Table) -> Result<Table, ModelError> {
        let mut out = table;
        for relation in self.0 {
            let rows = out.rows();
            out = match &relation.form {
                Form::Copy { of } => {
                    let column = out.column(of)?;
                    let names = column.categories().unwrap_or_default().to_vec();
                    let codes = (0..rows).map(|row| code(column, row)).collect();
                    coded(out, &relation.column, &names, codes)?
                }
                _ => {
                    let mut columns = BTreeMap::new();
                    for (name, _) in relation.terms() {
                        columns.insert(name.as_str(), out.column(name)?);
                    }
                    let cells =
                        (0..rows).map(|row| relation.value(|name| number(columns.get(name)?, row)));
                    let cells: Vec<Option<f64>> = cells.collect();
                    out.real(&relation.column, cells)?
                }
            };
        }
        Ok(out)
    }

    /// True if `column` is determined by others.
    pub fn determines(self, column: &str) -> bool {
        self.0.iter().any(|r| r.column == column)
    }

    /// The cells of all columns of numbers that relations name.
    fn numbers(self, table: &Table) -> BTreeMap<String, Vec<Option<f64>>> {
        let sums = self.0.iter().filter(|r| !r.terms().is_empty());
        let names = sums.flat_map(|r| r.terms().iter().map(|(name, _)| name).chain([&r.column]));
        let cells = |name: &String| match table.column(name) {
            Ok(column) => (0..table.rows()).map(|row| number(column, row)).collect(),
            Err(_) => vec![None; table.rows()],
        };
        names.map(|name| (name.clone(), cells(name))).collect()
    }

    /// Fills the terms that a relation and its other terms determine.
    fn fill(self, numbers: &mut BTreeMap<String, Vec<Option<f64>>>, rows: usize) {
        // One pass may make another term the only missing one.
        let mut changed = true;
        while std::mem::take(&mut changed) {
            for relation in self.0 {
                for row in 0..rows {
                    let Some(y) = numbers.get(&relation.column).and_then(|c| c[row]) else {
                        continue;
                    };
                    let x = |name: &str| numbers.get(name).and_then(|c| c[row]);
                    let terms = relation.terms().iter().enumerate();
                    let mut missing = terms.filter(|(_, (name, _))| x(name).is_none());
                    let (Some((at, (name, _))), None) = (missing.next(), missing.next()) else {
                        continue;
                    };
                    let found = relation.solved(at, y, x).filter(|x| x.is_finite());
                    if let (Some(found), Some(cells)) = (found, numbers.get_mut(name)) {
                        cells[row] = Some(found);
                        changed = true;
                    }
                }
            }
        }
    }

    fn check(
        self,
        numbers: &BTreeMap<String, Vec<Option<f64>>>,
        rows: usize,
    ) -> Result<(), ModelError> {
        for relation in self.0 {
            let Some(known) = numbers.get(&relation.column) else {
                continue;
            };
            for row in 0..rows {
                let x = |name: &str| numbers.get(name).and_then(|c| c[row]);
                if known[row].is_some_and(|y| !relation.holds(y, x)) {
                    return Err(broken(relation, row));
                }
            }
        }
        Ok(())
    }

    /// The cells of all columns that others copy, with what the copies know: categories and codes.
    fn copies(self, table: &Table) -> Result<BTreeMap<String, Coded>, ModelError> {
        let mut all = BTreeMap::new();
        for relation in self.0 {
            let Form::Copy { of } = &relation.form else {
                continue;
            };
            let Ok(copy) = table.column(&relation.column) else {
                continue;
            };
            let own = match table.column(of) {
                Ok(column) => (
                    column.categories().unwrap_or_default().to_vec(),
                    (0..table.rows()).map(|row| code(column, row)).collect(),
                ),
                Err(_) => (Vec::new(), vec![None; table.rows()]),
            };
            let (names, codes) = all.entry(of.clone()).or_insert(own);
            let categories = copy.categories().unwrap_or_default();
            for (row, own) in codes.iter_mut().enumerate() {
                let Some(name) = code(copy, row).and_then(|code| categories.get(code)) else {
                    continue;
                };
                match *own {
                    Some(code) if names[code] != *name => return Err(broken(relation, row)),
                    Some(_) => {}
                    None => {
                        let known = names.iter().position(|n| n == name);
                        *own = Some(known.unwrap_or_else(|| {
                            names.push(name.clone());
                            names.len() - 1
                        }));
                    }
                }
            }
        }
        Ok(all)
    }
}

fn broken(relation: &Relation, row: usize) -> ModelError {
    ModelError::Contradiction {
        row: Some(row),
        variable: relation.said(),
    }
}

pub(super) fn number(column: &Column, row: usize) -> Option<f64> {
    match column.cell(row) {
        Cell::Real(value) => Some(value),
        _ => None,
    }
}

pub(super) fn code(column: &Column, row: usize) -> Option<usize> {
    match column.cell(row) {
        Cell::Code(code) => Some(code),
        _ => None,
    }
}

fn coded(
    table: Table,
    name: &str,
    names: &[String],
    codes: Vec<Option<usize>>,
) -> Result<Table, ModelError> {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    table.codes(name, &names, codes)
}
