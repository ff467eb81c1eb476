//! Communities of weighted graphs: Girvan and Newman (2002), Louvain (Blondel et al. 2008), and the
//! modularity that judges both.
//!
//! Modularity of a partition of a graph of total weight m: Q = Σ_c (w_c / m - (d_c / 2m)²), with w_c the
//! weight of edges inside c and d_c the sum of weighted degrees in c (Newman and Girvan 2004).

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use petgraph::graph::{NodeIndex, UnGraph};
use petgraph::visit::EdgeRef;
use rayon::prelude::*;

use super::moves::{best_label, links};

/// A graph whose edges carry weights, positive and finite.
pub type WeightedGraph = UnGraph<(), f64>;

/// Modularity of a partition: a label for each node. 0 for a graph without edges.
pub fn modularity(graph: &WeightedGraph, labels: &[usize]) -> f64 {
    let total: f64 = graph.edge_weights().sum();
    if total <= 0.0 {
        return 0.0;
    }
    let mut inside: BTreeMap<usize, f64> = BTreeMap::new();
    let mut degree: BTreeMap<usize, f64> = BTreeMap::new();
    for e in graph.edge_references() {
        let [a, b] = [e.source(), e.target()].map(|n| labels[n.index()]);
        *degree.entry(a).or_default() += e.weight();
        *degree.entry(b).or_default() += e.weight();
        if a == b {
            *inside.entry(a).or_default() += e.weight();
        }
    }
    let share = |(c, d): (&usize, &f64)| {
        let half = d / (2.0 * total);
        inside.get(c).copied().unwrap_or(0.0) / total - half * half
    };
    degree.iter().map(share).sum()
}

/// A partition and its modularity.
#[derive(Debug, Clone, PartialEq)]
pub struct Communities {
    /// Label of each node, from 0, numbered by first nodes.
    pub labels: Vec<usize>,
    /// Its modularity with the edge weights.
    pub modularity: f64,
}

/// Girvan and Newman: the edge of highest betweenness is removed until none is left; of the partitions into
/// connected parts met, the one of largest modularity. Shortest paths count edges (igraph's reading without
/// weights) and modularity takes the edge weights. Betweenness is recomputed only in the part that lost an
/// edge. O(V E²) at worst.
pub fn girvan_newman(graph: &WeightedGraph) -> Communities {
    let n = graph.node_count();
    let mut adjacent: Vec<Vec<(usize, usize)>> = vec![Vec::new(); n];
    for e in graph.edge_references() {
        let (a, b) = (e.source().index(), e.target().index());
        if a != b {
            adjacent[a].push((b, e.id().index()));
            adjacent[b].push((a, e.id().index()));
        }
    }
    let mut betweenness = vec![f64::NEG_INFINITY; graph.edge_count()];
    let mut labels = components(&adjacent);
    for part in groups(&labels) {
        betweenness_of(&part, &adjacent, &mut betweenness);
    }
    let mut best = Communities {
        modularity: modularity(graph, &labels),
        labels: labels.clone(),
    };
    loop {
        // Equal up to rounding: the first edge.
        let mut worst: Option<usize> = None;
        for (i, &b) in betweenness.iter().enumerate() {
            let least = worst.map_or(f64::NEG_INFINITY, |w| betweenness[w]);
            if b > least * (1.0 + 1e-9) {
                worst = Some(i);
            }
        }
        let Some(edge) = worst else {
            return best;
        };
        betweenness[edge] = f64::NEG_INFINITY;
        let ends = graph.edge_endpoints(petgraph::graph::EdgeIndex::new(edge));
        let Some((a, b)) = ends.map(|(a, b)| (a.index(), b.index())) else {
            return best;
        };
        adjacent[a].retain(|&(_, e)| e != edge);
        adjacent[b].retain(|&(_, e)| e != edge);
        let part = reachable(a, &adjacent);
        betweenness_of(&part, &adjacent, &mut betweenness);
        if !part.contains(&b) {
            let other = reachable(b, &adjacent);
            betweenness_of(&other, &adjacent, &mut betweenness);
            labels = components(&adjacent);
            let found = modularity(graph, &labels);
            if found > best.modularity + 1e-12 {
                best = Communities {
                    modularity: found,
                    labels: labels.clone(),
                };
            }
        }
    }
}

/// Number of groups of sources; sums are over groups in order, the same for any number of threads.
const SOURCE_GROUPS: usize = 16;

