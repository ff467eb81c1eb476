//! A Gaussian mixture: its parameters, densities and draws.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::super::error::ModelError;
use super::super::linalg::{LN_2PI, categorical_of_logs, cholesky, lower_inverse};
use super::settings::Covariance;

/// A Gaussian mixture, `p(x) = Σ_k w_k N(x; μ_k, Σ_k)` over x of d values, K components.
///
/// Weights K, means K x d, covariances K x d x d (d x d when tied), row-major, with their inverse Cholesky factors beside them:
/// `log |Σ|` and Mahalanobis distances cost no factorization. A complete row's density is O(K d²), one with missing
/// values O(K d³) where the row before lacks others. Conditional draws ([`Mixture::sample_given`]) factor once, O(K d³).
/// Source: Bishop, *Pattern Recognition and Machine Learning* (2006), Sec. 2.3 and 9.2.
///
/// # Examples
/// ```
/// use edifice_model::gmm::{Covariance, Mixture, Points};
/// use edifice_base::rng::stream;
/// let unit = [1.0, 0.0, 0.0, 1.0];
/// let covariances = [unit, unit].concat();
/// let mixture = Mixture::new(2, Covariance::Full, vec![0.5, 0.5], vec![0.0, 0.0, 8.0, 8.0], covariances)?;
/// assert_eq!(mixture.free_parameters(), 1 + 4 + 6);
/// let posterior = mixture.posterior(&Points::new(2, &[0.0, 0.0, 4.0, 4.0])?)?;
/// assert!(posterior[0][0] > 0.999 && (posterior[1][0] - 0.5).abs() < 1e-9);
/// // A missing value is integrated out: at 0, the density of the first coordinate is 1 / (2 sqrt(2 pi)).
/// let log = mixture.log_density(&Points::with_missing(2, &[0.0, f64::NAN])?)?[0];
/// assert!((log.exp() - 0.5 / std::f64::consts::TAU.sqrt()).abs() < 1e-9);
/// // The first coordinate given, the second is that of the same component.
/// let rows = mixture.sample_given(&[Some(8.0)], 100, &mut stream(1, "draws", 0));
/// assert!(rows.chunks(2).all(|row| row[0] == 8.0 && (row[1] - 8.0).abs() < 6.0));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    pub(crate) d: usize,
    pub(crate) kind: Covariance,
    /// w_k.
    pub(crate) weights: Vec<f64>,
    /// μ_k, one after the other.
    pub(crate) means: Vec<f64>,
    /// Σ_k, row-major one after the other; one only when tied.
    pub(crate) covariances: Vec<f64>,
    /// Inverse Cholesky factors, in the same layout.
    pub(crate) whitening: Vec<f64>,
    /// `log w_k - d/2 log 2π - 1/2 log|Σ_k|`.
    pub(crate) log_norms: Vec<f64>,
}

impl Mixture {
    /// From weights (summing to 1), means (K x d) and covariances (K x d x d, or d x d when tied;
    /// off-diagonal entries must be 0 when diagonal).
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for sizes that do not fit or values out of range,
    /// [`ModelError::Singular`].
    pub fn new(
        d: usize,
        kind: Covariance,
        weights: Vec<f64>,
        means: Vec<f64>,
        covariances: Vec<f64>,
    ) -> Result<Self, ModelError> {
        let k = weights.len();
        let matrices = if kind == Covariance::Tied { 1 } else { k };
        if d == 0 || k == 0 || means.len() != k * d || covariances.len() != matrices * d * d {
            return Err(ModelError::parameter("mixture", "sizes do not fit"));
        }
        let sum: f64 = weights.iter().sum();
        let weights_ok = weights.iter().all(|w| *w >= 0.0) && (sum - 1.0).abs() < 1e-9;
        if !weights_ok || !means.iter().all(|m| m.is_finite()) {
            return Err(ModelError::parameter(
                "mixture",
                "weights or means are out of range",
            ));
        }
        let mut whitening = Vec::with_capacity(covariances.len());
        let mut halves = Vec::with_capacity(matrices);
        for (m, covariance) in covariances.chunks(d * d).enumerate() {
            let mut l = covariance.to_vec();
            if !cholesky(&mut l, d) {
                return Err(ModelError::Singular {
                    variable: format!("component {m}"),
                });
            }
            halves.push((0..d).map(|i| l[i * d + i].ln()).sum::<f64>());
            whitening.extend(lower_inverse(&l, d));
        }
        let log_norms = weights
            .iter()
            .enumerate()
            .map(|(k, w)| w.ln() - 0.5 * d as f64 * LN_2PI - halves[k.min(matrices - 1)])
            .collect();
        Ok(Self {
            d,
            kind,
            weights,
            means,
            covariances,
            whitening,
            log_norms,
        })
    }

