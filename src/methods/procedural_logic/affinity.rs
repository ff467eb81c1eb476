//! Affinity between assets: weighted co-occurrence of facing edges (Sec. 3.3, Eq. 6 to 8).

use serde::{Deserialize, Serialize};

use super::canvas::{Canvas, View};
use super::parameters::Facing;
use edifice_shape::Axis;

/// Sums of Eq. 8 over a set of facades: `sums[d][l][l']`, square matrices over the labels.
///
/// Sums, not yet normalized, so that facades can be added one by one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Affinity {
    facing: Facing,
    labels: usize,
    sums: [Vec<f64>; 2],
}

/// An edge cell on a line: the labels it faces on both sides, and how far away they are.
pub(super) struct Edge {
    /// Index of the line.
    pub line: usize,
    /// Cell along the line.
    pub cell: usize,
    /// `(l_xy, l_xy*, distance)` from the lower and from the upper side.
    pub pairs: [Option<(u32, u32, f64)>; 2],
}

impl Affinity {
    /// No co-occurrence yet.
    pub fn new(facing: Facing) -> Self {
        Self {
            facing,
            labels: 0,
            sums: [Vec::new(), Vec::new()],
        }
    }

    /// Adds the pairs of one facade whose labels are below `labels` (Eq. 8).
    ///
    /// Complexity: linear in the cells.
    pub fn add(&mut self, canvas: &Canvas, labels: usize) {
        self.grow(labels);
        for axis in Axis::BOTH {
            let view = canvas.view(axis);
            let extent = view.cuts[view.depth()] - view.cuts[0];
            let span = view.spans[view.span()] - view.spans[0];
            let sums = &mut self.sums[axis as usize];
            for_each_edge(&view, self.facing, |edge| {
                let pixels = (view.spans[edge.cell + 1] - view.spans[edge.cell]) / span;
                for (own, facing, distance) in edge.pairs.into_iter().flatten() {
                    sums[own as usize * labels + facing as usize] += pixels * distance / extent;
                }
            });
        }
    }

    /// Adds the sums of another set of facades over the same alphabet.
    pub fn merge(&mut self, other: &Self) {
        self.grow(other.labels);
        for (mine, theirs) in self.sums.iter_mut().zip(&other.sums) {
            for a in 0..other.labels {
                for b in 0..other.labels {
                    mine[a * self.labels + b] += theirs[a * other.labels + b];
                }
            }
        }
    }

    /// `C_d`, normalized by its largest entry to lie in 0..=1; all zero when nothing faces.
    pub fn normalized(&self) -> Coefficients {
        let scale = |sums: &Vec<f64>| {
            let largest = sums.iter().copied().fold(0.0, f64::max);
            let factor = if largest > 0.0 { 1.0 / largest } else { 0.0 };
            sums.iter().map(|sum| sum * factor).collect()
        };
        Coefficients {
            labels: self.labels,
            values: [scale(&self.sums[0]), scale(&self.sums[1])],
        }
    }

    /// True if the matrices are square, over at most `labels` labels, of finite numbers from zero.
    pub(super) fn is_sound(&self, labels: usize) -> bool {
        let sound = |sums: &Vec<f64>| {
            self.labels.checked_mul(self.labels) == Some(sums.len())
                && sums.iter().all(|sum| sum.is_finite() && *sum >= 0.0)
        };
        self.labels <= labels && self.sums.iter().all(sound)
    }

    fn grow(&mut self, labels: usize) {
        if labels <= self.labels {
            return;
        }
        for sums in &mut self.sums {
            let mut wider = vec![0.0; labels * labels];
            for a in 0..self.labels {
                for b in 0..self.labels {
                    wider[a * labels + b] = sums[a * self.labels + b];
                }
            }
            *sums = wider;
        }
        self.labels = labels;
    }
}

/// The normalized matrices `C_d`.
#[derive(Debug, Clone)]
pub struct Coefficients {
    labels: usize,
    values: [Vec<f64>; 2],
}

impl Coefficients {
    /// `c_d(l, l*)`; a label never seen in training has no affinity to anything.
    pub fn get(&self, axis: Axis, own: u32, facing: u32) -> f64 {
        let (own, facing) = (own as usize, facing as usize);
        if own < self.labels && facing < self.labels {
            self.values[axis as usize][own * self.labels + facing]
        } else {
            0.0
        }
    }
}

/// Visits every edge cell of every line across `view`, with the assets that face it (Eq. 6).
///
/// Each column of cells is a sequence of runs of one asset; at the line between run `r` and
/// `r + 1`, the lower asset faces run `r + 2` across the length of `r + 1`, and the upper asset
/// faces run `r - 1` across the length of `r`. With [`Facing::Adjacent`] the two face each other.
pub(super) fn for_each_edge(view: &View, facing: Facing, mut visit: impl FnMut(Edge)) {
    let mut runs: Vec<(usize, u32)> = Vec::new();
    for cell in 0..view.span() {
        runs.clear();
        for k in 0..view.depth() {
            let asset = view.asset(k, cell);
            if runs.last().is_none_or(|&(_, last)| last != asset) {
                runs.push((k, asset));
            }
        }
        let label = |r: usize| view.label(runs[r].1);
        let length = |r: usize| {
            let end = runs.get(r + 1).map_or(view.depth(), |run| run.0);
            view.cuts[end] - view.cuts[runs[r].0]
        };
        for r in 0..runs.len().saturating_sub(1) {
            let pairs = match facing {
                Facing::Across => [
                    (r + 2 < runs.len()).then(|| (label(r), label(r + 2), length(r + 1))),
                    (r > 0).then(|| (label(r + 1), label(r - 1), length(r))),
                ],
                Facing::Adjacent => [
                    Some((label(r), label(r + 1), 1.0)),
                    Some((label(r + 1), label(r), 1.0)),
                ],
            };
            visit(Edge {
                line: runs[r + 1].0,
                cell,
                pairs,
            });
        }
    }
}
