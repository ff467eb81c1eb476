//! Conjugate families: maximum a posteriori parameters and closed-form marginal likelihoods from
//! (expected) sufficient statistics.
//!
//! **Tables.** Counts n₁..n_K with prior Dirichlet(α, .., α):
//! mode `(n_k + α - 1) / (n + Kα - K)`, evidence
//! `log Γ(Kα) - log Γ(Kα + n) + Σ log Γ(α + n_k) - log Γ(α)`.
//!
//! **Linear Gaussian.** y (d values) given x (p values, the first always 1): y ~ N(Bᵀx, Σ), with
//! Σ ~ IW(ψI, ν), B | Σ ~ MN(0, Λ₀⁻¹, Σ), Λ₀ = diag(κ, λ, .., λ): the matrix-normal
//! inverse-Wishart; without parents (p = 1) the normal-inverse-Wishart. The statistics are the
//! scatter matrix `Σ w u uᵀ` of u = (x, y), whose first entry is the weight n. With the factor L
//! of `scatter + diag(Λ₀, ψI)`, the leading p x p block of L holds log|Λ_n|, the trailing d x d
//! block is a factor of Ψ_n, and B solves `L₁₁ᵀ B = L₂₁ᵀ`.
//! Mode `Σ = Ψ_n / (ν + n + d + 1 + p)`, evidence
//! `-nd/2 log π + d/2 (log|Λ₀| - log|Λ_n|) + ν/2 log|ψI| - (ν+n)/2 log|Ψ_n| + log Γ_d((ν+n)/2) - log Γ_d(ν/2)`.
//!
//! Sources: Heckerman 1998; Murphy, *Machine Learning* (2012), Sec. 4.6 and 7.6.

use statrs::function::gamma::ln_gamma;

use super::error::ModelError;
use super::linalg::{LN_2PI, cholesky, ln_gamma_d, lower_inverse};

/// Most probable table under a symmetric Dirichlet(α) prior, α ≥ 1; uniform without any counts
/// at α = 1.
///
/// K counts, which may be fractions; O(K).
/// ```
/// use edifice_model::conjugate::dirichlet_mode;
/// assert_eq!(dirichlet_mode(&[3.0, 1.0], 1.0), [0.75, 0.25]);
/// assert_eq!(dirichlet_mode(&[3.0, 0.0], 1.5), [0.875, 0.125]);
/// ```
pub fn dirichlet_mode(counts: &[f64], alpha: f64) -> Vec<f64> {
    let total: f64 = counts.iter().map(|n| n + alpha - 1.0).sum();
    if total <= 0.0 {
        return vec![1.0 / counts.len() as f64; counts.len()];
    }
    counts.iter().map(|n| (n + alpha - 1.0) / total).collect()
}

/// `log P(counts)` (of one ordered sequence) under a symmetric Dirichlet(α) prior.
///
/// In nats, O(K). At α = 1, K = 2 it is `1 / ((n + 1) C(n, n₁))`:
/// ```
/// use edifice_model::conjugate::dirichlet_evidence;
/// assert!((dirichlet_evidence(&[2.0, 1.0], 1.0) - (1.0_f64 / 12.0).ln()).abs() < 1e-12);
/// ```
pub fn dirichlet_evidence(counts: &[f64], alpha: f64) -> f64 {
    let sum_alpha = alpha * counts.len() as f64;
    let n: f64 = counts.iter().sum();
    ln_gamma(sum_alpha) - ln_gamma(sum_alpha + n)
        + counts
            .iter()
            .map(|c| ln_gamma(alpha + c) - ln_gamma(alpha))
            .sum::<f64>()
}

/// Log density of a table under a symmetric Dirichlet(α) prior.
///
/// `log Γ(Kα) - K log Γ(α) + (α - 1) Σ log p_k`; 0 nats for K = 2, α = 1. O(K).
pub fn dirichlet_log_density(table: &[f64], alpha: f64) -> f64 {
    let k = table.len() as f64;
    let sum = if alpha == 1.0 {
        0.0
    } else {
        table.iter().map(|p| (alpha - 1.0) * p.ln()).sum::<f64>()
    };
    ln_gamma(alpha * k) - k * ln_gamma(alpha) + sum
}

