//! Gaussian mixtures by EM, with the number of components chosen by description length or BIC.
//!
//! ```text
//! p(x) = Σ_k w_k N(x; μ_k, Σ_k),      x of d values, k = 1..K
//! E: r_nk = w_k N(x_n; μ_k, Σ_k) / Σ_j ...        N_k = Σ_n r_nk
//! M: w_k = N_k / N,  μ_k = Σ_n r_nk x_n / (N_k + κ),
//!    Σ_k = (ψD + κ μ_k μ_kᵀ + Σ_n r_nk (x_n - μ_k)(x_n - μ_k)ᵀ) / (N_k + ν)
//! ```
//! with x relative to the overall mean and D the diagonal of the overall variances, so that a fit does not depend on the
//! units of the data. κ, ψ and ν are a normal-inverse-Wishart prior
//! ([`Prior`]), so that an empty or a singular component is no special case. Full covariances,
//! diagonal ones, or one shared by all components ([`Covariance`]). Rows may carry weights.
//!
//! The number of components minimises `-log L + P/2 log(N d)` (MDL; Rissanen 1983, with the N d
//! real numbers of the data as its length, as in Bouman's CLUSTER), or `-log L + P/2 log N` (BIC),
//! with P free parameters: [`select`]. Missing values are integrated out ([`Points::with_missing`]), and the length counts
//! the observed values.
//!
//! # Deviations and readings
//! - The E step works on blocks of rows: a matrix product whitens a block, so that time per round
//!   is N K d². The M step leaves out rows whose responsibility is below 1e-14.
//! - Starts are k-means++ (Arthur and Vassilvitskii 2007) with a few Lloyd rounds, as many as
//!   [`Settings::restarts`]; the first of highest log posterior wins.

mod block;
mod densities;
#[cfg(feature = "linfa")]
pub mod linfa;
mod missing;
mod mixture;
mod points;
mod problem;
mod select;
mod settings;
mod step;

use rand::Rng;

use super::em;
use super::error::ModelError;
pub use mixture::Mixture;
pub use points::Points;
pub use problem::Fitted;
use problem::Steps;
pub use select::{Criterion, Selected, select};
pub use settings::{Covariance, Prior, Settings};

/// Fits `k` components from [`Settings::restarts`] starts.
///
/// Complexity: a round of EM is O(N K d²) (O(N K d) for diagonal covariances) and O(K d³) for the factors, and there are as
/// many runs as restarts. Rows are worked on in parallel. Formulas and sources are in the [module](self).
///
/// # Errors
/// [`ModelError::TooFewRows`] for fewer rows than components, [`ModelError::AllMissing`] for a coordinate (its index)
/// without a value; a prior out of range.
///
/// # Examples
/// ```
/// use edifice_model::gmm::{Points, Settings, fit};
/// use edifice_base::rng::stream;
/// let values: Vec<f64> = (0..40).map(|i| if i % 2 == 0 { 0.0 } else { 9.0 } + (i % 5) as f64 / 10.0).collect();
/// let fitted = fit(&Points::new(1, &values)?, 2, &Settings::default(), &mut stream(1, "gmm", 0))?;
/// let mut means: Vec<f64> = (0..2).map(|k| fitted.mixture.mean(k)[0]).collect();
/// means.sort_by(f64::total_cmp);
/// assert!((means[0] - 0.2).abs() < 0.01 && (means[1] - 9.2).abs() < 0.01);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn fit<R: Rng>(
    points: &Points,
    k: usize,
    settings: &Settings,
    rng: &mut R,
) -> Result<Fitted, ModelError> {
    let steps = Steps::new(points, k, settings)?;
    let starts: Result<Vec<Mixture>, ModelError> = (0..settings.restarts.max(1))
        .map(|_| steps.start(rng))
        .collect();
    Ok(steps.result(em::restarts(&steps, starts?, &steps.stopping())?))
}

/// Runs EM from a given mixture.
///
/// One run, without randomness: for a start that is known, such as an earlier fit. A round costs as in [`fit`].
///
/// # Errors
/// A start of another dimension or shape of covariance; a prior out of range.
///
/// # Examples
/// ```
/// use edifice_model::gmm::{Covariance, Mixture, Points, Settings, fit_from};
/// let values: Vec<f64> = (0..40).map(|i| if i % 4 == 0 { 0.0 } else { 9.0 } + (i % 5) as f64 / 10.0).collect();
/// let settings = Settings { covariance: Covariance::Diagonal, ..Settings::default() };
/// let start = Mixture::new(1, Covariance::Diagonal, vec![0.5, 0.5], vec![1.0, 8.0], vec![1.0, 1.0])?;
/// let fitted = fit_from(&Points::new(1, &values)?, &start, &settings)?;
/// // Components keep their order; a quarter of the rows is in the first.
/// assert!((fitted.mixture.weights()[0] - 0.25).abs() < 1e-6);
/// assert!((fitted.mixture.mean(1)[0] - 9.2).abs() < 1e-6);
/// assert!(fitted.trace.is_sorted());
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn fit_from(
    points: &Points,
    start: &Mixture,
    settings: &Settings,
) -> Result<Fitted, ModelError> {
    if start.d != points.dimension() || start.kind != settings.covariance {
        return Err(ModelError::parameter(
            "start",
            "does not fit the data or the settings",
        ));
    }
    let steps = Steps::new(points, start.components(), settings)?;
    let start = steps.centred(start);
    Ok(steps.result(em::run(&steps, start, &steps.stopping())?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;

    #[test]
    fn extreme_units_are_refused_by_name_and_wide_ones_do_not_matter() {
        let values = |unit: f64| -> Vec<f64> {
            (0..60)
                .map(|i| unit * (f64::from(i % 2) * 9.0 + f64::from(i % 5) / 10.0))
                .collect()
        };
        let fitted = |unit: f64| {
            let values = values(unit);
            let points = Points::new(1, &values).unwrap();
            fit(&points, 2, &Settings::default(), &mut stream(1, "units", 0))
        };
        let plain = fitted(1.0).unwrap();
        for unit in [1e-130, 1e130] {
            let other = fitted(unit).unwrap();
            let shift = 60.0 * unit.ln();
            assert!((other.log_likelihood + shift - plain.log_likelihood).abs() < 1e-6);
        }
        for unit in [1e-300, 1e300] {
            let error = fitted(unit).unwrap_err().to_string();
            assert!(error.contains("another unit"), "{error}");
        }
    }
}
