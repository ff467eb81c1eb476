//! Gaussian mixtures by EM, with the number of components chosen by description length or BIC.
//!
//! ```text
//! p(x) = Σ_k w_k N(x; μ_k, Σ_k),      x of d values, k = 1..K
//! E: r_nk = w_k N(x_n; μ_k, Σ_k) / Σ_j ...        N_k = Σ_n r_nk
//! M: w_k = N_k / N,  μ_k = Σ_n r_nk x_n / (N_k + κ),
//!    Σ_k = (ψI + κ μ_k μ_kᵀ + Σ_n r_nk (x_n - μ_k)(x_n - μ_k)ᵀ) / (N_k + ν)
//! ```
//! with x relative to the overall mean. κ, ψ and ν are a normal-inverse-Wishart prior
//! ([`Prior`]), so that an empty or a singular component is no special case. Full covariances,
//! diagonal ones, or one shared by all components ([`Covariance`]). Rows may carry weights.
//!
//! The number of components minimises `-log L + P/2 log(N d)` (MDL; Rissanen 1983, with the N d
//! real numbers of the data as its length, as in Bouman's CLUSTER), or `-log L + P/2 log N` (BIC),
//! with P free parameters: [`select`].
//!
//! # Deviations and readings
//! - The E step works on blocks of rows: a matrix product whitens a block, so that time per round
//!   is N K d². The M step leaves out rows whose responsibility is below 1e-14.
//! - Starts are k-means++ (Arthur and Vassilvitskii 2007) with a few Lloyd rounds, as many as
//!   [`Settings::restarts`]; the first of highest log posterior wins.

mod points;
mod select;
mod step;

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use rayon::prelude::*;

use super::conjugate::LinearPrior;
use super::em::{self, Stopping};
use super::error::ModelError;
use super::linalg::{LN_2PI, cholesky, log_sum_exp, lower_inverse};
pub use points::Points;
pub use select::{Criterion, Selected, select};
use step::Steps;

/// Shape of the covariances.
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

/// Normal-inverse-Wishart prior of every component, in units of the data.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Prior {
    /// κ: how many rows at the overall mean each component has seen.
    pub mean: f64,
    /// ψ: scatter (squared units) that each coordinate of each component has seen.
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Shape of the covariances.
    pub covariance: Covariance,
    /// Number of k-means++ starts.
    pub restarts: usize,
    /// Prior of every component.
    pub prior: Prior,
    /// When EM stops.
    pub stopping: Stopping,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            covariance: Covariance::Full,
            restarts: 5,
            prior: Prior::default(),
            stopping: Stopping::default(),
        }
    }
}

/// A Gaussian mixture.
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

/// Result of [`fit`].
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
/// # Errors
/// [`ModelError::TooFewRows`] for fewer rows than components; a prior out of range.
///
/// # Examples
/// ```
/// use edifice::model::gmm::{Points, Settings, fit};
/// use edifice::rng::stream;
/// let values: Vec<f64> = (0..40).map(|i| if i % 2 == 0 { 0.0 } else { 9.0 } + (i % 5) as f64 / 10.0).collect();
/// let fitted = fit(&Points::new(1, &values)?, 2, &Settings::default(), &mut stream(1, "gmm", 0))?;
/// let mut means: Vec<f64> = (0..2).map(|k| fitted.mixture.mean(k)[0]).collect();
/// means.sort_by(f64::total_cmp);
/// assert!((means[0] - 0.2).abs() < 0.01 && (means[1] - 9.2).abs() < 0.01);
/// # Ok::<(), edifice::model::ModelError>(())
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
    Ok(steps.result(em::restarts(&steps, starts?, &settings.stopping)?))
}

/// Runs EM from a given mixture.
///
/// # Errors
/// A start of another dimension or shape of covariance; a prior out of range.
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
    Ok(steps.result(em::run(&steps, start, &settings.stopping)?))
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

    /// `log (w_k N(x; μ_k, Σ_k))` of every component.
    fn log_joint(&self, x: &[f64]) -> Vec<f64> {
        let d = self.d;
        (0..self.components())
            .map(|k| {
                let (w, mean) = (self.whitening_of(k), self.mean(k));
                let quad: f64 = (0..d)
                    .map(|i| {
                        (0..=i)
                            .map(|j| w[i * d + j] * (x[j] - mean[j]))
                            .sum::<f64>()
                            .powi(2)
                    })
                    .sum();
                self.log_norms[k] - 0.5 * quad
            })
            .collect()
    }

    /// `log p(x)` of every row, nats.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for points of another dimension.
    pub fn log_density(&self, points: &Points) -> Result<Vec<f64>, ModelError> {
        self.check(points)?;
        let rows: Vec<&[f64]> = points.rows().collect();
        Ok(rows
            .par_iter()
            .map(|x| log_sum_exp(&self.log_joint(x)))
            .collect())
    }

    /// P(k | x) of every row.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for points of another dimension.
    pub fn posterior(&self, points: &Points) -> Result<Vec<Vec<f64>>, ModelError> {
        self.check(points)?;
        Ok(points
            .rows()
            .map(|x| {
                let logs = self.log_joint(x);
                let total = log_sum_exp(&logs);
                logs.iter().map(|l| (l - total).exp()).collect()
            })
            .collect())
    }

    fn check(&self, points: &Points) -> Result<(), ModelError> {
        if points.dimension() != self.d {
            return Err(ModelError::parameter(
                "points",
                format!("must have {} values", self.d),
            ));
        }
        Ok(())
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
        let total = log_sum_exp(&logs);
        let mut rows = Vec::with_capacity(count * d);
        for _ in 0..count {
            let mut at = rng.random::<f64>();
            let k = logs
                .iter()
                .position(|l| {
                    at -= (l - total).exp();
                    at < 0.0
                })
                .unwrap_or(logs.len() - 1);
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