/// Edge betweenness inside a connected part (Brandes 2001), each pair of nodes counted once.
fn betweenness_of(part: &[usize], adjacent: &[Vec<(usize, usize)>], betweenness: &mut [f64]) {
    let local = Local::new(part, adjacent);
    let n = part.len();
    let group = n.div_ceil(SOURCE_GROUPS).max(1);
    let sums: Vec<Vec<f64>> = (0..n.div_ceil(group))
        .into_par_iter()
        .map(|g| local.dependencies(g * group..n.min((g + 1) * group)))
        .collect();
    for (e, &edge) in local.edges.iter().enumerate() {
        betweenness[edge] = sums.iter().map(|s| s[e]).sum();
    }
}

/// A part of a graph in one array: the neighbours of node v are `ends[first[v]..first[v + 1]]`.
struct Local {
    first: Vec<u32>,
    /// Neighbour, and index of the edge in the part.
    ends: Vec<(u32, u32)>,
    /// Edges of the part, by their indices in the graph.
    edges: Vec<usize>,
}

impl Local {
    fn new(part: &[usize], adjacent: &[Vec<(usize, usize)>]) -> Self {
        let mut number = vec![0u32; adjacent.len()];
        for (i, &v) in part.iter().enumerate() {
            number[v] = i as u32;
        }
        let (mut first, mut ends, mut edges) = (vec![0], Vec::new(), Vec::new());
        let mut index = rustc_hash::FxHashMap::default();
        for &v in part {
            for &(w, e) in &adjacent[v] {
                let local = *index.entry(e).or_insert_with(|| {
                    edges.push(e);
                    edges.len() as u32 - 1
                });
                ends.push((number[w], local));
            }
            first.push(ends.len() as u32);
        }
        Self { first, ends, edges }
    }

    fn around(&self, v: u32) -> &[(u32, u32)] {
        &self.ends[self.first[v as usize] as usize..self.first[v as usize + 1] as usize]
    }

    /// Sums, over shortest paths from the sources, of the shares that pass each edge; halved, since each pair of
    /// nodes is met from both ends.
    fn dependencies(&self, sources: std::ops::Range<usize>) -> Vec<f64> {
        let n = self.first.len() - 1;
        let mut sums = vec![0.0f64; self.edges.len()];
        let mut distance = vec![u32::MAX; n];
        let mut paths = vec![0.0f64; n];
        let mut dependency = vec![0.0f64; n];
        let mut order: Vec<u32> = Vec::with_capacity(n);
        for source in sources {
            distance.fill(u32::MAX);
            paths.fill(0.0);
            dependency.fill(0.0);
            order.clear();
            order.push(source as u32);
            distance[source] = 0;
            paths[source] = 1.0;
            let mut next = 0;
            while let Some(&v) = order.get(next) {
                next += 1;
                let (far, through) = (distance[v as usize] + 1, paths[v as usize]);
                for &(w, _) in self.around(v) {
                    let w = w as usize;
                    if distance[w] == u32::MAX {
                        distance[w] = far;
                        order.push(w as u32);
                    }
                    if distance[w] == far {
                        paths[w] += through;
                    }
                }
            }
            for &w in order.iter().rev() {
                let far = distance[w as usize];
                let each = (1.0 + dependency[w as usize]) / paths[w as usize];
                for &(v, e) in self.around(w) {
                    let v = v as usize;
                    if distance[v] + 1 == far {
                        let share = paths[v] * each;
                        sums[e as usize] += share / 2.0;
                        dependency[v] += share;
                    }
                }
            }
        }
        sums
    }
}

fn reachable(start: usize, adjacent: &[Vec<(usize, usize)>]) -> Vec<usize> {
    let mut seen = vec![false; adjacent.len()];
    seen[start] = true;
    let mut found = vec![start];
    let mut next = 0;
    while let Some(&v) = found.get(next) {
        next += 1;
        for &(w, _) in &adjacent[v] {
            if !seen[w] {
                seen[w] = true;
                found.push(w);
            }
        }
    }
    found.sort_unstable();
    found
}

fn components(adjacent: &[Vec<(usize, usize)>]) -> Vec<usize> {
    let mut labels = vec![usize::MAX; adjacent.len()];
    let mut next = 0;
    for v in 0..adjacent.len() {
        if labels[v] == usize::MAX {
            for w in reachable(v, adjacent) {
                labels[w] = next;
            }
            next += 1;
        }
    }
    labels
}

