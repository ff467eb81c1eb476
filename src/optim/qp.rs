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

use std::time::{Duration, Instant};

use argmin::core::{Error as ArgminError, Executor, KV, Problem, Solver, State, TerminationReason};
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT,
};

use super::qp_form::Form;
pub use super::qp_problem::{Duals, QpError, QuadraticProgram, Row};
use super::qp_warm::{Pair, solve_near};
use super::run::{Outcome, Search};

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

/// Result of [`solve`] and [`solve_from`].
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The point; `None` where there is none: the program is infeasible or unbounded, or the run ended before it was solved.
    pub best: Option<Vec<f64>>,
    /// The cost at the point; infinity for an infeasible program, minus infinity for an unbounded one, else not a number without a point.
    pub cost: f64,
    /// The price of each constraint, where there is a point.
    pub duals: Option<Duals>,
    /// The reason for which the run ended.
    pub outcome: Outcome,
    /// Interior-point iterations, and steps from the solution before ([`solve_from`]).
    pub iterations: u32,
    /// True if the solution before led here without the interior-point method.
    pub warm: bool,
}

/// Solves a convex quadratic program.
///
/// Sparse throughout: memory and time are Clarabel's, and those of one sparse factor of P, which tells whether it is positive semidefinite.
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
/// let found = solve(&program, QpOptions::default()).unwrap();
/// assert_eq!(found.outcome, Outcome::Converged);
/// let (x, duals) = (found.best.unwrap(), found.duals.unwrap());
/// assert!((x[0] - 1.5).abs() < 1e-6 && (x[1] - 0.5).abs() < 1e-6);
/// // One more on the right moves y towards 1 and spares 0.5; the bound spares 1.
/// assert!((duals.equalities[0] - 0.5).abs() < 1e-5 && (duals.upper[0] - 1.0).abs() < 1e-5);
/// // No point is both at most 0 and at least 1.
/// program.lower = vec![1.0; 2];
/// program.inequalities.push(Row::new([(1, 1.0)], 0.0));
/// let found = solve(&program, QpOptions::default()).unwrap();
/// assert_eq!((found.best, found.outcome), (None, Outcome::Infeasible));
/// ```
pub fn solve(program: &QuadraticProgram, options: QpOptions) -> Result<Solution, QpError> {
    execute(program, options, None)
}

/// As [`solve`], from the solution of a program that differs little: with numbers changed, not with other variables or constraints.
///
/// The constraints that were tight are assumed to be so, and corrected by at most eight Newton steps on the optimality conditions, each of one
/// sparse factor; an interior-point iteration takes one as well. Where these do not lead to the end, or the solution given has no point, the
/// interior-point method solves the program from the start. A start that is far away costs time alone: in the families of programs of OSQP, with
/// all costs and right-hand sides changed, the median was at most 1.7 times the time of [`solve`].
///
/// # Errors
/// As [`solve`]; [`QpError::Start`] for a solution of other numbers of variables, equalities or inequalities.
///
/// # Examples
/// ```
/// use edifice_optim::qp::{QpOptions, QuadraticProgram, Row, solve, solve_from};
/// let mut program = QuadraticProgram::new(2);
/// program.pull(0, 3.0, 1.0).pull(1, 1.0, 1.0);
/// program.equalities.push(Row::new([(0, 1.0), (1, 1.0)], 2.0));
/// program.upper[0] = 1.5;
/// let first = solve(&program, QpOptions::default())?;
/// program.equalities[0].right = 2.2;
/// let second = solve_from(&program, QpOptions::default(), &first)?;
/// assert!(second.warm && second.iterations == 1);
/// assert!((second.best.unwrap()[1] - 0.7).abs() < 1e-6);
/// # Ok::<(), edifice_optim::qp::QpError>(())
/// ```
pub fn solve_from(
    program: &QuadraticProgram,
    options: QpOptions,
    previous: &Solution,
) -> Result<Solution, QpError> {
    let pair = previous.best.as_deref().zip(previous.duals.as_ref());
    let n = program.dimension();
    let fits = |(x, duals): (&[f64], &Duals)| {
        [x.len(), duals.lower.len(), duals.upper.len()] == [n; 3]
            && duals.equalities.len() == program.equalities.len()
            && duals.inequalities.len() == program.inequalities.len()
    };
    match pair.is_none_or(fits) {
        true => execute(program, options, pair),
        false => Err(QpError::Start),
    }
}

