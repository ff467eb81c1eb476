//! A Gaussian mixture over the concatenated columns of a table, its number of components chosen by MDL: the baseline
//! of Fan and Wonka 2016, Sec. 7.
//!
//! Real columns are standardised by the training rows. A category (or yes/no) code c becomes
//! `c + u`, u uniform on (-1/2, 1/2), and its probability is the mass of that unit interval,
//! estimated over [`DRAWS`] draws of u: so that a density over all columns can be set beside the
//! other models, whose discrete columns have probabilities. Every component has the same
//! normal-inverse-Wishart prior as the Gaussians of the hierarchical model.

use rand::{Rng, RngExt};

use crate::conjugate::LinearPrior;
use crate::gmm::{Criterion, Mixture, Points, Prior, Settings, select};
use crate::linalg::LN_2PI;
use crate::standardize::{Constant, moments};
use crate::{Cell, ModelError, Table};
use edifice_base::rng::stream;

/// Deviation of the background, in deviations of the columns.
const WIDTH: f64 = 3.0;

/// Draws of u per row.
pub const DRAWS: usize = 200;

/// A learned mixture over the columns of a table.
#[derive(Debug, Clone)]
pub struct Baseline {
    columns: Vec<Column>,
    mixture: Mixture,
}

#[derive(Debug, Clone)]
struct Column {
    name: String,
    /// Number of categories; `None` for a real column.
    categories: Option<usize>,
    mean: f64,
    scale: f64,
}

impl Baseline {
    /// Fits mixtures of 1 to `most` components and keeps the one of least description length; missing values are
    /// integrated out.
    ///
    /// # Errors
    /// [`ModelError::AllMissing`] for a column without any value; as [`select`].
    pub fn learn(
        train: &Table,
        prior: &LinearPrior,
        most: usize,
        seed: u64,
    ) -> Result<Self, ModelError> {
        let mut columns = Vec::new();
        for column in train.columns() {
            let categories = column.categories().map(<[String]>::len);
            let values = (0..train.rows()).map(|row| value(column.cell(row)));
            let values: Vec<f64> = values.filter(|v| !v.is_nan()).collect();
            if values.is_empty() {
                let column = column.name().to_owned();
                return Err(ModelError::AllMissing { column });
            }
            // A category code keeps its own scale, a constant column unit scale, as in the
            // hierarchical model.
            let (mean, scale) = moments(column.name(), &values, Constant::Keep)?;
            columns.push(Column {
                name: column.name().to_owned(),
                categories,
                mean,
                scale: if categories.is_some() { 1.0 } else { scale },
            });
        }
        let mut rng = stream(seed, "building_exteriors/dequantize", 0);
        let mut values = encode(&columns, train)?;
        for row in values.chunks_mut(columns.len()) {
            jitter(&columns, row, &mut rng);
        }
        let points = Points::with_missing(columns.len(), &values)?;
        let settings = Settings {
            prior: Prior::of_linear(prior, columns.len()),
            ..Settings::default()
        };
        let selected = select(&points, most, Criterion::Mdl, &settings, seed)?;
        Ok(Self {
            columns,
            mixture: selected.fitted.mixture,
        })
    }

    /// Number of components.
    pub fn components(&self) -> usize {
        self.mixture.components()
    }

    /// Mean of component `k` in the columns' own units.
    pub fn mean(&self, k: usize) -> Vec<f64> {
        self.decode(self.mixture.mean(k))
    }

    /// `log p(row)` of what every row has, nats, in the columns' own units, of which the share `background` is a wide one:
    /// `(1 - ε) p(row) + ε Π N(x; 0, 9) Π 1 / categories`, on standardised columns.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] for a column that `data` lacks.
    pub fn log_likelihood(
        &self,
        data: &Table,
        background: f64,
        seed: u64,
    ) -> Result<Vec<f64>, ModelError> {
        let d = self.columns.len();
        let values = encode(&self.columns, data)?;
        let mut rng = stream(seed, "building_exteriors/dequantize", 1);
        let mut out = Vec::with_capacity(data.rows());
        for row in values.chunks(d) {
            let seen = self.columns.iter().zip(row).filter(|(_, v)| !v.is_nan());
            let units: f64 = seen.map(|(c, _)| c.scale.ln()).sum();
            let mut draws = Vec::with_capacity(DRAWS * d);
            for _ in 0..DRAWS {
                let mut draw = row.to_vec();
                jitter(&self.columns, &mut draw, &mut rng);
                draws.extend(draw);
            }
            let logs = self
                .mixture
                .log_density(&Points::with_missing(d, &draws)?)?;
            let top = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let mean = logs.iter().map(|l| (l - top).exp()).sum::<f64>() / DRAWS as f64;
            let own = (-background).ln_1p() + top + mean.ln();
            let wide = background.ln() + wide(&self.columns, row);
            let most = own.max(wide);
            out.push(most + ((own - most).exp() + (wide - most).exp()).ln() - units);
        }
        Ok(out)
    }

    /// Draws `count` rows with the named columns given, in the columns' own units and order.
    pub fn sample_given<R: Rng>(
        &self,
        given: &[(&str, f64)],
        count: usize,
        rng: &mut R,
    ) -> Vec<Vec<f64>> {
        let fixed: Vec<Option<f64>> = self
            .columns
            .iter()
            .map(|c| {
                let value = given.iter().find(|(name, _)| *name == c.name);
                value.map(|(_, v)| (v - c.mean) / c.scale)
            })
            .collect();
        let draws = self.mixture.sample_given(&fixed, count, rng);
        draws
            .chunks(self.columns.len())
            .map(|row| self.decode(row))
            .collect()
    }

    fn decode(&self, row: &[f64]) -> Vec<f64> {
        let columns = self.columns.iter().zip(row);
        columns.map(|(c, v)| v * c.scale + c.mean).collect()
    }
}

fn value(cell: Cell) -> f64 {
    match cell {
        Cell::Real(v) => v,
        Cell::Code(c) => c as f64,
        Cell::Missing => f64::NAN,
    }
}

/// Standardised rows, one after the other; NaN is missing.
fn encode(columns: &[Column], data: &Table) -> Result<Vec<f64>, ModelError> {
    let mut out = Vec::with_capacity(columns.len() * data.rows());
    for row in 0..data.rows() {
        for column in columns {
            let cell = data.column(&column.name)?.cell(row);
            out.push((value(cell) - column.mean) / column.scale);
        }
    }
    Ok(out)
}

/// Log density of the background at a standardised row.
fn wide(columns: &[Column], row: &[f64]) -> f64 {
    let seen = columns.iter().zip(row).filter(|(_, v)| !v.is_nan());
    let logs = seen.map(|(column, v)| match column.categories {
        Some(k) => -(k as f64).ln(),
        None => -0.5 * (LN_2PI + (v / WIDTH).powi(2)) - WIDTH.ln(),
    });
    logs.sum()
}

/// Spreads category codes over their unit intervals.
fn jitter<R: Rng>(columns: &[Column], row: &mut [f64], rng: &mut R) {
    for (column, value) in columns.iter().zip(row) {
        if column.categories.is_some() {
            *value += rng.random::<f64>() - 0.5;
        }
    }
}
