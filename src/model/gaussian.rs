//! Gaussians over the missing values of a row: extended by a linear Gaussian, conditioned on what is
//! observed, summed into sufficient statistics, drawn from.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::conjugate::Linear;
use super::linalg::{LN_2PI, cholesky};

/// An assignment of states to the groups of a component, with the Gaussian of its missing values.
#[derive(Clone, Debug)]
pub(crate) struct Particle {
    /// `log p(observed values of the component | states)`.
    pub log_density: f64,
    /// States, in the order of [`Component::groups`].
    pub states: Vec<usize>,
    /// Posterior mean of the missing values, in the order of [`Component::missing`].
    pub mean: Vec<f64>,
    /// Their posterior covariance, row-major.
    pub cov: Vec<f64>,
}

impl Particle {
    /// No states, nothing missing.
    pub fn empty() -> Self {
        Self {
            log_density: 0.0,
            states: Vec::new(),
            mean: Vec::new(),
            cov: Vec::new(),
        }
    }
}

/// E[u uᵀ] under `particle`, u = (1, columns), lower triangle added to `scatter` times `weight`;
/// `missing` are the columns the particle's Gaussian is over.
pub(crate) fn add_scatter(
    particle: &Particle,
    missing: &[usize],
    columns: &[usize],
    real: &[f64],
    weight: f64,
    scatter: &mut [f64],
) {
    let q = columns.len() + 1;
    let place: Vec<Option<usize>> = std::iter::once(None)
        .chain(columns.iter().map(|c| missing.iter().position(|m| m == c)))
        .collect();
    let u: Vec<f64> = (0..q)
        .map(|i| match place[i] {
            Some(m) => particle.mean[m],
            None if i == 0 => 1.0,
            None => real[columns[i - 1]],
        })
        .collect();
    let m = missing.len();
    for i in 0..q {
        for j in 0..=i {
            let mut v = u[i] * u[j];
            if let (Some(a), Some(b)) = (place[i], place[j]) {
                v += particle.cov[a * m + b];
            }
            scatter[i * q + j] += weight * v;
        }
    }
}

/// Extends a particle by a group with Gaussian `linear`, conditioned on the group's own values.
pub(crate) fn extend(
    particle: &Particle,
    missing: &[usize],
    columns: &[usize],
    linear: &Linear,
    real: &[f64],
) -> Particle {
    let (m, p, d) = (missing.len(), linear.p, linear.d);
    // Mean of y, and slopes on the values that are still missing.
    let mut mean_y = linear.coefficients[..d].to_vec();
    let mut slopes = vec![0.0; m * d];
    for (i, column) in columns[..p - 1].iter().enumerate() {
        let b = &linear.coefficients[(i + 1) * d..(i + 2) * d];
        let place = missing.iter().position(|c| c == column);
        let x = place.map_or(real[*column], |k| particle.mean[k]);
        for j in 0..d {
            mean_y[j] += b[j] * x;
            if let Some(k) = place {
                slopes[k * d + j] = b[j];
            }
        }
    }
    // cross = C B (m x d), cov_y = Bᵀ C B + Σ.
    let mut cross = vec![0.0; m * d];
    for a in 0..m {
        for k in 0..m {
            let c = particle.cov[a * m + k];
            for j in 0..d {
                cross[a * d + j] += c * slopes[k * d + j];
            }
        }
    }
    let mut cov_y = linear.covariance.clone();
    for a in 0..m {
        for i in 0..d {
            for j in 0..d {
                cov_y[i * d + j] += slopes[a * d + i] * cross[a * d + j];
            }
        }
    }
    let own = &columns[p - 1..];
    let seen: Vec<usize> = (0..d).filter(|&j| !real[own[j]].is_nan()).collect();
    let gone: Vec<usize> = (0..d).filter(|&j| real[own[j]].is_nan()).collect();
    // Joint over the old and the new missing values, then conditioned on the seen ones.
    let t = m + gone.len();
    let mut mean = particle.mean.clone();
    mean.extend(gone.iter().map(|&j| mean_y[j]));
    let mut cov = vec![0.0; t * t];
    for a in 0..t {
        for b in 0..=a {
            let v = match (a < m, b < m) {
                (true, _) => particle.cov[a * m + b],
                (false, true) => cross[b * d + gone[a - m]],
                (false, false) => cov_y[gone[a - m] * d + gone[b - m]],
            };
            cov[a * t + b] = v;
            cov[b * t + a] = v;
        }
    }
    let o = seen.len();
    let mut l = vec![0.0; o * o];
    for (a, &i) in seen.iter().enumerate() {
        for (b, &j) in seen.iter().enumerate() {
            l[a * o + b] = cov_y[i * d + j];
        }
    }
    let mut log_density = particle.log_density;
    if o > 0 && !cholesky(&mut l, o) {
        log_density = f64::NEG_INFINITY;
    } else {
        // Rows: whitened residual, and whitened covariances with each missing value.
        let whiten = |v: &mut [f64]| {
            for i in 0..o {
                let dot: f64 = (0..i).map(|k| l[i * o + k] * v[k]).sum();
                v[i] = (v[i] - dot) / l[i * o + i];
            }
        };
        let mut z: Vec<f64> = seen.iter().map(|&j| real[own[j]] - mean_y[j]).collect();
        whiten(&mut z);
        log_density -= 0.5 * (o as f64 * LN_2PI + z.iter().map(|v| v * v).sum::<f64>());
        log_density -= (0..o).map(|i| l[i * o + i].ln()).sum::<f64>();
        let gains: Vec<Vec<f64>> = (0..t)
            .map(|a| {
                let mut v: Vec<f64> = seen
                    .iter()
                    .map(|&j| {
                        if a < m {
                            cross[a * d + j]
                        } else {
                            cov_y[gone[a - m] * d + j]
                        }
                    })
                    .collect();
                whiten(&mut v);
                v
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        for a in 0..t {
            mean[a] += dot(&gains[a], &z);
            for b in 0..t {
                cov[a * t + b] -= dot(&gains[a], &gains[b]);
            }
        }
    }
    Particle {
        log_density,
        states: particle.states.clone(),
        mean,
        cov,
    }
}

/// A draw from N(mean, cov); directions in which `cov` is singular stay at the mean.
pub(crate) fn gaussian<R: Rng>(mean: &[f64], cov: &[f64], rng: &mut R) -> Vec<f64> {
    let n = mean.len();
    let mut l = cov.to_vec();
    let mut raise = 1e-14;
    while !cholesky(&mut l, n) {
        l.copy_from_slice(cov);
        for i in 0..n {
            l[i * n + i] += raise * (1.0 + cov[i * n + i].abs());
        }
        raise *= 100.0;
    }
    let z: Vec<f64> = (0..n).map(|_| rng.sample(StandardNormal)).collect();
    (0..n)
        .map(|i| mean[i] + (0..=i).map(|j| l[i * n + j] * z[j]).sum::<f64>())
        .collect()
}
