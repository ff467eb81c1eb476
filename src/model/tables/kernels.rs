//! A kernel density over mixed columns: the peer without parameters.
//!
//! `p(x) = 1/n Σ_i Π_c k_c(x_c, x_ic)` over the rows learned from: of a real column a Gaussian of deviation h times the column's, of a category of r
//! values `1 - λ` where equal and `λ / (r - 1)` elsewhere (Aitchison and Aitken 1976). One h and one λ serve all columns, those of the highest
//! likelihood of left-out fifths of the rows among [`BANDWIDTHS`] and [`SHARES`]. A cell that is missing on either side is left out of the product: a
//! row with a missing cell says nothing of it.
//!
//! Time: O(rows learned from x rows judged x columns), and for the choice as much for each pair of values tried.

use rayon::prelude::*;

use crate::linalg::{LN_2PI, log_sum_exp};
use crate::standardize::{Constant, moments};
use crate::{Cell, ModelError, Table};

/// Deviations of kernels tried, in deviations of the columns.
pub const BANDWIDTHS: [f64; 10] = [0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3, 0.45, 0.7, 1.0];
/// Shares of other categories tried.
pub const SHARES: [f64; 4] = [0.003, 0.03, 0.1, 0.3];
/// Parts of the rows that are left out in turn.
const FOLDS: usize = 5;

/// A kernel density, learned.
#[derive(Debug, Clone)]
pub struct Kernels {
    columns: Vec<Column>,
    /// Standardised values and codes, row by row; NaN where missing.
    rows: Vec<f64>,
    bandwidth: f64,
    share: f64,
}

#[derive(Debug, Clone)]
struct Column {
    name: String,
    categories: Option<usize>,
    mean: f64,
    scale: f64,
}

impl Kernels {
    /// Keeps the rows and chooses the width.
    ///
    /// # Errors
    /// [`ModelError::Empty`] for fewer than ten rows; [`ModelError::AllMissing`] for a column without any value.
    pub fn learn(train: &Table) -> Result<Self, ModelError> {
        if train.rows() < 2 * FOLDS {
            return Err(ModelError::Empty { what: "rows" });
        }
        let mut columns = Vec::new();
        for column in train.columns() {
            let values = (0..train.rows()).map(|row| value(column.cell(row)));
            let values: Vec<f64> = values.filter(|v| !v.is_nan()).collect();
            if values.is_empty() {
                let column = column.name().to_owned();
                return Err(ModelError::AllMissing { column });
            }
            let (mean, scale) = moments(column.name(), &values, Constant::Keep)?;
            let categories = column.categories().map(<[String]>::len);
            columns.push(Column {
                name: column.name().to_owned(),
                mean: if categories.is_some() { 0.0 } else { mean },
                scale: if categories.is_some() { 1.0 } else { scale },
                categories,
            });
        }
        let mut found = Self {
            rows: encode(&columns, train)?,
            columns,
            bandwidth: 0.0,
            share: 0.0,
        };
        let mut best = f64::NEG_INFINITY;
        let mixed = found.columns.iter().any(|c| c.categories.is_some());
        let real = found.columns.iter().any(|c| c.categories.is_none());
        for &bandwidth in if real {
            &BANDWIDTHS[..]
        } else {
            &BANDWIDTHS[..1]
        } {
            for &share in if mixed { &SHARES[..] } else { &SHARES[..1] } {
                let own = Self {
                    bandwidth,
                    share,
                    ..found.clone()
                };
                let log = own.left_out();
                if log > best {
                    best = log;
                    (found.bandwidth, found.share) = (bandwidth, share);
                }
            }
        }
        Ok(found)
    }

    /// Chosen deviation of the kernels, in deviations of the columns.
    pub fn bandwidth(&self) -> f64 {
        self.bandwidth
    }

