//! Completion of a matrix by nuclear-norm regularization: soft-impute (Mazumder, Hastie, Tibshirani 2010).
//!
//! Minimizes `1/2 sum over known (x_ij - z_ij)^2 + lambda ||Z||_*` by repeating: fill the unknown entries of `X`
//! from `Z`, then shrink the singular values of the result by `lambda`. Each step lowers the objective. O(n m min(n, m))
//! a step.

use nalgebra::DMatrix;

/// When [`soft_impute`] stops, the default after 100 steps or a change of 1e-6. Reaching either limit is no error; [`objective`]
/// tells how good the result is. Unknown entries move by about `lambda` a step: where that is small beside the values, the
/// default tolerance ends far too early, and the example of [`soft_impute`] sets another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most steps.
    pub steps: usize,
    /// Relative change `‖Z' - Z‖² / ‖Z‖²` (Frobenius norms) below which it has converged; a `‖Z‖²` below 1e-12 counts as 1e-12.
    pub tolerance: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            steps: 100,
            tolerance: 1e-6,
        }
    }
}

/// The completed matrix: minimizer of the objective, also at known entries.
///
/// `known` has the value of each known entry, `None` elsewhere, `rows` times `columns` of them, row by row.
///
/// Formula, method, source and cost per step are in the [module](self). Values and `lambda` have one unit; a larger
/// `lambda` gives a smaller matrix of lower rank, the zero matrix from the largest singular value of the known entries on, the
/// others being 0. The start is the zero matrix.
///
/// # Examples
/// If all is known, one step is the answer: singular values 3 and 1, less 1.
/// ```
/// use edifice_model::low_rank::{Limits, objective, soft_impute};
/// let known = [Some(3.0), Some(0.0), Some(0.0), Some(1.0)];
/// let z = soft_impute(2, 2, &known, 1.0, Limits::default());
/// assert!((z[(0, 0)] - 2.0).abs() < 1e-12 && z[(1, 1)].abs() < 1e-12);
/// assert!((objective(&z, &known, 1.0) - (0.5 + 0.5 + 2.0)).abs() < 1e-12);
/// // With an unknown entry and little shrinking, the matrix of rank 1 that fits: rows (3, 2) and (3, 2).
/// let holes = [Some(3.0), Some(2.0), Some(3.0), None];
/// let limits = Limits { steps: 20_000, tolerance: 1e-16 };
/// let z = soft_impute(2, 2, &holes, 1e-3, limits);
/// assert!((z[(1, 1)] - 2.0).abs() < 0.01);
/// ```
pub fn soft_impute(
    rows: usize,
    columns: usize,
    known: &[Option<f64>],
    lambda: f64,
    limits: Limits,
) -> DMatrix<f64> {
    let mut z = DMatrix::zeros(rows, columns);
    if rows == 0 || columns == 0 {
        return z;
    }
    for _ in 0..limits.steps {
        let filled = DMatrix::from_fn(rows, columns, |i, j| {
            known[i * columns + j].unwrap_or(z[(i, j)])
        });
        let next = shrink(filled, lambda);
        let change = (&next - &z).norm_squared() / z.norm_squared().max(1e-12);
        z = next;
        if change < limits.tolerance {
            break;
        }
    }
    z
}

/// The matrix with its singular values lowered by `lambda`, at least to zero.
fn shrink(matrix: DMatrix<f64>, lambda: f64) -> DMatrix<f64> {
    let svd = matrix.svd(true, true);
    let (Some(u), Some(vt)) = (svd.u, svd.v_t) else {
        // Both were asked for.
        return DMatrix::zeros(0, 0);
    };
    let values = svd.singular_values.map(|s| (s - lambda).max(0.0));
    u * DMatrix::from_diagonal(&values) * vt
}

/// The objective that [`soft_impute`] minimizes.
///
/// `1/2 Σ (x_ij - z_ij)²` over the known entries, plus `lambda` times the sum of the singular values of `z`, which is rows x
/// columns; `known` as there. It is convex in `z`. One singular value decomposition, O(n m min(n, m)).
pub fn objective(z: &DMatrix<f64>, known: &[Option<f64>], lambda: f64) -> f64 {
    let columns = z.ncols();
    let errors = known.iter().enumerate().filter_map(|(index, value)| {
        let error = value.as_ref()? - z[(index / columns, index % columns)];
        Some(error * error / 2.0)
    });
    errors.sum::<f64>() + lambda * z.singular_values().sum()
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use edifice_base::rng::stream;

    #[test]
    fn a_matrix_of_rank_one_comes_back() {
        let mut rng = stream(3, "low rank", 0);
        let u: Vec<f64> = (0..12).map(|_| rng.random::<f64>() + 0.5).collect();
        let v: Vec<f64> = (0..9).map(|_| rng.random::<f64>() + 0.5).collect();
        let truth = |k: usize| u[k / 9] * v[k % 9];
        let known: Vec<Option<f64>> = (0..108)
            .map(|k| (rng.random::<f64>() < 0.6).then(|| truth(k)))
            .collect();
        let limits = Limits {
            steps: 3000,
            tolerance: 1e-14,
        };
        let z = soft_impute(12, 9, &known, 0.01, limits);
        let worst = (0..108)
            .map(|k| (z[(k / 9, k % 9)] - truth(k)).abs())
            .fold(0.0, f64::max);
        assert!(worst < 0.05, "{worst}");
    }

    #[test]
    fn no_small_change_lowers_the_objective() {
        let mut rng = stream(4, "low rank", 0);
        let known: Vec<Option<f64>> = (0..30)
            .map(|_| (rng.random::<f64>() < 0.7).then(|| rng.random::<f64>()))
            .collect();
        let limits = Limits {
            steps: 5000,
            tolerance: 1e-18,
        };
        let z = soft_impute(6, 5, &known, 0.3, limits);
        let least = objective(&z, &known, 0.3);
        for _ in 0..500 {
            let moved = z.map(|v| v + 0.02 * (rng.random::<f64>() - 0.5));
            assert!(objective(&moved, &known, 0.3) >= least - 1e-9);
        }
    }
}
