//! Convex quadratic programming.
//!
//! ```text
//! minimise    1/2 x' P x + q' x           x in R^n, P symmetric positive semidefinite
//! subject to  E x  = e                    equalities
//!             A x <= b                    inequalities
//!             l <= x <= u                 bounds, infinite where there is none
//! ```
//! The mathematics is the interior-point method of Clarabel (Goulart and Chen 2024), wrapped as an
//! argmin [`Solver`], so that limits, observers and statuses are those of every other optimizer here.
//! Clarabel returns "solved" for a P that is not positive semidefinite: that is checked at the door.

use std::time::Duration;

use argmin::core::{Error as ArgminError, Executor, KV, Problem, Solver, State, TerminationReason};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT,
};

pub use super::qp_problem::{QpError, QuadraticProgram, Row};
use super::run::{Outcome, Run, Search, Step};

/// Limits of a run of [`solve`], whose example uses the default: 200 iterations, no limit of time, tolerance 1e-9. A limit
/// that is reached is an [`Outcome`], not an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QpOptions {
    /// Interior-point iterations at most.
    pub max_iterations: u32,
    /// Time at most; no limit unless given.
    pub time_limit: Option<Duration>,
    /// Relative and absolute tolerance of feasibility and optimality.
    pub tolerance: f64,
}

impl Default for QpOptions {
    fn default() -> Self {
        Self {
            max_iterations: 200,
            time_limit: None,
            tolerance: 1e-9,
        }
    }
}

/// Solves a convex quadratic program. The solution means something where the outcome
/// [is solved](Outcome::is_solved); the trace has one step, the last of the interior-point iterations.
///
/// # Errors
/// [`QpError`] when the program is not one: dimensions that do not fit, numbers that are not finite,
/// crossed bounds, P not positive semidefinite. Stopping early is an outcome.
///
/// # Examples
/// ```
/// use edifice_optim::Outcome;
/// use edifice_optim::qp::{QpOptions, QuadraticProgram, Row, solve};
/// // The point nearest to (3, 1) on the line x + y = 2, with x at most 1.5.
/// let mut program = QuadraticProgram::new(2);
/// program.pull(0, 3.0, 1.0).pull(1, 1.0, 1.0);
/// program.equalities.push(Row::new([(0, 1.0), (1, 1.0)], 2.0));
/// program.upper[0] = 1.5;
/// let run = solve(&program, QpOptions::default()).unwrap();
/// assert_eq!(run.outcome, Outcome::Converged);
/// assert!((run.best[0] - 1.5).abs() < 1e-6 && (run.best[1] - 0.5).abs() < 1e-6);
/// ```
pub fn solve(program: &QuadraticProgram, options: QpOptions) -> Result<Run<Vec<f64>>, QpError> {
    program.check()?;
    let solver = InteriorPoint {
        options,
        outcome: Outcome::Stalled,
        iterations: 0,
    };
    let result = Executor::new(program, solver)
        .configure(|state| state.max_iters(1))
        .timer(false)
        .run()
        .map_err(|e| QpError::Solver(e.to_string()))?;
    let mut state = result.state;
    let cost = state.get_cost();
    Ok(Run {
        // argmin's best point has a cost that is a number; where there is no solution, the last may have none.
        best: state.take_param().unwrap_or_default(),
        cost,
        outcome: result.solver.outcome,
        trace: vec![Step {
            iteration: u64::from(result.solver.iterations),
            cost,
            best: cost,
        }],
    })
}

/// The interior-point method as an argmin solver: one argmin iteration is a whole run.
struct InteriorPoint {
    options: QpOptions,
    outcome: Outcome,
    iterations: u32,
}

impl Solver<&QuadraticProgram, Search<Vec<f64>>> for InteriorPoint {
    fn name(&self) -> &str {
        "interior point (Clarabel)"
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<&QuadraticProgram>,
        state: Search<Vec<f64>>,
    ) -> Result<(Search<Vec<f64>>, Option<KV>), ArgminError> {
        let program = problem
            .problem
            .ok_or_else(|| ArgminError::msg("no program"))?;
        let (x, status, iterations) = run_clarabel(program, self.options)?;
        self.iterations = iterations;
        self.outcome = outcome(status);
        let cost = program.value(&x);
        let done = TerminationReason::SolverConverged;
        Ok((state.param(x).cost(cost).terminate_with(done), None))
    }
}

fn outcome(status: SolverStatus) -> Outcome {
    match status {
        SolverStatus::Solved => Outcome::Converged,
        SolverStatus::AlmostSolved => Outcome::AlmostConverged,
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            Outcome::Infeasible
        }
        SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Outcome::Unbounded,
        SolverStatus::MaxIterations => Outcome::MaxIterations,
        SolverStatus::MaxTime => Outcome::TimeLimit,
        _ => Outcome::Stalled,
    }
}

