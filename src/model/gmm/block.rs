//! One block of rows through the E step and into the sums of the M step, by matrix products.

use ndarray::linalg::general_mat_mul;
use ndarray::{ArrayView2, ArrayViewMut2, Axis};

use super::mixture::Mixture;
use super::problem::{Moments, Steps};
use super::settings::Covariance;

/// Rows of one matrix product.
pub(super) const BLOCK: usize = 256;
/// Responsibilities below this are left out of the M step.
pub(super) const NEGLIGIBLE: f64 = 1e-14;

/// Buffers of one thread's blocks.
pub(super) struct Work {
    x: Vec<f64>,
    z: Vec<f64>,
    u: Vec<f64>,
    quad: Vec<f64>,
    logs: Vec<f64>,
    shift: Vec<f64>,
}

impl Work {
    /// An accumulator for rows of `d` values and `k` components.
    pub(super) fn new(d: usize, k: usize) -> Self {
        Self {
            x: vec![0.0; BLOCK * d],
            z: vec![0.0; BLOCK * d],
            u: vec![0.0; BLOCK * (d + 1)],
            quad: vec![0.0; BLOCK],
            logs: vec![0.0; BLOCK * k],
            shift: vec![0.0; d],
        }
    }
}

impl Steps<'_> {
    /// Both steps' sums over complete rows, at most [`BLOCK`].
    pub(super) fn block(
        &self,
        model: &Mixture,
        rows: &[usize],
        work: &mut Work,
        moments: &mut Moments,
    ) {
        let d = model.d;
        let n = rows.len();
        for (x, &i) in work.x.chunks_mut(d).zip(rows) {
            for ((x, v), c) in x.iter_mut().zip(self.points.row(i)).zip(&self.centre) {
                *x = v - c;
            }
        }
        let x = &work.x[..n * d];
        for k in 0..self.k {
            let w = model.whitening_of(k);
            let mean = model.mean(k);
            let quad = &mut work.quad[..n];
            if model.kind == Covariance::Diagonal {
                for (q, x) in quad.iter_mut().zip(x.chunks_exact(d)) {
                    *q = (0..d)
                        .map(|i| (w[i * d + i] * (x[i] - mean[i])).powi(2))
                        .sum();
                }
            } else {
                if k == 0 || model.kind == Covariance::Full {
                    product(x, n, w, d, &mut work.z[..n * d]);
                }
                for (i, m) in work.shift.iter_mut().enumerate() {
                    *m = (0..=i).map(|j| w[i * d + j] * mean[j]).sum();
                }
                for (q, z) in quad.iter_mut().zip(work.z.chunks_exact(d)) {
                    *q = z
                        .iter()
                        .zip(&work.shift)
                        .map(|(z, m)| (z - m) * (z - m))
                        .sum();
                }
            }
            let norm = model.log_norms[k];
            for (l, q) in work.logs.iter_mut().skip(k).step_by(self.k).zip(quad) {
                *l = norm - 0.5 * *q;
            }
        }
        for (&i, logs) in rows.iter().zip(work.logs.chunks_mut(self.k)) {
            let max = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let mut sum = 0.0;
            for l in logs.iter_mut() {
                let shifted = *l - max;
                *l = if shifted < -40.0 { 0.0 } else { shifted.exp() };
                sum += *l;
            }
            let weight = self.points.weight(i);
            moments.log_likelihood += weight * (max + sum.ln());
            let scale = weight / sum;
            logs.iter_mut().for_each(|l| *l *= scale);
        }
        for k in 0..self.k {
            let sums = &mut moments.sums[k];
            let mut m = 0;
            for (i, x) in x.chunks_exact(d).enumerate() {
                let r = work.logs[i * self.k + k];
                if r <= NEGLIGIBLE {
                    continue;
                }
                if model.kind == Covariance::Diagonal {
                    sums[0] += r;
                    let (first, second) = sums[1..].split_at_mut(d);
                    for ((a, b), x) in first.iter_mut().zip(second).zip(x) {
                        *a += r * x;
                        *b += r * x * x;
                    }
                } else {
                    let root = r.sqrt();
                    let u = &mut work.u[m * (d + 1)..(m + 1) * (d + 1)];
                    u[0] = root;
                    for (u, x) in u[1..].iter_mut().zip(x) {
                        *u = root * x;
                    }
                    m += 1;
                }
            }
            if model.kind != Covariance::Diagonal && m > 0 {
                gram(&work.u[..m * (d + 1)], m, d + 1, sums);
            }
        }
    }
}

/// z (n x d) = x (n x d) wᵀ, w lower triangular: its upper right quarter is not multiplied.
fn product(x: &[f64], n: usize, w: &[f64], d: usize, z: &mut [f64]) {
    let (Ok(x), Ok(w), Ok(z)) = (
        ArrayView2::from_shape((n, d), x),
        ArrayView2::from_shape((d, d), w),
        ArrayViewMut2::from_shape((n, d), z),
    ) else {
        return;
    };
    let h = half(d);
    let (mut left, mut right) = z.split_at(Axis(1), h);
    let (above, below) = w.split_at(Axis(0), h);
    let (x1, w11) = (x.split_at(Axis(1), h).0, above.split_at(Axis(1), h).0);
    general_mat_mul(1.0, &x1, &w11.t(), 0.0, &mut left);
    general_mat_mul(1.0, &x, &below.t(), 0.0, &mut right);
}

/// The lower triangle of sums (q x q) += uᵀ u, u n x q; the upper right quarter is left as it is.
fn gram(u: &[f64], n: usize, q: usize, sums: &mut [f64]) {
    let (Ok(u), Ok(sums)) = (
        ArrayView2::from_shape((n, q), u),
        ArrayViewMut2::from_shape((q, q), sums),
    ) else {
        return;
    };
    let h = half(q);
    let (above, mut below) = sums.split_at(Axis(0), h);
    let (mut corner, _) = above.split_at(Axis(1), h);
    let (u1, u2) = u.split_at(Axis(1), h);
    general_mat_mul(1.0, &u1.t(), &u1, 1.0, &mut corner);
    general_mat_mul(1.0, &u2.t(), &u, 1.0, &mut below);
}

/// The row at which a triangle is cut in two: a multiple of the kernel's width, or 0 (no cut) if it is small.
fn half(d: usize) -> usize {
    if d < 24 { 0 } else { d / 2 / 8 * 8 }
}
