//! A mixture of Gaussians of one value.

use serde::{Deserialize, Serialize};

use super::{LogDensity, check_values};
use crate::ModelError;
use crate::gmm::{Criterion, Points, Settings, select};
use crate::linalg::LN_2PI;

/// Components beyond which none are tried.
const MOST: usize = 4;
/// Groups that values are pooled into.
const GROUPS: usize = 256;
/// Least standard deviation of a component, in standard deviations of the data.
const LEAST: f64 = 0.02;

/// `p(x) = Σ w_k N(x; μ_k, σ_k)`.
///
/// K components of one value, in its unit; a density is O(K). A fit sorts n values, O(n log n), and runs [`gmm`](crate::gmm)'s
/// EM for K = 1 to 4 on at most 256 groups of them, whatever n is. Source: Rissanen 1983 for the number of components.
///
/// # Examples
/// ```
/// use edifice_model::density::{LogDensity, ScalarMixture};
/// let values: Vec<f64> = (0..60).map(|i| if i % 3 == 0 { 0.0 } else { 20.0 } + f64::from(i % 7) / 10.0).collect();
/// let density = ScalarMixture::fit(&values, 0.01, 1)?;
/// assert_eq!(density.components(), 2);
/// assert!(density.at(20.3) > density.at(0.3) && density.at(0.3) > density.at(10.0) + 100.0);
/// assert!(density.relative(&[20.3]) > -0.1);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts", into = "Parts")]
pub struct ScalarMixture {
    parts: Parts,
    /// `log w_k - log σ_k - 1/2 log 2π`.
    log_norms: Vec<f64>,
    log_max: f64,
}

/// The parameters, as in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Parts {
    weights: Vec<f64>,
    means: Vec<f64>,
    deviations: Vec<f64>,
}

impl ScalarMixture {
    /// From weights (summing to 1), means and standard deviations.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for lists of different lengths or values out of range.
    pub fn new(
        weights: Vec<f64>,
        means: Vec<f64>,
        deviations: Vec<f64>,
    ) -> Result<Self, ModelError> {
        Parts {
            weights,
            means,
            deviations,
        }
        .try_into()
    }

    /// Fits 1 to 4 components by EM and keeps the number of least description length (Rissanen 1983).
    /// The data are brought to mean 0 and deviation 1 before; no deviation gets below
    /// `max(floor, 0.02 deviations of the data)`, so that equal values are no singularity. More than 256 values
    /// are pooled into as many groups of neighbours.
    ///
    /// # Errors
    /// [`ModelError::Empty`], [`ModelError::NotFinite`], a floor that is not positive where the data
    /// have no spread.
    pub fn fit(values: &[f64], floor: f64, seed: u64) -> Result<Self, ModelError> {
        let weighted: Vec<(f64, f64)> = values.iter().map(|v| (*v, 1.0)).collect();
        Self::fit_weighted(&weighted, floor, seed)
    }

    /// As [`ScalarMixture::fit`], from pairs of a value and its weight, a positive number.
    ///
    /// # Errors
    /// As [`ScalarMixture::fit`].
    pub fn fit_weighted(pairs: &[(f64, f64)], floor: f64, seed: u64) -> Result<Self, ModelError> {
        let values: Vec<f64> = pairs.iter().map(|p| p.0).collect();
        check_values(&values)?;
        let total: f64 = pairs.iter().map(|p| p.1).sum();
        let mean = pairs.iter().map(|(v, w)| v * w).sum::<f64>() / total;
        let square = pairs
            .iter()
            .map(|(v, w)| (v - mean).powi(2) * w)
            .sum::<f64>();
        let spread = (square / total).sqrt();
        if spread <= floor {
            return Self::new(vec![1.0], vec![mean], vec![floor]);
        }
        let mut sorted: Vec<(f64, f64)> = pairs.to_vec();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let groups = sorted.chunks(sorted.len().div_ceil(GROUPS));
        let groups = groups.map(|group| {
            let weight: f64 = group.iter().map(|p| p.1).sum();
            let sum: f64 = group.iter().map(|(v, w)| v * w).sum();
            (
                (sum / weight - mean) / spread,
                weight * pairs.len() as f64 / total,
            )
        });
        let (unit, weights): (Vec<f64>, Vec<f64>) = groups.unzip();
        let settings = Settings {
            restarts: 2,
            // One dimension, and few groups of values: EM is run to its end.
            gain: 0.0,
            ..Settings::default()
        };
        let points = Points::new(1, &unit)?.weighted(&weights)?;
        let selected = select(&points, MOST, Criterion::Mdl, &settings, seed)?;
        let mixture = &selected.fitted.mixture;
        let k = 0..mixture.components();
        let deviation = |k| (mixture.covariance(k)[0].sqrt().max(LEAST) * spread).max(floor);
        Self::new(
            mixture.weights().to_vec(),
            k.clone()
                .map(|k| mean + spread * mixture.mean(k)[0])
                .collect(),
            k.map(deviation).collect(),
        )
    }

    /// Number of components.
    pub fn components(&self) -> usize {
        self.parts.weights.len()
    }

    /// `log p(x)`, nats.
    pub fn at(&self, x: f64) -> f64 {
        let log = |k: usize| {
            let z = (x - self.parts.means[k]) / self.parts.deviations[k];
            self.log_norms[k] - 0.5 * z * z
        };
        let k = 0..self.log_norms.len();
        let most = k.clone().map(log).fold(f64::NEG_INFINITY, f64::max);
        if k.len() == 1 {
            return most;
        }
        most + k.map(|k| (log(k) - most).exp()).sum::<f64>().ln()
    }
}

impl LogDensity for ScalarMixture {
    fn dimension(&self) -> usize {
        1
    }
    fn log_density(&self, x: &[f64]) -> f64 {
        self.at(x[0])
    }
    fn log_max(&self) -> f64 {
        self.log_max
    }
}

impl TryFrom<Parts> for ScalarMixture {
    type Error = ModelError;

    fn try_from(parts: Parts) -> Result<Self, ModelError> {
        let count = parts.weights.len();
        let sized = count > 0 && parts.means.len() == count && parts.deviations.len() == count;
        let sum: f64 = parts.weights.iter().sum();
        let fine = parts.weights.iter().all(|w| *w >= 0.0)
            && (sum - 1.0).abs() < 1e-6
            && parts.means.iter().all(|m| m.is_finite())
            && (parts.deviations.iter()).all(|s| s.is_finite() && *s > 0.0);
        if !sized || !fine {
            return Err(ModelError::parameter("mixture", "is out of range"));
        }
        let log_norms = (parts.weights.iter().zip(&parts.deviations))
            .map(|(w, s)| w.ln() - s.ln() - 0.5 * LN_2PI)
            .collect();
        let mut mixture = Self {
            parts,
            log_norms,
            log_max: f64::NEG_INFINITY,
        };
        // Modes lie between the least and the greatest mean, near a mean.
        for k in 0..count {
            for j in 0..count {
                let (from, to) = (mixture.parts.means[k], mixture.parts.means[j]);
                for step in 0..16 {
                    let x = from + (to - from) * (f64::from(step) / 16.0).powi(2);
                    mixture.log_max = mixture.log_max.max(mixture.at(x));
                }
            }
        }
        Ok(mixture)
    }
}

impl From<ScalarMixture> for Parts {
    fn from(mixture: ScalarMixture) -> Self {
        mixture.parts
    }
}
