//! Exhaustive search over a grid: every combination of the values of each variable.
//!
//! One iteration evaluates one point, the last variable fastest, so that limits, observers and
//! statuses are those of every other optimizer here.

use argmin::core::{CostFunction, Error as ArgminError, KV, Problem, Solver};
use argmin::core::{TerminationReason, TerminationStatus};

use super::run::{Run, Search, execute};

/// Why a search has no result: from [`minimize`], [`GridError::Cost`] at the first point that fails.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// A variable has no value to try, or there is no variable.
    #[error("variable {variable} has no value to try")]
    Empty {
        /// Index of the variable.
        variable: usize,
    },
    /// A value to try is not a number.
    #[error("variable {variable}, value {index} is not a number")]
    Value {
        /// Index of the variable.
        variable: usize,
        /// Index among its values.
        index: usize,
    },
    /// The grid has more points than can be counted.
    #[error("the grid has more points than can be counted")]
    TooLarge,
    /// The cost could not be evaluated, or is a number nowhere.
    #[error("{0}")]
    Cost(String),
}

/// Every point of the grid spanned by `axes`, in the order of evaluation: the last variable fastest.
///
/// d axes of n_1, .., n_d values span `n_1 n_2 .. n_d` points of d values; none where an axis is empty, and one, the empty
/// point, without axes. Points are made when asked for, O(d) each. The number of points has to fit a `usize`,
/// which [`minimize`] checks and this does not.
///
/// # Examples
/// ```
/// use edifice_optim::grid::points;
/// let all: Vec<Vec<f64>> = points(&[vec![0.0, 1.0], vec![5.0, 6.0, 7.0]]).collect();
/// assert_eq!(all.len(), 6);
/// assert_eq!(all[..2], [[0.0, 5.0], [0.0, 6.0]]);
/// assert_eq!(all[5], [1.0, 7.0]);
/// ```
pub fn points(axes: &[Vec<f64>]) -> impl Iterator<Item = Vec<f64>> {
    let point = |mut number: usize| {
        let value = |values: &Vec<f64>| {
            let value = values[number % values.len()];
            number /= values.len();
            value
        };
        let mut point: Vec<f64> = axes.iter().rev().map(value).collect();
        point.reverse();
        point
    };
    (0..size(axes)).map(point)
}

fn size(axes: &[Vec<f64>]) -> usize {
    axes.iter().map(Vec::len).product()
}

/// The points still to come.
struct Grid<I> {
    points: I,
    left: usize,
}

struct Objective<F>(F);

impl<E: std::fmt::Display, F: Fn(&[f64]) -> Result<f64, E>> CostFunction for Objective<F> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, point: &Vec<f64>) -> Result<f64, ArgminError> {
        (self.0)(point).map_err(|error| GridError::Cost(error.to_string()).into())
    }
}

impl<O, I> Solver<O, Search<Vec<f64>>> for Grid<I>
where
    O: CostFunction<Param = Vec<f64>, Output = f64>,
    I: Iterator<Item = Vec<f64>>,
{
    fn name(&self) -> &str {
        "grid search"
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<O>,
        state: Search<Vec<f64>>,
    ) -> Result<(Search<Vec<f64>>, Option<KV>), ArgminError> {
        let next = self.points.next();
        let point = next.ok_or_else(|| ArgminError::msg("the grid has no further point"))?;
        let cost = problem.cost(&point)?;
        self.left -= 1;
        Ok((state.param(point).cost(cost), None))
    }

    fn terminate(&mut self, _: &Search<Vec<f64>>) -> TerminationStatus {
        match self.left {
            0 => TerminationStatus::Terminated(TerminationReason::SolverConverged),
            _ => TerminationStatus::NotTerminated,
        }
    }
}

/// Minimizes `cost` over the grid spanned by `axes`, one list of values per variable. The trace has
/// the cost of each of its [`points`].
///
/// Complexity: one evaluation per point, the product of the lengths.
///
/// # Errors
/// [`GridError::Empty`] when a variable has no values, [`GridError::Value`] for one that is not a number,
/// [`GridError::TooLarge`], [`GridError::Cost`] when `cost` fails.
///
/// # Examples
/// ```
/// use edifice_optim::grid::minimize;
/// let found = minimize(&[vec![0.0, 1.0, 2.0], vec![3.0, 4.0]], |p| {
///     Ok::<_, std::convert::Infallible>((p[0] - 1.0).abs() + p[1])
/// })?;
/// assert_eq!((found.best, found.cost), (vec![1.0, 3.0], 3.0));
/// assert_eq!(found.trace.len(), 6);
/// # Ok::<(), edifice_optim::grid::GridError>(())
/// ```
pub fn minimize<E: std::fmt::Display>(
    axes: &[Vec<f64>],
    cost: impl Fn(&[f64]) -> Result<f64, E>,
) -> Result<Run<Vec<f64>>, GridError> {
    let empty = axes.iter().position(Vec::is_empty);
    if let Some(variable) = empty.or(axes.is_empty().then_some(0)) {
        return Err(GridError::Empty { variable });
    }
    for (variable, values) in axes.iter().enumerate() {
        if let Some(index) = values.iter().position(|v| v.is_nan()) {
            return Err(GridError::Value { variable, index });
        }
    }
    let counted = axes.iter().try_fold(1_usize, |n, v| n.checked_mul(v.len()));
    if counted.is_none() {
        return Err(GridError::TooLarge);
    }
    let grid = Grid {
        points: points(axes),
        left: size(axes),
    };
    let (run, _) = execute(Objective(cost), grid, |e| e, |_| {})
        .map_err(|error| GridError::Cost(error.to_string()))?;
    Ok(run)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Outcome;

    #[test]
    fn finds_the_first_of_equal_points_and_passes_errors_on() {
        let axes = [vec![1.0, 2.0], vec![5.0, 6.0]];
        let flat = minimize(&axes, |_| Ok::<_, String>(1.0)).expect("a grid");
        assert_eq!(flat.best, vec![1.0, 5.0]);
        assert_eq!(flat.outcome, Outcome::Converged);
        assert_eq!(flat.trace.len(), 4);
        let all = [[1.0, 5.0], [1.0, 6.0], [2.0, 5.0], [2.0, 6.0]];
        assert!(points(&axes).eq(all.map(Vec::from)));
        let error = minimize(&axes, |_| Err::<f64, _>("no cost"));
        assert_eq!(error, Err(GridError::Cost("no cost".into())));
        let error = minimize(&[vec![1.0], vec![]], |_| Ok::<_, String>(1.0));
        assert_eq!(error, Err(GridError::Empty { variable: 1 }));
        let error = minimize(&[vec![1.0], vec![0.0, f64::NAN]], |_| Ok::<_, String>(1.0));
        let (variable, index) = (1, 1);
        assert_eq!(error, Err(GridError::Value { variable, index }));
        let wide = vec![vec![0.0; 1 << 16]; 4];
        let error = minimize(&wide, |_| Ok::<_, String>(1.0));
        assert_eq!(error, Err(GridError::TooLarge));
    }
}
