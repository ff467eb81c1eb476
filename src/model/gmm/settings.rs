//! Settings of a fit, and its prior.

use super::super::conjugate::LinearPrior;
use super::super::em::Stopping;

/// Shape of the covariances.
///
/// Free parameters of the covariances of K components of d values: `K d (d + 1) / 2`, `K d` and `d (d + 1) / 2`. The
/// [module](super)'s M step is that of full matrices; a diagonal one keeps the diagonal of Σ_k, a tied one is the sum of
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
/// In the [module](super)'s M step it adds κ rows at the overall mean, and ψ and ν to numerator and denominator of the
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

/// Settings of [`fit`](super::fit).
///
/// The example of [`fit`](super::fit) uses the default, that of [`fit_from`](super::fit_from) other covariances.
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
