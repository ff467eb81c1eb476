//! Small dense matrices in row-major slices: what the inner loops need and no more.

use rand::{Rng, RngExt};

/// Cholesky factor of the symmetric matrix whose lower triangle is in `a` (n x n), in place:
/// afterwards the lower triangle holds L with L Lᵀ = a. False when `a` is not positive definite.
pub(crate) fn cholesky(a: &mut [f64], n: usize) -> bool {
    for j in 0..n {
        for i in j..n {
            let mut sum = a[i * n + j];
            for k in 0..j {
                sum -= a[i * n + k] * a[j * n + k];
            }
            if i == j {
                if !(sum > 0.0 && sum.is_finite()) {
                    return false;
                }
                a[j * n + j] = sum.sqrt();
            } else {
                a[i * n + j] = sum / a[j * n + j];
            }
        }
    }
    true
}

/// Inverse of the lower triangular matrix `l` (n x n); the upper triangle of the result is zero.
pub(crate) fn lower_inverse(l: &[f64], n: usize) -> Vec<f64> {
    let mut inverse = vec![0.0; n * n];
    for j in 0..n {
        inverse[j * n + j] = 1.0 / l[j * n + j];
        for i in j + 1..n {
            let mut sum = 0.0;
            for k in j..i {
                sum -= l[i * n + k] * inverse[k * n + j];
            }
            inverse[i * n + j] = sum / l[i * n + i];
        }
    }
    inverse
}

/// `log Σ exp(x)`, with -∞ for an empty or all -∞ slice.
pub(crate) fn log_sum_exp(x: &[f64]) -> f64 {
    let max = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if max == f64::NEG_INFINITY {
        return max;
    }
    max + x.iter().map(|v| (v - max).exp()).sum::<f64>().ln()
}

/// `log Γ_d(x)`, the multivariate gamma function.
pub(crate) fn ln_gamma_d(d: usize, x: f64) -> f64 {
    let constant = (d * d.saturating_sub(1)) as f64 / 4.0 * std::f64::consts::PI.ln();
    constant
        + (0..d)
            .map(|j| statrs::function::gamma::ln_gamma(x - j as f64 / 2.0))
            .sum::<f64>()
}

/// `log 2π`.
pub(crate) const LN_2PI: f64 = 1.837_877_066_409_345_3;

/// An index drawn in proportion to `exp(logs)`; the last of positive weight where rounding runs out.
pub(crate) fn categorical_of_logs<R: Rng>(logs: &[f64], rng: &mut R) -> usize {
    let total = log_sum_exp(logs);
    let mut at = rng.random::<f64>();
    let mut last = 0;
    for (i, l) in logs
        .iter()
        .enumerate()
        .filter(|(_, l)| **l > f64::NEG_INFINITY)
    {
        last = i;
        at -= (l - total).exp();
        if at < 0.0 {
            break;
        }
    }
    last
}

/// An index drawn by probabilities; the last positive one where rounding runs out.
pub(crate) fn categorical<R: Rng>(probabilities: &[f64], rng: &mut R) -> usize {
    let mut at = rng.random::<f64>();
    let mut last = 0;
    for (i, p) in probabilities.iter().enumerate().filter(|(_, p)| **p > 0.0) {
        last = i;
        at -= p;
        if at < 0.0 {
            break;
        }
    }
    last
}
