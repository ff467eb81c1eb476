//! Exhaustive search over a grid: every combination of the values of each variable.
//!
//! One iteration evaluates one point, the last variable fastest, so that limits, observers and
//! statuses are those of every other optimizer here.

use argmin::core::{
    CostFunction, Error as ArgminError, Executor, IterState, KV, Problem, Solver, State,
    TerminationReason, TerminationStatus,
};

type GridState = IterState<Vec<f64>, (), (), (), (), f64>;

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub struct GridOutcome {
    /// The first point of lowest cost.
    pub best: Vec<f64>,
    /// Its cost.
    pub cost: f64,
    /// Every point with its cost, in the order of evaluation.
    pub evaluated: Vec<(Vec<f64>, f64)>,
}

/// Why a search has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// A variable has no value to try, or there is no variable.
    #[error("variable {variable} has no value to try")]
    Empty {
        /// Index of the variable.
        variable: usize,
    },
    /// The cost could not be evaluated.
    #[error("{0}")]
    Cost(String),
}

/// The grid as an argmin solver.
struct Grid {
    axes: Vec<Vec<f64>>,
    evaluated: Vec<(Vec<f64>, f64)>,
}

struct Objective<F>(F);

impl<E: std::fmt::Display, F: Fn(&[f64]) -> Result<f64, E>> CostFunction for Objective<F> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, point: &Vec<f64>) -> Result<f64, ArgminError> {
        (self.0)(point).map_err(|error| GridError::Cost(error.to_string()).into())
    }
}

impl Grid {
    fn size(&self) -> usize {
        self.axes.iter().map(Vec::len).product()
    }

    /// The point of the given number, the last variable fastest.
    fn point(&self, mut number: usize) -> Vec<f64> {
        let mut point: Vec<f64> = self
            .axes
            .iter()
            .rev()
            .map(|values| {
                let value = values[number % values.len()];
                number /= values.len();
                value
            })
            .collect();
        point.reverse();
        point
    }
}

impl<O: CostFunction<Param = Vec<f64>, Output = f64>> Solver<O, GridState> for Grid {
    fn name(&self) -> &str {
        "Grid search"
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<O>,
        state: GridState,
    ) -> Result<(GridState, Option<KV>), ArgminError> {
        let point = self.point(self.evaluated.len());
        let cost = problem.cost(&point)?;
        self.evaluated.push((point.clone(), cost));
        Ok((state.param(point).cost(cost), None))
    }

    fn terminate(&mut self, _state: &GridState) -> TerminationStatus {
        if self.evaluated.len() == self.size() {
            TerminationStatus::Terminated(TerminationReason::SolverConverged)
        } else {
            TerminationStatus::NotTerminated
        }
    }
}

/// Minimizes `cost` over the grid spanned by `axes`, one list of values per variable.
///
/// Complexity: one evaluation per point, the product of the lengths.
///
/// # Errors
/// [`GridError::Empty`] when a variable has no values, [`GridError::Cost`] when `cost` fails.
///
/// # Examples
/// ```
/// use edifice::optim::grid::minimize;
/// let found = minimize(&[vec![0.0, 1.0, 2.0], vec![3.0, 4.0]], |p| {
///     Ok::<_, std::convert::Infallible>((p[0] - 1.0).abs() + p[1])
/// })?;
/// assert_eq!((found.best, found.cost), (vec![1.0, 3.0], 3.0));
/// assert_eq!(found.evaluated.len(), 6);
/// # Ok::<(), edifice::optim::grid::GridError>(())
/// ```
pub fn minimize<E: std::fmt::Display>(
    axes: &[Vec<f64>],
    cost: impl Fn(&[f64]) -> Result<f64, E>,
) -> Result<GridOutcome, GridError> {
    let empty = axes.iter().position(Vec::is_empty);
    if let Some(variable) = empty.or(axes.is_empty().then_some(0)) {
        return Err(GridError::Empty { variable });
    }
    let grid = Grid {
        axes: axes.to_vec(),
        evaluated: Vec::new(),
    };
    let points = grid.size() as u64;
    let run = Executor::new(Objective(cost), grid)
        .configure(|state| state.max_iters(points))
        .run()
        .map_err(|error| GridError::Cost(error.to_string()))?;
    let cost = run.state.get_best_cost();
    Ok(GridOutcome {
        best: run.state.get_best_param().cloned().unwrap_or_default(),
        cost,
        evaluated: run.solver.evaluated,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_first_of_equal_points_and_passes_errors_on() {
        let axes = [vec![1.0, 2.0], vec![5.0, 6.0]];
        let flat = minimize(&axes, |_| Ok::<_, String>(1.0)).expect("a grid");
        assert_eq!(flat.best, vec![1.0, 5.0]);
        let all: Vec<Vec<f64>> = flat.evaluated.into_iter().map(|point| point.0).collect();
        assert_eq!(
            all,
            [
                vec![1.0, 5.0],
                vec![1.0, 6.0],
                vec![2.0, 5.0],
                vec![2.0, 6.0]
            ]
        );
        let error = minimize(&axes, |_| Err::<f64, _>("no cost"));
        assert_eq!(error, Err(GridError::Cost("no cost".into())));
        let error = minimize(&[vec![1.0], vec![]], |_| Ok::<_, String>(1.0));
        assert_eq!(error, Err(GridError::Empty { variable: 1 }));
    }
}
