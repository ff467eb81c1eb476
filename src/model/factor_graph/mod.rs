//! Factor graphs with log-linear features and shared weights, fitted by contrastive divergence.
//!
//! `p(x; w) ∝ exp(wᵀ f(x))` over states x of any kind: f are features summed over all factors of a
//! state, so that factors of one kind share a weight. A user supplies the features and a way to
//! move ([`Chain`]); for discrete variables with local features [`Gibbs`] supplies the moves.
//!
//! Learning ([`fit`]) climbs `L(w) = mean_n log p(x_n; w) - λ/2 |w|²`. Its gradient is
//! `mean f(x_n) - E_w f - λ w`; contrastive divergence (Hinton 2002) replaces `E_w f` by the mean
//! over chains of a few moves: started at the data in every round, or kept from round to round
//! when persistent (Tieleman 2008), which removes the bias as the step shrinks; with chains at several temperatures
//! ([`Settings::temperatures`]) that exchange their states where single moves do not leave a mode.
//!
//! Metropolis-Hastings: from x, a proposal x' with `log q(x | x') - log q(x' | x)` is accepted with
//! probability `min(1, exp(wᵀ(f(x') - f(x)) + log q ratio))`.
//!
//! With hidden parts h of examples v, `p(v; w) = Σ_h p(v, h; w)`, the first term of the gradient is `mean E_w[f | v_n]`, by moves that
//! keep v ([`Chain::clamp`]). A graph of discrete variables is asked by [`Gibbs::ask`], and where elimination fits it is fitted without
//! chains ([`fit_exact`]).
//!
//! # Deviations and readings
//! - Unless [`Settings::newton`] is switched off a step is the gradient over the information that the chains give of the weights,
//!   half the covariance of `f(x) - f(x')` between examples and the ends of their chains, so that the rate has no unit and correlated features do not slow the ascent.
//! - Step sizes fall as `rate / (1 + round / decay)`; the result is the mean of the weights over
//!   the second half of the rounds (Polyak and Juditsky 1992).
//!
//! Sources: Hinton 2002, *Training products of experts*; Koller and Friedman 2009, Sec. 20.6.

mod annealed;
mod ask;
mod exact;
mod fit;
mod gibbs;
mod tempered;

use rand::RngExt;

pub use annealed::{Annealing, LogPartition};
pub use ask::{Beliefs, Question};
use edifice_base::rng::Stream;
pub use exact::{ExactFit, exact_gradient, fit_exact};
pub use fit::{Fitted, Outcome, Settings, fit, gradient};
pub use gibbs::{Factor, Feature, Gibbs};

/// A model family: features of a state, and a way to move between states.
///
/// `weights` is the length K of every feature and weight vector, `w` and `f(x)`; features should be of similar size, as all
/// have one rate. `step` must be able to reach every state from every other, in several moves. It is called once
/// per example, round and move, and makes most of the cost. [`Gibbs`] and [`Metropolis`] are two, with examples.
pub trait Chain: Sync {
    /// A state x.
    type State: Clone + Send + Sync;

    /// Number of weights.
    fn weights(&self) -> usize;

    /// f(x), one value per weight, finite.
    fn features(&self, state: &Self::State) -> Vec<f64>;

    /// One move of a Markov chain that leaves `p(x; w)` invariant.
    fn step(&self, state: &mut Self::State, weights: &[f64], rng: &mut Stream);

    /// One move of the hidden part of an example that leaves `p(hidden | observed; w)` invariant; false where nothing is hidden, as unless
    /// overridden. With it [`fit`] climbs the likelihood of the observed part.
    fn clamp(&self, _: &mut Self::State, _: &[f64], _: &mut Stream) -> bool {
        false
    }

    /// Least value that weight `k` may have: none unless overridden, and at most 0, where fits start.
    fn least(&self, _: usize) -> f64 {
        f64::NEG_INFINITY
    }
}

/// A proposal for Metropolis-Hastings, and with it a [`Chain`] through [`Metropolis`].
///
/// q is the probability of a proposal, which must not depend on the weights. `propose` does not change its state, so that
/// refusing costs nothing. [`Metropolis`] has an example.
pub trait Propose: Sync {
    /// A state x.
    type State: Clone + Send + Sync;

    /// Number of weights.
    fn weights(&self) -> usize;

    /// f(x), one value per weight, finite.
    fn features(&self, state: &Self::State) -> Vec<f64>;

    /// A proposed state x' and `log q(x | x') - log q(x' | x)` (0 for a symmetric proposal).
    fn propose(&self, state: &Self::State, rng: &mut Stream) -> (Self::State, f64);
}

/// Metropolis-Hastings with a user's proposal: the rule of acceptance is in the [module](self). A move is one proposal
/// and two evaluations of the features. Sources: Metropolis et al. 1953; Hastings 1970.
///
/// # Examples
/// Numbers 0 to 2 with `p(x) ∝ 2^x`: 1/7, 2/7 and 4/7.
/// ```
/// use edifice_model::factor_graph::{Metropolis, Propose, sample};
/// use edifice_base::rng::{Stream, stream};
/// use rand::RngExt;
/// struct Digits;
/// impl Propose for Digits {
///     type State = u8;
///     fn weights(&self) -> usize { 1 }
///     fn features(&self, x: &u8) -> Vec<f64> { vec![f64::from(*x)] }
///     fn propose(&self, _: &u8, rng: &mut Stream) -> (u8, f64) { (rng.random_range(0..3), 0.0) }
/// }
/// let weights = [2.0_f64.ln()];
/// let draws = sample(&Metropolis(Digits), &0, &weights, 20_000, 3, &mut stream(1, "digits", 0));
/// let share = draws.iter().filter(|&&x| x == 2).count() as f64 / 20_000.0;
/// assert!((share - 4.0 / 7.0).abs() < 0.02);
/// ```
#[derive(Clone, Debug)]
pub struct Metropolis<P>(pub P);

impl<P: Propose> Chain for Metropolis<P> {
    type State = P::State;

    fn weights(&self) -> usize {
        self.0.weights()
    }

    fn features(&self, state: &P::State) -> Vec<f64> {
        self.0.features(state)
    }

    fn step(&self, state: &mut P::State, weights: &[f64], rng: &mut Stream) {
        let (proposed, log_ratio) = self.0.propose(state, rng);
        let gain = dot(weights, &self.features(&proposed)) - dot(weights, &self.features(state));
        if rng.random::<f64>().ln() < gain + log_ratio {
            *state = proposed;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Draws `count` states by running one chain from `start`, `apart` moves between draws.
///
/// `count * apart` moves (`apart` at least 1), and the memory of the draws. Draws follow `p(x; w)` only after the chain
/// has forgotten its start, and are correlated: more moves between them help both. [`Metropolis`] has an example.
pub fn sample<C: Chain>(
    chain: &C,
    start: &C::State,
    weights: &[f64],
    count: usize,
    apart: usize,
    rng: &mut Stream,
) -> Vec<C::State> {
    let mut state = start.clone();
    (0..count)
        .map(|_| {
            for _ in 0..apart.max(1) {
                chain.step(&mut state, weights, rng);
            }
            state.clone()
        })
        .collect()
}
