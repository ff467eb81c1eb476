//! The parse tree: types that stand together become nodes, level by level (Sec. V.B), and the rules with
//! mean transforms (Eq. 7, Sec. V.C).

use std::collections::BTreeMap;

use super::type_graph::{
    DistanceWeights, NEIGHBOUR, NodeInstance, TypeEdge, neighbours, type_graph,
};
use edifice_base::{Progress, Watched};
use edifice_cluster::{Communities, WeightedGraph, girvan_newman, louvain, weighted_graph};
use edifice_grammar::instance::{InstanceRule, Placement};

/// Levels at most: the tolerance is doubled at each.
const MOST_LEVELS: usize = 16;

/// Edges of a node that are kept whatever the other node's are.
const NEAREST: usize = 4;

/// The method of finding communities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detection {
    /// Girvan and Newman, as the paper does.
    GirvanNewman,
    /// The method of Blondel et al. 2008, known as Louvain.
    Louvain,
}

/// One level of communities.
#[derive(Debug, Clone)]
pub struct Level {
    /// Distance up to which instances are neighbours, in metres.
    pub tolerance: f64,
    /// Nodes and edges of the type graph.
    pub size: (usize, usize),
    /// The graph, edge weights 1 / D.
    pub graph: WeightedGraph,
    /// The communities of the graph.
    pub communities: Communities,
}

/// Rules, and the instances of what is left at the top.
#[derive(Debug, Clone)]
pub struct ParseTree {
    /// A rule for each inner node, children before parents.
    pub rules: Vec<InstanceRule>,
    /// Children of each rule, as indices of nodes: leaves first, then rules in order.
    pub children: Vec<Vec<usize>>,
    /// Instances at the top, in the frame of the city.
    pub top: Vec<Placement>,
    /// The levels, from the smallest tolerance on.
    pub levels: Vec<Level>,
}

/// An instance while the tree grows.
#[derive(Debug, Clone)]
struct Grown {
    node: usize,
    middle: [f64; 3],
    /// In the frame of the city.
    placed: Placement,
}

/// Grows the tree from placed leaves: `leaves` are symbols of terminals, `instances` their uses with
/// midpoints. Stopped, it has the levels that were grown until then.
pub fn grow(
    leaves: usize,
    instances: Vec<(usize, [f64; 3], Placement)>,
    detection: Detection,
    weights: DistanceWeights,
    watched: &Watched,
) -> ParseTree {
    let mut tree = ParseTree {
        rules: Vec::new(),
        children: Vec::new(),
        top: Vec::new(),
        levels: Vec::new(),
    };
    let grown = instances.into_iter().map(|(node, middle, placed)| Grown {
        node,
        middle,
        placed,
    });
    let mut grown: Vec<Grown> = grown.collect();
    let mut tolerance = NEIGHBOUR;
    for _ in 0..MOST_LEVELS {
        // Nodes that are still at the top, numbered anew.
        let mut active: Vec<usize> = grown.iter().map(|g| g.node).collect();
        active.sort_unstable();
        active.dedup();
        let level = Progress::of(
            "parse tree: levels of communities",
            tree.levels.len() as u64,
            MOST_LEVELS as u64,
        );
        if active.len() < 2 || !watched.goes_on(level) {
            break;
        }
        let number: BTreeMap<usize, usize> =
            active.iter().enumerate().map(|(i, &n)| (n, i)).collect();
        let plain: Vec<NodeInstance> = grown
            .iter()
            .map(|g| NodeInstance {
                node: number[&g.node],
                middle: g.middle,
            })
            .collect();
        let edges = type_graph(&plain, active.len(), tolerance, weights);
        let edges = without_distant(edges, active.len());
        let near: Vec<_> = edges
            .iter()
            .map(|e| (e.nodes.0, e.nodes.1, 1.0 / e.distance))
            .collect();
        let graph = weighted_graph(active.len(), &near);
        let communities = match detection {
            Detection::GirvanNewman => girvan_newman(&graph),
            Detection::Louvain => louvain(&graph),
        };
        let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (i, &c) in communities.labels.iter().enumerate() {
            members.entry(c).or_default().push(active[i]);
        }
        tree.levels.push(Level {
            tolerance,
            size: (active.len(), edges.len()),
            graph,
            communities,
        });
        for children in members.into_values().filter(|m| m.len() > 1) {
            join(&mut tree, leaves, children, &mut grown, tolerance);
        }
        tolerance *= 2.0;
    }
    tree.top = grown.into_iter().map(|g| g.placed).collect();
    tree
}

