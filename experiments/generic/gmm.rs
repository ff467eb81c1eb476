//! Gaussian mixtures, on tables of numbers.

use std::path::Path;

use nalgebra::{Cholesky, DMatrix, DVector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sweep::{Better, Given, Outcome, Study};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_model::gmm::{self, Criterion, Mixture, Points, select};

/// The criterion that the number of components minimizes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum CriterionName {
    Mdl,
    Bic,
}

/// Shape of the covariances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Covariance {
    Full,
    Diagonal,
    Tied,
}

/// Settings of the mixture.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Settings {
    /// Criterion that the number of components minimizes.
    criterion: CriterionName,
    /// Shape of the covariances: full, diagonal, or one for all components.
    covariance: Covariance,
    /// Most components.
    most: usize,
    /// k-means++ starts.
    restarts: usize,
    /// Share of the rows that is learnt from; the others judge.
    share: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            criterion: CriterionName::Mdl,
            covariance: Covariance::Full,
            most: 8,
            restarts: gmm::Settings::default().restarts,
            share: 0.8,
        }
    }
}

/// Gaussian mixtures.
pub fn study() -> Study {
    const METRICS: &[(&str, Better)] = &[("nll", Better::Lower), ("components", Better::Lower)];
    let about = "Gaussian mixtures on a CSV table of numbers: negative log-likelihood of unseen rows; seeds split the rows";
    Study::new("model/gmm", about, "model", METRICS, run)
}

/// The errors of a table or a setting.
#[derive(Debug, thiserror::Error)]
enum GmmError {
    #[error("`{0}` is no number")]
    NotANumber(String),
    #[error("share is {0}, expected a number between 0 and 1 that leaves rows on both sides")]
    Share(f64),
    #[error("a covariance of the mixture is not positive definite")]
    Singular,
}

fn run(settings: &Settings, given: &Given) -> Result<Outcome> {
    use rand::seq::SliceRandom;
    let rows = read(given.path)?;
    let d = rows.first().map_or(0, Vec::len);
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.shuffle(&mut stream(given.seed, "model/gmm split", 0));
    let kept = (settings.share * rows.len() as f64).round() as usize;
    if kept == 0 || kept >= rows.len() {
        return Err(Error::method(GmmError::Share(settings.share)));
    }
    let (train, test) = order.split_at(kept);
    let values: Vec<f64> = train.iter().flat_map(|&i| rows[i].clone()).collect();
    let points = Points::new(d, &values).map_err(|e| Error::content(given.path, e))?;
    let asked = gmm::Settings {
        covariance: match settings.covariance {
            Covariance::Full => gmm::Covariance::Full,
            Covariance::Diagonal => gmm::Covariance::Diagonal,
            Covariance::Tied => gmm::Covariance::Tied,
        },
        restarts: settings.restarts,
        ..gmm::Settings::default()
    };
    let criterion = match settings.criterion {
        CriterionName::Mdl => Criterion::Mdl,
        CriterionName::Bic => Criterion::Bic,
    };
    let selected = select(&points, settings.most, criterion, &asked, given.seed);
    let mixture = selected.map_err(Error::method)?.fitted.mixture;
    let mut found = Outcome::default();
    let unseen: Vec<&Vec<f64>> = test.iter().map(|&i| &rows[i]).collect();
    let nll = loss(&mixture, &unseen).ok_or_else(|| Error::method(GmmError::Singular))?;
    found.metrics.insert("nll".into(), nll);
    let components = mixture.components() as f64;
    found.metrics.insert("components".into(), components);
    Ok(found)
}

/// Mean negative log density of rows, nats: written out again here, so that the mixture does not judge itself.
fn loss(mixture: &Mixture, rows: &[&Vec<f64>]) -> Option<f64> {
    let d = mixture.dimension();
    let parts: Vec<(f64, DVector<f64>, Cholesky<f64, nalgebra::Dyn>)> = (0..mixture.components())
        .map(|k| {
            let covariance = DMatrix::from_row_slice(d, d, mixture.covariance(k));
            let mean = DVector::from_row_slice(mixture.mean(k));
            Some((mixture.weights()[k], mean, covariance.cholesky()?))
        })
        .collect::<Option<_>>()?;
    let log_density = |row: &[f64]| {
        let logs = parts.iter().map(|(weight, mean, cholesky)| {
            let centred = DVector::from_row_slice(row) - mean;
            let distance = centred.dot(&cholesky.solve(&centred));
            let log_det = 2.0 * cholesky.l().diagonal().map(f64::ln).sum();
            weight.ln() - 0.5 * (d as f64 * std::f64::consts::TAU.ln() + log_det + distance)
        });
        let logs: Vec<f64> = logs.collect();
        let top = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        top + logs.iter().map(|log| (log - top).exp()).sum::<f64>().ln()
    };
    Some(-rows.iter().map(|row| log_density(row)).sum::<f64>() / rows.len() as f64)
}

/// The rows of a CSV file with a header.
fn read(path: &Path) -> Result<Vec<Vec<f64>>> {
    let table = edifice_io::building_csv::read(path)?;
    let number = |(row, cell): (usize, &String)| {
        cell.trim().parse::<f64>().map_err(|_| {
            let place = format!("row {}", row + 1);
            Error::input(path, place, GmmError::NotANumber(cell.clone()))
        })
    };
    let rows = table.rows.iter().enumerate();
    rows.map(|(i, row)| row.iter().map(|cell| number((i, cell))).collect())
        .collect()
}
