//! The result of every optimizer, and the one way in which argmin runs them.

use argmin::core::{
    Error, Executor, IterState, KV, Problem, Solver, State, TerminationReason, TerminationStatus,
};
use edifice_base::{Progress, Watch};

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
/// Both costs have the unit of the problem. The watch of a run is told of each step when it is done; [`Run::trace`] keeps them
/// all. [`Run`] has an example.
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
    /// The problem asked to stop, for example because memory is used up.
    Exhausted,
    /// Its watch stopped it; the solution is the best until then.
    Interrupted,
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
            // Our solvers exit by themselves for this reason only.
            TerminationReason::SolverExit(_) => Self::Exhausted,
            // No run listens to signals.
            TerminationReason::Interrupt => Self::Interrupted,
        }
    }
}

/// argmin's state for solutions that have no gradient.
pub(super) type Search<S> = IterState<S, (), (), (), (), f64>;

/// Runs a solver on a problem (which may be borrowed) with argmin's executor, telling `watch` of
/// every iteration, of at most `most`; returns the solver besides. `configure` sets limits and where to start.
///
/// # Errors
/// Those of the solver, and when it ends without a solution.
pub(super) fn execute<O, M, S: Clone>(
    problem: O,
    solver: M,
    configure: impl FnOnce(
        Executor<O, Watching<'_, M>, Search<S>>,
    ) -> Executor<O, Watching<'_, M>, Search<S>>,
    watch: &Watch,
    most: Option<u64>,
) -> Result<(Run<S>, M), Error>
where
    M: Solver<O, Search<S>>,
{
    let watching = Watching {
        solver,
        watch,
        most,
        trace: Vec::new(),
    };
    let result = configure(Executor::new(problem, watching))
        .ctrlc(false)
        .run()?;
    let (state, watching) = (result.state, result.solver);
    let run = Run {
        best: (state.best_param).ok_or_else(|| Error::msg("no solution was found"))?,
        cost: state.best_cost,
        outcome: Outcome::of(&state.termination_status),
        trace: watching.trace,
    };
    Ok((run, watching.solver))
}

/// A solver whose iterations are recorded and told of; argmin's own observers would have to outlive the run.
pub(super) struct Watching<'a, M> {
    solver: M,
    watch: &'a Watch<'a>,
    most: Option<u64>,
    trace: Vec<Step>,
}

impl<O, S: Clone, M: Solver<O, Search<S>>> Solver<O, Search<S>> for Watching<'_, M> {
    fn name(&self) -> &str {
        self.solver.name()
    }

    fn init(
        &mut self,
        problem: &mut Problem<O>,
        state: Search<S>,
    ) -> Result<(Search<S>, Option<KV>), Error> {
        self.solver.init(problem, state)
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<O>,
        state: Search<S>,
    ) -> Result<(Search<S>, Option<KV>), Error> {
        let (mut state, kv) = self.solver.next_iter(problem, state)?;
        // The executor does so afterwards again, which changes nothing.
        state.update();
        let step = Step {
            iteration: state.get_iter(),
            cost: state.get_cost(),
            best: state.get_best_cost(),
        };
        self.trace.push(step);
        let progress = Progress {
            most: self.most,
            ..Progress::stage("iterations")
        };
        let told = (self.watch)(
            Progress {
                done: step.iteration + 1,
                ..progress
            }
            .costs(step.cost, step.best),
        );
        if told.is_break() && !state.terminated() {
            state = state.terminate_with(TerminationReason::Interrupt);
        }
        Ok((state, kv))
    }

    fn terminate(&mut self, state: &Search<S>) -> TerminationStatus {
        self.solver.terminate(state)
    }
}
