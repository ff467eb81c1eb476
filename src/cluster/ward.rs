//! Ward's hierarchy of weighted points in near-linear time.
//!
//! Clusters a, b with weights w and centroids c cost Δ(a, b) = w_a w_b / (w_a + w_b) |c_a - c_b|² to
//! merge, by which the weighted sum of squared errors grows (Ward 1963). Δ is reducible, so all pairs
//! that are each other's nearest neighbours may merge at once and the hierarchy is the one of the
//! greedy algorithm (Murtagh 1983, Bruynooghe 1978), up to ties. Nearest neighbours are found exactly in a
//! kd-tree whose boxes carry the least weight below them, which bounds Δ from below; a cluster's
//! neighbour stays valid until that neighbour merges. Ties go to the lower index, so that a round merges at
//! least one pair.

use rayon::prelude::*;

use super::kd_tree::KdTree;

/// Two clusters become one. Clusters are numbered: points first, then merges in order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WardMerge {
    /// Number of the one cluster, the lower of the two.
    pub first: u32,
    /// Number of the other.
    pub second: u32,
    /// Growth Δ of the weighted sum of squared errors.
    pub cost: f64,
}

/// A hierarchy of `points` points: `points - 1` merges, children before parents, of non-decreasing cost
/// along each path.
#[derive(Debug, Clone, PartialEq)]
pub struct WardTree {
    /// Number of points.
    pub points: usize,
    /// The merges.
    pub merges: Vec<WardMerge>,
}

/// Why points cannot be clustered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WardError {
    /// The table's length is not the number of weights times the dimension.
    #[error("{values} values are not {points} points of dimension {dimension}")]
    Shape {
        /// Values given.
        values: usize,
        /// Weights given.
        points: usize,
        /// Dimension given.
        dimension: usize,
    },
    /// A coordinate is not finite.
    #[error("point {0} has a coordinate that is not finite")]
    NotFinite(usize),
    /// A weight is not positive and finite.
    #[error("point {index} weighs {weight}")]
    Weight {
        /// Index of the point.
        index: usize,
        /// Its weight.
        weight: f64,
    },
}

/// Ward's hierarchy. `points`: row after row; `weights`: one per row, positive.
///
/// Memory O(n d); time near n log n in low dimension.
///
/// # Errors
/// [`WardError`].
pub fn ward(points: &[f64], dimension: usize, weights: &[f64]) -> Result<WardTree, WardError> {
    check(points, dimension, weights)?;
    let n = weights.len();
    let mut state = State {
        dimension,
        points: points.to_vec(),
        weights: weights.to_vec(),
        alive: vec![true; n],
        nearest: vec![(u32::MAX, f64::INFINITY); n],
    };
    let mut merges = Vec::with_capacity(n.saturating_sub(1));
    let mut active: Vec<u32> = (0..n as u32).collect();
    let mut stale = active.clone();
    let mut tree = state.tree(&active);
    // Clusters made since the tree was built.
    let mut fresh: Vec<u32> = Vec::new();
    let mut built = n;
    while active.len() > 1 {
        let found: Vec<(u32, f64)> = stale
            .par_iter()
            .with_min_len(64)
            .map(|&a| state.neighbour(a, &tree, &fresh))
            .collect();
        for (&a, found) in stale.iter().zip(found) {
            state.nearest[a as usize] = found;
        }
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for &a in &active {
            let (b, _) = state.nearest[a as usize];
            if a < b && state.nearest[b as usize].0 == a {
                pairs.push((a, b));
            }
        }
        for &(first, second) in &pairs {
            let cost = state.nearest[first as usize].1;
            fresh.push(state.merge(first, second));
            merges.push(WardMerge {
                first,
                second,
                cost,
            });
        }
        let made = state.alive.len() - pairs.len();
        active.retain(|&a| state.alive[a as usize]);
        active.extend(made as u32..state.alive.len() as u32);
        fresh.retain(|&a| state.alive[a as usize]);
        let lost = |a: u32| {
            let b = state.nearest[a as usize].0;
            b == u32::MAX || !state.alive[b as usize]
        };
        stale = active.iter().copied().filter(|&a| lost(a)).collect();
        if fresh.len() * fresh.len() > 16 * active.len() + 256 || active.len() * 2 < built {
            tree = state.tree(&active);
            built = active.len();
            fresh.clear();
        }
    }
    Ok(WardTree { points: n, merges })
}