    /// `log p(row)` of what each row has, nats, in the columns' own units.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] for a column that `data` lacks.
    pub fn log_likelihood(&self, data: &Table) -> Result<Vec<f64>, ModelError> {
        let d = self.columns.len().max(1);
        let rows = encode(&self.columns, data)?;
        let one = |row: &[f64]| {
            let seen = self.columns.iter().zip(row).filter(|(_, v)| !v.is_nan());
            let units: f64 = seen.map(|(c, _)| c.scale.ln()).sum();
            self.log_density(row, |_| true) - units
        };
        Ok(rows.par_chunks(d).map(one).collect())
    }

    /// Mean log density of each row under those of the other parts.
    fn left_out(&self) -> f64 {
        let d = self.columns.len().max(1);
        let logs: Vec<f64> = self
            .rows
            .par_chunks(d)
            .enumerate()
            .map(|(i, row)| self.log_density(row, |j| j % FOLDS != i % FOLDS))
            .collect();
        logs.iter().sum::<f64>() / logs.len() as f64
    }

    fn log_density(&self, row: &[f64], used: impl Fn(usize) -> bool) -> f64 {
        let d = self.columns.len().max(1);
        let own = self.rows.chunks(d).enumerate().filter(|(j, _)| used(*j));
        let logs: Vec<f64> = own.map(|(_, other)| self.kernel(row, other)).collect();
        log_sum_exp(&logs) - (logs.len() as f64).ln()
    }

    fn kernel(&self, a: &[f64], b: &[f64]) -> f64 {
        let constant = -0.5 * LN_2PI - self.bandwidth.ln();
        let pairs = self.columns.iter().zip(a.iter().zip(b));
        let one = |(column, (a, b)): (&Column, (&f64, &f64))| match column.categories {
            _ if a.is_nan() => 0.0,
            // A row that lacks the cell stands for the whole column, as its mean and deviation do.
            None if b.is_nan() => -0.5 * (LN_2PI + a * a),
            None => constant - 0.5 * ((a - b) / self.bandwidth).powi(2),
            Some(r) if b.is_nan() => -(r.max(1) as f64).ln(),
            Some(1) => 0.0,
            Some(_) if a == b => (-self.share).ln_1p(),
            Some(r) => (self.share / (r as f64 - 1.0)).ln(),
        };
        pairs.map(one).sum()
    }
}

fn value(cell: Cell) -> f64 {
    match cell {
        Cell::Real(v) => v,
        Cell::Code(c) => c as f64,
        Cell::Missing => f64::NAN,
    }
}

fn encode(columns: &[Column], data: &Table) -> Result<Vec<f64>, ModelError> {
    let found: Result<Vec<_>, ModelError> = columns.iter().map(|c| data.column(&c.name)).collect();
    let found = found?;
    let mut out = Vec::with_capacity(columns.len() * data.rows());
    for row in 0..data.rows() {
        for (column, own) in found.iter().zip(columns) {
            out.push((value(column.cell(row)) - own.mean) / own.scale);
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_has_mass_one_and_follows_the_data() {
        let x = (0..60).map(|i| Some(f64::from(i % 10) / 3.0));
        let table = Table::new().real("x", x).unwrap();
        let kernels = Kernels::learn(&table).unwrap();
        let grid: Vec<f64> = (0..4000).map(|i| -4.0 + f64::from(i) * 0.003).collect();
        let at = Table::new()
            .real("x", grid.iter().map(|x| Some(*x)))
            .unwrap();
        let mass: f64 = kernels
            .log_likelihood(&at)
            .unwrap()
            .iter()
            .map(|l| l.exp() * 0.003)
            .sum();
        assert!((mass - 1.0).abs() < 1e-3, "{mass}");
    }

    #[test]
    fn units_do_not_matter() {
        let x: Vec<f64> = (0..40).map(|i| (f64::from(i) * 0.618).fract()).collect();
        let table = |unit: f64| {
            Table::new()
                .real("x", x.iter().map(|x| Some(x * unit)))
                .unwrap()
        };
        let logs = |unit: f64| {
            Kernels::learn(&table(unit))
                .unwrap()
                .log_likelihood(&table(unit))
                .unwrap()
        };
        for (a, b) in logs(1.0).iter().zip(logs(1000.0)) {
            assert!((a - b - 1000_f64.ln()).abs() < 1e-9);
        }
    }
}
