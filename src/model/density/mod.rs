//! Log densities of a few real values, learned from data.
//!
//! | density | learned by |
//! | --- | --- |
//! | [`ScalarMixture`], [`gmm::Mixture`](super::gmm::Mixture) | EM, number of components by description length |
//! | [`SmoothHistogram`] | counts in equal bins, smoothed by a Gaussian kernel, any dimension |
//! | [`KernelDensity`] | Gaussian product kernels on the data, any dimension |
//! | [`Conditional`] | one density for each quantile range of a given value |
//!
//! A density has the unit 1/x. What is learned does not depend on the unit of x: from data times c,
//! each density gives `log p(c x) - log c` per dimension. A score that adds log densities therefore
//! uses [`LogDensity::relative`], the log density less its maximum, which has no unit at all and is at
//! most 0, so that further terms never pay for themselves. [`Typical`] takes the log density of a typical value of the
//! data in place of the maximum.

mod conditional;
mod histogram;
mod kernel;
mod mixture;
mod typical;

pub use conditional::Conditional;
pub use histogram::SmoothHistogram;
pub use kernel::KernelDensity;
pub use mixture::ScalarMixture;
pub use typical::Typical;

use super::ModelError;
use super::gmm::Mixture;
use super::linalg::log_sum_exp;

/// A density over vectors of [`LogDensity::dimension`] values.
///
/// Logarithms are natural; the unit of the density is that of `1 / (x_1 .. x_d)`, so that differences of `log_density` at
/// two points have none. [`LogDensity::relative`] is what scores add up, as the [module](self) explains.
///
/// # Examples
/// ```
/// use edifice_model::density::{LogDensity, ScalarMixture};
/// let standard = ScalarMixture::new(vec![1.0], vec![0.0], vec![1.0])?;
/// assert!((standard.log_density(&[0.0]) + 0.5 * std::f64::consts::TAU.ln()).abs() < 1e-12);
/// assert!((standard.relative(&[2.0]) + 2.0).abs() < 1e-12); // -x² / 2
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub trait LogDensity {
    /// Number of values d.
    fn dimension(&self) -> usize;
    /// `log p(x)`, nats; x has d values.
    fn log_density(&self, x: &[f64]) -> f64;
    /// The greatest value of `log p`, or of those at its modes.
    fn log_max(&self) -> f64;
    /// `log p(x) - max log p`, without unit and at most 0.
    fn relative(&self, x: &[f64]) -> f64 {
        (self.log_density(x) - self.log_max()).min(0.0)
    }
}

impl LogDensity for Mixture {
    fn dimension(&self) -> usize {
        Mixture::dimension(self)
    }
    fn log_density(&self, x: &[f64]) -> f64 {
        log_sum_exp(&self.log_joint(x))
    }
    /// The greatest of the values at the means.
    fn log_max(&self) -> f64 {
        let modes = (0..self.components()).map(|k| LogDensity::log_density(self, self.mean(k)));
        modes.fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Checks that there are values and that all are finite.
fn check_values(values: &[f64]) -> Result<(), ModelError> {
    if values.is_empty() {
        return Err(ModelError::Empty { what: "values" });
    }
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(row) => Err(ModelError::NotFinite {
            column: "value".into(),
            row,
            value: values[row],
        }),
    }
}

/// Mean and standard deviation.
pub(super) fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / n;
    let square = values.map(|v| (v - mean).powi(2)).sum::<f64>() / n;
    (mean, square.sqrt())
}
