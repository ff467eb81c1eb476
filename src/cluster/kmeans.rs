//! k-means: k-means++ starts (Arthur and Vassilvitskii 2007) and Lloyd's steps with exact nearest
//! centres from a kd-tree.

use edifice_base::rng::categorical;
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

/// Labels of `k` centres drawn by k-means++, refined by at most `steps` steps of Lloyd; fewer centres where there are fewer
/// distinct points of positive weight. O(n k d) to draw.
///
/// # Panics
/// If there are points but no centre, since `k` or all weights are 0, and if `dimension` is 0.
pub fn kmeans<R: Rng>(
    points: &[f64],
    dimension: usize,
    weights: &[f64],
    k: usize,
    steps: usize,
    rng: &mut R,
) -> KMeans {
    let first = match k.min(weights.len()) {
        0 => None,
        _ => positive(weights, rng),
    };
    let centres = spread(points, dimension, weights, first, k, rng);
    lloyd(points, dimension, weights, centres, steps)
}

/// As [`kmeans`], of points that weigh 1 each. The first centre is drawn as an integer, so that the same generator gives other
/// centres than in `kmeans` with weights of 1.
///
/// # Panics
/// If there are points but `k` is 0, and if `dimension` is 0.
///
/// # Examples
/// ```
/// use edifice_base::rng::stream;
/// let widths = [1.0, 1.2, 7.0, 7.1, 6.9];
/// let found = edifice_cluster::kmeans_unweighted(&widths, 1, 2, 10, &mut stream(1, "widths", 0));
/// assert_eq!(found.labels[0], found.labels[1]);
/// assert_ne!(found.labels[0], found.labels[2]);
/// ```
pub fn kmeans_unweighted<R: Rng>(
    points: &[f64],
    dimension: usize,
    k: usize,
    steps: usize,
    rng: &mut R,
) -> KMeans {
    let n = points.len().checked_div(dimension).unwrap_or(0);
    let weights = vec![1.0; n];
    let first = (k.min(n) > 0).then(|| rng.random_range(0..n));
    let centres = spread(points, dimension, &weights, first, k, rng);
    lloyd(points, dimension, &weights, centres, steps)
}

/// k-means++ (Arthur and Vassilvitskii 2007, Sec. 2.2): after the first, each centre is drawn in proportion to
/// the squared distance to the nearest one before it.
fn spread<R: Rng>(
    points: &[f64],
    dimension: usize,
    weights: &[f64],
    first: Option<usize>,
    k: usize,
    rng: &mut R,
) -> Vec<f64> {
    let row = |i: usize| &points[i * dimension..(i + 1) * dimension];
    let mut nearest = vec![f64::INFINITY; weights.len()];
    let mut mass = vec![0.0; weights.len()];
    let mut centres = Vec::with_capacity(k.min(weights.len()) * dimension);
    let mut next = first;
    while let Some(chosen) = next {
        centres.extend_from_slice(row(chosen));
        if centres.len() >= k.min(weights.len()) * dimension {
            break;
        }
        for (i, least) in nearest.iter_mut().enumerate() {
            *least = least.min(square(row(i), row(chosen)));
            mass[i] = weights[i] * *least;
        }
        next = positive(&mass, rng);
    }
    centres
}

/// An index drawn in proportion to `mass`; `None` where all mass is zero, as when every point is a centre.
fn positive<R: Rng>(mass: &[f64], rng: &mut R) -> Option<usize> {
    let chosen = categorical(mass, rng);
    (mass.get(chosen)? > &0.0).then_some(chosen)
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

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;

    #[test]
    fn each_point_is_with_its_nearest_centre() {
        for dimension in 1..6 {
            let mut rng = stream(5, "points", dimension as u64);
            let points: Vec<f64> = (0..300 * dimension).map(|_| rng.random()).collect();
            let k = 7;
            let found = kmeans_unweighted(&points, dimension, k, 20, &mut rng);
            assert_eq!(found.centres.len(), k * dimension);
            let mut sse = 0.0;
            for (p, label) in points.chunks(dimension).zip(&found.labels) {
                let distance =
                    |c: &[f64]| -> f64 { p.iter().zip(c).map(|(a, b)| (a - b) * (a - b)).sum() };
                let all = found.centres.chunks(dimension).map(distance);
                let least = all.clone().fold(f64::INFINITY, f64::min);
                let own = all.clone().nth(*label).unwrap();
                assert!(own <= least + 1e-12, "{own} {least}");
                sse += own;
            }
            assert!((sse - found.sse).abs() < 1e-9);
        }
    }
}
