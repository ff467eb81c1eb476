//! The graph of types: repetition, closeness and consistency of the instances of two nodes that stand together (Sec. V.A).
//!
//! Over pairs of neighbouring instances (midpoints within τ) of nodes k and l:
//! - r = number of pairs (Eq. 8),
//! - `σ = sqrt(Σ (mht - mean mht)² / min(|N_k|, |N_l|))`, mht the Manhattan distance in plan (Eq. 9),
//! - `μ = Σ dist / min(|N_k|, |N_l|)` (Eq. 10),
//! - `D = (w_μ μ + w_σ σ) / r` (Eq. 11).

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

/// Neighbours' midpoints are no farther apart than this, in metres: τ.
pub const NEIGHBOUR: f64 = 30.0;
/// Pairs that stand together at least so often have an edge.
const LEAST_REPETITION: usize = 2;
/// Least distance, so that its inverse is finite.
const LEAST_DISTANCE: f64 = 1e-6;

/// Weights of Eq. 11.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistanceWeights {
    /// Weight `w_μ` of closeness.
    pub closeness: f64,
    /// Weight `w_σ` of consistency.
    pub consistency: f64,
}

impl Default for DistanceWeights {
    fn default() -> Self {
        Self {
            closeness: 1.0,
            consistency: 1.0,
        }
    }
}

/// An instance of a node in the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeInstance {
    /// Index of the node.
    pub node: usize,
    /// Midpoint of the instance, in metres.
    pub middle: [f64; 3],
}

/// An edge between two nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TypeEdge {
    /// The nodes, the lower one first.
    pub nodes: (usize, usize),
    /// Number r of pairs of neighbouring instances (Eq. 8).
    pub repetition: usize,
    /// Closeness μ, in metres (Eq. 10).
    pub closeness: f64,
    /// Consistency σ, in metres (Eq. 9).
    pub consistency: f64,
    /// Distance D (Eq. 11); its inverse is the weight of the edge.
    pub distance: f64,
}

/// All pairs of instances within `tolerance`, each once, the nearest first for each first member.
pub fn neighbours(instances: &[NodeInstance], tolerance: f64) -> Vec<(usize, usize)> {
    let cell = |p: &[f64; 3]| [0, 1].map(|k| (p[k] / tolerance).floor() as i64);
    let mut grid: FxHashMap<[i64; 2], Vec<usize>> = FxHashMap::default();
    for (i, instance) in instances.iter().enumerate() {
        grid.entry(cell(&instance.middle)).or_default().push(i);
    }
    let mut pairs = Vec::new();
    for (i, instance) in instances.iter().enumerate() {
        let [x, y] = cell(&instance.middle);
        let around = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [x + a, y + b]));
        let mut near: Vec<(f64, usize)> = around
            .filter_map(|c| grid.get(&c))
            .flatten()
            .filter(|&&j| j > i)
            .map(|&j| (distance(&instance.middle, &instances[j].middle), j))
            .filter(|&(d, _)| d <= tolerance)
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        pairs.extend(near.into_iter().map(|(_, j)| (i, j)));
    }
    pairs
}

/// The edges between different nodes, by nodes; `nodes` is how many there are.
pub fn type_graph(
    instances: &[NodeInstance],
    nodes: usize,
    tolerance: f64,
    weights: DistanceWeights,
) -> Vec<TypeEdge> {
    let mut counts = vec![0usize; nodes];
    instances.iter().for_each(|i| counts[i.node] += 1);
    // Pairs, Σ dist, Σ mht, Σ mht².
    let mut sums: BTreeMap<(usize, usize), (usize, f64, f64, f64)> = BTreeMap::new();
    for (i, j) in neighbours(instances, tolerance) {
        let (a, b) = (instances[i], instances[j]);
        if a.node != b.node {
            let mht = (0..2)
                .map(|k| (a.middle[k] - b.middle[k]).abs())
                .sum::<f64>();
            let key = (a.node.min(b.node), a.node.max(b.node));
            let sum = sums.entry(key).or_default();
            sum.0 += 1;
            sum.1 += distance(&a.middle, &b.middle);
            sum.2 += mht;
            sum.3 += mht * mht;
        }
    }
    let edge = |(nodes, (r, dist, mht, square)): ((usize, usize), (usize, f64, f64, f64))| {
        let fewer = counts[nodes.0].min(counts[nodes.1]) as f64;
        let spread = (square - mht * mht / r as f64).max(0.0);
        let (closeness, consistency) = (dist / fewer, (spread / fewer).sqrt());
        let both = weights.closeness * closeness + weights.consistency * consistency;
        TypeEdge {
            nodes,
            repetition: r,
            closeness,
            consistency,
            distance: (both / r as f64).max(LEAST_DISTANCE),
        }
    };
    let edges = sums.into_iter().filter(|(_, s)| s.0 >= LEAST_REPETITION);
    edges.map(edge).collect()
}

pub(super) fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3)
        .map(|k| (a[k] - b[k]) * (a[k] - b[k]))
        .sum::<f64>()
        .sqrt()
}
