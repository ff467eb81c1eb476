//! Annealed importance sampling: the partition function of graphs that are too wide for elimination.
//!
//! Chains begin at uniform states and move by Gibbs sweeps under `β_k w`, `β_k = k / K` from 0 to 1. The weight of a chain is
//! `exp(Σ_k (β_k - β_(k-1)) wᵀ f(x_(k-1)))`, and its mean over chains is, without bias, `Z(w) / Z(0)`.
//!
//! Source: Neal 2001, *Annealed importance sampling*.

use rand::RngExt;
use rayon::prelude::*;

use super::super::error::ModelError;
use super::super::linalg::log_sum_exp;
use super::{Chain, Question, dot};
use edifice_base::rng::stream;

/// Settings of [`Question::annealed`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Annealing {
    /// Independent chains, at least 2.
    pub chains: usize,
    /// Steps from β = 0 to 1, one sweep each.
    pub steps: usize,
    /// Names all randomness.
    pub seed: u64,
}

impl Default for Annealing {
    fn default() -> Self {
        Self {
            chains: 100,
            steps: 1000,
            seed: 1,
        }
    }
}

/// An estimate of the logarithm of a partition function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogPartition {
    /// `log Z`, nats.
    pub log: f64,
    /// Its standard error, to first order: the deviation of the weights over their mean and the root of the number of chains.
    pub error: f64,
    /// Effective number of chains, `(Σ w)² / Σ w²`: where it is small, so is the trust that the error deserves.
    pub ess: f64,
}

impl Question<'_> {
    /// `log Z` by annealed importance sampling, with its error; chains in parallel, the same for any number of threads.
    ///
    /// `chains * steps` sweeps, each O(Σ_v `sizes[v]` (factors around v)), whatever the width of the graph.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for fewer than 2 chains or no step.
    ///
    /// # Examples
    /// ```
    /// use edifice_model::factor_graph::{Annealing, Factor, Gibbs};
    /// let pair = |i: usize| Factor { variables: vec![i, i + 1], weight: 0, feature: Box::new(|x| if x[0] == x[1] { 1.0 } else { -1.0 }) };
    /// let chain = Gibbs::new(vec![2; 20], (0..19).map(pair).collect())?;
    /// let question = chain.ask(&[0.5])?;
    /// let found = question.annealed(&Annealing { steps: 100, ..Annealing::default() })?;
    /// assert!((found.log - question.log_partition()?).abs() < 4.0 * found.error);
    /// # Ok::<(), edifice_model::ModelError>(())
    /// ```
    pub fn annealed(&self, settings: &Annealing) -> Result<LogPartition, ModelError> {
        if settings.chains < 2 || settings.steps == 0 {
            let problem = "at least 2 chains and 1 step are needed";
            return Err(ModelError::parameter("settings", problem));
        }
        let free: Vec<usize> = (0..self.known.len())
            .filter(|&v| self.known[v].is_none())
            .collect();
        let sizes = &self.graph.sizes;
        let start: f64 = free.iter().map(|&v| (sizes[v] as f64).ln()).sum();
        let chain = |i: usize| {
            let mut rng = stream(settings.seed, "factor graph/annealed", i as u64);
            let draw = |v: usize| self.known[v].unwrap_or_else(|| rng.random_range(0..sizes[v]));
            let mut state: Vec<usize> = (0..sizes.len()).map(draw).collect();
            let mut log = 0.0;
            for k in 1..=settings.steps {
                let step = 1.0 / settings.steps as f64;
                log += step * dot(&self.weights, &self.graph.features(&state));
                if k < settings.steps {
                    let beta = k as f64 * step;
                    let weights: Vec<f64> = self.weights.iter().map(|w| beta * w).collect();
                    self.graph.sweep(&free, &mut state, &weights, &mut rng);
                }
            }
            log
        };
        let logs: Vec<f64> = (0..settings.chains).into_par_iter().map(chain).collect();
        let (total, n) = (log_sum_exp(&logs), settings.chains as f64);
        let squares: f64 = logs.iter().map(|l| (2.0 * (l - total)).exp()).sum();
        Ok(LogPartition {
            log: start + total - n.ln(),
            error: ((squares - 1.0 / n).max(0.0) * n / (n - 1.0)).sqrt(),
            ess: 1.0 / squares,
        })
    }
}
