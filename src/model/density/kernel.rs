//! Kernel density estimation.

use super::{LogDensity, check_values, moments};
use crate::ModelError;
use crate::linalg::LN_2PI;

/// `p(x) = 1/n Σ_i Π_j N(x_j; x_ij, h_j)`: Gaussian product kernels on n rows.
///
/// Rows n x d, one bandwidth per dimension, in the unit of its values. [`KernelDensity::fit`] is O(n² d), for the greatest
/// density at a row, and a density O(n d). Source: Scott 1992; a product kernel follows correlated values badly, where
/// [`gmm`](crate::gmm) is better.
///
/// # Examples
/// ```
/// use edifice_model::density::{KernelDensity, LogDensity};
/// // Deviation 1 of 2 rows: bandwidth 2^(-1/5).
/// let density = KernelDensity::fit(1, &[-1.0, 1.0], 0.01)?;
/// let h = 2.0_f64.powf(-0.2);
/// let expected = (-0.5 / (h * h)).exp() / (h * std::f64::consts::TAU.sqrt());
/// assert!((density.log_density(&[0.0]).exp() - expected).abs() < 1e-12);
/// assert_eq!(density.log_density(&[0.7]), density.log_density(&[-0.7]));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct KernelDensity {
    rows: Vec<f64>,
    bandwidths: Vec<f64>,
    log_norm: f64,
    log_max: f64,
}

impl KernelDensity {
    /// From rows of `d` values, one after the other, with Scott's bandwidths `σ_j n^(-1/(d + 4))`
    /// (Scott 1992), none below `floor`.
    ///
    /// # Errors
    /// [`ModelError`] for no values, broken rows, a value that is not finite, or a floor that is not positive.
    pub fn fit(d: usize, values: &[f64], floor: f64) -> Result<Self, ModelError> {
        check_values(values)?;
        if d == 0 || !values.len().is_multiple_of(d) {
            return Err(ModelError::parameter("values", "are not whole rows"));
        }
        if !(floor.is_finite() && floor > 0.0) {
            return Err(ModelError::parameter("floor", "is not positive"));
        }
        let n = (values.len() / d) as f64;
        let shrink = n.powf(-1.0 / (d as f64 + 4.0));
        let bandwidths: Vec<f64> = (0..d)
            .map(|j| {
                let column = values.iter().skip(j).step_by(d).copied();
                (moments(column).1 * shrink).max(floor)
            })
            .collect();
        let log_norm = -n.ln()
            - bandwidths
                .iter()
                .map(|h| h.ln() + 0.5 * LN_2PI)
                .sum::<f64>();
        let mut density = Self {
            rows: values.to_vec(),
            bandwidths,
            log_norm,
            log_max: f64::NEG_INFINITY,
        };
        let at_rows = values.chunks(d).map(|row| density.log_density(row));
        density.log_max = at_rows.fold(f64::NEG_INFINITY, f64::max);
        Ok(density)
    }
}

impl LogDensity for KernelDensity {
    fn dimension(&self) -> usize {
        self.bandwidths.len()
    }
    fn log_density(&self, x: &[f64]) -> f64 {
        let kernel = |row: &[f64]| -> f64 {
            let squares =
                (row.iter().zip(x).zip(&self.bandwidths)).map(|((r, x), h)| ((x - r) / h).powi(2));
            -0.5 * squares.sum::<f64>()
        };
        let rows = self.rows.chunks(self.bandwidths.len());
        let most = rows.clone().map(kernel).fold(f64::NEG_INFINITY, f64::max);
        self.log_norm + most + rows.map(|r| (kernel(r) - most).exp()).sum::<f64>().ln()
    }
    /// The greatest of the values at the rows.
    fn log_max(&self) -> f64 {
        self.log_max
    }
}
