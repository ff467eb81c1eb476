//! Approximate dynamic programming over a finite decision process.
//!
//! The problem: from an initial state, choose actions until the state is final, so that the sum of
//! the costs is smallest. Bellman's equation, deterministic version (Powell 2011; Wu et al. 2014,
//! Eq. 3):
//!
//! ```text
//! V_t(S_t) = min_a ( C_t(S_t, a) + V_{t+1}(S_{t+1}) )
//! ```
//!
//! Each iteration walks from the initial to a final state. At every step it *explores* with
//! probability `epsilon`, drawing an action from a heuristic, or else *exploits* an approximation
//! of the value function, taking the action that minimizes `C + V`. After the walk the
//! approximation learns from what was seen. `epsilon` decays exponentially (Sec. 4.2).
//!
//! Three traits say what the problem is: [`Process`], [`Heuristic`] and [`Approximation`]. The process
//! is theirs to change, so that what all three share (for example a table of states discovered so
//! far) can live in it.
//!
//! # Examples
//! ```
//! use edifice_optim::adp::{Adp, Approximation, Epsilon, Heuristic, Process};
//! use rand::{Rng, RngExt};
//!
//! /// Climb to step 10, one or three steps at a time; odd steps cost twice.
//! struct Stairs;
//! impl Process for Stairs {
//!     type State = usize;
//!     type Action = usize;
//!     fn initial(&self) -> usize { 0 }
//!     fn is_final(&self, s: &usize) -> bool { *s >= 10 }
//!     fn cost(&self, s: &usize, a: &usize) -> f64 { if (s + a) % 2 == 1 { 2.0 } else { 1.0 } }
//!     fn apply(&self, s: &mut usize, a: &usize) { *s += a }
//! }
//! struct Coin;
//! impl Heuristic<Stairs> for Coin {
//!     fn sample<R: Rng>(&mut self, _: &mut Stairs, _: &usize, rng: &mut R) -> usize {
//!         if rng.random::<bool>() { 1 } else { 3 }
//!     }
//! }
//! struct Table([f64; 13]);
//! impl Approximation<Stairs> for Table {
//!     fn best(&mut self, p: &mut Stairs, s: &usize) -> Option<usize> {
//!         [1, 3].into_iter().min_by(|a, b| (p.cost(s, a) + self.0[s + a]).total_cmp(&(p.cost(s, b) + self.0[s + b])))
//!     }
//!     fn learn(&mut self, _: &mut Stairs, walk: &[usize], costs: &[f64]) {
//!         let (mut state, mut rest): (usize, f64) = (0, costs.iter().sum());
//!         for (a, c) in walk.iter().zip(costs) {
//!             self.0[state] = self.0[state].min(rest);
//!             state += a;
//!             rest -= c;
//!         }
//!     }
//! }
//! let table = Table(std::array::from_fn(|s| if s >= 10 { 0.0 } else { 100.0 }));
//! let adp = Adp::new(Coin, table, Epsilon::default(), 500, 7);
//! let run = adp.run(&mut Stairs, |_| {}).unwrap();
//! assert_eq!(run.cost, 6.0); // 3 + 3 + 3 + 1 and its orders: 2 + 1 + 2 + 1
//! ```

use argmin::core::{Error as ArgminError, KV, Problem, Solver, State, TerminationReason};
use rand::{Rng, RngExt};

use super::limits::Answer;
use super::run::{Run, Search, Step, execute};
use edifice_base::rng::{Stream, stream};

/// A finite decision process with additive costs.
///
/// A walk is `S_0, a_0, S_1, .., S_T` with `S_0` from [`Process::initial`], `S_{t+1}` from [`Process::apply`] and `S_T`
/// final; its cost is `Σ_t C_t(S_t, a_t)`, in any one unit. A cost that depends on t keeps t in the state. Every sequence of
/// possible actions has to end in a final state, or [`Adp::run`] does not return.
///
/// Source: Wu et al. 2014, Eq. 3 and Sec. 4.2; Powell 2011. The [module](self)'s example solves a process with all three traits.
///
/// # Examples
/// ```
/// use edifice_optim::adp::Process;
/// /// Pay 6 with coins of 1, 3 and 4, each of cost 1.
/// struct Change;
/// impl Process for Change {
///     type State = u32;
///     type Action = u32;
///     fn initial(&self) -> u32 { 6 }
///     fn is_final(&self, left: &u32) -> bool { *left == 0 }
///     fn cost(&self, _: &u32, _: &u32) -> f64 { 1.0 }
///     fn apply(&self, left: &mut u32, coin: &u32) { *left -= coin }
/// }
/// let (mut left, mut cost) = (Change.initial(), 0.0);
/// for coin in [4, 1, 1] {
///     cost += Change.cost(&left, &coin);
///     Change.apply(&mut left, &coin);
/// }
/// assert!(Change.is_final(&left));
/// assert_eq!(cost, 3.0);
/// ```
pub trait Process {
    /// The state of a walk.
    type State;
    /// A decision.
    type Action: Clone;

