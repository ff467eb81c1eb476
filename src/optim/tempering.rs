//! Parallel tempering (replica exchange): copies of a landscape at a ladder of temperatures, that trade places.
//!
//! Copy r moves by Metropolis' rule at temperature `T_r`, `T_1 < T_2 < .. < T_R`. After each round, neighbours r and r + 1 exchange
//! their solutions with probability
//!
//! ```text
//! min(1, exp((1 / T_r - 1 / T_(r+1)) (cost_r - cost_(r+1))))
//! ```
//! in even and odd pairs by turns, which leaves `Π_r exp(-cost_r / T_r)` invariant. What is found in the heat comes down to the cold, and
//! what is stuck in the cold goes up: unlike annealing there is no last temperature at which all is over, and no schedule to guess.
//!
//! # Deviations and readings
//! - Temperatures unless given: after a descent by moves that do not raise the cost, moves raise it by d; the highest accepts the median d half of the
//!   time, the lowest one in a hundred of the least positive d (their 5 % quantile). The ladder between is geometric.
//! - Copies run in parallel, each with its own stream; the result is the same for any number of threads.
//!
//! Sources: Swendsen and Wang 1986; Geyer 1991; Earl and Deem 2005.

use argmin::core::{Error as ArgminError, KV, Problem, Solver, TerminationStatus};
use rand::RngExt;
use rayon::prelude::*;

use super::annealing::Landscape;
use super::limits::{Answer, Limits, Watch};
use super::run::{Run, Search, Step, execute};
use edifice_base::rng::{Stream, stream};

/// Moves that are tried to set the temperatures, and moves without a gain that end the descent before.
const TRIALS: usize = 1000;
/// Moves of that descent at most.
const DESCENT: usize = 100_000;

/// Settings of [`temper`], whose example uses them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Copies, each at its temperature; at least 2.
    pub replicas: usize,
    /// Moves of each copy between exchanges, at least 1.
    pub moves: u32,
    /// Rounds of moves and exchanges.
    pub rounds: u64,
    /// Lowest and highest temperature, in units of cost; found by trial moves unless given.
    pub temperatures: Option<(f64, f64)>,
    /// Limits of the run; a move is an evaluation.
    pub limits: Limits,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            replicas: 12,
            moves: 100,
            rounds: 1000,
            temperatures: None,
            limits: Limits::default(),
        }
    }
}

/// Failures of [`temper`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TemperingError {
    /// A setting is out of its range.
    #[error("`{setting}` must be {must}")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// Its range.
        must: &'static str,
    },
    /// argmin failed.
    #[error("parallel tempering stopped: {0}")]
    Stopped(String),
}

/// Minimises over a landscape by copies that begin where it stands, telling `observer` of every round. The landscape itself is only
/// copied.
///
/// `rounds * replicas * moves` moves; one copy of a solution for each that is better than all before of its replica.
///
/// # Errors
/// [`TemperingError::Setting`].
///
/// # Examples
/// A walk on the integers with valleys at all multiples of 10, the deepest at 50, from 0:
/// ```
/// use edifice_optim::{annealing::Landscape, tempering::{Settings, temper}};
/// use rand::{Rng, RngExt};
/// #[derive(Clone)]
/// struct Walk { at: i32, before: i32 }
/// impl Landscape for Walk {
///     type Solution = i32;
///     fn cost(&self) -> f64 { f64::from((self.at - 50).abs()) + 4.0 * f64::from(self.at.rem_euclid(10).min(5)) }
///     fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
///         self.before = self.at;
///         self.at += if rng.random::<bool>() { 1 } else { -1 };
///         Some(self.cost())
///     }
///     fn accept(&mut self) {}
///     fn reject(&mut self) { self.at = self.before }
///     fn solution(&self) -> i32 { self.at }
/// }
/// let settings = Settings { temperatures: Some((0.5, 20.0)), ..Settings::default() };
/// let run = temper(&Walk { at: 0, before: 0 }, &settings, 1, |_| {})?;
/// assert_eq!((run.best, run.cost), (50, 0.0));
/// # Ok::<(), edifice_optim::tempering::TemperingError>(())
/// ```
pub fn temper<L, A: Answer>(
    landscape: &L,
    settings: &Settings,
    seed: u64,
    observer: impl FnMut(Step) -> A,
) -> Result<Run<L::Solution>, TemperingError>
where
    L: Landscape + Clone + Send,
    L::Solution: Send,
{
    let wrong = |setting, must| Err(TemperingError::Setting { setting, must });
    if settings.replicas < 2 {
        return wrong("replicas", "at least 2");
    }
    if settings.moves == 0 {
        return wrong("moves", "at least 1");
    }
    let (low, high) = match settings.temperatures {
        Some(given) => given,
        None => temperatures(landscape.clone(), &mut stream(seed, "tempering/trial", 0)),
    };
    if !(low > 0.0 && low < high && high.is_finite()) {
        return wrong("temperatures", "positive and rising");
    }
    let last = settings.replicas as f64 - 1.0;
    let replicas = (0..settings.replicas).map(|r| Replica {
        landscape: landscape.clone(),
        temperature: low * (high / low).powf(r as f64 / last),
        best: None,
        least: f64::INFINITY,
        rng: stream(seed, "tempering", r as u64),
    });
    let solver = Tempering {
        replicas: replicas.collect(),
        moves: settings.moves,
        odd: false,
        watch: Watch::new(settings.limits),
        rng: stream(seed, "tempering/exchange", 0),
    };
    let (start, cost) = (landscape.solution(), landscape.cost());
    let begin = |state: Search<L::Solution>| {
        let state = state.param(start).cost(cost);
        state.max_iters(settings.rounds)
    };
    let (run, _) = execute((), solver, |e| e.configure(begin), observer)
        .map_err(|error| TemperingError::Stopped(error.to_string()))?;
    Ok(run)
}

