//! The information that negative chains give of the weights of a log-linear model.
//!
//! Let x be an example of `p(x; w*)` and x' the state of a chain that begins at x and leaves `p(x; w)` invariant,
//! reversibly. Near w* the mean of the gap `f(x) - f(x')` is `I (w* - w)` with
//!
//! ```text
//! I = 1/2 Cov(f(x) - f(x'))
//! ```
//!
//! For chains that forget their start I is the Fisher information `Cov_w(f)` (its mean, where each example has features of
//! its own space of states); for a move that resamples a part of x given the rest it is the mean covariance given the rest.
//! `I⁻¹ gap` is therefore Newton's step of contrastive divergence.

use super::linalg::{cholesky, lower_inverse};

/// Least share of a new round in the running mean of I.
const SHARE: f64 = 0.1;
/// Largest step, as `sqrt(stepᵀ I step)`: in standard deviations of the score.
const LONGEST: f64 = 1.0;
/// Share of the mean variance that is added to each, for features that hardly vary.
const RIDGE: f64 = 1e-6;

/// Running mean of I, n x n.
#[derive(Debug, Clone)]
pub(super) struct Information {
    n: usize,
    mean: Vec<f64>,
    rounds: usize,
}

impl Information {
    /// An estimate without observations, for `n` weights.
    pub(crate) fn new(n: usize) -> Self {
        Self {
            n,
            mean: vec![0.0; n * n],
            rounds: 0,
        }
    }

    /// Takes a round in: features of examples and of their negatives, and the mean gap between them.
    pub(crate) fn observe(&mut self, examples: &[Vec<f64>], negatives: &[Vec<f64>], gap: &[f64]) {
        let mut now = vec![0.0; self.n * self.n];
        for (x, y) in examples.iter().zip(negatives) {
            let d: Vec<f64> = (0..self.n).map(|i| x[i] - y[i] - gap[i]).collect();
            for i in 0..self.n {
                for j in 0..=i {
                    now[i * self.n + j] += 0.5 * d[i] * d[j] / examples.len() as f64;
                }
            }
        }
        self.rounds += 1;
        let share = (1.0 / self.rounds as f64).max(SHARE);
        for (mean, now) in self.mean.iter_mut().zip(now) {
            *mean += share * (now - *mean);
        }
    }

    /// `(I + λ)⁻¹ gradient`, shortened where it is longer than one standard deviation of the score. A matrix that is
    /// singular though a millionth of its mean variance is added gives the gradient as it is. Weights that are held do not
    /// move, and the others do as if these were no weights (the projected Newton step of Bertsekas 1982); their gradient is 0.
    pub(crate) fn newton(&self, gradient: &[f64], penalty: f64, held: &[bool]) -> Vec<f64> {
        let n = self.n;
        let variance = (0..n).map(|i| self.mean[i * n + i]).sum::<f64>() / n.max(1) as f64;
        let mut factor = self.mean.clone();
        for i in 0..n {
            factor[i * n + i] += penalty + RIDGE * variance;
            for j in (0..n).filter(|&j| j != i && (held[i] || held[j])) {
                factor[i * n + j] = 0.0;
            }
        }
        if !cholesky(&mut factor, n) {
            return gradient.to_vec();
        }
        let inverse = lower_inverse(&factor, n);
        // L⁻¹ g, whose length is that of the step in standard deviations; then L⁻ᵀ of it.
        let white = |i: usize| {
            (0..=i)
                .map(|j| inverse[i * n + j] * gradient[j])
                .sum::<f64>()
        };
        let white: Vec<f64> = (0..n).map(white).collect();
        let length = white.iter().map(|v| v * v).sum::<f64>().sqrt();
        let shrink = (LONGEST / length).min(1.0);
        let step = |j: usize| (j..n).map(|i| inverse[i * n + j] * white[i]).sum::<f64>() * shrink;
        (0..n).map(step).collect()
    }

    /// Roots of the diagonal of `(I + λ)⁻¹ / n`: standard errors of the weights from n examples. Infinite where I is singular.
    pub(crate) fn standard_errors(&self, penalty: f64, examples: usize) -> Vec<f64> {
        let n = self.n;
        let mut factor = self.mean.clone();
        (0..n).for_each(|i| factor[i * n + i] += penalty);
        if !cholesky(&mut factor, n) {
            return vec![f64::INFINITY; n];
        }
        let inverse = lower_inverse(&factor, n);
        let variance = |j: usize| (j..n).map(|i| inverse[i * n + j].powi(2)).sum::<f64>();
        let error = |j: usize| (variance(j) / examples.max(1) as f64).sqrt();
        (0..n).map(error).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two correlated features, of which the gap of a known shift is given.
    #[test]
    fn the_shift_of_correlated_features_is_found() {
        let differences = [[2.0, 1.0], [-2.0, -1.0], [0.5, -1.0], [-0.5, 1.0]];
        let examples: Vec<Vec<f64>> = differences.iter().map(|d| d.to_vec()).collect();
        let zeros = vec![vec![0.0; 2]; 4];
        let mut information = Information::new(2);
        information.observe(&examples, &zeros, &[0.0, 0.0]);
        // I = 1/2 mean of d dᵀ.
        let matrix = [[1.0625, 0.375], [0.375, 0.5]];
        let shift = [0.2, -0.3];
        let gradient: Vec<f64> = matrix
            .iter()
            .map(|r| r[0] * shift[0] + r[1] * shift[1])
            .collect();
        let step = information.newton(&gradient, 0.0, &[false; 2]);
        for (s, t) in step.iter().zip(shift) {
            assert!((s - t).abs() < 1e-5, "{step:?}");
        }
        // A long one keeps its direction.
        let long: Vec<f64> = gradient.iter().map(|g| 1e3 * g).collect();
        let step = information.newton(&long, 0.0, &[false; 2]);
        assert!((step[0] / step[1] - shift[0] / shift[1]).abs() < 1e-4 && step[0] < 10.0);
        // With the second held, the first moves by its own gradient over its own variance.
        let step = information.newton(&[gradient[0], 0.0], 0.0, &[false, true]);
        assert!((step[0] - gradient[0] / 1.0625).abs() < 1e-5 && step[1] == 0.0);
        // Without any variance the gradient itself.
        assert_eq!(
            Information::new(2).newton(&gradient, 0.0, &[false; 2]),
            gradient
        );
    }
}
