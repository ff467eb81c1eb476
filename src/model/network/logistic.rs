//! Weights of a softmax from weighted cases: multinomial logistic regression by Newton's method.
//!
//! ```text
//! max_w Σ_i Σ_k r_ik log P(k | x_i; w) - λ/2 Σ w²,     P(k | x; w) ∝ exp(w_kᵀ (1, x))
//! gradient  Σ_i (r_ik - n_i P_ik) (1, x_i) - λ w_k,     n_i = Σ_k r_ik
//! -Hessian  Σ_i n_i (diag(P_i) - P_i P_iᵀ) ⊗ (1, x_i)(1, x_i)ᵀ + λ I
//! ```
//! The objective is strictly concave, so that the maximum is one and no start matters. A round takes `O(n (K p)²)` for n
//! cases, K categories and p inputs with the constant.
//!
//! Source: Bishop 2006, *Pattern Recognition and Machine Learning*, Sec. 4.3.4.

use super::super::linalg::cholesky;

/// Precision λ of the Gaussian prior of every weight, for standardised inputs: weights of up to 10 cost little.
pub(super) const PRECISION: f64 = 0.01;
/// Newton steps; few are needed.
const ROUNDS: usize = 100;
/// A step that gains less than this share of the objective is the last.
const SETTLED: f64 = 1e-13;

/// Inputs of one row, and how much of it belongs to each category.
#[derive(Clone, Debug)]
pub(super) struct Case {
    /// (1, x).
    pub inputs: Vec<f64>,
    /// r_k.
    pub shares: Vec<f64>,
}

/// The weights of highest objective, category by category, from `start`.
pub(super) fn fit(start: &[f64], cases: &[Case]) -> Vec<f64> {
    let mut weights = start.to_vec();
    let mut now = objective(&weights, cases);
    for _ in 0..ROUNDS {
        let Some(step) = newton(&weights, cases) else {
            return weights;
        };
        // A full step overshoots where the objective is far from quadratic.
        let mut length = 1.0;
        let better = loop {
            let moved: Vec<f64> = weights
                .iter()
                .zip(&step)
                .map(|(w, s)| w + length * s)
                .collect();
            let value = objective(&moved, cases);
            if value > now {
                break Some((moved, value));
            }
            length /= 2.0;
            if length < 1e-6 {
                break None;
            }
        };
        let Some((moved, value)) = better else {
            return weights;
        };
        let gain = value - now;
        (weights, now) = (moved, value);
        if gain < SETTLED * now.abs() {
            return weights;
        }
    }
    weights
}

/// `log p(w)` up to a constant.
pub(super) fn log_prior(weights: &[f64]) -> f64 {
    -0.5 * PRECISION * weights.iter().map(|w| w * w).sum::<f64>()
}

fn objective(weights: &[f64], cases: &[Case]) -> f64 {
    let mut logs = Vec::new();
    let mut total = log_prior(weights);
    for case in cases {
        log_probabilities(weights, case, &mut logs);
        total += case
            .shares
            .iter()
            .zip(&logs)
            .map(|(r, l)| r * l)
            .sum::<f64>();
    }
    total
}

fn log_probabilities(weights: &[f64], case: &Case, logs: &mut Vec<f64>) {
    let p = case.inputs.len();
    logs.clear();
    logs.extend(
        weights
            .chunks(p)
            .map(|w| -> f64 { w.iter().zip(&case.inputs).map(|(w, x)| w * x).sum() }),
    );
    let total = super::super::linalg::log_sum_exp(logs);
    logs.iter_mut().for_each(|l| *l -= total);
}

/// The Newton step; `None` where the weights have left what can be represented.
fn newton(weights: &[f64], cases: &[Case]) -> Option<Vec<f64>> {
    let size = weights.len();
    let mut step: Vec<f64> = weights.iter().map(|w| -PRECISION * w).collect();
    let mut hessian = vec![0.0; size * size];
    for i in 0..size {
        hessian[i * size + i] = PRECISION;
    }
    let mut logs = Vec::new();
    for case in cases {
        log_probabilities(weights, case, &mut logs);
        let (p, k) = (case.inputs.len(), logs.len());
        let n: f64 = case.shares.iter().sum();
        let probability = |a: usize| logs[a].exp();
        for a in 0..k {
            let (own, residual) = (probability(a), case.shares[a] - n * probability(a));
            for (s, x) in step[a * p..(a + 1) * p].iter_mut().zip(&case.inputs) {
                *s += residual * x;
            }
            for b in 0..=a {
                let same = if a == b { own } else { 0.0 };
                let curvature = n * (same - own * probability(b));
                for (i, x) in case.inputs.iter().enumerate() {
                    let row = &mut hessian[(a * p + i) * size + b * p..][..p];
                    for (h, y) in row.iter_mut().zip(&case.inputs) {
                        *h += curvature * x * y;
                    }
                }
            }
        }
    }
    if !cholesky(&mut hessian, size) {
        return None;
    }
    // L Lᵀ step = gradient.
    for i in 0..size {
        let known: f64 = (0..i).map(|j| hessian[i * size + j] * step[j]).sum();
        step[i] = (step[i] - known) / hessian[i * size + i];
    }
    for i in (0..size).rev() {
        let known: f64 = (i + 1..size).map(|j| hessian[j * size + i] * step[j]).sum();
        step[i] = (step[i] - known) / hessian[i * size + i];
    }
    step.iter().all(|s| s.is_finite()).then_some(step)
}
