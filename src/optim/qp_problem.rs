//! The statement of a quadratic program, checked at the door.

use clarabel::qdldl::{QDLDLFactorisation, QDLDLSettingsBuilder};
use nalgebra::DMatrix;

use super::triplets::Triplets;

/// Eigenvalues below zero by less than this share of the largest are rounding.
const ROUNDING: f64 = 1e-10;
/// Variables up to which all eigenvalues are computed where P is not positive semidefinite.
const FEW: usize = 300;
/// Steps of the power method for more variables.
const POWER_STEPS: usize = 2000;

/// minimise 1/2 x' P x + q' x subject to equalities, inequalities and bounds; see
/// [`qp`](super::qp).
///
/// n variables; P is n x n and symmetric positive semidefinite, stored by its entries on and on one side of the diagonal;
/// constraints are sparse rows. Memory is O(n + entries + terms). [`QuadraticProgram::check`] decides whether the numbers are a
/// convex program; a missing lower or upper bound is an infinity of the right sign.
/// Source: Boyd and Vandenberghe, *Convex Optimization* (2004), Sec. 4.4.
///
/// # Examples
/// P has the rows (2, 1) and (1, 2), q is (-3, -3); the minimum is where `P x = -q`, at (1, 1):
/// ```
/// use edifice_optim::qp::{QpError, QpOptions, QuadraticProgram, solve};
/// let mut program = QuadraticProgram::new(2);
/// program.quadratic = vec![(0, 0, 2.0), (0, 1, 1.0), (1, 1, 2.0)];
/// program.linear = vec![-3.0, -3.0];
/// assert_eq!(program.value(&[1.0, 1.0]), -3.0);
/// let found = solve(&program, QpOptions::default())?;
/// assert!(found.best.unwrap().iter().all(|x| (x - 1.0).abs() < 1e-6));
/// program.quadratic[1].2 = 3.0; // eigenvalues 5 and -1
/// assert!(matches!(program.check(), Err(QpError::NotConvex(_))));
/// # Ok::<(), QpError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct QuadraticProgram {
    /// Entries `(i, j, value)` of the symmetric P, each pair `i`, `j` given once, in either order
    /// (the mirrored entry is understood); entries given again are added.
    pub quadratic: Vec<(usize, usize, f64)>,
    /// q, n numbers.
    pub linear: Vec<f64>,
    /// Rows of E x = e.
    pub equalities: Vec<Row>,
    /// Rows of A x <= b.
    pub inequalities: Vec<Row>,
    /// l, n numbers, minus infinity where there is no bound.
    pub lower: Vec<f64>,
    /// u, n numbers, infinity where there is no bound.
    pub upper: Vec<f64>,
}

/// One linear constraint: sum of `value * x[index]` against `right`.
///
/// Among [`QuadraticProgram::equalities`] the sum is equal to `right`, among [`QuadraticProgram::inequalities`] it is at most `right`;
/// "at least" has all signs changed. Indices count from 0; terms of one index add up. The example of
/// [`solve`](super::qp::solve) has a row.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Terms `(index, value)`.
    pub terms: Vec<(usize, f64)>,
    /// Right-hand side.
    pub right: f64,
}

impl Row {
    /// A constraint from its terms `(index, value)` and its right-hand side.
    pub fn new(terms: impl IntoIterator<Item = (usize, f64)>, right: f64) -> Self {
        Self {
            terms: terms.into_iter().collect(),
            right,
        }
    }
}

/// Multipliers of the constraints: by how much the least cost falls for each unit by which the right-hand side of a row, or an upper bound, is
/// raised, or a lower bound lowered.
///
/// At the solution `P x + q + E' y + A' z + (upper - lower) = 0`; all but those of equalities are at least 0, and 0 where the
/// constraint is not tight. Source: Boyd and Vandenberghe 2004, Sec. 5.6.
#[derive(Debug, Clone, PartialEq)]
pub struct Duals {
    /// y, of each equality.
    pub equalities: Vec<f64>,
    /// z, of each inequality.
    pub inequalities: Vec<f64>,
    /// Of each lower bound; 0 where there is none.
    pub lower: Vec<f64>,
    /// Of each upper bound; 0 where there is none.
    pub upper: Vec<f64>,
}

