//! A quadratic program with all its constraints as rows of one sparse matrix, `A x + s = b`: equalities (s = 0), then inequalities,
//! then bounds (s >= 0).

use clarabel::algebra::CscMatrix;

use super::qp_problem::{Duals, QuadraticProgram};
use super::triplets::Triplets;

/// The matrices of a program of n variables and m rows.
pub(super) struct Form {
    /// P, n x n, its upper half with the diagonal.
    pub(super) quadratic: CscMatrix<f64>,
    /// A, m x n.
    pub(super) rows: CscMatrix<f64>,
    /// b, m numbers.
    pub(super) right: Vec<f64>,
    /// Rows that are equalities; they come first.
    pub(super) equalities: usize,
    /// The row after the last inequality.
    pub(super) bounds: usize,
    /// The row of each variable's upper bound.
    pub(super) upper: Vec<Option<usize>>,
    /// The row of each variable's lower bound.
    pub(super) lower: Vec<Option<usize>>,
}

impl Form {
    /// Of a program that was checked; O(n + entries).
    pub(super) fn new(program: &QuadraticProgram) -> Self {
        let n = program.dimension();
        let lists = || program.equalities.iter().chain(&program.inequalities);
        let size = lists().map(|row| row.terms.len()).sum::<usize>() + 2 * n;
        let (mut rows, mut right) = (Triplets::with_capacity(size), Vec::new());
        for row in lists() {
            for &(column, value) in &row.terms {
                rows.entry(right.len(), column, value);
            }
            right.push(row.right);
        }
        let bounds = right.len();
        let (mut upper, mut lower) = (vec![None; n], vec![None; n]);
        for i in 0..n {
            if program.upper[i] < f64::INFINITY {
                upper[i] = Some(right.len());
                rows.entry(right.len(), i, 1.0);
                right.push(program.upper[i]);
            }
            if program.lower[i] > f64::NEG_INFINITY {
                lower[i] = Some(right.len());
                rows.entry(right.len(), i, -1.0);
                right.push(-program.lower[i]);
            }
        }
        let mut half = Triplets::with_capacity(program.quadratic.len());
        for &(i, j, value) in &program.quadratic {
            half.entry(i.min(j), i.max(j), value);
        }
        Self {
            quadratic: half.matrix(n, n),
            rows: rows.matrix(right.len(), n),
            right,
            equalities: program.equalities.len(),
            bounds,
            upper,
            lower,
        }
    }

    /// The multipliers of all rows, by kind.
    pub(super) fn duals(&self, z: &[f64]) -> Duals {
        let bound = |at: &[Option<usize>]| -> Vec<f64> {
            at.iter().map(|row| row.map_or(0.0, |row| z[row])).collect()
        };
        Duals {
            equalities: z[..self.equalities].to_vec(),
            inequalities: z[self.equalities..self.bounds].to_vec(),
            lower: bound(&self.lower),
            upper: bound(&self.upper),
        }
    }

    /// The multipliers of all rows, the inverse of [`Form::duals`], of which there are as many.
    pub(super) fn multipliers(&self, duals: &Duals) -> Vec<f64> {
        let mut z = vec![0.0; self.right.len()];
        z[..self.equalities].copy_from_slice(&duals.equalities);
        z[self.equalities..self.bounds].copy_from_slice(&duals.inequalities);
        let bounds = [(&self.upper, &duals.upper), (&self.lower, &duals.lower)];
        for (at, values) in bounds {
            for (row, value) in at.iter().zip(values) {
                if let Some(row) = row {
                    z[*row] = *value;
                }
            }
        }
        z
    }
}
