//! Simulated annealing on a landscape that changes in place.
//!
//! Metropolis acceptance: a move that changes the cost by `d > 0` is kept with probability
//! `exp(-d / T)`. The temperature falls geometrically, `T_n = start (end / start)^(n / (N - 1))`.
//! (argmin's own annealing accepts with `1 / (1 + exp(d / T))`, which is not Metropolis.)
//!
//! A [`Landscape`] tries a move in place and then either keeps it or takes it back, so that a move
//! costs what it changes and not what there is.

use argmin::core::{Error as ArgminError, KV, Problem, Solver, State};
use rand::{Rng, RngExt};

use super::limits::Answer;
use super::run::{Run, Search, Step, execute};
use edifice_base::rng::{Stream, stream};

/// A solution that can be changed a little and changed back.
///
/// A state machine: after [`Landscape::propose`] has returned a cost, exactly one of `accept` and `reject` follows, and
/// `reject` restores the former state and cost. For Metropolis' rule to sample `exp(-cost / T)` at a fixed temperature,
/// proposals have to be symmetric: as probable from x to y as from y to x.
/// One call of each per move, which should cost O(size of the change). [`Annealing`] has an example that minimizes.
///
/// # Examples
/// ```
/// use edifice_optim::annealing::Landscape;
/// use edifice_base::rng::stream;
/// use rand::{Rng, RngExt};
/// /// Walk on the integers towards 3.
/// struct Walk { at: i32, before: i32 }
/// impl Landscape for Walk {
///     type Solution = i32;
///     fn cost(&self) -> f64 { f64::from((self.at - 3).abs()) }
///     fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
///         self.before = self.at;
///         self.at += if rng.random::<bool>() { 1 } else { -1 };
///         Some(self.cost())
///     }
///     fn accept(&mut self) {}
///     fn reject(&mut self) { self.at = self.before }
///     fn solution(&self) -> i32 { self.at }
/// }
/// let mut walk = Walk { at: 0, before: 0 };
/// let tried = walk.propose(&mut stream(1, "walk", 0));
/// assert!(tried == Some(2.0) || tried == Some(4.0));
/// walk.reject();
/// assert_eq!((walk.solution(), walk.cost()), (0, 3.0));
/// ```
pub trait Landscape {
    /// The record that is kept of the best solution.
    type Solution: Clone;

    /// Cost of the solution as it stands.
    fn cost(&self) -> f64;
    /// Changes the solution tentatively; returns the new cost, or `None` when there was nothing to
    /// try (then nothing has changed).
    fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64>;
    /// Keeps the tentative change.
    fn accept(&mut self);
    /// Takes the tentative change back.
    fn reject(&mut self);
    /// The solution as it stands.
    fn solution(&self) -> Self::Solution;
}

/// Geometric cooling, `T_n = start (end / start)^(n / (N - 1))` at iteration n of N; both temperatures in units of cost.
///
/// A change of cost by d is accepted half of the time at `T = d / ln 2`: `start` is of the size of the largest changes to be
/// crossed, `end` well below the smallest difference that matters. Source: Kirkpatrick, Gelatt and Vecchi 1983.
///
/// # Examples
/// ```
/// use edifice_optim::annealing::Cooling;
/// let cooling = Cooling { start: 4.0, end: 1.0 };
/// let temperatures = [0, 1, 2].map(|n| cooling.at(n, 3));
/// assert!(temperatures.iter().zip([4.0, 2.0, 1.0]).all(|(t, expected)| (t - expected).abs() < 1e-12));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cooling {
    /// Temperature of the first move, in units of cost.
    pub start: f64,
    /// Temperature of the last move.
    pub end: f64,
}

impl Cooling {
    /// Temperature at `iteration` of `iterations`.
    pub fn at(self, iteration: u64, iterations: u64) -> f64 {
        let progress = iteration as f64 / (iterations.max(2) - 1) as f64;
        self.start * (self.end / self.start).powf(progress)
    }
}