/// Prior of a linear Gaussian, on the scale of the data.
///
/// All scatter matrices are (p + d) x (p + d), row-major, x first; each function is O((p + d)³). [`Priors::default`] has values.
/// ```
/// use edifice_model::conjugate::Priors;
/// // y = 1, 3 without parents: u = (1, y), scatter [2, 4; 4, 10]. Mean 4 / (2 + κ), κ = 0.01.
/// let linear = Priors::default().linear.mode(&[2.0, 4.0, 4.0, 10.0], 1, 1);
/// assert!(linear.is_some_and(|l| (l.coefficients()[0] - 4.0 / 2.01).abs() < 1e-12));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LinearPrior {
    /// κ: how many observations the prior mean 0 of the intercept is worth.
    pub intercept: f64,
    /// λ: the same for each slope.
    pub slope: f64,
    /// ψ: prior scatter of every coordinate.
    pub scatter: f64,
    /// Degrees of freedom ν beyond `d - 1` (greater than 0).
    pub freedom: f64,
}

impl LinearPrior {
    fn nu(&self, d: usize) -> f64 {
        self.freedom + d as f64 - 1.0
    }

    fn precision(&self, i: usize) -> f64 {
        if i == 0 { self.intercept } else { self.slope }
    }

    fn log_det_precision(&self, p: usize) -> f64 {
        (0..p).map(|i| self.precision(i).ln()).sum()
    }

    /// Adds Λ₀ and ψI to the diagonal of a scatter matrix of side p + d and factors it. The
    /// diagonal is raised by a trillionth where rounding has made the matrix indefinite.
    pub(crate) fn factor(&self, scatter: &[f64], p: usize, d: usize) -> Option<Vec<f64>> {
        let q = p + d;
        let mut raise = 0.0;
        for _ in 0..5 {
            let mut a = scatter.to_vec();
            for i in 0..q {
                let prior = if i < p {
                    self.precision(i)
                } else {
                    self.scatter
                };
                a[i * q + i] = (a[i * q + i] + prior) * (1.0 + raise);
            }
            if cholesky(&mut a, q) {
                return Some(a);
            }
            raise = if raise == 0.0 { 1e-12 } else { raise * 100.0 };
        }
        None
    }

    /// `log P(y | x)` integrated over B and Σ; `None` for a scatter matrix that is none.
    pub fn evidence(&self, scatter: &[f64], p: usize, d: usize) -> Option<f64> {
        let q = p + d;
        let l = self.factor(scatter, p, d)?;
        let (n, nu) = (scatter[0], self.nu(d));
        let log_det = |range: std::ops::Range<usize>| -> f64 {
            2.0 * range.map(|i| l[i * q + i].ln()).sum::<f64>()
        };
        let df = d as f64;
        Some(
            -0.5 * n * df * std::f64::consts::PI.ln()
                + 0.5 * df * (self.log_det_precision(p) - log_det(0..p))
                + 0.5 * nu * df * self.scatter.ln()
                - 0.5 * (nu + n) * log_det(p..q)
                + ln_gamma_d(d, 0.5 * (nu + n))
                - ln_gamma_d(d, 0.5 * nu),
        )
    }

    /// The joint mode of B and Σ.
    pub fn mode(&self, scatter: &[f64], p: usize, d: usize) -> Option<Linear> {
        let q = p + d;
        let l = self.factor(scatter, p, d)?;
        let mut coefficients = vec![0.0; p * d];
        for j in 0..d {
            for i in (0..p).rev() {
                let mut sum = l[(p + j) * q + i];
                for k in i + 1..p {
                    sum -= l[k * q + i] * coefficients[k * d + j];
                }
                coefficients[i * d + j] = sum / l[i * q + i];
            }
        }
        let weight = 1.0 / (self.nu(d) + scatter[0] + (d + 1 + p) as f64);
        let mut covariance = vec![0.0; d * d];
        for i in 0..d {
            for j in 0..=i {
                let dot: f64 = (0..=j)
                    .map(|k| l[(p + i) * q + p + k] * l[(p + j) * q + p + k])
                    .sum();
                covariance[i * d + j] = dot * weight;
                covariance[j * d + i] = dot * weight;
            }
        }
        Linear::new(p, d, coefficients, covariance)
    }

