//! A histogram that is smoothed by a Gaussian kernel.

use serde::{Deserialize, Serialize};

use super::{LogDensity, check_values};
use crate::ModelError;

/// Most bins of all dimensions together.
const MOST_BINS: usize = 1 << 16;
/// Weight of the uniform prior over the box, in rows.
const PRIOR_ROWS: f64 = 0.5;

/// A density over a box, constant in each of its equal bins. Values outside have the density of the
/// nearest bin.
///
/// `p(x) = share of x's bin / volume of a bin`, the shares summing to 1. d dimensions with `bins_1 .. bins_d` bins, at most 2^16 in
/// all. Learning from n rows is O(n d + B d bandwidth) for B bins, a density O(d). Source: Wand and Jones 1994 (reflection
/// at the borders).
///
/// # Examples
/// ```
/// use edifice_model::density::{LogDensity, SmoothHistogram};
/// let values = [0.5, 0.5, 0.5, 2.5];
/// let density = SmoothHistogram::fit(vec![0.0], vec![4.0], vec![4], 0.0, &values)?;
/// // Counts 3, 0, 1, 0, an eighth of a row for each bin, over 4.5 rows; bins have width 1.
/// let p = |x: f64| density.log_density(&[x]).exp();
/// assert!((p(0.9) - 3.125 / 4.5).abs() < 1e-12 && (p(1.1) - 0.125 / 4.5).abs() < 1e-12);
/// assert!(((0..4).map(|bin| p(f64::from(bin))).sum::<f64>() - 1.0).abs() < 1e-12);
/// assert_eq!(density.log_max(), density.log_density(&[0.0]));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts", into = "Parts")]
pub struct SmoothHistogram {
    parts: Parts,
    logs: Vec<f64>,
    log_max: f64,
}

/// The parameters, as in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Parts {
    low: Vec<f64>,
    high: Vec<f64>,
    bins: Vec<usize>,
    /// Probability of each bin, the last dimension fastest.
    shares: Vec<f64>,
}

impl SmoothHistogram {
    /// Counts rows of d values, one after the other, in `bins` bins from `low` to `high`, and smooths with
    /// a Gaussian kernel of `bandwidth` bins, reflected at the borders (Wand and Jones 1994). A uniform
    /// share of half a row keeps every bin above zero.
    ///
    /// # Errors
    /// [`ModelError`] for an empty or infinite box, no values or broken rows, or a value that is not finite.
    pub fn fit(
        low: Vec<f64>,
        high: Vec<f64>,
        bins: Vec<usize>,
        bandwidth: f64,
        values: &[f64],
    ) -> Result<Self, ModelError> {
        check_values(values)?;
        let d = bins.len();
        if d == 0 || !values.len().is_multiple_of(d) {
            return Err(ModelError::parameter("values", "are not whole rows"));
        }
        let count = checked_size(&bins)?;
        let shares = vec![1.0 / count as f64; count];
        let mut parts = Self::try_from(Parts {
            low,
            high,
            bins,
            shares,
        })?
        .parts;
        let mut shares = vec![0.0; count];
        for row in values.chunks(d) {
            shares[parts.bin(row)] += 1.0;
        }
        let mut stride = count;
        for bins in &parts.bins {
            stride /= bins;
            shares = smoothed(&shares, *bins, stride, bandwidth);
        }
        let uniform = PRIOR_ROWS / count as f64;
        let total: f64 = shares.iter().sum::<f64>() + PRIOR_ROWS;
        parts.shares = shares.iter().map(|s| (s + uniform) / total).collect();
        Self::try_from(parts)
    }
}

/// Convolution along one dimension of `bins` bins that lie `stride` apart.
fn smoothed(shares: &[f64], bins: usize, stride: usize, bandwidth: f64) -> Vec<f64> {
    if bandwidth <= 0.0 {
        return shares.to_vec();
    }
    let reach = (4.0 * bandwidth).ceil() as i64;
    let kernel = |offset: i64| (-0.5 * (offset as f64 / bandwidth).powi(2)).exp();
    let norm: f64 = (-reach..=reach).map(kernel).sum();
    let mut out = vec![0.0; shares.len()];
    for (index, share) in shares.iter().enumerate().filter(|(_, s)| **s > 0.0) {
        let at = index / stride % bins;
        for offset in -reach..=reach {
            let period = 2 * bins as i64;
            let folded = (at as i64 + offset).rem_euclid(period);
            let to = if folded < bins as i64 {
                folded
            } else {
                period - 1 - folded
            } as usize;
            out[index - at * stride + to * stride] += share * kernel(offset) / norm;
        }
    }
    out
}

fn checked_size(bins: &[usize]) -> Result<usize, ModelError> {
    let size = bins.iter().try_fold(1usize, |n, k| n.checked_mul(*k));
    let size = size.filter(|n| (1..=MOST_BINS).contains(n));
    size.ok_or_else(|| ModelError::parameter("bins", "are none or too many"))
}

impl Parts {
    fn bin(&self, x: &[f64]) -> usize {
        let mut index = 0;
        for (i, bins) in self.bins.iter().enumerate() {
            let share = (x[i] - self.low[i]) / (self.high[i] - self.low[i]);
            // The cast of a float saturates.
            let at = ((share * *bins as f64).max(0.0) as usize).min(bins - 1);
            index = index * bins + at;
        }
        index
    }
}

impl LogDensity for SmoothHistogram {
    fn dimension(&self) -> usize {
        self.parts.bins.len()
    }
    fn log_density(&self, x: &[f64]) -> f64 {
        self.logs[self.parts.bin(x)]
    }
    fn log_max(&self) -> f64 {
        self.log_max
    }
}

impl TryFrom<Parts> for SmoothHistogram {
    type Error = ModelError;

    fn try_from(parts: Parts) -> Result<Self, ModelError> {
        let count = checked_size(&parts.bins)?;
        let d = parts.bins.len();
        let sized = parts.low.len() == d && parts.high.len() == d && parts.shares.len() == count;
        let sides: Vec<f64> = parts
            .low
            .iter()
            .zip(&parts.high)
            .map(|(l, h)| h - l)
            .collect();
        let fine = sides.iter().all(|s| s.is_finite() && *s > 0.0)
            && parts.shares.iter().all(|s| s.is_finite() && *s > 0.0)
            && (parts.shares.iter().sum::<f64>() - 1.0).abs() < 1e-6;
        if !sized || !fine {
            return Err(ModelError::parameter("histogram", "is out of range"));
        }
        let volume: f64 = sides.iter().product::<f64>() / count as f64;
        let logs: Vec<f64> = parts.shares.iter().map(|s| s.ln() - volume.ln()).collect();
        let log_max = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Ok(Self {
            parts,
            logs,
            log_max,
        })
    }
}

impl From<SmoothHistogram> for Parts {
    fn from(histogram: SmoothHistogram) -> Self {
        histogram.parts
    }
}