/// The solver: Metropolis' rule under [`Cooling`] on a [`Landscape`]. One iteration of argmin is `moves` proposals at one
/// temperature; the trace has the least cost of each.
///
/// Complexity: `iterations * moves` proposals, and one copy of the solution per improvement of the best cost by more
/// than 1e-6, which also is the precision of the result. Sources: Metropolis et al. 1953; Kirkpatrick, Gelatt and Vecchi 1983.
///
/// # Examples
/// Numbers with signs, such that the sum is 0 (number partitioning):
/// ```
/// use edifice_optim::Outcome;
/// use edifice_optim::annealing::{Annealing, Cooling, Landscape};
/// use rand::{Rng, RngExt};
/// struct Signs { numbers: Vec<f64>, flipped: usize }
/// impl Landscape for Signs {
///     type Solution = Vec<f64>;
///     fn cost(&self) -> f64 { self.numbers.iter().sum::<f64>().abs() }
///     fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
///         self.flipped = rng.random_range(0..self.numbers.len());
///         self.reject(); // flips, which is its own inverse
///         Some(self.cost())
///     }
///     fn accept(&mut self) {}
///     fn reject(&mut self) { self.numbers[self.flipped] *= -1.0 }
///     fn solution(&self) -> Vec<f64> { self.numbers.clone() }
/// }
/// let mut signs = Signs { numbers: vec![8.0, 7.0, 6.0, 5.0, 4.0], flipped: 0 };
/// let cooling = Cooling { start: 10.0, end: 0.5 };
/// let run = Annealing::new(cooling, 100, 20, 1)?.until(0.0).run(&mut signs, |_| {})?;
/// assert_eq!((run.cost, run.outcome), (0.0, Outcome::TargetReached));
/// assert_eq!(run.best[0].signum(), run.best[1].signum()); // 8 + 7 = 6 + 5 + 4
/// # Ok::<(), edifice_optim::annealing::AnnealingError>(())
/// ```
#[derive(Debug)]
pub struct Annealing {
    cooling: Cooling,
    iterations: u64,
    moves: u32,
    goal: f64,
    rng: Stream,
}

/// The errors of a run: temperatures in [`Annealing::new`], anything else in [`Annealing::run`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AnnealingError {
    /// Temperatures must be positive numbers, the first at least the last.
    #[error("annealing temperatures {start} to {end} are not positive and falling")]
    Temperatures {
        /// The first temperature.
        start: f64,
        /// The last temperature.
        end: f64,
    },
    /// argmin failed.
    #[error("annealing stopped: {0}")]
    Stopped(String),
}

impl Annealing {
    /// A solver of `iterations` rounds of `moves` proposals each, with the randomness of `seed`.
    ///
    /// # Errors
    /// [`AnnealingError::Temperatures`].
    pub fn new(
        cooling: Cooling,
        iterations: u64,
        moves: u32,
        seed: u64,
    ) -> Result<Self, AnnealingError> {
        let Cooling { start, end } = cooling;
        if !(start.is_finite() && end > 0.0 && start >= end) {
            return Err(AnnealingError::Temperatures { start, end });
        }
        Ok(Self {
            cooling,
            iterations,
            moves,
            goal: f64::NEG_INFINITY,
            rng: stream(seed, "annealing", 0),
        })
    }

    /// Stops once a solution costs no more than `goal`, for instance where a bound shows that none costs less.
    #[must_use]
    pub fn until(self, goal: f64) -> Self {
        Self { goal, ..self }
    }

    /// Anneals, telling `observer` of every round; the landscape is left where the last move led.
    ///
    /// # Errors
    /// [`AnnealingError::Stopped`] when argmin fails.
    pub fn run<L: Landscape, A: Answer>(
        self,
        landscape: &mut L,
        observer: impl FnMut(Step) -> A,
    ) -> Result<Run<L::Solution>, AnnealingError> {
        let (iterations, goal) = (self.iterations, self.goal);
        let (start, cost) = (landscape.solution(), landscape.cost());
        let begin = |state: Search<L::Solution>| {
            let state = state.param(start).cost(cost);
            state.max_iters(iterations).target_cost(goal)
        };
        let (run, _) = execute(landscape, self, |e| e.configure(begin), observer)
            .map_err(|error| AnnealingError::Stopped(error.to_string()))?;
        Ok(run)
    }
}

