//! The nearest of some rows of a table of features.

use edifice_cluster::KdTree;

/// Chosen rows in a kd-tree.
pub(super) struct Nearest<'a> {
    rows: &'a [f64],
    dimension: usize,
    chosen: &'a [usize],
    tree: KdTree,
}

impl<'a> Nearest<'a> {
    /// The `chosen` of `rows`, each of `dimension` numbers.
    pub(super) fn new(rows: &'a [f64], dimension: usize, chosen: &'a [usize]) -> Self {
        let own = |&r: &usize| rows[r * dimension..(r + 1) * dimension].iter().copied();
        let points: Vec<f64> = chosen.iter().flat_map(own).collect();
        let numbers = (0..chosen.len() as u32).collect();
        let tree = KdTree::new(&points, dimension, &vec![1.0; chosen.len()], numbers);
        Self {
            rows,
            dimension,
            chosen,
            tree,
        }
    }

    /// The positions, among the chosen, of the `count` nearest to a point, the nearest first, of equals the lower.
    pub(super) fn of(&self, point: &[f64], count: usize) -> Vec<usize> {
        let d = self.dimension;
        let mut found: Vec<(f64, usize)> = Vec::with_capacity(count + 1);
        let visit = |position: u32| {
            let position = position as usize;
            let row = self.chosen[position];
            let entry = (square(point, &self.rows[row * d..(row + 1) * d]), position);
            let before = |f: &(f64, usize)| f.0.total_cmp(&entry.0).then(f.1.cmp(&entry.1)).is_lt();
            let at = found.partition_point(before);
            if at < count {
                found.insert(at, entry);
                found.truncate(count);
            }
            found.get(count - 1).map_or(f64::INFINITY, |f| f.0)
        };
        // A box as far as the last one may hold an equal of a lower number.
        let bound = |gap: f64, _: f64| gap * (1.0 - 1e-12);
        self.tree.search(point, f64::INFINITY, bound, visit);
        found.into_iter().map(|f| f.1).collect()
    }
}

/// The squared Euclidean distance of two points.
pub(super) fn square(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}
