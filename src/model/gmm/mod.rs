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
#[cfg(feature = "linfa")]
pub mod linfa;
mod missing;
mod mixture;
mod points;
mod select;
mod step;

use rand::Rng;

use super::conjugate::LinearPrior;
use super::em::{self, Stopping};
use super::error::ModelError;
pub use mixture::Mixture;
pub use points::Points;
pub use select::{Criterion, Selected, select};
use step::Steps;

/// Shape of the covariances.
///
/// Free parameters of the covariances of K components of d values: `K d (d + 1) / 2`, `K d` and `d (d + 1) / 2`. The
/// [module](self)'s M step is that of full matrices; a diagonal one keeps the diagonal of Σ_k, a tied one is the sum of
/// all components' scatters over the sum of their weights. All are stored as d x d matrices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Covariance {
    /// One full matrix per component.
    #[default]
    Full,
    /// One diagonal matrix per component.
    Diagonal,
    /// One full matrix for all components.
    Tied,
}

/// Normal-inverse-Wishart prior of every component, in units of the overall standard deviations.
///
/// In the [module](self)'s M step it adds κ rows at the overall mean, and ψ and ν to numerator and denominator of the
/// covariance. [`Prior::default`] is negligible unless a component is empty or singular; a larger ψ bounds variances away from 0.
/// Source: Murphy, *Machine Learning* (2012), Sec. 4.6.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Prior {
    /// κ: how many rows at the overall mean each component has seen.
    pub mean: f64,
    /// ψ: scatter (times the overall variance) that each coordinate of each component has seen.
    pub scatter: f64,
    /// ν: how many rows that scatter is worth.
    pub freedom: f64,
}

impl Default for Prior {
    /// As good as none: it only keeps a component without rows, or on one point, defined.
    fn default() -> Self {
        Self {
            mean: 1e-9,
            scatter: 1e-6,
            freedom: 1e-6,
        }
    }
}

impl Prior {
    /// The same prior as [`LinearPrior`] is for a group of `d` columns.
    pub fn of_linear(prior: &LinearPrior, d: usize) -> Self {
        Self {
            mean: prior.intercept,
            scatter: prior.scatter,
            freedom: prior.freedom + (2 * d + 1) as f64,
        }
    }
}

/// Settings of [`fit`].
///
/// The example of [`fit`] uses the default, that of [`fit_from`] other covariances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Shape of the covariances.
    pub covariance: Covariance,
    /// Number of k-means++ starts.
    pub restarts: usize,
    /// Prior of every component.
    pub prior: Prior,
    /// When EM stops, besides [`Settings::gain`].
    pub stopping: Stopping,
    /// Stop as well when a round gains less log posterior than this, nats a row (0: never for this reason).
    pub gain: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            covariance: Covariance::Full,
            restarts: 5,
            prior: Prior::default(),
            stopping: Stopping::default(),
            gain: 1e-7,
        }
    }
}

/// Result of [`fit`].
///
/// The trace has the posterior of the best start only; it never falls. Log densities are of data in their own unit: in
/// another unit c times as fine, `log_likelihood` is `N d log c` less. The example of [`fit_from`] reads one.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The mixture of highest log posterior.
    pub mixture: Mixture,
    /// `Σ weight log p(x)`, nats.
    pub log_likelihood: f64,
    /// Log posterior (up to a constant of the prior) before each round and after the last.
    pub trace: Vec<f64>,
    /// Why EM stopped.
    pub outcome: em::Outcome,
}

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
