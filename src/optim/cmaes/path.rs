//! One run between restarts: the mean, the step and the covariance, and how they learn.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// The state of one run between restarts.
#[derive(Debug)]
pub(super) struct Path {
    pub weights: Vec<f64>,
    /// Σ w, squared, over Σ w²: how many points the mean is of.
    pub effective: f64,
    pub count: usize,
    pub mean: DVector<f64>,
    pub first: f64,
    pub step: f64,
    pub covariance: DMatrix<f64>,
    /// Eigenvectors of the covariance, and the roots of its eigenvalues.
    pub axes: DMatrix<f64>,
    pub lengths: DVector<f64>,
    pub path_step: DVector<f64>,
    pub path: DVector<f64>,
    pub generation: u64,
    pub decomposed: u64,
    /// Best costs of the last generations, newest last.
    pub recent: Vec<f64>,
    /// Largest spread of costs of a generation so far.
    pub widest: f64,
    pub evaluations: u64,
}

impl Path {
    pub(super) fn new(start: &[f64], step: f64, count: usize) -> Self {
        let n = start.len();
        let half = count / 2;
        let raw = (1..=half).map(|i| ((count as f64 + 1.0) / 2.0).ln() - (i as f64).ln());
        let raw: Vec<f64> = raw.collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        Self {
            effective: 1.0 / weights.iter().map(|w| w * w).sum::<f64>(),
            weights,
            count,
            mean: DVector::from_column_slice(start),
            first: step,
            step,
            covariance: DMatrix::identity(n, n),
            axes: DMatrix::identity(n, n),
            lengths: DVector::from_element(n, 1.0),
            path_step: DVector::zeros(n),
            path: DVector::zeros(n),
            generation: 0,
            decomposed: 0,
            recent: Vec::new(),
            widest: 0.0,
            evaluations: 0,
        }
    }

    pub(super) fn draw<R: Rng>(&self, rng: &mut R) -> DVector<f64> {
        let n = self.mean.len();
        let z = DVector::from_fn(n, |i, _| {
            self.lengths[i] * rng.sample::<f64, _>(StandardNormal)
        });
        &self.axes * z
    }

    /// Learns from steps y in rising order of cost.
    pub(super) fn learn(&mut self, ranked: &[&DVector<f64>]) {
        let n = self.mean.len() as f64;
        let mu = self.effective;
        let c_step = (mu + 2.0) / (n + mu + 5.0);
        let damping = 1.0 + 2.0 * (((mu - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_step;
        let c_path = (4.0 + mu / n) / (n + 4.0 + 2.0 * mu / n);
        let c_one = 2.0 / ((n + 1.3).powi(2) + mu);
        let c_mu = (2.0 * (mu - 2.0 + 1.0 / mu) / ((n + 2.0).powi(2) + mu)).min(1.0 - c_one);
        let normal_length = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let mut moved = DVector::zeros(self.mean.len());
        for (w, y) in self.weights.iter().zip(ranked) {
            moved.axpy(*w, y, 1.0);
        }
        self.mean.axpy(self.step, &moved, 1.0);
        self.generation += 1;
        // C^(-1/2) of the move.
        let inside = (self.axes.transpose() * &moved).component_div(&self.lengths);
        let white = &self.axes * inside;
        self.path_step *= 1.0 - c_step;
        self.path_step
            .axpy((c_step * (2.0 - c_step) * mu).sqrt(), &white, 1.0);
        let length = self.path_step.norm();
        let begun = 1.0 - (1.0 - c_step).powf(2.0 * self.generation as f64);
        let slow = length / begun.sqrt() < (1.4 + 2.0 / (n + 1.0)) * normal_length;
        self.path *= 1.0 - c_path;
        if slow {
            self.path
                .axpy((c_path * (2.0 - c_path) * mu).sqrt(), &moved, 1.0);
        }
        let lost = if slow {
            0.0
        } else {
            c_one * c_path * (2.0 - c_path)
        };
        self.covariance *= 1.0 - c_one - c_mu + lost;
        self.covariance.ger(c_one, &self.path, &self.path, 1.0);
        for (w, y) in self.weights.iter().zip(ranked) {
            self.covariance.ger(c_mu * w, y, y, 1.0);
        }
        self.step *= ((c_step / damping) * (length / normal_length - 1.0))
            .min(1.0)
            .exp();
        let pause = self.count as f64 / (c_one + c_mu) / n / 10.0;
        let since = (self.generation - self.decomposed) as f64 * self.count as f64;
        if since >= pause {
            self.decompose();
        }
    }

    fn decompose(&mut self) {
        self.decomposed = self.generation;
        self.covariance = (&self.covariance + self.covariance.transpose()) * 0.5;
        let eigen = SymmetricEigen::new(self.covariance.clone());
        self.lengths = eigen.eigenvalues.map(|v| v.max(1e-300).sqrt());
        self.axes = eigen.eigenvectors;
    }

    /// True if nothing more is to be had from this run.
    pub(super) fn converged(&self, tolerance: f64, spread: f64) -> bool {
        let n = self.mean.len();
        let window = 10 + 30 * n / self.count;
        let largest = self.lengths.max();
        let least = self.lengths.min();
        let last = &self.recent[self.recent.len().saturating_sub(window)..];
        let range = last.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - last.iter().copied().fold(f64::INFINITY, f64::min);
        let flat = last.len() >= window && range.max(spread) <= tolerance * self.widest;
        let small = self.step * largest <= tolerance * self.first;
        let singular = largest > 1e7 * least;
        let broken = !(self.step.is_finite() && largest.is_finite());
        // No progress for long: the median of the recent costs is not below that of before.
        let long = (120.0 + 30.0 * n as f64 / self.count as f64) as usize;
        let stagnant = self.recent.len() >= 2 * long && {
            let median = |x: &[f64]| {
                let mut x = x.to_vec();
                x.sort_by(f64::total_cmp);
                x[x.len() / 2]
            };
            let (old, new) = self.recent[self.recent.len() - 2 * long..].split_at(long);
            median(new) >= median(old)
        };
        flat || small || singular || broken || stagnant
    }
}