    /// Log density of B and Σ.
    pub fn log_density(&self, linear: &Linear) -> f64 {
        let (p, d) = (linear.p, linear.d);
        let (pf, df, nu) = (p as f64, d as f64, self.nu(d));
        let log_det = linear.log_det();
        let w = &linear.whitening;
        let trace: f64 = w.iter().map(|v| v * v).sum();
        let mut quad = 0.0;
        for i in 0..p {
            let b = &linear.coefficients[i * d..(i + 1) * d];
            let norm: f64 = (0..d)
                .map(|r| (0..=r).map(|c| w[r * d + c] * b[c]).sum::<f64>().powi(2))
                .sum();
            quad += self.precision(i) * norm;
        }
        0.5 * nu * df * self.scatter.ln()
            - 0.5 * nu * df * std::f64::consts::LN_2
            - ln_gamma_d(d, 0.5 * nu)
            - 0.5 * (nu + df + 1.0 + pf) * log_det
            - 0.5 * self.scatter * trace
            - 0.5 * pf * df * LN_2PI
            + 0.5 * df * self.log_det_precision(p)
            - 0.5 * quad
    }
}

/// A linear Gaussian y ~ N(Bᵀx, Σ), x with a leading 1.
///
/// B is p x d and Σ d x d, row-major; [`LinearPrior::mode`] makes one, in the example of [`LinearPrior`].
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Length of x.
    pub(crate) p: usize,
    /// Length of y.
    pub(crate) d: usize,
    /// B, p x d.
    pub(crate) coefficients: Vec<f64>,
    /// Σ, d x d.
    pub(crate) covariance: Vec<f64>,
    /// W = inverse of the Cholesky factor of Σ, so that W (y - Bᵀx) is standard normal.
    pub(crate) whitening: Vec<f64>,
    /// `-d/2 log 2π - 1/2 log|Σ|`.
    pub(crate) log_norm: f64,
}

impl Linear {
    /// From B (p x d) and Σ (d x d), row-major; `None` when a size is wrong, a value is not finite
    /// or Σ is not positive definite.
    pub fn new(p: usize, d: usize, coefficients: Vec<f64>, covariance: Vec<f64>) -> Option<Self> {
        let sized = p >= 1 && coefficients.len() == p * d && covariance.len() == d * d;
        if !sized || !coefficients.iter().all(|v| v.is_finite()) {
            return None;
        }
        let mut l = covariance.clone();
        if !cholesky(&mut l, d) {
            return None;
        }
        let whitening = lower_inverse(&l, d);
        let log_det: f64 = (0..d).map(|i| whitening[i * d + i].ln()).sum();
        Some(Self {
            p,
            d,
            coefficients,
            covariance,
            whitening,
            log_norm: -0.5 * d as f64 * LN_2PI + log_det,
        })
    }

    /// B, row-major, p x d.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Σ, row-major, d x d.
    pub fn covariance(&self) -> &[f64] {
        &self.covariance
    }

    /// `log|Σ|`.
    fn log_det(&self) -> f64 {
        -2.0 * (self.log_norm + 0.5 * self.d as f64 * LN_2PI)
    }

    /// The greatest log density of the chosen coordinates of y, whatever x is; 0 of none.
    pub(crate) fn log_peak(&self, chosen: &[usize]) -> f64 {
        let (d, k) = (self.d, chosen.len());
        if k == d {
            return self.log_norm;
        }
        let mut l = Vec::with_capacity(k * k);
        for &i in chosen {
            l.extend(chosen.iter().map(|&j| self.covariance[i * d + j]));
        }
        match cholesky(&mut l, k) {
            true => {
                let log_det: f64 = (0..k).map(|i| l[i * k + i].ln()).sum();
                -0.5 * k as f64 * LN_2PI - log_det
            }
            false => f64::INFINITY,
        }
    }

