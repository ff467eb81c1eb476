//! Early ends of a run: one set of limits for every optimizer, and an observer that may stop.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use argmin::core::{TerminationReason, TerminationStatus};

/// Limits of a run; none unless given. One that is reached is an [`Outcome`](super::Outcome), not an error.
///
/// They are looked at after each iteration of an optimizer (a generation, a round of moves), so that a run may exceed them by one
/// iteration.
///
/// # Examples
/// ```
/// use edifice_optim::{Limits, Outcome, cmaes};
/// let bowl = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
/// let limits = Limits { target: Some(1e-6), ..Limits::default() };
/// let settings = cmaes::Settings { limits, ..cmaes::Settings::default() };
/// let run = cmaes::minimize(bowl, &[3.0, -1.0], &settings, 1, |_| {})?;
/// assert_eq!(run.outcome, Outcome::TargetReached);
/// # Ok::<(), cmaes::CmaError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits {
    /// Time at most.
    pub time: Option<Duration>,
    /// Evaluations of the cost (or moves tried) at most.
    pub evaluations: Option<u64>,
    /// A cost that is low enough.
    pub target: Option<f64>,
}

/// The answer of an observer to a step: `()` goes on; [`ControlFlow`] may stop the run, whose outcome is then
/// [`Outcome::Stopped`](super::Outcome::Stopped).
pub trait Answer {
    /// True if the run is to stop.
    fn stops(self) -> bool;
}

impl Answer for () {
    fn stops(self) -> bool {
        false
    }
}

impl Answer for ControlFlow<()> {
    fn stops(self) -> bool {
        self.is_break()
    }
}

/// Name of the exit of argmin when evaluations are used up.
pub(super) const EVALUATIONS: &str = "evaluations";

/// Limits while a run goes on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Watch {
    limits: Limits,
    start: Instant,
    /// Evaluations so far.
    pub evaluations: u64,
}

impl Watch {
    pub(crate) fn new(limits: Limits) -> Self {
        Self {
            limits,
            start: Instant::now(),
            evaluations: 0,
        }
    }

    /// The reason to end at this least cost so far, if any.
    pub(crate) fn status(&self, best: f64) -> TerminationStatus {
        let reason = if self.limits.target.is_some_and(|t| best <= t) {
            TerminationReason::TargetCostReached
        } else if self
            .limits
            .evaluations
            .is_some_and(|n| self.evaluations >= n)
        {
            TerminationReason::SolverExit(EVALUATIONS.to_owned())
        } else if self.limits.time.is_some_and(|t| self.start.elapsed() >= t) {
            TerminationReason::Timeout
        } else {
            return TerminationStatus::NotTerminated;
        };
        TerminationStatus::Terminated(reason)
    }
}
