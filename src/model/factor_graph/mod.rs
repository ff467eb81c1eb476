//! Factor graphs with log-linear features and shared weights, fitted by contrastive divergence.
//!
//! `p(x; w) ∝ exp(wᵀ f(x))` over states x of any kind: f are features summed over all factors of a
//! state, so that factors of one kind share a weight. A user supplies the features and a way to
//! move ([`Chain`]); for discrete variables with local features [`Gibbs`] supplies the moves.
//!
//! Learning ([`fit`]) climbs `L(w) = mean_n log p(x_n; w) - λ/2 |w|²`. Its gradient is
//! `mean f(x_n) - E_w f - λ w`; contrastive divergence (Hinton 2002) replaces `E_w f` by the mean
//! over chains of a few moves: started at the data in every round, or kept from round to round
//! when persistent (Tieleman 2008), which removes the bias as the step shrinks.
//!
//! Metropolis-Hastings: from x, a proposal x' with `log q(x | x') - log q(x' | x)` is accepted with
//! probability `min(1, exp(wᵀ(f(x') - f(x)) + log q ratio))`.
//!
//! # Deviations and readings
//! - With [`Settings::newton`] a step is the gradient over the information that the chains give of the weights,
//!   half the covariance of `f(x) - f(x')` between examples and the ends of their chains, so that the rate has no unit and correlated features do not slow the ascent.
//! - Step sizes fall as `rate / (1 + round / decay)`; the result is the mean of the weights over
//!   the second half of the rounds (Polyak and Juditsky 1992).
//!
//! Sources: Hinton 2002, *Training products of experts*; Koller and Friedman 2009, Sec. 20.6.

mod gibbs;

use rand::RngExt;
use rayon::prelude::*;

use super::error::ModelError;
use super::information::Information;
use edifice_base::rng::{Stream, stream};
use edifice_base::{Progress, Watch, Watched};
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

/// Settings of [`fit`].
///
/// The example of [`fit`] uses them. `rate` has the unit of a weight over a feature, or none with `newton`; `penalty` is the
/// precision of a Gaussian prior of each weight, divided by the number of examples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Rounds of gradient ascent.
    pub rounds: usize,
    /// Moves of each chain in a round.
    pub moves: usize,
    /// True if chains go on from round to round (persistent), false if they restart at the data.
    pub persistent: bool,
    /// First step size.
    pub rate: f64,
    /// Rounds after which the step size is halved.
    pub decay: f64,
    /// λ of the penalty `λ/2 |w|²` per example.
    pub penalty: f64,
    /// True if steps are Newton's, with the information that the chains give of the weights; false for plain gradient
    /// steps.
    pub newton: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            rounds: 500,
            moves: 1,
            persistent: true,
            rate: 0.1,
            decay: 100.0,
            penalty: 1e-4,
            newton: false,
        }
    }
}

/// Estimate of the gradient `mean f(data) - E_w f` (without penalty) at fixed weights: chains of
/// `moves` moves, one from each example. As moves grow it tends to the exact gradient.
///
/// O(N moves) moves of chains, in parallel, and 2 N evaluations of features. Its standard error falls as `1 / sqrt(N)`; with
/// few moves it is biased (Hinton 2002).
///
/// # Errors
/// As [`fit`].
///
/// # Examples
/// ```
/// use edifice_model::factor_graph::{Factor, Gibbs, gradient};
/// // One bit whose feature is itself: E_w f = 1 / (1 + exp(-w)). One sweep of a single variable is exact.
/// let bit = Factor { variables: vec![0], weight: 0, feature: Box::new(|x| x[0] as f64) };
/// let gibbs = Gibbs::new(vec![2], vec![bit])?;
/// let data = vec![vec![1]; 10_000];
/// let slope = gradient(&gibbs, &data, &[3.0_f64.ln()], 1, 1)?;
/// assert!((slope[0] - (1.0 - 0.75)).abs() < 0.02);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn gradient<C: Chain>(
    chain: &C,
    data: &[C::State],
    weights: &[f64],
    moves: usize,
    seed: u64,
) -> Result<Vec<f64>, ModelError> {
    let examples = all_features(chain, data)?;
    let mut states = data.to_vec();
    advance(chain, &mut states, weights, moves, seed, 0);
    Ok(mean_difference(&examples, &all_features(chain, &states)?))
}