    /// Bᵀx for u = (x, ..).
    pub(crate) fn mean(&self, u: &[f64], mean: &mut [f64]) {
        mean.copy_from_slice(&self.coefficients[..self.d]);
        let slopes = self.coefficients[self.d..].chunks_exact(self.d);
        for (b, x) in slopes.zip(&u[1..]) {
            for (m, b) in mean.iter_mut().zip(b) {
                *m += b * x;
            }
        }
    }

    /// `log N(y; Bᵀx, Σ)` for u = (x, y); `residual` is scratch of length d.
    pub(crate) fn log_density(&self, u: &[f64], residual: &mut [f64]) -> f64 {
        let d = self.d;
        self.mean(u, residual);
        for (r, y) in residual.iter_mut().zip(&u[self.p..]) {
            *r = y - *r;
        }
        let mut quad = 0.0;
        for i in 0..d {
            let w = &self.whitening[i * d..i * d + i + 1];
            let z: f64 = w.iter().zip(residual.iter()).map(|(w, r)| w * r).sum();
            quad += z * z;
        }
        self.log_norm - 0.5 * quad
    }

    /// Expected `Σ w log N(y; Bᵀx, Σ)` given the scatter matrix `Σ w u uᵀ` (lower triangle).
    pub fn expected_log_likelihood(&self, scatter: &[f64]) -> f64 {
        let (p, d, q) = (self.p, self.d, self.p + self.d);
        let at = |i: usize, j: usize| scatter[i.max(j) * q + i.min(j)];
        // Rows of R are the coefficients of (y - Bᵀx) on u, whitened; trace = Σ R S Rᵀ.
        let mut trace = 0.0;
        let mut r = vec![0.0; q];
        for k in 0..d {
            let w = &self.whitening[k * d..(k + 1) * d];
            for (i, r) in r.iter_mut().enumerate() {
                *r = if i < p {
                    -(0..=k)
                        .map(|j| w[j] * self.coefficients[i * d + j])
                        .sum::<f64>()
                } else if i - p <= k {
                    w[i - p]
                } else {
                    0.0
                };
            }
            for i in 0..q {
                trace += r[i] * r[i] * at(i, i);
                for j in 0..i {
                    trace += 2.0 * r[i] * r[j] * at(i, j);
                }
            }
        }
        scatter[0] * self.log_norm - 0.5 * trace
    }
}

/// Priors of every parameter; real columns are on the standardised scale (mean 0, deviation 1).
///
/// The example of [`LinearPrior`] uses the default.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Priors {
    /// α of every table, at least 1 (1 is uniform; greater keeps probabilities off zero).
    pub dirichlet: f64,
    /// Normal-inverse-Wishart prior of every real group.
    pub linear: LinearPrior,
}

impl Default for Priors {
    fn default() -> Self {
        Self {
            dirichlet: 1.2,
            linear: LinearPrior {
                intercept: 0.01,
                slope: 1.0,
                scatter: 0.1,
                freedom: 3.0,
            },
        }
    }
}

impl Priors {
    /// Checks that every hyperparameter is in its range.
    ///
    /// # Errors
    /// [`ModelError::Parameter`].
    pub fn check(&self) -> Result<(), ModelError> {
        if !(self.dirichlet >= 1.0 && self.dirichlet.is_finite()) {
            return Err(ModelError::parameter("dirichlet", "must be at least 1"));
        }
        let l = &self.linear;
        for (name, value) in [
            ("intercept", l.intercept),
            ("slope", l.slope),
            ("scatter", l.scatter),
            ("freedom", l.freedom),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ModelError::parameter(name, "must be positive and finite"));
            }
        }
        Ok(())
    }
}
