//! Projection onto a simplex with bounds: the continuous quadratic knapsack problem.
//!
//! ```text
//! minimise    Σ_i w_i / 2 (x_i - t_i)²          x in R^n, w > 0
//! subject to  Σ_i a_i x_i = b                   one equality
//!             l_i <= x_i <= u_i                 bounds, infinite where there is none
//! ```
//! With the multiplier λ of the equality, the minimum over `x` separates:
//!
//! ```text
//! x_i(λ) = min(u_i, max(l_i, t_i + λ a_i / w_i)),      g(λ) = Σ_i a_i x_i(λ)
//! ```
//! `g` is continuous, piecewise linear and never falls; its breakpoints are where some `x_i` meets a
//! bound. Bisection over the sorted breakpoints finds the piece on which `g = b`, and λ follows from
//! one linear equation: the method of breakpoints (Helgason, Kennington and Lall 1980; Kiwiel 2008).
//! It ends after finitely many steps with the exact solution, up to rounding, in O(n log n).
//! [`qp`](super::qp) solves the same problem iteratively and is the oracle of its tests.

/// Bounds, and one linear equality.
///
/// `{x in R^n : Σ_i a_i x_i = b, l <= x <= u}`, never empty: [`BoundedSimplex::new`] refuses an equality that no point within the
/// bounds meets. Coefficients may be negative or 0, bounds infinite. [`BoundedSimplex::project`] finds the nearest point
/// exactly, by the method and with the sources of the [module](self); O(n) memory, O(n log n) time.
///
/// # Examples
/// Four widths that fill a wall of 10, none below 1:
/// ```
/// use edifice_optim::projection::{BoundedSimplex, ProjectionError};
/// let wall = |total| BoundedSimplex::new(vec![1.0; 4], total, vec![1.0; 4], vec![f64::INFINITY; 4]);
/// let widths = wall(10.0)?.project(&[4.0, 3.0, 0.5, 4.0], &[1.0; 4])?;
/// // The third meets its bound; the others, 11 together, share the difference to 9.
/// for (width, expected) in widths.iter().zip([10.0 / 3.0, 7.0 / 3.0, 1.0, 10.0 / 3.0]) {
///     assert!((width - expected).abs() < 1e-12);
/// }
/// assert!(matches!(wall(3.0), Err(ProjectionError::Infeasible { .. })));
/// # Ok::<(), ProjectionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BoundedSimplex {
    coefficients: Vec<f64>,
    total: f64,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

/// Why there is no projection: bounds and equality in [`BoundedSimplex::new`], the rest also in [`BoundedSimplex::project`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectionError {
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
    /// A number is NaN or infinite where it must not be, or a weight is not positive.
    #[error("{what}[{index}] is {value}")]
    Number {
        /// Name of the list.
        what: &'static str,
        /// Variable.
        index: usize,
        /// The number.
        value: f64,
    },
    /// No number lies between these bounds.
    #[error("variable {index} has the bounds {lower} to {upper}")]
    CrossedBounds {
        /// Variable.
        index: usize,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// Within the bounds the left-hand side of the equality does not reach its right-hand side.
    #[error("the equality asks for {total}, the bounds allow {least} to {most}")]
    Infeasible {
        /// b.
        total: f64,
        /// Least value of the left-hand side.
        least: f64,
        /// Its greatest value.
        most: f64,
    },
}

impl BoundedSimplex {
    /// The points with `Σ coefficients_i x_i = total` and `lower <= x <= upper`.
    ///
    /// # Errors
    /// [`ProjectionError`] with the first culprit, and when there is no such point.
    pub fn new(
        coefficients: Vec<f64>,
        total: f64,
        lower: Vec<f64>,
        upper: Vec<f64>,
    ) -> Result<Self, ProjectionError> {
        let n = coefficients.len();
        dimension("lower", &lower, n)?;
        dimension("upper", &upper, n)?;
        finite("total", &[total])?;
        finite("coefficients", &coefficients)?;
        for (index, (&lower, &upper)) in lower.iter().zip(&upper).enumerate() {
            let empty = lower == f64::INFINITY || upper == f64::NEG_INFINITY;
            if lower.is_nan() || upper.is_nan() || lower > upper || empty {
                return Err(ProjectionError::CrossedBounds {
                    index,
                    lower,
                    upper,
                });
            }
        }
        let simplex = Self {
            coefficients,
            total,
            lower,
            upper,
        };
        let least = simplex.sum(simplex.extreme(f64::NEG_INFINITY));
        let most = simplex.sum(simplex.extreme(f64::INFINITY));
        // The bounds may meet the equality only up to the rounding of their sum.
        let rounding = |x: Vec<f64>| {
            let sizes = simplex
                .coefficients
                .iter()
                .zip(x)
                .map(|(a, x)| (a * x).abs());
            (simplex.dimension() + 1) as f64 * f64::EPSILON * sizes.fold(total.abs(), f64::max)
        };
        if total < least - rounding(simplex.extreme(f64::NEG_INFINITY))
            || total > most + rounding(simplex.extreme(f64::INFINITY))
        {
            return Err(ProjectionError::Infeasible { total, least, most });
        }
        Ok(simplex)
    }

