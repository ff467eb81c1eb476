//! Nonlinear least squares: minimise `|r(x)|^2` by Levenberg and Marquardt's damped Gauss-Newton
//! steps (Nocedal and Wright 2006, Sec. 10.3), derivatives by forward differences.
//!
//! Each iteration solves `(J'J + m D) d = -J'r`, `D` the diagonal of `J'J` plus one, shortens `d` to
//! the largest step allowed, and keeps it when the sum falls; the damping `m` falls by 4 then and
//! rises by 4 otherwise. With fewer residuals than variables the steps stay short where the residuals do not care.

use argmin::core::{
    Error as ArgminError, KV, Problem, Solver, TerminationReason, TerminationStatus,
};
use nalgebra::{DMatrix, DVector};

use super::limits::Answer;
use super::run::{Run, Search, Step, execute};

/// A vector of residuals that depends on a vector of variables.
///
/// `r: R^n -> R^m`, differentiable, and m the same for every x. All residuals should have one unit, or be divided by their
/// standard deviations: then the sum of squares is twice a negative log likelihood of Gaussian errors.
/// [`minimize`] calls it n + 1 times or more an iteration, and has an example.
pub trait Residuals {
    /// Writes the residuals at `x` into `out`, always the same number of them, all finite.
    fn residuals(&self, x: &[f64], out: &mut Vec<f64>);
}

/// Limits of a run of [`minimize`], whose example uses them.
///
/// `step` and `difference` have the unit of the variables. For variables of size 1 and residuals computed to machine
/// precision, a `difference` near `sqrt(f64::EPSILON)`, about 1e-8, has the least error (Nocedal and Wright 2006, Sec. 8.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Iterations at most.
    pub iterations: u64,
    /// Largest change of one variable in one iteration.
    pub step: f64,
    /// Sum of squares at which to stop.
    pub goal: f64,
    /// Step of the differences.
    pub difference: f64,
}

/// A run of [`minimize`] failed within argmin; limits that are reached are an [`Outcome`](super::Outcome) instead.
#[derive(Debug, thiserror::Error)]
#[error("least squares stopped: {0}")]
pub struct LeastSquaresError(String);

/// Minimises the sum of squares from `start`, telling `observer` of every iteration. The cost of the run is the sum of
/// squared residuals; reaching a limit is no error.
///
/// The steps are in the [module](self)'s formula, for m residuals of n variables. A local minimum is found, the one whose
/// basin `start` is in. [`Outcome::Converged`](super::Outcome::Converged) where no step lowers the sum by more than one
/// part in 10^12.
///
/// Complexity of an iteration: n + 1 evaluations of the residuals, O(m n²) for `J'J` and O(n³) for its factor; for each
/// step refused one evaluation and one factor more. Memory O(m n). Sources: Levenberg 1944; Marquardt 1963.
///
/// # Errors
/// [`LeastSquaresError`] when argmin fails.
///
/// # Examples
/// A decay `y = a exp(-b t)` through four points without errors:
/// ```
/// use edifice_optim::least_squares::{Limits, Residuals, minimize};
/// struct Decay(Vec<(f64, f64)>);
/// impl Residuals for Decay {
///     fn residuals(&self, x: &[f64], out: &mut Vec<f64>) {
///         out.extend(self.0.iter().map(|(t, y)| x[0] * (-x[1] * t).exp() - y));
///     }
/// }
/// let points = (0..4).map(|t| (f64::from(t), 2.0 * (-0.5 * f64::from(t)).exp()));
/// let limits = Limits { iterations: 100, step: 1.0, goal: 1e-20, difference: 1e-7 };
/// let fit = minimize(&Decay(points.collect()), vec![1.0, 0.0], limits, |_| {})?;
/// assert!((fit.best[0] - 2.0).abs() < 1e-6 && (fit.best[1] - 0.5).abs() < 1e-6);
/// assert!(fit.cost < 1e-12);
/// # Ok::<(), edifice_optim::least_squares::LeastSquaresError>(())
/// ```
pub fn minimize<R: Residuals, A: Answer>(
    residuals: &R,
    start: Vec<f64>,
    limits: Limits,
    observer: impl FnMut(Step) -> A,
) -> Result<Run<Vec<f64>>, LeastSquaresError> {
    let mut first = Vec::new();
    residuals.residuals(&start, &mut first);
    let cost = sum(&first);
    let solver = LevenbergMarquardt {
        limits,
        damping: 1e-2,
        residuals: first,
        stuck: false,
    };
    let begin = |state: Search<Vec<f64>>| {
        let state = state.param(start).cost(cost);
        state.max_iters(limits.iterations).target_cost(limits.goal)
    };
    let run = execute(residuals, solver, |e| e.configure(begin), observer);
    let (run, _) = run.map_err(|e| LeastSquaresError(e.to_string()))?;
    Ok(run)
}

fn sum(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum()
}

/// The method as an argmin solver: one iteration is one step taken, or the last one.
struct LevenbergMarquardt {
    limits: Limits,
    damping: f64,
    /// The residuals at the present point.
    residuals: Vec<f64>,
    stuck: bool,
}