impl<L: Landscape> Solver<&mut L, Search<L::Solution>> for Annealing {
    fn name(&self) -> &str {
        "simulated annealing"
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<&mut L>,
        mut state: Search<L::Solution>,
    ) -> Result<(Search<L::Solution>, Option<KV>), ArgminError> {
        let landscape = problem
            .problem
            .as_deref_mut()
            .ok_or_else(|| ArgminError::msg("no landscape"))?;
        let temperature = self.cooling.at(state.get_iter(), self.iterations);
        let mut round_best = f64::INFINITY;
        for _ in 0..self.moves {
            let before = landscape.cost();
            let Some(after) = landscape.propose(&mut self.rng) else {
                continue;
            };
            if after <= before || self.rng.random::<f64>() < ((before - after) / temperature).exp()
            {
                landscape.accept();
            } else {
                landscape.reject();
            }
            let cost = landscape.cost();
            if cost < round_best {
                round_best = cost;
                // A millionth keeps rounding noise from passing for progress.
                if cost < state.get_best_cost() - 1e-6 {
                    state = state.param(landscape.solution()).cost(cost);
                    state.update();
                }
            }
        }
        let cost = if round_best.is_finite() {
            round_best
        } else {
            landscape.cost()
        };
        Ok((state.cost(cost), None))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Outcome;

    /// Steps along a line with a shallow valley at 5, a barrier, and the optimum at 15.
    #[derive(Clone)]
    struct Valleys {
        at: i32,
        before: i32,
    }

    impl Landscape for Valleys {
        type Solution = i32;

        fn cost(&self) -> f64 {
            let distance = |to: i32| f64::from((self.at - to).abs());
            (1.0 + distance(5)).min(distance(15))
        }
        fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
            self.before = self.at;
            self.at = (self.at + if rng.random::<bool>() { 1 } else { -1 }).clamp(0, 20);
            Some(self.cost())
        }
        fn accept(&mut self) {}
        fn reject(&mut self) {
            self.at = self.before;
        }
        fn solution(&self) -> i32 {
            self.at
        }
    }

    const VALLEY: Valleys = Valleys { at: 5, before: 5 };

    /// A run from the shallow valley.
    fn run(start: f64, goal: f64, seed: u64) -> Run<i32> {
        let cooling = Cooling { start, end: 0.01 };
        let annealing = Annealing::new(cooling, 200, 50, seed).unwrap().until(goal);
        annealing.run(&mut VALLEY.clone(), |_| {}).unwrap()
    }

    #[test]
    fn heat_crosses_a_barrier_that_cold_does_not() {
        for seed in 0..5 {
            for (start, expected) in [(5.0, (15, 0.0)), (0.01, (5, 1.0))] {
                let found = run(start, f64::NEG_INFINITY, seed);
                assert_eq!((found.best, found.cost), expected);
                assert_eq!(found.outcome, Outcome::MaxIterations);
                assert_eq!(found.trace.len(), 200);
            }
        }
    }

    #[test]
    fn a_goal_ends_the_run() {
        let found = run(5.0, 0.5, 0);
        assert_eq!((found.best, found.cost), (15, 0.0));
        assert_eq!(found.outcome, Outcome::TargetReached);
        assert!(found.trace.len() < 200, "{}", found.trace.len());
        assert!(found.trace.windows(2).all(|w| w[1].best <= w[0].best));
        // What it starts from may be good enough.
        assert!(run(5.0, 1.0, 0).trace.len() <= 1);
    }

    #[test]
    fn temperatures_must_fall_and_be_positive() {
        for (start, end) in [
            (1.0, 2.0),
            (1.0, 0.0),
            (f64::NAN, 0.1),
            (f64::INFINITY, 1.0),
        ] {
            let refused = Annealing::new(Cooling { start, end }, 1, 1, 0);
            assert!(matches!(refused, Err(AnnealingError::Temperatures { .. })));
        }
    }
}
