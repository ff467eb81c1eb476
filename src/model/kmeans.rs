//! k-means++ starts for mixtures: a few rounds, no more.
//! Not for clustering as such.

use rand::{Rng, RngExt};

use edifice_base::rng::categorical;

/// k-means++ seeding (Arthur and Vassilvitskii 2007) and `rounds` Lloyd rounds; the cluster of
/// every point. Clusters may be empty when there are fewer distinct points than `k`.
pub(crate) fn kmeans<R: Rng>(
    points: &[f64],
    width: usize,
    k: usize,
    rounds: usize,
    rng: &mut R,
) -> Vec<usize> {
    let n = points.len().checked_div(width).unwrap_or(0);
    let point = |i: usize| &points[i * width..(i + 1) * width];
    let distance =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>();
    let mut centres: Vec<Vec<f64>> = vec![point(rng.random_range(0..n)).to_vec()];
    let mut nearest: Vec<f64> = (0..n).map(|i| distance(point(i), &centres[0])).collect();
    while centres.len() < k {
        let chosen = categorical(&nearest, rng);
        centres.push(point(chosen).to_vec());
        for (i, best) in nearest.iter_mut().enumerate() {
            *best = best.min(distance(point(i), point(chosen)));
        }
    }
    let mut labels = vec![0; n];
    for round in 0..=rounds {
        let mut moved = false;
        for (i, label) in labels.iter_mut().enumerate() {
            let closest = (0..k)
                .map(|c| (distance(point(i), &centres[c]), c))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .map_or(0, |(_, c)| c);
            moved |= closest != *label;
            *label = closest;
        }
        if round == rounds || (!moved && round > 0) {
            break;
        }
        let mut counts = vec![0.0; k];
        let mut sums = vec![vec![0.0; width]; k];
        for (i, &label) in labels.iter().enumerate() {
            counts[label] += 1.0;
            for (s, v) in sums[label].iter_mut().zip(point(i)) {
                *s += v;
            }
        }
        for ((centre, sum), n) in centres.iter_mut().zip(sums).zip(counts) {
            if n > 0.0 {
                *centre = sum.into_iter().map(|v| v / n).collect();
            }
        }
    }
    labels
}
