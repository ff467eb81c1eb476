//! The number of components.

use rayon::prelude::*;

use super::super::error::ModelError;
use super::{Fitted, Points, Settings, fit};
use crate::rng::stream;

/// What the number of components minimises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Description length `-log L + P/2 log(N d)` (Rissanen 1983).
    Mdl,
    /// `-log L + P/2 log N` (Schwarz 1978).
    Bic,
}

impl Criterion {
    /// The criterion's value in nats; smaller is better.
    pub fn value(self, fitted: &Fitted, points: &Points) -> f64 {
        let length = match self {
            Self::Mdl => points.observed(),
            Self::Bic => points.total(),
        };
        0.5 * fitted.mixture.free_parameters() as f64 * length.ln() - fitted.log_likelihood
    }
}

/// Result of [`select`].
#[derive(Clone, Debug)]
pub struct Selected {
    /// The fit of smallest criterion.
    pub fitted: Fitted,
    /// (K, criterion in nats) of every K tried, ascending.
    pub trace: Vec<(usize, f64)>,
}

/// Fits 1..=`most` components (no more than there are rows) and keeps the first of smallest
/// criterion; each K has its own random stream under `seed`.
///
/// # Errors
/// As [`fit`].
pub fn select(
    points: &Points,
    most: usize,
    criterion: Criterion,
    settings: &Settings,
    seed: u64,
) -> Result<Selected, ModelError> {
    let fits: Result<Vec<(usize, Fitted)>, ModelError> = (1..=most.clamp(1, points.len()))
        .into_par_iter()
        .map(|k| {
            Ok((
                k,
                fit(points, k, settings, &mut stream(seed, "gmm", k as u64))?,
            ))
        })
        .collect();
    let mut trace = Vec::new();
    let mut best: Option<(f64, Fitted)> = None;
    for (k, fitted) in fits? {
        let value = criterion.value(&fitted, points);
        trace.push((k, value));
        if best.as_ref().is_none_or(|(b, _)| value < *b) {
            best = Some((value, fitted));
        }
    }
    let (_, fitted) = best.ok_or(ModelError::Empty { what: "components" })?;
    Ok(Selected { fitted, trace })
}
