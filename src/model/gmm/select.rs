//! The number of components.

use rayon::prelude::*;

use super::super::error::ModelError;
use super::{Fitted, Points, Settings, fit};
use edifice_base::rng::stream;

/// The criterion that the number of components minimises, in nats.
///
/// L is the likelihood, P the number of free parameters ([`Mixture::free_parameters`](super::Mixture::free_parameters)), N the sum of
/// weights and d the dimension; where values are missing, `N d` is the number of those that are observed. Without
/// missing values `log(N d)` is at least `log N`: of the same fits, description length never takes more components than BIC. [`select`] has an example.
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
///
/// The trace shows how clear the choice is: a difference of a few nats is not.
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
/// The sum of `most` [fits](fit), which run in parallel: O(N d² most²) a round. The smaller K wins among equal ones.
/// Sources: Rissanen 1983; Schwarz 1978.
///
/// # Errors
/// As [`fit`].
///
/// # Examples
/// ```
/// use edifice_model::gmm::{Criterion, Points, Settings, select};
/// let values: Vec<f64> = (0..60).map(|i| f64::from(i % 3) * 10.0 + f64::from(i % 7) / 10.0).collect();
/// let points = Points::new(1, &values)?;
/// let selected = select(&points, 5, Criterion::Mdl, &Settings::default(), 1)?;
/// assert_eq!(selected.fitted.mixture.components(), 3);
/// assert_eq!(selected.trace.len(), 5);
/// let least = selected.trace.iter().map(|t| t.1).fold(f64::INFINITY, f64::min);
/// assert_eq!(Criterion::Mdl.value(&selected.fitted, &points), least);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
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
