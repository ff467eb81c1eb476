//! The result of every optimizer, and the one way in which argmin runs them.

use std::ops::ControlFlow;

use argmin::core::{
    Error, Executor, IterState, KV, Problem, Solver, State, TerminationReason, TerminationStatus,
};

use edifice_base::{Progress, Watch};

use super::limits::{Answer, EVALUATIONS};

/// The result of a run.
///
/// `S` is the optimizer's form of a solution: a vector, a genome, the actions of a walk. The trace takes O(iterations) memory;
/// only a linear or quadratic program has one step for the whole run ([`qp::solve`](super::qp::solve)).
///
/// # Examples
/// ```
/// use edifice_optim::{Outcome, grid};
/// let run = grid::minimize(&[vec![3.0, 1.0, 2.0]], |x| Ok::<_, String>((x[0] - 1.2).powi(2)))?;
/// assert_eq!(run.best, [1.0]);
/// assert_eq!(run.outcome, Outcome::Converged);
/// // The cost of each point tried, and the least so far.
/// let best: Vec<f64> = run.trace.iter().map(|step| step.best).collect();
/// assert_eq!((run.trace.len(), best[2]), (3, run.cost));
/// assert!(run.trace[2].cost > best[2] && best.is_sorted_by(|a, b| a >= b));
/// # Ok::<(), grid::GridError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Run<S> {
    /// The solution of lowest cost, the first of several.
    pub best: S,
    /// Its cost.
    pub cost: f64,
    /// Why the run ended.
    pub outcome: Outcome,
    /// Every iteration, in order.
    pub trace: Vec<Step>,
}

/// One iteration of a run.
///
/// Both costs have the unit of the problem. Observers get each step when it is done; [`Run::trace`] keeps them all. [`Run`]
/// has an example.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Step {
    /// Iterations done before this one.
    pub iteration: u64,
    /// Cost of what this iteration found.
    pub cost: f64,
    /// Lowest cost so far.
    pub best: f64,
}

/// Why a run ended. None of these is an error: each is the answer to a well-posed question.
///
/// Every [`Run`] has one, as its example shows; [`Outcome::is_solved`] tells whether it is optimal. Which ones an optimizer can
/// return follows from its kind: only [`qp`](super::qp) knows `Infeasible` and `Unbounded`, for instance, and only
/// a search for a goal has `TargetReached`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Outcome {
    /// Solved: to the tolerance asked for, or because everything was tried.
    Converged,
    /// Solved, but less exactly than asked for.
    AlmostConverged,
    /// A solution as good as asked for was found.
    TargetReached,
    /// The iteration limit was reached.
    MaxIterations,
    /// The time limit was reached.
    TimeLimit,
    /// The limit of evaluations was reached.
    MaxEvaluations,
    /// The observer asked to stop.
    Stopped,
    /// The problem asked to stop, for example because memory is used up.
    Exhausted,
    /// No point satisfies the constraints.
    Infeasible,
    /// The cost has no lower bound on the feasible set.
    Unbounded,
    /// No progress, for example with numbers of too different sizes.
    Stalled,
}

impl Outcome {
    /// True if the solution is optimal to some tolerance.
    pub fn is_solved(self) -> bool {
        matches!(self, Self::Converged | Self::AlmostConverged)
    }

    /// The same while a run may still go on; `None` where it does.
    pub(super) fn reached(status: &TerminationStatus) -> Option<Self> {
        matches!(status, TerminationStatus::Terminated(_)).then(|| Self::of(status))
    }

    /// The outcome that argmin's status of termination means.
    fn of(status: &TerminationStatus) -> Self {
        let TerminationStatus::Terminated(reason) = status else {
            return Self::Stalled;
        };
        match reason {
            TerminationReason::SolverConverged => Self::Converged,
            TerminationReason::TargetCostReached => Self::TargetReached,
            TerminationReason::MaxItersReached => Self::MaxIterations,
            TerminationReason::Timeout => Self::TimeLimit,
            TerminationReason::SolverExit(why) if why == STOPPED => Self::Stopped,
            TerminationReason::SolverExit(why) if why == EVALUATIONS => Self::MaxEvaluations,
            // Our solvers exit by themselves for this reason only; no run listens to signals.
            TerminationReason::SolverExit(_) | TerminationReason::Interrupt => Self::Exhausted,
        }
    }
}