/// Lowest and highest temperature, by moves from a solution that a descent from where the landscape stands comes to.
///
/// A rise by d is accepted with probability `exp(-d / T)`: the highest is `median / ln 2`, the lowest `least / ln 100`. Where no move rises, 1 and
/// 2. Annealing may use them as its start and end.
pub fn temperatures<L: Landscape>(mut landscape: L, rng: &mut Stream) -> (f64, f64) {
    // Down to where moves mostly rise: from a random start nearly any move is an improvement, and large.
    let mut idle = 0;
    for _ in 0..DESCENT {
        let before = landscape.cost();
        let fell = match landscape.propose(rng) {
            Some(after) if after <= before => {
                landscape.accept();
                after < before
            }
            Some(_) => {
                landscape.reject();
                false
            }
            None => false,
        };
        idle = if fell { 0 } else { idle + 1 };
        if idle == TRIALS {
            break;
        }
    }
    let mut rises = Vec::new();
    for _ in 0..TRIALS {
        let before = landscape.cost();
        let Some(after) = landscape.propose(rng) else {
            continue;
        };
        if after - before > 1e-12 * before.abs() && after.is_finite() {
            rises.push(after - before);
        }
        landscape.reject();
    }
    rises.sort_by(f64::total_cmp);
    let (Some(&least), Some(&median)) = (rises.get(rises.len() / 20), rises.get(rises.len() / 2))
    else {
        return (1.0, 2.0);
    };
    let low = least / 100_f64.ln();
    (low, (median / 2_f64.ln()).max(2.0 * low))
}

struct Replica<L: Landscape> {
    landscape: L,
    temperature: f64,
    /// The best of this round, where it is better than all before.
    best: Option<L::Solution>,
    least: f64,
    rng: Stream,
}

impl<L: Landscape> Replica<L> {
    fn round(&mut self, moves: u32) {
        for _ in 0..moves {
            let before = self.landscape.cost();
            let Some(after) = self.landscape.propose(&mut self.rng) else {
                continue;
            };
            let rise = after - before;
            if rise <= 0.0 || self.rng.random::<f64>() < (-rise / self.temperature).exp() {
                self.landscape.accept();
            } else {
                self.landscape.reject();
                continue;
            }
            // A millionth keeps rounding noise from passing for progress.
            if after < self.least - 1e-6 {
                self.least = after;
                self.best = Some(self.landscape.solution());
            }
        }
    }
}

struct Tempering<L: Landscape> {
    /// From the lowest temperature to the highest.
    replicas: Vec<Replica<L>>,
    moves: u32,
    odd: bool,
    watch: Watch,
    rng: Stream,
}

impl<L: Landscape> Tempering<L> {
    fn exchange(&mut self) {
        let first = usize::from(self.odd);
        self.odd = !self.odd;
        for r in (first..self.replicas.len().saturating_sub(1)).step_by(2) {
            let [a, b] = &mut self.replicas[r..=r + 1] else {
                continue;
            };
            let cold = 1.0 / a.temperature - 1.0 / b.temperature;
            let gain = cold * (a.landscape.cost() - b.landscape.cost());
            if self.rng.random::<f64>() < gain.exp() {
                std::mem::swap(&mut a.landscape, &mut b.landscape);
            }
        }
    }
}

impl<L> Solver<(), Search<L::Solution>> for Tempering<L>
where
    L: Landscape + Send,
    L::Solution: Send,
{
    fn name(&self) -> &str {
        "parallel tempering"
    }

    fn next_iter(
        &mut self,
        _: &mut Problem<()>,
        state: Search<L::Solution>,
    ) -> Result<(Search<L::Solution>, Option<KV>), ArgminError> {
        let (moves, least) = (self.moves, state.get_best_cost());
        self.replicas.par_iter_mut().for_each(|r| {
            // Only what is better than the best of all is worth a copy.
            r.least = least;
            r.round(moves);
        });
        self.watch.evaluations += u64::from(moves) * self.replicas.len() as u64;
        let found = self
            .replicas
            .iter_mut()
            .filter_map(|r| Some((r.least, r.best.take()?)));
        let best = found.reduce(|a, b| if b.0 < a.0 { b } else { a });
        let now = self.replicas.iter().map(|r| r.landscape.cost());
        let now = now.fold(f64::INFINITY, f64::min);
        self.exchange();
        Ok((
            match best {
                Some((cost, solution)) => state.param(solution).cost(cost),
                // Not below the best but for rounding, which is no progress.
                None => state.cost(now.max(least)),
            },
            None,
        ))
    }

    fn terminate(&mut self, state: &Search<L::Solution>) -> TerminationStatus {
        self.watch.status(state.get_best_cost())
    }
}