    /// The state `S_0`.
    fn initial(&self) -> Self::State;
    /// True if no further walk is to begin, for example because memory is used up; asked after each walk.
    fn is_exhausted(&self) -> bool {
        false
    }
    /// True if nothing is left to decide.
    fn is_final(&self, state: &Self::State) -> bool;
    /// `C_t(S_t, a_t)`.
    fn cost(&self, state: &Self::State, action: &Self::Action) -> f64;
    /// Moves to the next state.
    fn apply(&self, state: &mut Self::State, action: &Self::Action);
}

/// The distribution from which exploration draws its actions.
///
/// One call of [`Heuristic::sample`] per explored step, so that its cost is a factor of the whole run's. An action that has
/// probability 0 here is found by no walk: the approximation only repeats actions that it has learnt of.
/// Source: Wu et al. 2014, Sec. 4.2. The [module](self) has an example.
pub trait Heuristic<P: Process> {
    /// An action that is possible in `state`, usually with probability proportional to `exp(-H)`.
    fn sample<R: Rng>(&mut self, process: &mut P, state: &P::State, rng: &mut R) -> P::Action;
    /// Called before each walk, for choices that hold for a whole walk.
    fn start_walk<R: Rng>(&mut self, _process: &mut P, _rng: &mut R) {}
}

/// The learnt approximation of the value function.
///
/// It stands for `V` in Bellman's equation (see the [module](self)): [`Approximation::best`] is
/// `argmin_a C(S, a) + V(S')`, over the actions that are known; [`Approximation::learn`] gets a walk of T actions from the
/// initial state and its T costs, in order, so that `Σ_{s >= t} costs[s]` is an upper bound of the optimal `V_t(S_t)`.
/// A table of the least such sums never rises and is exact once all walks have been seen: the [module](self)'s example keeps one.
pub trait Approximation<P: Process> {
    /// The action that minimizes `C + V`, or `None` when nothing is known of `state` yet.
    fn best(&mut self, process: &mut P, state: &P::State) -> Option<P::Action>;
    /// Learns from a finished walk and the cost of each of its actions.
    fn learn(&mut self, process: &mut P, walk: &[P::Action], costs: &[f64]);
}

/// A borrowed approximation, to keep what it has learnt.
impl<P: Process, V: Approximation<P>> Approximation<P> for &mut V {
    fn best(&mut self, process: &mut P, state: &P::State) -> Option<P::Action> {
        (**self).best(process, state)
    }

    fn learn(&mut self, process: &mut P, walk: &[P::Action], costs: &[f64]) {
        (**self).learn(process, walk, costs);
    }
}

/// Probability of exploring at iteration `n` of `N`: `start (end / start)^(n / (N - 1))`.
///
/// Valid are two positive probabilities (at most 1) in either order, or 0 for both, which never explores where
/// anything is known. Source: Wu et al. 2014, Sec. 4.2, with 0.9 at the start in Sec. 6.1.
///
/// # Examples
/// ```
/// use edifice_optim::adp::Epsilon;
/// let falling = Epsilon { start: 0.9, end: 0.1 };
/// // Of 5 iterations the middle one has the geometric mean of both ends.
/// for (n, expected) in [(0, 0.9), (2, 0.3), (4, 0.1)] {
///     assert!((falling.at(n, 5) - expected).abs() < 1e-12);
/// }
/// assert_eq!(Epsilon::ALWAYS_EXPLORE.at(3, 5), 1.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Epsilon {
    /// The share at the first iteration: 0.9 in Wu et al. 2014, Sec. 6.1.
    pub start: f64,
    /// The share at the last iteration.
    pub end: f64,
}

impl Default for Epsilon {
    fn default() -> Self {
        Self {
            start: 0.9,
            end: 0.1,
        }
    }
}

impl Epsilon {
    /// Only the heuristic: importance sampling.
    pub const ALWAYS_EXPLORE: Self = Self {
        start: 1.0,
        end: 1.0,
    };

    /// True if both are probabilities, and positive unless they are equal.
    fn is_valid(self) -> bool {
        let share = |p: f64| p > 0.0 && p <= 1.0;
        (share(self.start) && share(self.end)) || (self.start == 0.0 && self.end == 0.0)
    }

    /// The probability at `iteration` of `iterations`.
    pub fn at(self, iteration: u64, iterations: u64) -> f64 {
        if self.start == self.end {
            return self.start;
        }
        let progress = iteration as f64 / (iterations.max(2) - 1) as f64;
        self.start * (self.end / self.start).powf(progress)
    }
}

/// The solver: approximate dynamic programming over a [`Process`], from a [`Heuristic`] and an [`Approximation`].
///
/// One iteration of argmin is one walk, explored and exploited as the [module](self) says; the trace of the [`Run`] has the
/// cost of each walk. N walks of at most T steps take N T calls of `sample` or `best`, of `cost` and of `apply`, and N calls
/// of `learn`; memory is O(N + T) besides the caller's own. Source: Wu et al. 2014, Sec. 4.2.
/// The module's example runs it, and asserts the least cost.
#[derive(Debug)]
pub struct Adp<H, V> {
    heuristic: H,
    approximation: V,
    epsilon: Epsilon,
    iterations: u64,
    rng: Stream,
}