/// Why numbers are not a convex quadratic program: from [`QuadraticProgram::check`], and through it from
/// [`solve`](super::qp::solve). That there is no solution is an [`Outcome`](super::Outcome), not an error.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QpError {
    /// A list has not one number for each variable.
    #[error("{what} has {found} numbers, expected {expected}")]
    Dimension {
        /// Name of the list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Number of variables.
        expected: usize,
    },
    /// A term names a variable that does not exist.
    #[error("{what}[{row}] names variable {index}, there are {count}")]
    Index {
        /// Name of the list.
        what: &'static str,
        /// Index of the row or entry of the list.
        row: usize,
        /// The index named.
        index: usize,
        /// Number of variables.
        count: usize,
    },
    /// A number is NaN or infinite where it must not be.
    #[error("{what}[{row}] has the number {value}")]
    Number {
        /// Name of the list.
        what: &'static str,
        /// Index of the row or entry of the list.
        row: usize,
        /// The number.
        value: f64,
    },
    /// A lower bound above the upper one.
    #[error("variable {index} has the bounds {lower} to {upper}")]
    CrossedBounds {
        /// Variable.
        index: usize,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// P has a negative eigenvalue: the program is not convex.
    #[error("the quadratic form is not positive semidefinite: eigenvalue {0}")]
    NotConvex(f64),
    /// The solution to start from is of other variables or constraints.
    #[error("the solution to start from has other numbers of variables or constraints")]
    Start,
    /// The solver refused or failed.
    #[error("quadratic programming failed: {0}")]
    Solver(String),
}

impl QuadraticProgram {
    /// n variables, no cost, no constraints.
    pub fn new(n: usize) -> Self {
        Self {
            quadratic: Vec::new(),
            linear: vec![0.0; n],
            equalities: Vec::new(),
            inequalities: Vec::new(),
            lower: vec![f64::NEG_INFINITY; n],
            upper: vec![f64::INFINITY; n],
        }
    }

    /// Adds `weight / 2 * (x[index] - target)^2` to the cost, up to a constant.
    pub fn pull(&mut self, index: usize, target: f64, weight: f64) -> &mut Self {
        self.quadratic.push((index, index, weight));
        self.linear[index] -= weight * target;
        self
    }

    /// Number of variables, n.
    pub fn dimension(&self) -> usize {
        self.linear.len()
    }

    /// 1/2 x' P x + q' x.
    pub fn value(&self, x: &[f64]) -> f64 {
        let entry = |&(i, j, value): &(usize, usize, f64)| {
            let factor = if i == j { 0.5 } else { 1.0 };
            factor * value * x[i] * x[j]
        };
        let quadratic: f64 = self.quadratic.iter().map(entry).sum();
        let linear: f64 = self.linear.iter().zip(x).map(|(q, x)| q * x).sum();
        quadratic + linear
    }

    /// Checks dimensions, numbers, bounds and convexity.
    ///
    /// O(size), and one sparse factor of P where it is not diagonally dominant.
    ///
    /// # Errors
    /// [`QpError`] with the first culprit.
    pub fn check(&self) -> Result<(), QpError> {
        let n = self.dimension();
        for (what, list) in [("lower", &self.lower), ("upper", &self.upper)] {
            if list.len() != n {
                return Err(QpError::Dimension {
                    what,
                    found: list.len(),
                    expected: n,
                });
            }
        }
        let number = |what, row, value: f64| match value.is_finite() {
            true => Ok(()),
            false => Err(QpError::Number { what, row, value }),
        };
        let variable = |what, row, index| match index < n {
            true => Ok(()),
            false => Err(QpError::Index {
                what,
                row,
                index,
                count: n,
            }),
        };
        for (row, &value) in self.linear.iter().enumerate() {
            number("linear", row, value)?;
        }
        for (row, &(i, j, value)) in self.quadratic.iter().enumerate() {
            variable("quadratic", row, i)?;
            variable("quadratic", row, j)?;
            number("quadratic", row, value)?;
        }
        let lists = [
            ("equalities", &self.equalities),
            ("inequalities", &self.inequalities),
        ];
        for (what, rows) in lists {
            for (row, content) in rows.iter().enumerate() {
                number(what, row, content.right)?;
                for &(index, value) in &content.terms {
                    variable(what, row, index)?;
                    number(what, row, value)?;
                }
            }
        }
        for index in 0..n {
            let (lower, upper) = (self.lower[index], self.upper[index]);
            let empty = lower == f64::INFINITY || upper == f64::NEG_INFINITY;
            if lower.is_nan() || upper.is_nan() || lower > upper || empty {
                return Err(QpError::CrossedBounds {
                    index,
                    lower,
                    upper,
                });
            }
        }
        self.check_convex()
    }