    /// The probability simplex: n numbers from 0 to 1 that sum to 1.
    ///
    /// # Errors
    /// [`ProjectionError::Infeasible`] for n = 0.
    pub fn probability(n: usize) -> Result<Self, ProjectionError> {
        Self::new(vec![1.0; n], 1.0, vec![0.0; n], vec![1.0; n])
    }

    /// Number of variables, n.
    pub fn dimension(&self) -> usize {
        self.coefficients.len()
    }

    /// The point nearest to `target` with the weights `weights` of the squared differences.
    ///
    /// Complexity: O(n log n).
    ///
    /// # Errors
    /// [`ProjectionError::Dimension`], [`ProjectionError::Number`].
    ///
    /// # Examples
    /// ```
    /// use edifice_optim::projection::BoundedSimplex;
    /// let simplex = BoundedSimplex::probability(3)?;
    /// assert_eq!(simplex.project(&[0.75, 0.75, -1.0], &[1.0; 3])?, [0.5, 0.5, 0.0]);
    /// # Ok::<(), edifice_optim::projection::ProjectionError>(())
    /// ```
    pub fn project(&self, target: &[f64], weights: &[f64]) -> Result<Vec<f64>, ProjectionError> {
        dimension("target", target, self.dimension())?;
        dimension("weights", weights, self.dimension())?;
        finite("target", target)?;
        finite("weights", weights)?;
        if let Some(index) = weights.iter().position(|w| *w <= 0.0) {
            let (what, value) = ("weights", weights[index]);
            return Err(ProjectionError::Number { what, index, value });
        }
        let rates: Vec<f64> = (self.coefficients.iter().zip(weights))
            .map(|(a, w)| a / w)
            .collect();
        let multiplier = self.multiplier(target, &rates);
        Ok(self.minimizer(target, &rates, multiplier))
    }

    /// x(λ), with the rates a_i / w_i.
    fn minimizer(&self, target: &[f64], rates: &[f64], multiplier: f64) -> Vec<f64> {
        let at = |i: usize| (target[i] + multiplier * rates[i]).max(self.lower[i]);
        (0..self.dimension())
            .map(|i| at(i).min(self.upper[i]))
            .collect()
    }

    /// The λ with g(λ) = b.
    fn multiplier(&self, target: &[f64], rates: &[f64]) -> f64 {
        let ranges: Vec<[f64; 2]> = (0..self.dimension())
            .map(|i| self.free_range(i, target[i], rates[i]))
            .collect();
        let mut breakpoints = ranges.concat();
        breakpoints.retain(|at| at.is_finite());
        breakpoints.sort_by(f64::total_cmp);
        // The piece of g that reaches b first: g(from) < b <= g(to).
        let below = |at: &f64| self.sum(self.minimizer(target, rates, *at)) < self.total;
        let to = breakpoints.partition_point(below);
        let from = to.checked_sub(1).and_then(|i| breakpoints.get(i));
        let (from, to) = (from.copied(), breakpoints.get(to).copied());
        let piece = [
            from.unwrap_or(f64::NEG_INFINITY),
            to.unwrap_or(f64::INFINITY),
        ];
        // On it the same variables are at their bounds, and g(λ) = b - left + slope λ.
        let (mut left, mut slope) = (self.total, 0.0);
        for (i, [low, high]) in ranges.into_iter().enumerate() {
            let a = self.coefficients[i];
            if rates[i] == 0.0 {
                left -= a * target[i].max(self.lower[i]).min(self.upper[i]);
            } else if low <= piece[0] && piece[1] <= high {
                left -= a * target[i];
                slope += a * rates[i];
            } else {
                let side = if piece[1] <= low { -a } else { a };
                left -= a * self.bound(i, side);
            }
        }
        match slope > 0.0 {
            true => (left / slope).clamp(piece[0], piece[1]),
            // No variable is free: g is b on the whole piece.
            false => to.or(from).unwrap_or(0.0),
        }
    }

    /// The multipliers for which a variable lies between its bounds.
    fn free_range(&self, i: usize, target: f64, rate: f64) -> [f64; 2] {
        match rate {
            0.0 => [f64::NEG_INFINITY, f64::INFINITY],
            _ => [-rate, rate].map(|side| (self.bound(i, side) - target) / rate),
        }
    }

    /// The bound of a variable on one side.
    fn bound(&self, i: usize, side: f64) -> f64 {
        match side > 0.0 {
            true => self.upper[i],
            false => self.lower[i],
        }
    }

    /// The x to which λ drives every variable from far on one side.
    fn extreme(&self, side: f64) -> Vec<f64> {
        let end = |(i, &a): (usize, &f64)| match a {
            0.0 => 0.0,
            a => self.bound(i, side * a),
        };
        self.coefficients.iter().enumerate().map(end).collect()
    }

    /// Σ a_i x_i.
    fn sum(&self, x: Vec<f64>) -> f64 {
        self.coefficients.iter().zip(x).map(|(a, x)| a * x).sum()
    }
}

fn dimension(what: &'static str, list: &[f64], expected: usize) -> Result<(), ProjectionError> {
    let found = list.len();
    match found == expected {
        true => Ok(()),
        false => Err(ProjectionError::Dimension {
            what,
            found,
            expected,
        }),
    }
}

fn finite(what: &'static str, list: &[f64]) -> Result<(), ProjectionError> {
    match list.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => Err(ProjectionError::Number {
            what,
            index,
            value: list[index],
        }),
    }
}