/// The errors of a run: returned by [`Adp::run`], before the first walk for the first two.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AdpError {
    /// Not a single iteration was asked for.
    #[error("approximate dynamic programming needs at least one iteration")]
    NoIterations,
    /// [`Epsilon`] is out of range.
    #[error(
        "probabilities of exploring from {start} to {end} are out of range: above 0, at most 1, or both 0"
    )]
    Epsilon {
        /// The share at the first iteration.
        start: f64,
        /// The share at the last iteration.
        end: f64,
    },
    /// The cost of no walk was a number.
    #[error("approximate dynamic programming stopped: {0}")]
    Stopped(String),
}

impl<H, V> Adp<H, V> {
    /// A solver that will walk `iterations` times with the randomness of `seed`.
    pub fn new(
        heuristic: H,
        approximation: V,
        epsilon: Epsilon,
        iterations: u64,
        seed: u64,
    ) -> Self {
        Self {
            heuristic,
            approximation,
            epsilon,
            iterations,
            rng: stream(seed, "adp", 0),
        }
    }
}

impl<H, V> Adp<H, V> {
    /// Runs all iterations, telling `observer` of each; returns the actions of the cheapest walk.
    /// Lend the approximation (`&mut`) to [`Adp::new`] to keep what it has learnt.
    ///
    /// # Errors
    /// [`AdpError`] when there is no iteration to run, an exploration probability is out of range, or no walk has a cost that
    /// is a number.
    pub fn run<P, A: Answer>(
        self,
        process: &mut P,
        observer: impl FnMut(Step) -> A,
    ) -> Result<Run<Vec<P::Action>>, AdpError>
    where
        P: Process,
        H: Heuristic<P>,
        V: Approximation<P>,
    {
        if self.iterations == 0 {
            return Err(AdpError::NoIterations);
        }
        if !self.epsilon.is_valid() {
            let Epsilon { start, end } = self.epsilon;
            return Err(AdpError::Epsilon { start, end });
        }
        let iterations = self.iterations;
        let limits = |state: Search<Vec<P::Action>>| state.max_iters(iterations);
        let (run, _) = execute(process, self, |e| e.configure(limits), observer)
            .map_err(|error| AdpError::Stopped(error.to_string()))?;
        Ok(run)
    }

    /// One iteration of Sec. 4.2: from the initial to a final state.
    fn walk<P>(&mut self, process: &mut P, epsilon: f64) -> (Vec<P::Action>, Vec<f64>)
    where
        P: Process,
        H: Heuristic<P>,
        V: Approximation<P>,
    {
        let (mut actions, mut costs) = (Vec::new(), Vec::new());
        let mut state = process.initial();
        self.heuristic.start_walk(process, &mut self.rng);
        while !process.is_final(&state) {
            let explore = self.rng.random::<f64>() < epsilon;
            let known = if explore {
                None
            } else {
                self.approximation.best(process, &state)
            };
            let action =
                known.unwrap_or_else(|| self.heuristic.sample(process, &state, &mut self.rng));
            costs.push(process.cost(&state, &action));
            process.apply(&mut state, &action);
            actions.push(action);
        }
        (actions, costs)
    }
}

impl<P, H, V> Solver<&mut P, Search<Vec<P::Action>>> for Adp<H, V>
where
    P: Process,
    H: Heuristic<P>,
    V: Approximation<P>,
{
    fn name(&self) -> &str {
        "approximate dynamic programming"
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<&mut P>,
        state: Search<Vec<P::Action>>,
    ) -> Result<(Search<Vec<P::Action>>, Option<KV>), ArgminError> {
        let process = problem
            .problem
            .as_deref_mut()
            .ok_or_else(|| ArgminError::msg("no process"))?;
        let epsilon = self.epsilon.at(state.get_iter(), self.iterations);
        let (walk, costs) = self.walk(process, epsilon);
        self.approximation.learn(process, &walk, &costs);
        let cost = costs.iter().sum::<f64>();
        // The walk itself is kept only when it is the best so far: argmin clones what it is given.
        let state = if cost < state.get_best_cost() {
            state.param(walk)
        } else {
            state
        };
        let state = match process.is_exhausted() {
            true => state.terminate_with(TerminationReason::SolverExit("exhausted".into())),
            false => state,
        };
        Ok((state.cost(cost), None))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exploration_falls_from_start_to_end_and_is_checked() {
        let falling = Epsilon::default();
        assert_eq!((falling.at(0, 5), falling.at(0, 1)), (0.9, 0.9));
        assert!((falling.at(4, 5) - 0.1).abs() < 1e-12);
        let never = Epsilon {
            start: 0.0,
            end: 0.0,
        };
        assert!(never.is_valid() && never.at(3, 5) == 0.0);
        for (start, end) in [
            (f64::NAN, 0.1),
            (0.9, f64::NAN),
            (0.0, 0.5),
            (1.5, 0.5),
            (0.9, -0.1),
        ] {
            assert!(!Epsilon { start, end }.is_valid());
        }
    }
}