    fn check_convex(&self) -> Result<(), QpError> {
        let n = self.dimension();
        let mut diagonal = vec![0.0; n];
        let mut beside = vec![0.0; n];
        for &(i, j, value) in &self.quadratic {
            if i == j {
                diagonal[i] += value;
            } else {
                beside[i] += value.abs();
                beside[j] += value.abs();
            }
        }
        // Gershgorin: diagonally dominant with a diagonal not below zero is semidefinite.
        if diagonal.iter().zip(&beside).all(|(d, b)| d >= b) {
            return Ok(());
        }
        // Positive semidefinite up to rounding: positive definite once a little is added to the diagonal.
        let bound = diagonal.iter().zip(&beside).map(|(d, b)| d.abs() + b);
        let largest = bound.fold(f64::MIN_POSITIVE, f64::max);
        if self.factors(ROUNDING * largest) {
            return Ok(());
        }
        match self.least_eigenvalue(largest) {
            least if least >= -ROUNDING * largest => Ok(()),
            least => Err(QpError::NotConvex(least)),
        }
    }

    /// True if `P + shift` has a sparse factor `L D L'` with D > 0.
    fn factors(&self, shift: f64) -> bool {
        let n = self.dimension();
        let mut upper = Triplets::with_capacity(self.quadratic.len() + n);
        let shifts = (0..n).map(|i| (i, i, shift));
        for (i, j, value) in self.quadratic.iter().copied().chain(shifts) {
            upper.entry(i.min(j), i.max(j), value);
        }
        let upper = upper.matrix(n, n);
        let settings = QDLDLSettingsBuilder::default()
            .regularize_enable(false)
            .build();
        let factor = settings.map(|s| QDLDLFactorisation::new(&upper, Some(s)));
        factor.is_ok_and(|f| f.is_ok_and(|f| f.positive_inertia() == n))
    }

    /// The least eigenvalue of P, or a number above it that is negative: of few variables by all eigenvalues, of many by the power method on
    /// `largest - P`.
    fn least_eigenvalue(&self, largest: f64) -> f64 {
        let n = self.dimension();
        if n <= FEW {
            let mut p = DMatrix::<f64>::zeros(n, n);
            for &(i, j, value) in &self.quadratic {
                p[(i, j)] += value;
                if i != j {
                    p[(j, i)] += value;
                }
            }
            return p.symmetric_eigenvalues().min();
        }
        // A start that no eigenvector of use is orthogonal to.
        let mut x: Vec<f64> = (0..n)
            .map(|i| ((i + 1) as f64 * 0.754_877_666).fract() - 0.5)
            .collect();
        let mut least = f64::INFINITY;
        for _ in 0..POWER_STEPS {
            let length = x.iter().map(|v| v * v).sum::<f64>().sqrt();
            x.iter_mut().for_each(|v| *v /= length);
            let mut y = vec![0.0; n];
            for &(i, j, value) in &self.quadratic {
                y[i] += value * x[j];
                if i != j {
                    y[j] += value * x[i];
                }
            }
            let quotient = x.iter().zip(&y).map(|(x, y)| x * y).sum::<f64>();
            let settled =
                (least - quotient).abs() <= 1e-6 * largest && quotient < -ROUNDING * largest;
            least = least.min(quotient);
            if settled {
                break;
            }
            for (x, y) in x.iter_mut().zip(y) {
                *x = largest * *x - y;
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_door_names_the_culprit() {
        let mut program = QuadraticProgram::new(2);
        program.quadratic = vec![(0, 0, 1.0), (0, 1, 2.0), (1, 1, 1.0)];
        assert!(matches!(program.check(), Err(QpError::NotConvex(e)) if (e + 1.0).abs() < 1e-9));
        // Rank one, semidefinite but not dominant.
        program.quadratic = vec![(0, 0, 1.0), (0, 1, 2.0), (1, 1, 4.0)];
        assert_eq!(program.check(), Ok(()));
        program.equalities.push(Row::new([(2, 1.0)], 0.0));
        assert!(matches!(
            program.check(),
            Err(QpError::Index { index: 2, .. })
        ));
        program.equalities[0] = Row::new([(1, f64::NAN)], 0.0);
        assert!(matches!(
            program.check(),
            Err(QpError::Number { row: 0, .. })
        ));
        program.equalities.clear();
        program.lower[1] = f64::NAN;
        assert!(matches!(
            program.check(),
            Err(QpError::CrossedBounds { index: 1, .. })
        ));
        program.lower.pop();
        assert!(matches!(
            program.check(),
            Err(QpError::Dimension { what: "lower", .. })
        ));
    }
}
