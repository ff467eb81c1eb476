//! Rows with missing coordinates: the density of what is observed, and expectations of the rest.
//!
//! With o the observed and m the missing coordinates of a row, and Σ_oo = L Lᵀ,
//!
//! ```text
//! z = L⁻¹(x_o - μ_o),   log N(x_o; μ_o, Σ_oo) = -|o|/2 log 2π - log|L| - |z|²/2
//! G = Σ_mo L⁻ᵀ,         E[x_m | x_o] = μ_m + G z,      Cov[x_m | x_o] = Σ_mm - G Gᵀ
//! ```
//! The E step adds `r E[u uᵀ]`, so that EM climbs the likelihood of the observed values (Ghahramani and Jordan 1994,
//! *Supervised learning from incomplete data via an EM approach*, Sec. 3). Rows that lack the same coordinates share the
//! factorizations.

use super::super::linalg::{LN_2PI, cholesky, lower_inverse};
use super::block::NEGLIGIBLE;
use super::mixture::Mixture;
use super::problem::{Moments, Steps, add_row};
use super::settings::Covariance;

/// The coordinates of a row that are observed, and those that are missing.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Pattern {
    observed: Vec<usize>,
    missing: Vec<usize>,
}

impl Pattern {
    pub(super) fn of(x: &[f64]) -> Self {
        let (missing, observed) = (0..x.len()).partition(|&i| x[i].is_nan());
        Self { observed, missing }
    }
}

/// Density of the observed coordinates under every component.
pub(super) struct Marginals {
    pattern: Pattern,
    components: Vec<Marginal>,
}

struct Marginal {
    /// `log w_k - |o|/2 log 2π - log|L|`.
    norm: f64,
    /// L⁻¹.
    whitening: Vec<f64>,
}

impl Marginals {
    pub(super) fn new(model: &Mixture, pattern: Pattern) -> Self {
        let (d, o) = (model.d, pattern.observed.len());
        let components = (0..model.components()).map(|k| {
            let mut l = submatrix(model.covariance(k), d, &pattern.observed, &pattern.observed);
            // A principal submatrix of a positive definite matrix is one.
            cholesky(&mut l, o);
            let half: f64 = (0..o).map(|i| l[i * o + i].ln()).sum();
            Marginal {
                norm: model.weights[k].ln() - 0.5 * o as f64 * LN_2PI - half,
                whitening: lower_inverse(&l, o),
            }
        });
        Self {
            components: components.collect(),
            pattern,
        }
    }

    pub(super) fn fits(&self, x: &[f64]) -> bool {
        self.pattern.observed.iter().all(|&i| !x[i].is_nan())
            && self.pattern.missing.iter().all(|&i| x[i].is_nan())
    }

    /// `log (w_k N(x_o; μ_k, Σ_k))` of every component.
    pub(super) fn log_joint(&self, model: &Mixture, x: &[f64]) -> Vec<f64> {
        let mut z = vec![0.0; self.pattern.observed.len()];
        (0..self.components.len())
            .map(|k| self.whiten(model, k, x, &mut z))
            .collect()
    }

    /// The whitened residual under component `k`; returns its log joint.
    fn whiten(&self, model: &Mixture, k: usize, x: &[f64], z: &mut [f64]) -> f64 {
        let o = z.len();
        let (mean, marginal) = (model.mean(k), &self.components[k]);
        for (i, z) in z.iter_mut().enumerate() {
            let row = &marginal.whitening[i * o..i * o + i + 1];
            let residual = self.pattern.observed.iter().map(|&j| x[j] - mean[j]);
            *z = row.iter().zip(residual).map(|(w, r)| w * r).sum();
        }
        marginal.norm - 0.5 * z.iter().map(|v| v * v).sum::<f64>()
    }
}

/// The regression of the missing coordinates on the observed ones under one component.
struct Regression {
    /// G, |m| x |o|.
    gain: Vec<f64>,
    /// Covariance of the missing coordinates given the observed ones, |m| x |m|.
    covariance: Vec<f64>,
}

impl Regression {
    fn new(model: &Mixture, marginals: &Marginals, k: usize) -> Self {
        let Pattern { observed, missing } = &marginals.pattern;
        let (o, m, d) = (observed.len(), missing.len(), model.d);
        let cross = submatrix(model.covariance(k), d, missing, observed);
        let w = &marginals.components[k].whitening;
        let mut gain = vec![0.0; m * o];
        for (gain, cross) in gain.chunks_mut(o.max(1)).zip(cross.chunks(o.max(1))) {
            for (i, g) in gain.iter_mut().enumerate() {
                *g = (0..=i).map(|j| w[i * o + j] * cross[j]).sum();
            }
        }
        let mut covariance = submatrix(model.covariance(k), d, missing, missing);
        for a in 0..m {
            for b in 0..m {
                let explained: f64 = (0..o).map(|i| gain[a * o + i] * gain[b * o + i]).sum();
                covariance[a * m + b] -= explained;
            }
        }
        Self { gain, covariance }
    }
}

impl Steps<'_> {
    /// Both steps' sums over rows that lack the same coordinates.
    pub(super) fn incomplete(&self, model: &Mixture, rows: &[usize], moments: &mut Moments) {
        let Some(&first) = rows.first() else { return };
        let d = model.d;
        let marginals = Marginals::new(model, Pattern::of(self.points.row(first)));
        let Pattern { observed, missing } = &marginals.pattern;
        let (o, m) = (observed.len(), missing.len());
        let regressions: Vec<Regression> = (0..self.k)
            .map(|k| Regression::new(model, &marginals, k))
            .collect();
        let mut x = vec![0.0; d];
        let mut u = vec![1.0; d + 1];
        let mut z = vec![0.0; self.k * o];
        let mut logs = vec![0.0; self.k];
        for &row in rows {
            for ((x, v), c) in x.iter_mut().zip(self.points.row(row)).zip(&self.centre) {
                *x = v - c;
            }
            for (k, log) in logs.iter_mut().enumerate() {
                *log = marginals.whiten(model, k, &x, &mut z[k * o..(k + 1) * o]);
            }
            let weight = self.points.weight(row);
            let total = super::super::linalg::log_sum_exp(&logs);
            moments.log_likelihood += weight * total;
            for (k, regression) in regressions.iter().enumerate() {
                let r = weight * (logs[k] - total).exp();
                if r <= NEGLIGIBLE {
                    continue;
                }
                let (z, mean) = (&z[k * o..(k + 1) * o], model.mean(k));
                for &i in observed {
                    u[i + 1] = x[i];
                }
                for (a, &i) in missing.iter().enumerate() {
                    let gain = &regression.gain[a * o..(a + 1) * o];
                    u[i + 1] = mean[i] + gain.iter().zip(z).map(|(g, z)| g * z).sum::<f64>();
                }
                let sums = &mut moments.sums[k];
                add_row(sums, &u, r, model.kind);
                for (a, &i) in missing.iter().enumerate() {
                    for (b, &j) in missing[..=a].iter().enumerate() {
                        let left = r * regression.covariance[a * m + b];
                        match model.kind {
                            Covariance::Diagonal if i == j => sums[1 + d + i] += left,
                            Covariance::Diagonal => {}
                            _ => sums[(i + 1) * (d + 1) + j + 1] += left,
                        }
                    }
                }
            }
        }
    }
}

fn submatrix(matrix: &[f64], d: usize, rows: &[usize], columns: &[usize]) -> Vec<f64> {
    let cells = rows
        .iter()
        .flat_map(|&i| columns.iter().map(move |&j| matrix[i * d + j]));
    cells.collect()
}