/// The edges among the [`NEAREST`] of least distance D of either node: "edges for distant node type pairs are omitted"
/// (Sec. V.B).
fn without_distant(edges: Vec<TypeEdge>, nodes: usize) -> Vec<TypeEdge> {
    let mut order: Vec<usize> = (0..edges.len()).collect();
    let by_distance = |a: &usize, b: &usize| {
        edges[*a]
            .distance
            .total_cmp(&edges[*b].distance)
            .then(a.cmp(b))
    };
    order.sort_by(by_distance);
    let mut degree = vec![0usize; nodes];
    let mut kept: Vec<usize> = Vec::new();
    for e in order {
        let (a, b) = edges[e].nodes;
        if degree[a].min(degree[b]) < NEAREST {
            kept.push(e);
        }
        degree[a] += 1;
        degree[b] += 1;
    }
    kept.sort_unstable();
    kept.into_iter().map(|e| edges[e]).collect()
}

/// Makes a node of `children`: groups their instances and replaces them by the groups.
fn join(
    tree: &mut ParseTree,
    leaves: usize,
    children: Vec<usize>,
    grown: &mut Vec<Grown>,
    tolerance: f64,
) {
    let slot = |node: usize| children.iter().position(|&c| c == node);
    let (own, rest): (Vec<Grown>, Vec<Grown>) = std::mem::take(grown)
        .into_iter()
        .partition(|g| slot(g.node).is_some());
    *grown = rest;
    let groups = groups(&own, children.len(), tolerance, |n| slot(n).unwrap_or(0));
    let node = leaves + tree.rules.len();
    let symbol = format!("N{}", tree.rules.len() + 1);
    let means = mean_transforms(&own, &groups, children.len());
    let weight = groups.len() as f64;
    for group in &groups {
        let frame = frame_of(&own, group, &means);
        let parts = group
            .iter()
            .map(|m| m.map(|i| relative(&own[i].placed, &frame)));
        let present: Vec<usize> = group.iter().flatten().copied().collect();
        let mean = |k: usize| {
            present.iter().map(|&i| own[i].middle[k]).sum::<f64>() / present.len() as f64
        };
        let mut placed = Placement::new(symbol.clone(), frame.0, frame.1, [1.0; 3]);
        placed.parts = parts.collect();
        grown.push(Grown {
            node,
            middle: [mean(0), mean(1), mean(2)],
            placed,
        });
    }
    let successors = means.into_iter().map(|m| rounded(m.placement)).collect();
    tree.rules
        .push(InstanceRule::new(symbol, weight, successors));
    tree.children.push(children);
}

/// Greedy one-to-one matching of neighbours, the nearest first: groups with at most one instance of each child.
/// Every instance is in one group, perhaps alone.
fn groups(
    own: &[Grown],
    slots: usize,
    tolerance: f64,
    slot: impl Fn(usize) -> usize,
) -> Vec<Vec<Option<usize>>> {
    let plain: Vec<NodeInstance> = own
        .iter()
        .map(|g| NodeInstance {
            node: g.node,
            middle: g.middle,
        })
        .collect();
    let mut pairs = neighbours(&plain, tolerance);
    let far =
        |&(i, j): &(usize, usize)| super::type_graph::distance(&own[i].middle, &own[j].middle);
    pairs.sort_by(|a, b| far(a).total_cmp(&far(b)).then(a.cmp(b)));
    let mut group: Vec<usize> = (0..own.len()).collect();
    let mut members: Vec<Vec<usize>> = (0..own.len()).map(|i| vec![i]).collect();
    for (i, j) in pairs {
        let (a, b) = (group[i].min(group[j]), group[i].max(group[j]));
        let disjoint = || {
            members[a]
                .iter()
                .all(|&p| members[b].iter().all(|&q| own[p].node != own[q].node))
        };
        if a != b && disjoint() {
            let moved = std::mem::take(&mut members[b]);
            moved.iter().for_each(|&m| group[m] = a);
            members[a].extend(moved);
        }
    }
    let filled = members.into_iter().filter(|m| !m.is_empty());
    filled
        .map(|list| {
            let mut row = vec![None; slots];
            list.into_iter()
                .for_each(|i| row[slot(own[i].node)] = Some(i));
            row
        })
        .collect()
}

