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

use rand::RngExt;
use rayon::prelude::*;

use super::elimination::{self, BucketTree, Mode};
use super::error::ModelError;
use super::information::Information;
use super::linalg::categorical_of_logs;
use crate::rng::{Stream, stream};

/// A model family: features of a state, and a way to move between states.
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

/// Metropolis-Hastings with a user's proposal.
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

/// A feature of the values of a few variables.
pub type Feature = Box<dyn Fn(&[usize]) -> f64 + Send + Sync>;

/// A factor: a feature of a few discrete variables, with the weight it shares.
pub struct Factor {
    /// The variables it looks at.
    pub variables: Vec<usize>,
    /// Index of its weight.
    pub weight: usize,
    /// Its value for the variables' values, in that order; finite.
    pub feature: Feature,
}

/// Discrete variables under factors: Gibbs sampling, one sweep a move.
pub struct Gibbs {
    sizes: Vec<usize>,
    factors: Vec<Factor>,
    weights: usize,
    /// Factors of each variable.
    around: Vec<Vec<usize>>,
    /// Per factor, its feature for every configuration of its variables, the last fastest; empty beyond [`TABULATED`].
    tables: Vec<Vec<f64>>,
}

/// Most configurations of a factor whose feature is tabulated.
const TABULATED: usize = 1 << 12;

impl Gibbs {
    /// Variables with so many values each, and their factors.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for a factor on a variable that is not there, or that it names twice, or a variable
    /// without values; [`ModelError::Empty`] without factors.
    pub fn new(sizes: Vec<usize>, factors: Vec<Factor>) -> Result<Self, ModelError> {
        if factors.is_empty() {
            return Err(ModelError::Empty { what: "factors" });
        }
        if let Some(v) = sizes.iter().position(|k| *k == 0) {
            return Err(ModelError::parameter(v.to_string(), "has no values"));
        }
        let mut around = vec![Vec::new(); sizes.len()];
        for (i, factor) in factors.iter().enumerate() {
            for &v in &factor.variables {
                let list = around.get_mut(v).ok_or_else(|| {
                    ModelError::parameter(
                        format!("factor {i}"),
                        format!("there is no variable {v}"),
                    )
                })?;
                if list.last() == Some(&i) {
                    let problem = format!("names variable {v} twice");
                    return Err(ModelError::parameter(format!("factor {i}"), problem));
                }
                list.push(i);
            }
        }
        let tables = factors.iter().map(|f| tabulate(f, &sizes)).collect();
        Ok(Self {
            weights: factors.iter().map(|f| f.weight + 1).max().unwrap_or(0),
            sizes,
            factors,
            around,
            tables,
        })
    }

    fn value(&self, factor: usize, state: &[usize]) -> f64 {
        let (table, factor) = (&self.tables[factor], &self.factors[factor]);
        let variables = factor.variables.iter();
        if table.is_empty() {
            let values: Vec<usize> = variables.map(|&v| state[v]).collect();
            return (factor.feature)(&values);
        }
        table[variables.fold(0, |i, &v| i * self.sizes[v] + state[v])]
    }

    /// `log Z(w)` and `E_w f`, exactly, by variable elimination.
    ///
    /// # Errors
    /// [`ModelError::TooWide`]; [`ModelError::Parameter`] for a factor of more than 2¹² configurations, or weights of
    /// another number.
    pub fn exact(&self, weights: &[f64]) -> Result<(f64, Vec<f64>), ModelError> {
        if weights.len() != self.weights {
            return Err(ModelError::parameter("weights", "of another number"));
        }
        let mut factors = Vec::with_capacity(self.factors.len());
        for (i, (factor, table)) in self.factors.iter().zip(&self.tables).enumerate() {
            if table.is_empty() {
                let problem = "has too many configurations to be tabulated";
                return Err(ModelError::parameter(format!("factor {i}"), problem));
            }
            let logs = table.iter().map(|f| weights[factor.weight] * f).collect();
            factors.push(elimination::Factor::new(factor.variables.clone(), logs));
        }
        // Variables without a factor are free.
        let alone = (0..self.sizes.len()).filter(|&v| self.around[v].is_empty());
        let free: f64 = alone.map(|v| (self.sizes[v] as f64).ln()).sum();
        let tree = BucketTree::new(factors, &self.sizes, Mode::Sum);
        let tree = tree.map_err(|e| ModelError::TooWide {
            variable: e.variable.to_string(),
            width: e.width,
            cells: e.cells,
        })?;
        let beliefs = tree.beliefs();
        let mut mean = vec![0.0; self.weights];
        for (factor, table) in self.factors.iter().zip(&self.tables) {
            let joint = beliefs.of(&factor.variables);
            mean[factor.weight] += dot(table, &joint);
        }
        Ok((tree.total + free, mean))
    }
}

/// The feature for every configuration of the variables; nothing where there are too many.
fn tabulate(factor: &Factor, sizes: &[usize]) -> Vec<f64> {
    let variables = &factor.variables;
    let count = variables
        .iter()
        .try_fold(1_usize, |n, &v| n.checked_mul(sizes[v]));
    let Some(count) = count.filter(|n| *n <= TABULATED) else {
        return Vec::new();
    };
    let mut assignment = vec![0; sizes.len()];
    let each = (0..count).map(|_| {
        let values: Vec<usize> = variables.iter().map(|&v| assignment[v]).collect();
        elimination::advance(variables, sizes, &mut assignment);
        (factor.feature)(&values)
    });
    each.collect()
}

impl Chain for Gibbs {
    type State = Vec<usize>;

    fn weights(&self) -> usize {
        self.weights
    }

    fn features(&self, state: &Vec<usize>) -> Vec<f64> {
        let mut sums = vec![0.0; self.weights];
        for (i, factor) in self.factors.iter().enumerate() {
            sums[factor.weight] += self.value(i, state);
        }
        sums
    }

    fn step(&self, state: &mut Vec<usize>, weights: &[f64], rng: &mut Stream) {
        let mut logs = vec![0.0; self.sizes.iter().copied().max().unwrap_or(0)];
        for v in 0..self.sizes.len() {
            let logs = &mut logs[..self.sizes[v]];
            for (value, log) in logs.iter_mut().enumerate() {
                state[v] = value;
                let factors = self.around[v].iter();
                *log = factors
                    .map(|&f| weights[self.factors[f].weight] * self.value(f, state))
                    .sum();
            }
            state[v] = categorical_of_logs(logs, rng);
        }
    }
}

/// Settings of [`fit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Rounds of gradient ascent.
    pub rounds: usize,
    /// Moves of each chain in a round.
    pub moves: usize,
    /// Whether chains go on from round to round (persistent) or restart at the data.
    pub persistent: bool,
    /// First step size.
    pub rate: f64,
    /// Rounds after which the step size is halved.
    pub decay: f64,
    /// λ of the penalty `λ/2 |w|²` per example.
    pub penalty: f64,
    /// Whether steps are Newton's, with the information that the chains give of the weights.
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
/// # Errors
/// As [`fit`].
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
/// # Errors
/// [`ModelError::Empty`] without examples; [`ModelError::Parameter`] for a feature that is not
/// finite or settings out of range.
pub fn fit<C: Chain>(
    chain: &C,
    data: &[C::State],
    settings: &Settings,
    seed: u64,
) -> Result<Vec<f64>, ModelError> {
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
        );
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
) {
    states.par_iter_mut().enumerate().for_each(|(i, state)| {
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