/// Damping beyond which no step is tried.
const MOST_DAMPING: f64 = 1e8;

impl<R: Residuals> Solver<&R, Search<Vec<f64>>> for LevenbergMarquardt {
    fn name(&self) -> &str {
        "Levenberg-Marquardt"
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<&R>,
        mut state: Search<Vec<f64>>,
    ) -> Result<(Search<Vec<f64>>, Option<KV>), ArgminError> {
        let function = problem.problem;
        let function = function.ok_or_else(|| ArgminError::msg("no residuals"))?;
        let x = state.take_param().unwrap_or_default();
        let cost = sum(&self.residuals);
        let (normal, gradient) = self.linearize(function, &x);
        while self.damping < MOST_DAMPING {
            if let Some(next) = self.step(&normal, &gradient, &x) {
                let mut residuals = Vec::with_capacity(self.residuals.len());
                function.residuals(&next, &mut residuals);
                let now = sum(&residuals);
                if now < cost {
                    self.stuck = cost - now < 1e-12 * cost;
                    self.residuals = residuals;
                    self.damping = (self.damping / 4.0).max(1e-9);
                    return Ok((state.param(next).cost(now), None));
                }
            }
            self.damping *= 4.0;
        }
        self.stuck = true;
        Ok((state.param(x).cost(cost), None))
    }

    fn terminate(&mut self, _state: &Search<Vec<f64>>) -> TerminationStatus {
        if self.stuck {
            return TerminationStatus::Terminated(TerminationReason::SolverConverged);
        }
        TerminationStatus::NotTerminated
    }
}

impl LevenbergMarquardt {
    /// `J'J` and `J'r` at `x`.
    fn linearize(&self, function: &impl Residuals, x: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let (m, n) = (self.residuals.len(), x.len());
        let mut jacobian = DMatrix::zeros(m, n);
        let (mut moved, mut out) = (x.to_vec(), Vec::with_capacity(m));
        for k in 0..n {
            moved[k] = x[k] + self.limits.difference;
            out.clear();
            function.residuals(&moved, &mut out);
            moved[k] = x[k];
            for i in 0..m {
                jacobian[(i, k)] = (out[i] - self.residuals[i]) / self.limits.difference;
            }
        }
        let residuals = DVector::from_column_slice(&self.residuals);
        (jacobian.tr_mul(&jacobian), jacobian.tr_mul(&residuals))
    }

    /// The damped step from `x`, no variable changing by more than allowed.
    fn step(&self, normal: &DMatrix<f64>, gradient: &DVector<f64>, x: &[f64]) -> Option<Vec<f64>> {
        let mut damped = normal.clone();
        for k in 0..x.len() {
            damped[(k, k)] += self.damping * (1.0 + normal[(k, k)]);
        }
        let step = damped.cholesky()?.solve(gradient);
        let longest = step.amax();
        let scale = (self.limits.step / longest).min(1.0);
        let next = x.iter().zip(step.iter()).map(|(x, d)| x - scale * d);
        let next: Vec<f64> = next.collect();
        next.iter().all(|v| v.is_finite()).then_some(next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Rosenbrock;

    impl Residuals for Rosenbrock {
        fn residuals(&self, x: &[f64], out: &mut Vec<f64>) {
            out.extend([10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]);
        }
    }

    struct Line(Vec<(f64, f64)>);

    impl Residuals for Line {
        fn residuals(&self, x: &[f64], out: &mut Vec<f64>) {
            out.extend(self.0.iter().map(|(t, y)| x[0] + x[1] * t - y));
        }
    }

    const LIMITS: Limits = Limits {
        iterations: 200,
        step: 1.5,
        goal: 1e-20,
        difference: 1e-7,
    };

    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        let fit = minimize(&Rosenbrock, vec![-1.2, 1.0], LIMITS, |_| {}).unwrap();
        assert!((fit.best[0] - 1.0).abs() < 1e-6 && (fit.best[1] - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_line_is_fitted_as_the_normal_equations_say() {
        let points = vec![(0.0, 1.0), (1.0, 2.0), (2.0, 4.0)];
        let fit = minimize(&Line(points), vec![0.0, 0.0], LIMITS, |_| {}).unwrap();
        // Normal equations by hand: slope 3/2, intercept 5/6.
        assert!((fit.best[1] - 1.5).abs() < 1e-6 && (fit.best[0] - 5.0 / 6.0).abs() < 1e-6);
        assert!((fit.cost - 1.0 / 6.0).abs() < 1e-9);
    }

    #[test]
    fn more_variables_than_residuals() {
        struct Total;
        impl Residuals for Total {
            fn residuals(&self, x: &[f64], out: &mut Vec<f64>) {
                out.push(x.iter().sum::<f64>() - 9.0);
            }
        }
        let fit = minimize(&Total, vec![0.0; 3], LIMITS, |_| {}).unwrap();
        assert!(fit.cost < 1e-12);
        assert!(
            fit.best.iter().all(|v| (v - 3.0).abs() < 1e-5),
            "{:?}",
            fit.best
        );
    }
}
