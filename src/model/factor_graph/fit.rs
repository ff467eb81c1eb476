//! Contrastive divergence: weights by gradients from chains.

use rayon::prelude::*;

use super::super::error::ModelError;
use super::super::information::Information;
use super::Chain;
use super::tempered::Ladder;
use edifice_base::rng::stream;
use edifice_base::{Progress, Watch, Watched};

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
    /// True if steps are Newton's, with the information that the chains give of the weights; without, one rate serves all
    /// weights, which takes many times the rounds where features are correlated or of different size.
    pub newton: bool,
    /// Temperatures of the chains of each example: 1 is plain contrastive divergence; of more, chains at `p(x; β w)` with β from 1 down in equal
    /// steps exchange their states, which costs as many times the moves.
    pub temperatures: usize,
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
            newton: true,
            temperatures: 1,
        }
    }
}

/// Shortfall of the log-likelihood, nats an example, below which a fit has settled.
const SETTLED: f64 = 1e-3;
/// Rounds at the end that tell the standard errors where steps do not need the information.
const LAST: usize = 20;

/// The state in which [`fit`] ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The gap would gain no more than a thousandth of a nat an example.
    Settled,
    /// The weights were still moving, or the chains do not mix: more rounds or more moves are needed.
    Moving,
    /// The watch stopped it; the weights are those of the rounds until then.
    Interrupted,
}

/// Result of [`fit`].
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// One weight per feature, the mean over the second half of the rounds.
    pub weights: Vec<f64>,
    /// Length of the gap `mean f(data) - mean f(chains)` in each round, in units of the features.
    pub trace: Vec<f64>,
    /// The mean gap over the second half of the rounds: near `penalty * weights` where the fit has settled.
    pub gap: Vec<f64>,
    /// Standard errors of the weights, from the information that the chains give; infinite where a feature never varies.
    pub standard_errors: Vec<f64>,
    /// Log-likelihood that a further Newton step would gain, nats an example, to second order.
    pub shortfall: f64,
    /// [`Outcome::Settled`] if that is at most a thousandth of a nat.
    pub outcome: Outcome,
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
    let watched = Watched::new(&edifice_base::unwatched);
    advance(chain, &mut states, weights, moves, seed, 0, &watched);
    Ok(mean_difference(&examples, &all_features(chain, &states)?))
}

