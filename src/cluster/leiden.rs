//! Leiden (Traag, Waltman and van Eck 2019): communities that are connected, from several random orders.
//!
//! As in Louvain, nodes move to the neighbouring community of largest gain in modularity until none moves. Before communities become nodes
//! each is refined: its nodes start alone, and join, in random order and at random among those gains that are not negative, a
//! subcommunity that is well connected to the rest of the community. The subcommunities become the nodes of the next level, and the
//! communities their first labels. A run ends when nothing is joined any more, and begins again from its end while that gains; of several runs the partition of highest modularity is kept.

use std::collections::BTreeMap;

use petgraph::visit::EdgeRef;
use rand::seq::SliceRandom;
use rand::{Rng, RngExt};

use super::communities::{Communities, WeightedGraph, modularity, renumbered};
use super::moves::{best_label, links};

/// Randomness of the refinement: gains, in shares of the total weight, that differ by less are chosen between nearly evenly.
const THETA: f64 = 0.01;

/// The best partition of `restarts` runs (at least one), the first of several. Near O(E) a run.
///
/// # Examples
/// Two triangles and a bridge:
/// ```
/// use edifice_cluster::{leiden, weighted_graph};
/// use edifice_base::rng::stream;
/// let edges = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3)].map(|(a, b)| (a, b, 1.0));
/// let found = leiden(&weighted_graph(6, &edges), 5, &mut stream(1, "leiden", 0));
/// assert_eq!(found.labels, [0, 0, 0, 1, 1, 1]);
/// assert!((found.modularity - (6.0 / 7.0 - 0.5)).abs() < 1e-12);
/// ```
pub fn leiden<R: Rng>(graph: &WeightedGraph, restarts: usize, rng: &mut R) -> Communities {
    let mut best: Option<Communities> = None;
    for _ in 0..restarts.max(1) {
        let mut found = Communities {
            labels: (0..graph.node_count()).collect(),
            modularity: f64::NEG_INFINITY,
        };
        // Again from where the last run ended, while that gains.
        loop {
            let labels = renumbered(&run(graph, &found.labels, rng));
            let modularity = modularity(graph, &labels);
            if modularity <= found.modularity + 1e-12 {
                break;
            }
            found = Communities { labels, modularity };
        }
        if best
            .as_ref()
            .is_none_or(|b| found.modularity > b.modularity + 1e-12)
        {
            best = Some(found);
        }
    }
    best.unwrap_or(Communities {
        labels: Vec::new(),
        modularity: 0.0,
    })
}

fn run<R: Rng>(graph: &WeightedGraph, start: &[usize], rng: &mut R) -> Vec<usize> {
    let n = graph.node_count();
    let mut level = Level::new(graph);
    // The level's node of each node of the graph, and the community of each node of the level.
    let mut node: Vec<usize> = (0..n).collect();
    let mut label = start.to_vec();
    loop {
        level.moves(&mut label, rng);
        let communities = renumbered(&label);
        let count = communities.iter().max().map_or(0, |m| m + 1);
        let parts = renumbered(&level.refined(&communities, rng));
        let parts_count = parts.iter().max().map_or(0, |m| m + 1);
        // Nothing is joined any more.
        let size = level.degree.len();
        if count == size || parts_count == size {
            return node.iter().map(|&v| communities[v]).collect();
        }
        label = vec![0; parts_count];
        for (v, &p) in parts.iter().enumerate() {
            label[p] = communities[v];
        }
        // Communities are labels of nodes, so that no label is beyond the number of nodes.
        let mut first = BTreeMap::new();
        for (p, l) in label.iter_mut().enumerate() {
            *l = *first.entry(*l).or_insert(p);
        }
        node.iter_mut().for_each(|v| *v = parts[*v]);
        level = level.joined(&parts, parts_count);
    }
}

/// A graph whose nodes may hold weight inside, which moves do not change.
struct Level {
    neighbours: Vec<Vec<(usize, f64)>>,
    degree: Vec<f64>,
    total: f64,
}

impl Level {
    fn new(graph: &WeightedGraph) -> Self {
        let mut degree = vec![0.0; graph.node_count()];
        let mut edges: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        let mut total = 0.0;
        for e in graph.edge_references() {
            let (a, b) = (e.source().index(), e.target().index());
            degree[a] += e.weight();
            degree[b] += e.weight();
            total += e.weight();
            if a != b {
                *edges.entry((a.min(b), a.max(b))).or_default() += e.weight();
            }
        }
        Self::from_edges(degree, total, edges)
    }

