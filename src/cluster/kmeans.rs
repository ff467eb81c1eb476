//! k-means: k-means++ starts (Arthur and Vassilvitskii 2007) and Lloyd's steps with exact nearest
//! centres from a kd-tree.

use rand::{Rng, RngExt};
use rayon::prelude::*;

use super::kd_tree::KdTree;

/// A flat clustering.
#[derive(Debug, Clone, PartialEq)]
pub struct KMeans {
    /// Cluster of each point.
    pub labels: Vec<usize>,
    /// Centres, row after row.
    pub centres: Vec<f64>,
    /// Weighted sum of squared distances to the centres.
    pub sse: f64,
}

/// Labels of `k` centres drawn by k-means++, refined by at most `steps` steps of Lloyd. O(n k d) to draw.
pub fn kmeans<R: Rng>(
    points: &[f64],
    dimension: usize,
    weights: &[f64],
    k: usize,
    steps: usize,
    rng: &mut R,
) -> KMeans {
    let n = weights.len();
    let row = |i: usize| &points[i * dimension..(i + 1) * dimension];
    let mut nearest = vec![f64::INFINITY; n];
    let mut centres = Vec::with_capacity(k * dimension);
    for c in 0..k.min(n) {
        let mass = |i: usize| {
            if c == 0 {
                weights[i]
            } else {
                weights[i] * nearest[i]
            }
        };
        let total: f64 = (0..n).map(mass).sum();
        let mut left = rng.random::<f64>() * total;
        // Rounding may leave a rest: the last point with mass. Without mass all points are centres.
        let chosen = (0..n).filter(|&i| mass(i) > 0.0).find(|&i| {
            left -= mass(i);
            left <= 0.0
        });
        let last = || (0..n).rev().find(|&i| mass(i) > 0.0);
        let Some(chosen) = chosen.or_else(last) else {
            break;
        };
        centres.extend_from_slice(row(chosen));
        for (i, least) in nearest.iter_mut().enumerate() {
            *least = least.min(square(row(i), row(chosen)));
        }
    }
    lloyd(points, dimension, weights, centres, steps)
}

/// At most `steps` steps of Lloyd from given centres; ends when no label changes. A cluster that loses all
/// its points keeps its centre.
pub fn lloyd(
    points: &[f64],
    dimension: usize,
    weights: &[f64],
    mut centres: Vec<f64>,
    steps: usize,
) -> KMeans {
    let mut labels = assign(points, dimension, &centres);
    for _ in 0..steps {
        centres = means(points, dimension, weights, &labels, centres);
        let next = assign(points, dimension, &centres);
        if next == labels {
            break;
        }
        labels = next;
    }
    let sse = sum_of_squares(points, dimension, weights, &labels, &centres);
    KMeans {
        labels,
        centres,
        sse,
    }
}

/// The weighted sum of squared distances of points to their centres.
pub fn sum_of_squares(
    points: &[f64],
    dimension: usize,
    weights: &[f64],
    labels: &[usize],
    centres: &[f64],
) -> f64 {
    let row = |table: &[f64], i: usize| table[i * dimension..(i + 1) * dimension].to_vec();
    (labels.iter().enumerate())
        .map(|(i, &c)| weights[i] * square(&row(points, i), &row(centres, c)))
        .sum()
}

/// The weighted means of clusters; `before` where a cluster is empty.
pub fn means(
    points: &[f64],
    dimension: usize,
    weights: &[f64],
    labels: &[usize],
    before: Vec<f64>,
) -> Vec<f64> {
    let k = before.len() / dimension;
    let mut sums = vec![0.0; before.len()];
    let mut totals = vec![0.0; k];
    for (i, &c) in labels.iter().enumerate() {
        totals[c] += weights[i];
        for d in 0..dimension {
            sums[c * dimension + d] += weights[i] * points[i * dimension + d];
        }
    }
    for (c, &total) in totals.iter().enumerate() {
        for d in c * dimension..(c + 1) * dimension {
            sums[d] = if total > 0.0 {
                sums[d] / total
            } else {
                before[d]
            };
        }
    }
    sums
}

/// The nearest centre of each point, the first among equals.
fn assign(points: &[f64], dimension: usize, centres: &[f64]) -> Vec<usize> {
    let k = centres.len() / dimension;
    let tree = KdTree::new(centres, dimension, &vec![1.0; k], (0..k as u32).collect());
    points
        .par_chunks_exact(dimension)
        .with_min_len(256)
        .map(|p| {
            let mut best = (f64::INFINITY, 0);
            tree.search(
                p,
                f64::INFINITY,
                |gap, _| gap * (1.0 - 1e-12),
                |c| {
                    let c = c as usize;
                    let distance = square(p, &centres[c * dimension..(c + 1) * dimension]);
                    if (distance, c) < best {
                        best = (distance, c);
                    }
                    best.0
                },
            );
            best.1
        })
        .collect()
}

fn square(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}