/// Fits the weights to examples, starting at zero, each at [`Chain::least`] or above.
///
/// Chains run in parallel, each with its own random stream, so that the result does not depend on
/// the number of threads.
///
/// A round of N examples and K weights is O(N moves) moves of chains and O(N K), with `newton`
/// O(N K² + K³); memory is N states and N K features. Formulas and sources are in the first page of the module.
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
/// let fitted = fit(&gibbs, &data, &Settings { moves: 3, ..Settings::default() }, 1, &unwatched)?;
/// assert!((fitted.weights[0] - 3.0_f64.ln()).abs() < 0.1);
/// // The standard error of a log odds of 300 to 100 is the root of 1/300 + 1/100.
/// assert!((fitted.standard_errors[0] - (1.0 / 300.0 + 1.0 / 100.0_f64).sqrt()).abs() < 0.03);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn fit<C: Chain>(
    chain: &C,
    data: &[C::State],
    settings: &Settings,
    seed: u64,
    watch: &Watch,
) -> Result<Fitted, ModelError> {
    let watched = Watched::new(watch);
    let fine = settings.rate > 0.0 && settings.decay > 0.0 && settings.penalty >= 0.0;
    let counts = [settings.rounds, settings.moves, settings.temperatures];
    if !fine || counts.contains(&0) {
        return Err(ModelError::parameter(
            "settings",
            "rounds, moves, temperatures, rate and decay must be positive",
        ));
    }
    let mut examples = all_features(chain, data)?;
    let k = chain.weights();
    let mut weights = vec![0.0; k];
    let least: Vec<f64> = (0..k).map(|i| chain.least(i).min(0.0)).collect();
    let mut information = Information::new(k);
    let (mut mean, mut mean_gap) = (vec![0.0; k], vec![0.0; k]);
    let mut clamped = data.to_vec();
    let mut states = data.to_vec();
    let mut ladder = Ladder::new(settings.temperatures, data);
    let mut trace = Vec::with_capacity(settings.rounds);
    let half = settings.rounds / 2;
    // Rounds of the second half that were made.
    let mut counted = 0;
    for round in 0..settings.rounds {
        let told = Progress::of(
            "rounds of contrastive divergence",
            round as u64,
            settings.rounds as u64,
        );
        if !watched.goes_on(told) {
            break;
        }
        if clamp(
            chain,
            &mut clamped,
            &weights,
            settings.moves,
            seed,
            round as u64,
        ) {
            examples = all_features(chain, &clamped)?;
        }
        if !settings.persistent {
            states.clone_from_slice(&clamped);
            ladder = Ladder::new(settings.temperatures, &clamped);
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
            break;
        }
        let order = (seed, round as u64);
        ladder.exchange(chain, &mut states, &weights, settings.moves, order);
        let negatives = all_features(chain, &states)?;
        let gap = mean_difference(&examples, &negatives);
        let ascent = weights.iter().zip(&gap);
        let mut step: Vec<f64> = ascent.map(|(w, g)| g - settings.penalty * w).collect();
        let held = hold(&mut step, &weights, &least);
        if settings.newton || round + LAST >= settings.rounds {
            information.observe(&examples, &negatives, &gap);
        }
        if settings.newton {
            step = information.newton(&step, settings.penalty, &held);
        }
        let rate = settings.rate / (1.0 + round as f64 / settings.decay);
        for ((w, s), least) in weights.iter_mut().zip(&step).zip(&least) {
            *w = (*w + rate * s).max(*least);
        }
        trace.push(gap.iter().map(|g| g * g).sum::<f64>().sqrt());
        if round >= half {
            counted += 1;
            let share = 1.0 / (settings.rounds - half) as f64;
            let means = mean.iter_mut().zip(&mut mean_gap);
            for ((m, g), (w, now)) in means.zip(weights.iter().zip(&gap)) {
                *m += w * share;
                *g += now * share;
            }
        }
    }
    if watched.is_stopped() {
        // The mean of the rounds that count until now, or the last weights.
        let scale = (settings.rounds - half) as f64 / f64::from(counted.max(1));
        for (k, (m, g)) in mean.iter_mut().zip(&mut mean_gap).enumerate() {
            *m = if counted > 0 { *m * scale } else { weights[k] };
            *g *= scale;
        }
    }
    if let Some(i) = mean.iter().position(|w| !w.is_finite()) {
        return Err(ModelError::parameter(
            format!("weight {i}"),
            "diverged: lower the rate",
        ));
    }
    let pairs = mean_gap.iter().zip(&mean);
    let mut slope: Vec<f64> = pairs.map(|(g, w)| g - settings.penalty * w).collect();
    let held = hold(&mut slope, &mean, &least);
    let left = information.newton(&slope, settings.penalty, &held);
    // The gain of a further Newton step, to second order.
    let shortfall = 0.5 * slope.iter().zip(&left).map(|(s, l)| s * l).sum::<f64>();
    Ok(Fitted {
        standard_errors: information.standard_errors(settings.penalty, data.len()),
        weights: mean,
        trace,
        gap: mean_gap,
        outcome: match shortfall <= SETTLED {
            _ if watched.is_stopped() => Outcome::Interrupted,
            true => Outcome::Settled,
            false => Outcome::Moving,
        },
        shortfall,
    })
}

/// The weights at their least value that the gradient would take below it: their gradient becomes 0.
fn hold(gradient: &mut [f64], weights: &[f64], least: &[f64]) -> Vec<bool> {
    let held = weights.iter().zip(least).zip(gradient);
    held.map(|((w, least), g)| {
        let held = *w <= *least && *g < 0.0;
        if held {
            *g = 0.0;
        }
        held
    })
    .collect()
}

/// Moves the hidden parts of examples; false where nothing is hidden.
fn clamp<C: Chain>(
    chain: &C,
    states: &mut [C::State],
    weights: &[f64],
    moves: usize,
    seed: u64,
    round: u64,
) -> bool {
    let one = |(i, state): (usize, &mut C::State)| {
        let mut rng = stream(seed ^ round.rotate_left(32), "clamped", i as u64);
        (0..moves).all(|_| chain.clamp(state, weights, &mut rng))
    };
    states
        .par_iter_mut()
        .enumerate()
        .map(one)
        .reduce(|| true, |a, b| a && b)
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