    fn from_edges(degree: Vec<f64>, total: f64, edges: BTreeMap<(usize, usize), f64>) -> Self {
        let mut neighbours = vec![Vec::new(); degree.len()];
        for ((a, b), w) in edges {
            neighbours[a].push((b, w));
            neighbours[b].push((a, w));
        }
        Self {
            neighbours,
            degree,
            total,
        }
    }

    /// Moves nodes in random order, those whose surroundings changed again.
    fn moves<R: Rng>(&self, label: &mut [usize], rng: &mut R) {
        let n = self.degree.len();
        let mut sum = vec![0.0; n];
        (0..n).for_each(|v| sum[label[v]] += self.degree[v]);
        let mut order: Vec<usize> = (0..n).collect();
        order.shuffle(rng);
        let mut queue: std::collections::VecDeque<usize> = order.into();
        let mut waiting = vec![true; n];
        while let Some(v) = queue.pop_front() {
            waiting[v] = false;
            let own = label[v];
            sum[own] -= self.degree[v];
            let links = links(&self.neighbours[v], label);
            let best = best_label(&links, own, self.degree[v], self.total, &sum);
            sum[best] += self.degree[v];
            if best != own {
                label[v] = best;
                for &(w, _) in &self.neighbours[v] {
                    if label[w] != best && !waiting[w] {
                        waiting[w] = true;
                        queue.push_back(w);
                    }
                }
            }
        }
    }

    /// Subcommunities of communities, as labels of nodes.
    fn refined<R: Rng>(&self, communities: &[usize], rng: &mut R) -> Vec<usize> {
        let n = self.degree.len();
        let mut whole = vec![0.0; n];
        (0..n).for_each(|v| whole[communities[v]] += self.degree[v]);
        let mut part: Vec<usize> = (0..n).collect();
        let mut sum = self.degree.clone();
        let mut size = vec![1_usize; n];
        // Weight of each part to the rest of its community.
        let within = |v: usize| -> f64 {
            let all = self.neighbours[v].iter();
            all.filter(|(w, _)| communities[*w] == communities[v])
                .map(|(_, w)| w)
                .sum()
        };
        let mut outward: Vec<f64> = (0..n).map(within).collect();
        let well = |outward: f64, sum: f64, whole: f64| {
            outward >= sum * (whole - sum) / (2.0 * self.total) - 1e-12 * self.total
        };
        let mut order: Vec<usize> = (0..n).collect();
        order.shuffle(rng);
        for v in order {
            let total = whole[communities[v]];
            if size[part[v]] > 1 || !well(outward[v], self.degree[v], total) {
                continue;
            }
            let mut links: BTreeMap<usize, f64> = BTreeMap::new();
            for &(w, weight) in self.neighbours[v]
                .iter()
                .filter(|(w, _)| communities[*w] == communities[v])
            {
                *links.entry(part[w]).or_default() += weight;
            }
            // To stay alone gains nothing.
            let mut choices = vec![(part[v], 0.0, 0.0)];
            for (&c, &weight) in links.iter().filter(|(c, _)| **c != part[v]) {
                let gain = weight - self.degree[v] * sum[c] / (2.0 * self.total);
                if gain >= 0.0 && well(outward[c], sum[c], total) {
                    choices.push((c, gain, weight));
                }
            }
            let top = choices.iter().map(|c| c.1).fold(0.0, f64::max);
            let odds = |gain: f64| ((gain - top) / (THETA * self.total)).exp();
            let mut at = rng.random::<f64>() * choices.iter().map(|c| odds(c.1)).sum::<f64>();
            let chosen = choices.iter().find(|c| {
                at -= odds(c.1);
                at < 0.0
            });
            let &(to, _, weight) = chosen.unwrap_or(&choices[0]);
            if to != part[v] {
                let from = part[v];
                (size[from], size[to]) = (size[from] - 1, size[to] + 1);
                sum[from] -= self.degree[v];
                sum[to] += self.degree[v];
                outward[to] += outward[v] - 2.0 * weight;
                part[v] = to;
            }
        }
        part
    }

    /// Parts as nodes.
    fn joined(&self, parts: &[usize], count: usize) -> Self {
        let mut degree = vec![0.0; count];
        let mut edges: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        for (v, list) in self.neighbours.iter().enumerate() {
            let a = parts[v];
            degree[a] += self.degree[v];
            for &(w, weight) in list.iter().filter(|(w, _)| *w > v && parts[*w] != a) {
                let b = parts[w];
                *edges.entry((a.min(b), a.max(b))).or_default() += weight;
            }
        }
        Self::from_edges(degree, self.total, edges)
    }
}