fn groups(labels: &[usize]) -> Vec<Vec<usize>> {
    let mut groups = vec![Vec::new(); labels.iter().max().map_or(0, |m| m + 1)];
    for (v, &l) in labels.iter().enumerate() {
        groups[l].push(v);
    }
    groups
}

/// Louvain: nodes move to the neighbouring community of largest gain until none moves, communities become
/// nodes, and so on while modularity grows. Nodes are visited in order, so that the result is the same at
/// every run. Near O(E).
pub fn louvain(graph: &WeightedGraph) -> Communities {
    let n = graph.node_count();
    let mut level = Level::new(graph);
    let mut labels: Vec<usize> = (0..n).collect();
    while let Some(moved) = level.moves() {
        labels.iter_mut().for_each(|l| *l = moved[*l]);
        level = level.joined(&moved);
    }
    let labels = renumbered(&labels);
    Communities {
        modularity: modularity(graph, &labels),
        labels,
    }
}

/// A graph whose nodes may hold weight inside.
struct Level {
    neighbours: Vec<Vec<(usize, f64)>>,
    /// Twice the weight inside each node.
    inside: Vec<f64>,
    degree: Vec<f64>,
    total: f64,
}

impl Level {
    fn new(graph: &WeightedGraph) -> Self {
        let n = graph.node_count();
        let mut edges: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        for e in graph.edge_references() {
            let (a, b) = (e.source().index(), e.target().index());
            *edges.entry((a.min(b), a.max(b))).or_default() += e.weight();
        }
        Self::from_edges(n, edges)
    }

    fn from_edges(n: usize, edges: BTreeMap<(usize, usize), f64>) -> Self {
        let mut level = Self {
            neighbours: vec![Vec::new(); n],
            inside: vec![0.0; n],
            degree: vec![0.0; n],
            total: edges.values().sum(),
        };
        for ((a, b), w) in edges {
            level.degree[a] += w;
            level.degree[b] += w;
            if a == b {
                level.inside[a] += 2.0 * w;
            } else {
                level.neighbours[a].push((b, w));
                level.neighbours[b].push((a, w));
            }
        }
        level
    }

    /// Communities, from 0, after moving nodes; `None` when none moved.
    fn moves(&self) -> Option<Vec<usize>> {
        let n = self.degree.len();
        let mut label: Vec<usize> = (0..n).collect();
        let mut sum = self.degree.clone();
        let mut any = false;
        // Nodes whose surroundings changed, in order.
        let mut queue: BinaryHeap<Reverse<usize>> = (0..n).map(Reverse).collect();
        let mut waiting = vec![true; n];
        while let Some(Reverse(v)) = queue.pop() {
            waiting[v] = false;
            let own = label[v];
            sum[own] -= self.degree[v];
            let links = links(&self.neighbours[v], &label);
            let best = best_label(&links, own, self.degree[v], self.total, &sum);
            sum[best] += self.degree[v];
            if best != own {
                any = true;
                label[v] = best;
                for &(w, _) in &self.neighbours[v] {
                    if label[w] != best && !waiting[w] {
                        waiting[w] = true;
                        queue.push(Reverse(w));
                    }
                }
            }
        }
        any.then(|| renumbered(&label))
    }

    fn joined(&self, labels: &[usize]) -> Self {
        let n = labels.iter().max().map_or(0, |m| m + 1);
        let mut edges: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        for (v, list) in self.neighbours.iter().enumerate() {
            let a = labels[v];
            *edges.entry((a, a)).or_default() += self.inside[v] / 2.0;
            for &(w, weight) in list.iter().filter(|(w, _)| *w > v) {
                let b = labels[w];
                *edges.entry((a.min(b), a.max(b))).or_default() += weight;
            }
        }
        edges.retain(|_, w| *w > 0.0);
        Self::from_edges(n, edges)
    }
}

pub(super) fn renumbered(labels: &[usize]) -> Vec<usize> {
    let mut numbers = BTreeMap::new();
    let mut out = Vec::with_capacity(labels.len());
    for &l in labels {
        let next = numbers.len();
        out.push(*numbers.entry(l).or_insert(next));
    }
    out
}

/// A graph of `nodes` nodes and the given edges.
pub fn weighted_graph(nodes: usize, edges: &[(usize, usize, f64)]) -> WeightedGraph {
    let mut graph = WeightedGraph::with_capacity(nodes, edges.len());
    (0..nodes).for_each(|_| {
        graph.add_node(());
    });
    for &(a, b, w) in edges {
        graph.add_edge(NodeIndex::new(a), NodeIndex::new(b), w);
    }
    graph
}
