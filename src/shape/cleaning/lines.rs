//! The lines of one axis: candidates, and the cheapest choice among them.

use crate::{Axis, LabelGrid};

/// Most candidate lines of an axis.
const MOST_CANDIDATES: usize = 120;

/// Weight of what lies within the tolerance of a line against what does not.
const NEAR: f64 = 0.1;

/// Side of a square, in tolerances, whose area a line has to explain.
const SIDE: f64 = 6.0;

/// A merged label grid seen along one axis.
struct View<'a> {
    grid: &'a LabelGrid,
    /// Boundaries along the axis, and across it.
    cuts: &'a [f64],
    across: &'a [f64],
    step: usize,
    stride: usize,
}

impl<'a> View<'a> {
    fn new(grid: &'a LabelGrid, axis: Axis) -> Self {
        let columns = grid.columns();
        let (cuts, across, step, stride) = match axis {
            Axis::X => (&grid.xs, &grid.ys, 1, columns),
            Axis::Y => (&grid.ys, &grid.xs, columns, 1),
        };
        Self {
            grid,
            cuts,
            across,
            step,
            stride,
        }
    }

    fn label(&self, k: usize, t: usize) -> usize {
        usize::from(self.grid.cells[k * self.step + t * self.stride])
    }

    fn width(&self, t: usize) -> f64 {
        self.across[t + 1] - self.across[t]
    }
}

/// The lines of `axis` that minimize the energy of the module's first page, both borders included.
pub(super) fn choose(grid: &LabelGrid, axis: Axis, tolerance: f64) -> Vec<f64> {
    let view = View::new(grid, axis);
    let lines = candidates(&view, tolerance);
    let costs = strip_costs(&view, &lines, tolerance);
    let price = (SIDE * tolerance).powi(2);
    cheapest(lines.len(), &costs, price)
        .into_iter()
        .map(|k| lines[k])
        .collect()
}

/// Cuts where most edges lie near, no two of them within half the tolerance, and the borders; sorted.
fn candidates(view: &View, tolerance: f64) -> Vec<f64> {
    let depth = view.cuts.len() - 1;
    let edges: Vec<f64> = (1..depth)
        .map(|k| {
            let differ = |t: &usize| view.label(k - 1, *t) != view.label(k, *t);
            let cells = (0..view.across.len() - 1).filter(differ);
            cells.map(|t| view.width(t)).sum()
        })
        .collect();
    // Edges count the less the farther they are, up to twice the tolerance.
    let support = |k: usize| -> f64 {
        let weight = |l: usize| {
            let distance = (view.cuts[l] - view.cuts[k]).abs();
            (1.0 - distance / (2.0 * tolerance)).max(0.0) * edges[l - 1]
        };
        let near = |l: &usize| (view.cuts[*l] - view.cuts[k]).abs() < 2.0 * tolerance;
        let below = (1..k).rev().take_while(near).map(weight).sum::<f64>();
        below + (k..depth).take_while(near).map(weight).sum::<f64>()
    };
    let supports: Vec<f64> = (1..depth).map(support).collect();
    let mut order: Vec<usize> = (1..depth).collect();
    order.sort_by(|&a, &b| supports[b - 1].total_cmp(&supports[a - 1]).then(a.cmp(&b)));
    let mut lines = vec![view.cuts[0], view.cuts[depth]];
    for k in order {
        let at = lines.partition_point(|&line| line < view.cuts[k]);
        let gap = (view.cuts[k] - lines[at - 1]).min(lines[at] - view.cuts[k]);
        if gap >= tolerance / 2.0 {
            lines.insert(at, view.cuts[k]);
        }
        if lines.len() == MOST_CANDIDATES {
            break;
        }
    }
    lines
}

/// The cost of the strip between lines `a < b` at `a * lines + b`, infinite where it has no inside.
fn strip_costs(view: &View, lines: &[f64], tolerance: f64) -> Vec<f64> {
    let n = lines.len();
    let labels = view.grid.labels.len();
    let mut costs = vec![f64::INFINITY; n * n];
    let inside = |a: usize, b: usize| {
        let from = lines[a] + if a == 0 { 0.0 } else { tolerance };
        let to = lines[b] - if b + 1 == n { 0.0 } else { tolerance };
        to - from
    };
    for a in 0..n {
        for b in a + 1..n {
            if inside(a, b) > 0.0 || (a == 0 && b + 1 == n) {
                costs[a * n + b] = 0.0;
            }
        }
    }
    // Lengths of each label before each line, and before the points one tolerance beside it.
    let last = lines[n - 1];
    let up: Vec<f64> = std::iter::once(0.0)
        .chain(lines[1..].iter().map(|y| (y + tolerance).min(last)))
        .collect();
    let down: Vec<f64> = lines[..n - 1]
        .iter()
        .map(|y| (y - tolerance).max(0.0))
        .chain([last])
        .collect();
    let (mut at, mut above, mut below) = (Vec::new(), Vec::new(), Vec::new());
    for t in 0..view.across.len() - 1 {
        prefix(view, t, lines, labels, &mut at);
        prefix(view, t, &up, labels, &mut above);
        prefix(view, t, &down, labels, &mut below);
        let width = view.width(t);
        for a in 0..n {
            for b in a + 1..n {
                let cost = &mut costs[a * n + b];
                if *cost == f64::INFINITY {
                    continue;
                }
                let core = misfit(
                    &above[a * labels..][..labels],
                    &below[b * labels..][..labels],
                );
                let all = misfit(&at[a * labels..][..labels], &at[b * labels..][..labels]);
                *cost += width * (core + NEAR * all);
            }
        }
    }
    costs
}

/// Length between two points that is not of the most frequent label there.
fn misfit(from: &[f64], to: &[f64]) -> f64 {
    let (mut sum, mut largest) = (0.0, 0.0);
    for (from, to) in from.iter().zip(to) {
        let length = to - from;
        sum += length;
        largest = f64::max(largest, length);
    }
    sum - largest
}

/// For each of the rising `points`, the length of each label before it along cell `t` across.
fn prefix(view: &View, t: usize, points: &[f64], labels: usize, out: &mut Vec<f64>) {
    out.clear();
    let mut lengths = vec![0.0; labels];
    let mut k = 0;
    let mut reached = view.cuts[0];
    for &point in points {
        while reached < point {
            let to = view.cuts[k + 1].min(point);
            lengths[view.label(k, t)] += to - reached;
            reached = to;
            k += usize::from(to == view.cuts[k + 1]);
        }
        out.extend_from_slice(&lengths);
    }
}

/// The path from line 0 to line `n - 1` of least cost, each line on it but the last at `price`.
fn cheapest(n: usize, costs: &[f64], price: f64) -> Vec<usize> {
    let mut best = vec![(f64::INFINITY, 0); n];
    best[0].0 = 0.0;
    for b in 1..n {
        for a in 0..b {
            let cost = best[a].0 + costs[a * n + b] + price;
            if cost < best[b].0 {
                best[b] = (cost, a);
            }
        }
    }
    let mut path = vec![n - 1];
    let mut at = n - 1;
    while at > 0 {
        at = best[at].1;
        path.push(at);
    }
    path.reverse();
    path
}