/// Clarabel's form: equalities, then inequalities, then bounds as rows of one matrix.
fn run_clarabel(
    program: &QuadraticProgram,
    options: QpOptions,
) -> Result<(Vec<f64>, SolverStatus, u32), QpError> {
    let n = program.dimension();
    let mut rows = Triplets::default();
    for row in &program.equalities {
        rows.push(row.terms.iter().copied(), row.right);
    }
    let equalities = rows.count();
    for row in &program.inequalities {
        rows.push(row.terms.iter().copied(), row.right);
    }
    for i in 0..n {
        if program.upper[i] < f64::INFINITY {
            rows.push([(i, 1.0)], program.upper[i]);
        }
        if program.lower[i] > f64::NEG_INFINITY {
            rows.push([(i, -1.0)], -program.lower[i]);
        }
    }
    let mut cones = Vec::new();
    if equalities > 0 {
        cones.push(SupportedConeT::ZeroConeT(equalities));
    }
    if rows.count() > equalities {
        cones.push(SupportedConeT::NonnegativeConeT(rows.count() - equalities));
    }
    let mut upper = Triplets::default();
    for &(i, j, value) in &program.quadratic {
        upper.entry(i.min(j), i.max(j), value);
    }
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .max_iter(options.max_iterations)
        .time_limit(
            options
                .time_limit
                .map_or(f64::INFINITY, |t| t.as_secs_f64()),
        )
        .tol_gap_abs(options.tolerance)
        .tol_gap_rel(options.tolerance)
        .tol_feas(options.tolerance)
        .build()
        .map_err(|e| QpError::Solver(e.to_string()))?;
    let p = upper.matrix(n, n);
    let right = std::mem::take(&mut rows.right);
    let a = rows.matrix(right.len(), n);
    let mut solver = DefaultSolver::new(&p, &program.linear, &a, &right, &cones, settings)
        .map_err(|e| QpError::Solver(e.to_string()))?;
    solver.solve();
    let solution = solver.solution;
    Ok((solution.x, solution.status, solution.iterations))
}

/// A sparse matrix while it is written.
#[derive(Default)]
struct Triplets {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    right: Vec<f64>,
}

impl Triplets {
    fn entry(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    fn push(&mut self, terms: impl IntoIterator<Item = (usize, f64)>, right: f64) {
        let row = self.right.len();
        for (column, value) in terms {
            self.entry(row, column, value);
        }
        self.right.push(right);
    }

    fn count(&self) -> usize {
        self.right.len()
    }

    fn matrix(self, rows: usize, columns: usize) -> CscMatrix<f64> {
        CscMatrix::new_from_triplets(rows, columns, self.rows, self.columns, self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn stopping_is_an_outcome() {
        let mut program = QuadraticProgram::new(1);
        program.linear[0] = 1.0;
        let run = |p: &QuadraticProgram| solve(p, QpOptions::default()).unwrap().outcome;
        assert_eq!(run(&program), Outcome::Unbounded);
        program.inequalities.push(Row::new([(0, 1.0)], -1.0));
        program.lower[0] = 0.0;
        assert_eq!(run(&program), Outcome::Infeasible);
        let mut far = QuadraticProgram::new(2);
        far.pull(0, 1.0, 3.0).pull(1, 2.0, 1.0);
        far.inequalities.push(Row::new([(0, 1.0), (1, 1.0)], 1.0));
        let options = QpOptions {
            max_iterations: 1,
            ..QpOptions::default()
        };
        assert_eq!(
            solve(&far, options).unwrap().outcome,
            Outcome::MaxIterations
        );
    }

    proptest! {
        /// Oracle: projected gradient, slow and obvious, for a box.
        #[test]
        fn agrees_with_projected_gradient(
            target in prop::collection::vec(-2.0f64..2.0, 3),
            mix in prop::collection::vec(-1.0f64..1.0, 3),
        ) {
            // P = I + m m', so that P is positive definite; box -1..1.
            let mut program = QuadraticProgram::new(3);
            for i in 0..3 {
                program.linear[i] = -target[i];
                (program.lower[i], program.upper[i]) = (-1.0, 1.0);
                for j in i..3 {
                    let identity = if i == j { 1.0 } else { 0.0 };
                    program.quadratic.push((i, j, identity + mix[i] * mix[j]));
                }
            }
            let mut x = [0.0f64; 3];
            for _ in 0..4000 {
                let dot: f64 = (0..3).map(|i| mix[i] * x[i]).sum();
                for i in 0..3 {
                    x[i] = (x[i] - 0.2 * (x[i] + mix[i] * dot - target[i])).clamp(-1.0, 1.0);
                }
            }
            let solution = solve(&program, QpOptions::default()).unwrap();
            prop_assert_eq!(solution.outcome, Outcome::Converged);
            for (found, expected) in solution.best.iter().zip(x) {
                prop_assert!((found - expected).abs() < 1e-4);
            }
        }
    }
}