    /// K.
    pub fn components(&self) -> usize {
        self.weights.len()
    }

    /// d.
    pub fn dimension(&self) -> usize {
        self.d
    }

    /// w_k of every component.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// μ_k.
    pub fn mean(&self, k: usize) -> &[f64] {
        &self.means[k * self.d..(k + 1) * self.d]
    }

    /// Σ_k, row-major.
    pub fn covariance(&self, k: usize) -> &[f64] {
        let size = self.d * self.d;
        let m = if self.kind == Covariance::Tied { 0 } else { k };
        &self.covariances[m * size..(m + 1) * size]
    }

    pub(crate) fn whitening_of(&self, k: usize) -> &[f64] {
        let size = self.d * self.d;
        let m = if self.kind == Covariance::Tied { 0 } else { k };
        &self.whitening[m * size..(m + 1) * size]
    }

    /// Number of free parameters P.
    pub fn free_parameters(&self) -> usize {
        let (k, d) = (self.components(), self.d);
        let covariance = match self.kind {
            Covariance::Full => k * d * (d + 1) / 2,
            Covariance::Diagonal => k * d,
            Covariance::Tied => d * (d + 1) / 2,
        };
        k - 1 + k * d + covariance
    }

    /// Draws `count` rows, one after the other.
    pub fn sample<R: Rng>(&self, count: usize, rng: &mut R) -> Vec<f64> {
        self.sample_given(&vec![None; self.d], count, rng)
    }

    /// Draws `count` rows with some coordinates given, from the exact conditional mixture.
    ///
    /// `given` has one entry per coordinate; further entries are ignored and lacking ones drawn.
    pub fn sample_given<R: Rng>(
        &self,
        given: &[Option<f64>],
        count: usize,
        rng: &mut R,
    ) -> Vec<f64> {
        let d = self.d;
        let fixed: Vec<usize> = (0..d)
            .filter(|&i| given.get(i).is_some_and(Option::is_some))
            .collect();
        let free: Vec<usize> = (0..d).filter(|i| !fixed.contains(i)).collect();
        let order: Vec<usize> = fixed.iter().chain(&free).copied().collect();
        let f = fixed.len();
        // Cholesky with the given coordinates first: their whitened residuals fix the leading
        // normals, the remaining ones are free.
        let parts: Vec<(f64, Vec<f64>, Vec<f64>)> = (0..self.components())
            .map(|k| {
                let (mean, cov) = (self.mean(k), self.covariance(k));
                let mut l = vec![0.0; d * d];
                for (a, &i) in order.iter().enumerate() {
                    for (b, &j) in order.iter().enumerate() {
                        l[a * d + b] = cov[i * d + j];
                    }
                }
                cholesky(&mut l, d);
                let mut z = vec![0.0; f];
                let mut log = self.weights[k].ln();
                for a in 0..f {
                    let x = given[order[a]].unwrap_or(0.0) - mean[order[a]];
                    let dot: f64 = (0..a).map(|b| l[a * d + b] * z[b]).sum();
                    z[a] = (x - dot) / l[a * d + a];
                    log -= 0.5 * (z[a] * z[a] + LN_2PI) + l[a * d + a].ln();
                }
                (log, z, l)
            })
            .collect();
        let logs: Vec<f64> = parts.iter().map(|p| p.0).collect();
        let mut rows = Vec::with_capacity(count * d);
        for _ in 0..count {
            let k = categorical_of_logs(&logs, rng);
            let (_, fixed_z, l) = &parts[k];
            let mut z = fixed_z.clone();
            z.extend((f..d).map(|_| rng.sample::<f64, _>(StandardNormal)));
            let mut row = vec![0.0; d];
            for (a, &i) in order.iter().enumerate() {
                row[i] = match given.get(i) {
                    Some(Some(x)) => *x,
                    _ => self.mean(k)[i] + (0..=a).map(|b| l[a * d + b] * z[b]).sum::<f64>(),
                };
            }
            rows.extend(row);
        }
        rows
    }
}