/// The mean transform of a child, and from how many instances.
#[derive(Clone)]
struct Mean {
    placement: Placement,
    count: usize,
}

type Frame = ([f64; 3], f64);

/// `E_kl`: mean shift, turn and size of each child in the frame of the anchor, the child that most groups have.
/// Children that never stand with the anchor lie at its place.
fn mean_transforms(own: &[Grown], groups: &[Vec<Option<usize>>], slots: usize) -> Vec<Mean> {
    let has = |s: usize| groups.iter().filter(|g| g[s].is_some()).count();
    let company = |s: usize| {
        groups
            .iter()
            .filter(|g| g[s].is_some() && g.iter().flatten().count() > 1)
            .count()
    };
    let anchor = (0..slots)
        .max_by_key(|&s| (company(s), has(s), slots - s))
        .unwrap_or(0);
    (0..slots)
        .map(|s| {
            let example = groups.iter().find_map(|g| g[s]).map(|i| &own[i].placed);
            let together = groups.iter().filter_map(|g| Some((g[anchor]?, g[s]?)));
            let seen: Vec<Placement> = together
                .map(|(a, i)| {
                    let frame = (own[a].placed.at, own[a].placed.turn);
                    relative(&own[i].placed, &frame)
                })
                .collect();
            let symbol = example.map_or(String::new(), |p| p.symbol.clone());
            let alone: Vec<Placement> = match (seen.is_empty(), example) {
                (true, Some(p)) => vec![Placement::new(symbol.clone(), [0.0; 3], 0.0, p.size)],
                _ => Vec::new(),
            };
            let list = if seen.is_empty() { &alone } else { &seen };
            let n = list.len().max(1) as f64;
            let mean = |f: &dyn Fn(&Placement) -> f64| list.iter().map(f).sum::<f64>() / n;
            let sin = mean(&|p| p.turn.to_radians().sin());
            let cos = mean(&|p| p.turn.to_radians().cos());
            let at = [0, 1, 2].map(|k| mean(&|p: &Placement| p.at[k]));
            let size = [0, 1, 2].map(|k| mean(&|p: &Placement| p.size[k]));
            let turn = sin.atan2(cos).to_degrees().rem_euclid(360.0);
            Mean {
                placement: Placement::new(symbol, at, turn, size),
                count: seen.len(),
            }
        })
        .collect()
}

/// The frame of a group: where its best known child, by the mean transform, puts the anchor.
fn frame_of(own: &[Grown], group: &[Option<usize>], means: &[Mean]) -> Frame {
    let known = (0..group.len()).filter(|&s| group[s].is_some());
    let best = known.max_by_key(|&s| (means[s].count, group.len() - s));
    let Some((s, i)) = best.and_then(|s| group[s].map(|i| (s, i))) else {
        return ([0.0; 3], 0.0);
    };
    let (placed, mean) = (&own[i].placed, &means[s].placement);
    let turn = (placed.turn - mean.turn).rem_euclid(360.0);
    let (sin, cos) = turn.to_radians().sin_cos();
    let [x, y, z] = mean.at;
    let at = [
        placed.at[0] - (x * cos - y * sin),
        placed.at[1] - (x * sin + y * cos),
        placed.at[2] - z,
    ];
    let frame = rounded(Placement::new("", at, turn, [1.0; 3]));
    (frame.at, frame.turn)
}

/// A placement of the city in a frame.
fn relative(placed: &Placement, frame: &Frame) -> Placement {
    let (sin, cos) = frame.1.to_radians().sin_cos();
    let [x, y, z] = [0, 1, 2].map(|k| placed.at[k] - frame.0[k]);
    let mut out = placed.clone();
    out.at = [x * cos + y * sin, y * cos - x * sin, z];
    out.turn = placed.turn - frame.1;
    rounded(out)
}

/// Millimetres and thousandths of degrees: so small that nesting does not add up to a centimetre.
fn rounded(mut placed: Placement) -> Placement {
    let round = |v: f64| (v * 1000.0).round() / 1000.0 + 0.0;
    placed.at = placed.at.map(round);
    placed.size = placed.size.map(|v| round(v).max(0.001));
    placed.turn = round(placed.turn.rem_euclid(360.0));
    if placed.turn >= 360.0 {
        placed.turn = 0.0;
    }
    placed
}