/// The observer of a run that tells the watch of a longer call of every step, of at most `most`.
///
/// # Examples
/// ```
/// use std::ops::ControlFlow;
/// use edifice_base::Progress;
/// use edifice_optim::{Step, tell};
/// let second = |progress: Progress| match progress.done {
///     2.. => ControlFlow::Break(()),
///     _ => ControlFlow::Continue(()),
/// };
/// let mut observer = tell(&second, Some(10));
/// assert!(observer(Step { iteration: 0, cost: 3.0, best: 3.0 }).is_continue());
/// assert!(observer(Step { iteration: 1, cost: 4.0, best: 3.0 }).is_break());
/// ```
pub fn tell<'a>(
    watch: &'a Watch<'a>,
    most: Option<u64>,
) -> impl FnMut(Step) -> ControlFlow<()> + 'a {
    move |step| {
        let done = Progress {
            done: step.iteration + 1,
            most,
            ..Progress::stage("iterations")
        };
        watch(done.costs(step.cost, step.best))
    }
}

/// argmin's state for solutions that have no gradient.
pub(super) type Search<S> = IterState<S, (), (), (), (), f64>;

/// Runs a solver on a problem (which may be borrowed) with argmin's executor, telling `observer` of
/// every iteration; returns the solver besides. `configure` sets limits and where to start.
///
/// # Errors
/// Those of the solver, and when it ends without a solution.
pub(super) fn execute<O, M, S: Clone, W: FnMut(Step) -> A, A: Answer>(
    problem: O,
    solver: M,
    configure: impl FnOnce(
        Executor<O, Watched<M, W>, Search<S>>,
    ) -> Executor<O, Watched<M, W>, Search<S>>,
    observer: W,
) -> Result<(Run<S>, M), Error>
where
    M: Solver<O, Search<S>>,
{
    let watched = Watched {
        inner: solver,
        observer,
        trace: Vec::new(),
        stopped: false,
    };
    let result = configure(Executor::new(problem, watched))
        .ctrlc(false)
        .run()?;
    let (state, watched) = (result.state, result.solver);
    let run = Run {
        best: (state.best_param).ok_or_else(|| Error::msg("no solution was found"))?,
        cost: state.best_cost,
        outcome: Outcome::of(&state.termination_status),
        trace: watched.trace,
    };
    Ok((run, watched.inner))
}

/// Name of the exit of argmin when the observer stops the run.
const STOPPED: &str = "stopped";

/// A solver whose iterations are recorded and told of, and which ends when its observer says so. (The observers of argmin
/// would have to outlive the run.)
pub(super) struct Watched<M, W> {
    inner: M,
    observer: W,
    trace: Vec<Step>,
    stopped: bool,
}

impl<O, S, M, W, A> Solver<O, Search<S>> for Watched<M, W>
where
    S: Clone,
    M: Solver<O, Search<S>>,
    W: FnMut(Step) -> A,
    A: Answer,
{
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn init(
        &mut self,
        problem: &mut Problem<O>,
        state: Search<S>,
    ) -> Result<(Search<S>, Option<KV>), Error> {
        self.inner.init(problem, state)
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<O>,
        state: Search<S>,
    ) -> Result<(Search<S>, Option<KV>), Error> {
        let (mut state, pairs) = self.inner.next_iter(problem, state)?;
        // The executor does so once more afterwards, which changes nothing.
        state.update();
        let step = Step {
            iteration: state.get_iter(),
            cost: state.get_cost(),
            best: state.get_best_cost(),
        };
        self.trace.push(step);
        self.stopped |= (self.observer)(step).stops();
        Ok((state, pairs))
    }

    fn terminate(&mut self, state: &Search<S>) -> TerminationStatus {
        if self.stopped {
            let reason = TerminationReason::SolverExit(STOPPED.to_owned());
            return TerminationStatus::Terminated(reason);
        }
        self.inner.terminate(state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn steps_are_told_whole() {
        let told = Mutex::new(Vec::new());
        let watch = |progress: Progress| {
            told.lock().unwrap().push(progress);
            ControlFlow::Continue(())
        };
        let mut observer = tell(&watch, Some(10));
        let step = Step {
            iteration: 3,
            cost: 2.5,
            best: 1.5,
        };
        assert!(observer(step).is_continue());
        drop(observer);
        let told = told.into_inner().unwrap();
        assert_eq!((told[0].done, told[0].most), (4, Some(10)));
        assert_eq!((told[0].cost, told[0].best), (Some(2.5), Some(1.5)));
    }
}