/// Fits the weights to examples, starting at zero.
///
/// Chains run in parallel, each with its own random stream, so that the result does not depend on
/// the number of threads.
///
/// Returns one weight per feature. A round of N examples and K weights is O(N moves) moves of chains and O(N K), with `newton`
/// O(N K² + K³); memory is N states and N K features. Formulas and sources are in the [module](self).
///
/// # Errors
/// [`ModelError::Empty`] without examples; [`ModelError::Parameter`] for a feature that is not
/// finite or settings out of range.
///
/// # Examples
/// Two bits that are equal in 3 of 4 examples: the weight of "equal" is the log odds, `log 3`.
/// ```
/// use edifice_base::unwatched;
/// use edifice_model::factor_graph::{Factor, Gibbs, Settings, fit};
/// let equal = Factor { variables: vec![0, 1], weight: 0, feature: Box::new(|x| f64::from(u8::from(x[0] == x[1]))) };
/// let gibbs = Gibbs::new(vec![2, 2], vec![equal])?;
/// let examples = [[0, 0], [1, 1], [0, 0], [0, 1]].repeat(100);
/// let data: Vec<Vec<usize>> = examples.into_iter().map(Vec::from).collect();
/// let settings = Settings { newton: true, moves: 3, ..Settings::default() };
/// let weights = fit(&gibbs, &data, &settings, 1, &unwatched)?;
/// assert!((weights[0] - 3.0_f64.ln()).abs() < 0.1);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn fit<C: Chain>(
    chain: &C,
    data: &[C::State],
    settings: &Settings,
    seed: u64,
    watch: &Watch,
) -> Result<Vec<f64>, ModelError> {
    let watched = Watched::new(watch);
    let fine = settings.rate > 0.0 && settings.decay > 0.0 && settings.penalty >= 0.0;
    if !fine || settings.rounds == 0 || settings.moves == 0 {
        return Err(ModelError::parameter(
            "settings",
            "rounds, moves, rate and decay must be positive",
        ));
    }
    let examples = all_features(chain, data)?;
    let mut weights = vec![0.0; chain.weights()];
    let mut information = Information::new(weights.len());
    let mut mean = vec![0.0; weights.len()];
    let mut states = data.to_vec();
    let half = settings.rounds / 2;
    for round in 0..settings.rounds {
        if !settings.persistent {
            states.clone_from_slice(data);
        }
        advance(
            chain,
            &mut states,
            &weights,
            settings.moves,
            seed,
            round as u64,
            &watched,
        );
        if watched.is_stopped() {
            // Of the rounds until now: the mean of those that count, or the last weights.
            let counted = round.saturating_sub(half) as f64;
            let share = counted / (settings.rounds - half) as f64;
            mean = match counted > 0.0 {
                true => mean.iter().map(|m| m / share).collect(),
                false => weights,
            };
            break;
        }
        let negatives = all_features(chain, &states)?;
        let gap = mean_difference(&examples, &negatives);
        let ascent = weights.iter().zip(&gap);
        let mut step: Vec<f64> = ascent.map(|(w, g)| g - settings.penalty * w).collect();
        if settings.newton {
            information.observe(&examples, &negatives, &gap);
            step = information.newton(&step, settings.penalty);
        }
        let rate = settings.rate / (1.0 + round as f64 / settings.decay);
        for (w, s) in weights.iter_mut().zip(&step) {
            *w += rate * s;
        }
        if round >= half {
            for (m, w) in mean.iter_mut().zip(&weights) {
                *m += w / (settings.rounds - half) as f64;
            }
        }
    }
    match mean.iter().position(|w| !w.is_finite()) {
        Some(i) => Err(ModelError::parameter(
            format!("weight {i}"),
            "diverged: lower the rate",
        )),
        None => Ok(mean),
    }
}

fn advance<C: Chain>(
    chain: &C,
    states: &mut [C::State],
    weights: &[f64],
    moves: usize,
    seed: u64,
    round: u64,
    watched: &Watched,
) {
    let told = Progress {
        done: round,
        ..Progress::stage("rounds of contrastive divergence")
    };
    states.par_iter_mut().enumerate().for_each(|(i, state)| {
        if !watched.goes_on(told) {
            return;
        }
        let mut rng = stream(seed ^ round.rotate_left(32), "chain", i as u64);
        for _ in 0..moves {
            chain.step(state, weights, &mut rng);
        }
    });
}

/// Features of all states, row by row.
fn all_features<C: Chain>(chain: &C, states: &[C::State]) -> Result<Vec<Vec<f64>>, ModelError> {
    if states.is_empty() {
        return Err(ModelError::Empty { what: "examples" });
    }
    let all: Vec<Vec<f64>> = states.par_iter().map(|s| chain.features(s)).collect();
    for (row, features) in all.iter().enumerate() {
        if let Some(i) = features.iter().position(|f| !f.is_finite()) {
            return Err(ModelError::NotFinite {
                column: format!("feature {i}"),
                row,
                value: features[i],
            });
        }
    }
    Ok(all)
}

/// Mean of a row of `a` less the row of `b`.
fn mean_difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<f64> {
    let mut mean = vec![0.0; a.first().map_or(0, Vec::len)];
    for (x, y) in a.iter().zip(b) {
        for (m, (x, y)) in mean.iter_mut().zip(x.iter().zip(y)) {
            *m += (x - y) / a.len() as f64;
        }
    }
    mean
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