fn check(points: &[f64], dimension: usize, weights: &[f64]) -> Result<(), WardError> {
    if dimension == 0 || points.len() != weights.len() * dimension {
        return Err(WardError::Shape {
            values: points.len(),
            points: weights.len(),
            dimension,
        });
    }
    if let Some(at) = points.iter().position(|v| !v.is_finite()) {
        return Err(WardError::NotFinite(at / dimension));
    }
    match weights.iter().position(|&w| !(w > 0.0 && w.is_finite())) {
        Some(index) => Err(WardError::Weight {
            index,
            weight: weights[index],
        }),
        None => Ok(()),
    }
}

/// The clusters so far: centroids, weights, whether they still stand, and nearest neighbours.
struct State {
    dimension: usize,
    points: Vec<f64>,
    weights: Vec<f64>,
    alive: Vec<bool>,
    nearest: Vec<(u32, f64)>,
}

impl State {
    fn tree(&self, active: &[u32]) -> KdTree {
        KdTree::new(&self.points, self.dimension, &self.weights, active.to_vec())
    }

    fn centroid(&self, a: u32) -> &[f64] {
        &self.points[a as usize * self.dimension..(a as usize + 1) * self.dimension]
    }

    /// Δ(a, b).
    fn cost(&self, a: u32, b: u32) -> f64 {
        let [v, w] = [a, b].map(|i| self.weights[i as usize]);
        let (a, b) = (self.centroid(a), self.centroid(b));
        let square: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
        v * w / (v + w) * square
    }

    /// The cheapest partner, the one of lowest index among equals.
    fn neighbour(&self, a: u32, tree: &KdTree, fresh: &[u32]) -> (u32, f64) {
        let mut best = (u32::MAX, f64::INFINITY);
        let mut offer = |b: u32| {
            if b != a && self.alive[b as usize] {
                let cost = self.cost(a, b);
                if cost < best.1 || (cost == best.1 && b < best.0) {
                    best = (b, cost);
                }
            }
            best.1
        };
        fresh.iter().for_each(|&b| {
            offer(b);
        });
        let limit = offer(a);
        let w = self.weights[a as usize];
        // Rounding of the box distance must not hide a tie.
        let bound = |gap: f64, least: f64| w * least / (w + least) * gap * (1.0 - 1e-12);
        tree.search(self.centroid(a), limit, bound, offer);
        best
    }

    /// Appends the union of two clusters and returns its number.
    fn merge(&mut self, a: u32, b: u32) -> u32 {
        let [v, w] = [a, b].map(|i| self.weights[i as usize]);
        for k in 0..self.dimension {
            let mean = (v * self.centroid(a)[k] + w * self.centroid(b)[k]) / (v + w);
            self.points.push(mean);
        }
        self.weights.push(v + w);
        self.alive[a as usize] = false;
        self.alive[b as usize] = false;
        self.alive.push(true);
        self.nearest.push((u32::MAX, f64::INFINITY));
        self.alive.len() as u32 - 1
    }
}

impl WardTree {
    /// The merges by cost, the cheapest first: a child is before its parent, and costs no more.
    pub fn order(&self) -> Vec<usize> {
        let cost = |m: usize| self.merges[m].cost;
        let mut order: Vec<usize> = (0..self.merges.len()).collect();
        order.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(a.cmp(&b)));
        order
    }

    /// The flat clustering with `k` clusters (between 1 and the number of points): the cheapest merges
    /// are done. Returns a label from 0 for each point, numbered by their first points.
    pub fn cut(&self, k: usize) -> Vec<usize> {
        let order = self.order();
        let merged = self.points.saturating_sub(k.max(1));
        let mut done = vec![false; self.merges.len()];
        for &m in &order[..merged.min(order.len())] {
            done[m] = true;
        }
        // From the top: a merge that is not done gives each child its own label.
        let n = self.points;
        let mut root: Vec<usize> = (0..n + self.merges.len()).collect();
        for m in (0..self.merges.len()).rev() {
            let merge = self.merges[m];
            for child in [merge.first as usize, merge.second as usize] {
                root[child] = if done[m] { root[n + m] } else { child };
            }
        }
        let mut numbers = rustc_hash::FxHashMap::default();
        (0..n)
            .map(|p| {
                let next = numbers.len();
                *numbers.entry(root[p]).or_insert(next)
            })
            .collect()
    }
}
