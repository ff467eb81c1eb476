//! The number of clusters by description length: the cut of a hierarchy with the shortest description (Rissanen 1978).
//!
//! Points are told to a precision ε, as a cluster's label, the cluster's mean, and what is left:
//! - labels: n log2 n - Σ_c n_c log2 n_c bits;
//! - means: for each cluster `Σ_j log2(1 + range_j / ε_j)` bits;
//! - rest: n/2 log2 det(I + W / n) bits, W the scatter within clusters in units of ε: one Gaussian for all
//!   clusters. With the whole matrix, and not its diagonal, a noise that several coordinates share is paid once,
//!   so that it does not split clusters.

use nalgebra::{Cholesky, DMatrix};

use super::WardTree;

/// The number of clusters at which [`WardTree::cut`] describes the points in the fewest bits; of equal ones the
/// fewest clusters. `points`: row after row, as the tree was made from, all of weight 1; `precision`: ε of each
/// coordinate, positive.
///
/// O(n (d³ + log n)) for n points of dimension d.
pub fn shortest_description(tree: &WardTree, points: &[f64], precision: &[f64]) -> usize {
    let (n, d) = (tree.points, precision.len());
    if n < 2 {
        return n;
    }
    let scaled: Vec<f64> = (points.iter().zip(precision.iter().cycle()))
        .map(|(v, e)| v / e)
        .collect();
    let mean_bits = mean_bits(&scaled, d);
    // Sizes and means of all clusters, points first.
    let mut sizes = vec![1.0f64; n];
    let mut means = scaled;
    for merge in &tree.merges {
        let [a, b] = [merge.first, merge.second].map(|c| c as usize);
        let (v, w) = (sizes[a], sizes[b]);
        for j in 0..d {
            let mean = (v * means[a * d + j] + w * means[b * d + j]) / (v + w);
            means.push(mean);
        }
        sizes.push(v + w);
    }
    let own = |n: f64| n * n.log2();
    let mut scatter = DMatrix::<f64>::zeros(d, d);
    let mut labels = own(n as f64);
    let bits = |k: usize, labels: f64, scatter: &DMatrix<f64>| {
        k as f64 * mean_bits + labels + n as f64 / 2.0 * log2_det(scatter, n as f64)
    };
    let mut best = (bits(n, labels, &scatter), n);
    for (done, &m) in tree.order().iter().enumerate() {
        let merge = tree.merges[m];
        let [a, b] = [merge.first, merge.second].map(|c| c as usize);
        let (v, w) = (sizes[a], sizes[b]);
        let shift = nalgebra::DVector::from_fn(d, |j, _| means[a * d + j] - means[b * d + j]);
        scatter.ger(v * w / (v + w), &shift, &shift, 1.0);
        labels -= own(v + w) - own(v) - own(w);
        let k = n - done - 1;
        let now = bits(k, labels, &scatter);
        if now <= best.0 {
            best = (now, k);
        }
    }
    best.1
}

/// Bits of a mean: to ε, within the range of the points.
fn mean_bits(scaled: &[f64], d: usize) -> f64 {
    let range = |j: usize| {
        let column = scaled.iter().skip(j).step_by(d);
        let (low, high) = column.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| {
            (l.min(v), h.max(v))
        });
        high - low
    };
    (0..d).map(|j| (1.0 + range(j)).log2()).sum()
}

/// log2 det(I + W / n).
fn log2_det(scatter: &DMatrix<f64>, n: f64) -> f64 {
    let mut matrix = scatter / n;
    for j in 0..matrix.nrows() {
        matrix[(j, j)] += 1.0;
    }
    // Positive definite but for rounding, which the trace bounds.
    match Cholesky::new(matrix) {
        Some(factor) => {
            2.0 * factor
                .l_dirty()
                .diagonal()
                .iter()
                .map(|v| v.log2())
                .sum::<f64>()
        }
        None => scatter.nrows() as f64 * (1.0 + scatter.trace() / n).log2(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ward;
    use edifice_base::rng::stream;
    use rand::RngExt;
    use rand_distr::{Distribution, StandardNormal};

    /// `clusters` Gaussians of 40 points each in three dimensions; with `shared`, a noise that all dimensions share.
    fn points(clusters: usize, noise: f64, shared: bool) -> Vec<f64> {
        let mut rng = stream(3, "description", clusters as u64);
        let mut out = Vec::new();
        for _ in 0..clusters {
            let middle: [f64; 3] = std::array::from_fn(|_| rng.random_range(0.0..10.0));
            for _ in 0..40 {
                let common: f64 = StandardNormal.sample(&mut rng);
                for m in middle {
                    let own: f64 = StandardNormal.sample(&mut rng);
                    out.push(m + noise * if shared { common } else { own });
                }
            }
        }
        out
    }

    #[test]
    fn as_many_clusters_as_were_drawn() {
        for clusters in [1, 2, 7, 30] {
            for (noise, shared) in [(0.0, false), (0.03, false), (0.03, true)] {
                let points = points(clusters, noise, shared);
                let tree = ward(&points, 3, &vec![1.0; 40 * clusters]).unwrap();
                let found = shortest_description(&tree, &points, &[0.01; 3]);
                assert_eq!(found, clusters, "noise {noise}, shared {shared}");
            }
        }
    }

    #[test]
    fn few_points() {
        for n in 0..3 {
            let points: Vec<f64> = (0..n).map(f64::from).collect();
            let tree = ward(&points, 1, &vec![1.0; n as usize]).unwrap();
            assert!(shortest_description(&tree, &points, &[0.1]) <= n as usize);
        }
    }
}