fn execute(
    program: &QuadraticProgram,
    options: QpOptions,
    previous: Option<(&[f64], &Duals)>,
) -> Result<Solution, QpError> {
    program.check()?;
    let solver = InteriorPoint {
        options,
        previous,
        found: None,
    };
    let result = Executor::new(program, solver)
        .configure(|state: Search<Vec<f64>>| state.max_iters(1))
        .timer(false)
        .run()
        .map_err(|e| QpError::Solver(e.to_string()))?;
    let found = result.solver.found;
    found.ok_or_else(|| QpError::Solver("no iteration was run".to_owned()))
}

/// The interior-point method as an argmin solver: one argmin iteration is a whole run.
struct InteriorPoint<'a> {
    options: QpOptions,
    previous: Option<(&'a [f64], &'a Duals)>,
    found: Option<Solution>,
}

impl Solver<&QuadraticProgram, Search<Vec<f64>>> for InteriorPoint<'_> {
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
        let found = run(program, self.options, self.previous)?;
        let cost = found.cost;
        self.found = Some(found);
        let done = TerminationReason::SolverConverged;
        Ok((state.cost(cost).terminate_with(done), None))
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

/// Newton steps from the solution before, where there is one, and the interior-point method where these do not lead to the end.
fn run(
    program: &QuadraticProgram,
    options: QpOptions,
    previous: Option<(&[f64], &Duals)>,
) -> Result<Solution, QpError> {
    let (start, form) = (Instant::now(), Form::new(program));
    let mut steps = 0;
    let left = || {
        options
            .time_limit
            .map(|limit| limit.saturating_sub(start.elapsed()))
    };
    if let Some((x, duals)) = previous {
        let near = Pair {
            x: x.to_vec(),
            z: form.multipliers(duals),
        };
        let goes_on = || left() != Some(Duration::ZERO);
        let (tolerance, most) = (options.tolerance, options.max_iterations);
        let (found, count) = solve_near(&form, &program.linear, &near, tolerance, most, goes_on);
        if let Some(pair) = found {
            return Ok(Solution {
                cost: program.value(&pair.x),
                duals: Some(form.duals(&pair.z)),
                outcome: Outcome::Converged,
                iterations: count,
                warm: true,
                best: Some(pair.x),
            });
        }
        steps = count;
    }
    let cold = QpOptions {
        time_limit: left(),
        ..options
    };
    let found = interior_point(program, &form, cold)?;
    Ok(Solution {
        iterations: found.iterations + steps,
        ..found
    })
}

/// Clarabel on the matrices of a program.
fn interior_point(
    program: &QuadraticProgram,
    form: &Form,
    options: QpOptions,
) -> Result<Solution, QpError> {
    let (equalities, rows) = (form.equalities, form.right.len());
    let mut cones = Vec::new();
    if equalities > 0 {
        cones.push(SupportedConeT::ZeroConeT(equalities));
    }
    if rows > equalities {
        cones.push(SupportedConeT::NonnegativeConeT(rows - equalities));
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
    let (p, a) = (&form.quadratic, &form.rows);
    let mut solver = DefaultSolver::new(p, &program.linear, a, &form.right, &cones, settings)
        .map_err(|e| QpError::Solver(e.to_string()))?;
    solver.solve();
    let found = solver.solution;
    let outcome = outcome(found.status);
    let point = outcome.is_solved() && found.x.iter().all(|v| v.is_finite());
    let cost = match outcome {
        Outcome::Infeasible => f64::INFINITY,
        Outcome::Unbounded => f64::NEG_INFINITY,
        _ if point => program.value(&found.x),
        _ => f64::NAN,
    };
    Ok(Solution {
        cost,
        duals: point.then(|| form.duals(&found.z)),
        outcome,
        iterations: found.iterations,
        warm: false,
        best: point.then_some(found.x),
    })
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
            for (found, expected) in solution.best.unwrap().iter().zip(x) {
                prop_assert!((found - expected).abs() < 1e-4);
            }
        }
    }
}
