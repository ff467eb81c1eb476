//! Chains at several temperatures that exchange their states: negatives of a distribution with modes that single moves do not leave.
//!
//! Each example has chains of `p(x; β_k w)` at `β_k = 1 - k / K`, k from 0 to K - 1. After their moves neighbours exchange their states, from the hottest
//! pair down, with probability
//!
//! ```text
//! min(1, exp((β_k - β_(k+1)) wᵀ (f(x_(k+1)) - f(x_k))))
//! ```
//! which leaves the product of all distributions invariant; the chain of `β_0 = 1` gives the negatives.
//!
//! Sources: Geyer 1991; Desjardins, Courville, Bengio, Vincent and Delalleau 2010 (tempered chains for learning).

use rand::RngExt;
use rayon::prelude::*;

use super::Chain;
use edifice_base::rng::stream;

/// The hotter chains of all examples.
pub(super) struct Ladder<S> {
    /// β of each, below 1 and falling.
    betas: Vec<f64>,
    /// Per example, a state for each β.
    states: Vec<Vec<S>>,
}

impl<S: Clone + Send + Sync> Ladder<S> {
    /// Chains at `temperatures - 1` further temperatures, which all start at the states given.
    pub(super) fn new(temperatures: usize, start: &[S]) -> Self {
        let count = temperatures.max(1);
        let betas: Vec<f64> = (1..count).map(|k| 1.0 - k as f64 / count as f64).collect();
        let states = start.iter().map(|s| vec![s.clone(); betas.len()]);
        Self {
            states: states.collect(),
            betas,
        }
    }

    /// Moves the hotter chains, then exchanges states down to `cold`, the chains of β = 1.
    pub(super) fn exchange<C: Chain<State = S>>(
        &mut self,
        chain: &C,
        cold: &mut [S],
        weights: &[f64],
        moves: usize,
        (seed, round): (u64, u64),
    ) {
        if self.betas.is_empty() {
            return;
        }
        let scaled: Vec<Vec<f64>> = self
            .betas
            .iter()
            .map(|beta| weights.iter().map(|w| beta * w).collect())
            .collect();
        let log = |state: &S| -> f64 {
            let features = chain.features(state);
            features.iter().zip(weights).map(|(f, w)| f * w).sum()
        };
        let pairs = self.states.par_iter_mut().zip(cold.par_iter_mut());
        pairs.enumerate().for_each(|(i, (hot, cold))| {
            let mut rng = stream(seed ^ round.rotate_left(32), "tempered", i as u64);
            for (state, weights) in hot.iter_mut().zip(&scaled) {
                for _ in 0..moves {
                    chain.step(state, weights, &mut rng);
                }
            }
            for k in (0..hot.len()).rev() {
                let above = if k == 0 { 1.0 } else { self.betas[k - 1] };
                let colder = if k == 0 { &*cold } else { &hot[k - 1] };
                let gain = (above - self.betas[k]) * (log(&hot[k]) - log(colder));
                if rng.random::<f64>().ln() < gain {
                    match k {
                        0 => std::mem::swap(cold, &mut hot[0]),
                        _ => hot.swap(k - 1, k),
                    }
                }
            }
        });
    }
}