#[cfg(test)]
mod tests {
    use super::super::communities::{louvain, weighted_graph};
    use super::*;
    use edifice_base::rng::stream;

    /// Friendships in a karate club (Zachary 1977).
    const KARATE: [(usize, usize); 78] = [
        (0, 1),
        (0, 2),
        (0, 3),
        (0, 4),
        (0, 5),
        (0, 6),
        (0, 7),
        (0, 8),
        (0, 10),
        (0, 11),
        (0, 12),
        (0, 13),
        (0, 17),
        (0, 19),
        (0, 21),
        (0, 31),
        (1, 2),
        (1, 3),
        (1, 7),
        (1, 13),
        (1, 17),
        (1, 19),
        (1, 21),
        (1, 30),
        (2, 3),
        (2, 7),
        (2, 8),
        (2, 9),
        (2, 13),
        (2, 27),
        (2, 28),
        (2, 32),
        (3, 7),
        (3, 12),
        (3, 13),
        (4, 6),
        (4, 10),
        (5, 6),
        (5, 10),
        (5, 16),
        (6, 16),
        (8, 30),
        (8, 32),
        (8, 33),
        (9, 33),
        (13, 33),
        (14, 32),
        (14, 33),
        (15, 32),
        (15, 33),
        (18, 32),
        (18, 33),
        (19, 33),
        (20, 32),
        (20, 33),
        (22, 32),
        (22, 33),
        (23, 25),
        (23, 27),
        (23, 29),
        (23, 32),
        (23, 33),
        (24, 25),
        (24, 27),
        (24, 31),
        (25, 31),
        (26, 29),
        (26, 33),
        (27, 33),
        (28, 31),
        (28, 33),
        (29, 32),
        (29, 33),
        (30, 32),
        (30, 33),
        (31, 32),
        (31, 33),
        (32, 33),
    ];

    #[test]
    fn the_best_partition_of_the_karate_club_is_found() {
        let edges = KARATE.map(|(a, b)| (a, b, 1.0));
        let graph = weighted_graph(34, &edges);
        for seed in 0..10 {
            let found = leiden(&graph, 10, &mut stream(seed, "karate", 0));
            // The optimum is known (Brandes et al. 2008).
            assert!(
                (found.modularity - 0.419_790).abs() < 1e-5,
                "{seed}: {}",
                found.modularity
            );
        }
        assert!(louvain(&graph).modularity < 0.4198);
    }

    #[test]
    fn communities_are_connected_and_better_than_louvains() {
        let (mut ours, mut theirs) = (0.0, 0.0);
        for round in 0..20 {
            let mut rng = stream(5, "graphs", round);
            let n = 60;
            let mut edges = Vec::new();
            for a in 0..n {
                for b in a + 1..n {
                    let near = a / 12 == b / 12;
                    if rng.random::<f64>() < if near { 0.4 } else { 0.04 } {
                        edges.push((a, b, 0.5 + rng.random::<f64>()));
                    }
                }
            }
            let graph = weighted_graph(n, &edges);
            let found = leiden(&graph, 10, &mut rng);
            let other = louvain(&graph).modularity;
            assert!(found.modularity >= other - 0.005, "{round}");
            (ours, theirs) = (ours + found.modularity, theirs + other);
            for c in 0..=found.labels.iter().copied().max().unwrap_or(0) {
                let own: Vec<usize> = (0..n).filter(|&v| found.labels[v] == c).collect();
                let mut seen = vec![own[0]];
                let mut next = 0;
                while let Some(&v) = seen.get(next) {
                    next += 1;
                    for &(a, b, _) in &edges {
                        let other = if a == v { b } else { a };
                        if (a == v || b == v) && found.labels[other] == c && !seen.contains(&other)
                        {
                            seen.push(other);
                        }
                    }
                }
                assert_eq!(seen.len(), own.len());
            }
        }
        assert!(ours > theirs, "{ours} {theirs}");
    }

    #[test]
    fn graphs_without_edges_are_nodes_alone() {
        let found = leiden(&weighted_graph(3, &[]), 2, &mut stream(1, "none", 0));
        assert_eq!((found.labels, found.modularity), (vec![0, 1, 2], 0.0));
        assert!(
            leiden(&weighted_graph(0, &[]), 2, &mut stream(1, "none", 0))
                .labels
                .is_empty()
        );
    }
}
