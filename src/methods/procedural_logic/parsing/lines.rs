//! The terms of Eq. 3 along every line, summed so that any scope reads them in constant time.

use crate::affinity::{Coefficients, for_each_edge};
use crate::canvas::Canvas;
use crate::parameters::{Extent, Parameters};
use edifice_shape::Axis;

/// Prefix sums along each line across one axis: entry `k * (span + 1) + t` sums the cells before
/// `t` of line `k`.
struct Terms {
    span: usize,
    /// Cells on which the line is an edge.
    edges: Vec<u32>,
    /// Length of the edge cells, in the unit of the canvas.
    length: Vec<f64>,
    /// Affinity times length.
    affinity: Vec<f64>,
    /// Corners before corner `t` where a perpendicular edge of one asset passes through the line.
    crossings: Vec<u32>,
    /// Those of them where the line leaves one asset's inside for another's.
    cuts: Vec<u32>,
}

/// The condition on the perpendicular edges that a line may cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rule {
    /// Condition b of Sec. 3.3: no perpendicular edge passes through.
    NoCrossing,
    /// Perpendicular edges may meet on the line, provided an edge of the line starts there.
    NoCut,
    /// Any line with an edge on it.
    Any,
    /// The line is an edge from end to end.
    Whole,
}

/// A part of the canvas: columns and rows of cells, `[start, end)` per axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Scope {
    /// Start and end along x and along y.
    pub range: [(usize, usize); 2],
}

/// A line with its energy.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Proposal {
    /// Axis along which the line splits.
    pub axis: Axis,
    /// Index of the line.
    pub line: usize,
    /// `f(p)`, Eq. 3.
    pub energy: f64,
    /// Number of perpendicular edges that the line cuts.
    pub cuts: u32,
}

/// Everything the recursion asks of one facade.
pub(crate) struct Lines<'a> {
    canvas: &'a Canvas,
    terms: [Terms; 2],
}

impl<'a> Lines<'a> {
    /// Sums the terms of both axes ("pre-computed for each pixel"). Linear in the cells.
    pub(crate) fn new(
        canvas: &'a Canvas,
        coefficients: &Coefficients,
        parameters: &Parameters,
    ) -> Self {
        let terms = Axis::BOTH.map(|axis| terms(canvas, axis, coefficients, parameters));
        Self { canvas, terms }
    }

    /// True if some edge lies inside the scope.
    pub(crate) fn has_edge(&self, scope: &Scope) -> bool {
        Axis::BOTH.into_iter().any(|axis| {
            let (start, end) = scope.range[axis as usize];
            (start + 1..end).any(|line| self.edges(axis, line, scope) > 0)
        })
    }

    /// The allowed proposal of lowest energy (Eq. 3). Ties go to the fewest cuts, then to
    /// horizontal lines, then to the lowest coordinate.
    pub(crate) fn best(
        &self,
        scope: &Scope,
        parent: Option<Axis>,
        rule: Rule,
        parameters: &Parameters,
    ) -> Option<Proposal> {
        let mut best: Option<Proposal> = None;
        for axis in [Axis::Y, Axis::X] {
            let bias = parameters.bias(axis, parent);
            let (start, end) = scope.range[axis as usize];
            for line in start + 1..end {
                let Some((energy, cuts)) = self.energy(axis, line, scope, rule, parameters) else {
                    continue;
                };
                let energy = bias * energy;
                let better = best.is_none_or(|b| (cuts, energy) < (b.cuts, b.energy - 1e-12));
                if better {
                    best = Some(Proposal {
                        axis,
                        line,
                        energy,
                        cuts,
                    });
                }
            }
        }
        best
    }

    /// The bracket of Eq. 3, and the number of cuts (counted under [`Rule::Any`] only).
    fn energy(
        &self,
        axis: Axis,
        line: usize,
        scope: &Scope,
        rule: Rule,
        parameters: &Parameters,
    ) -> Option<(f64, u32)> {
        let edges = self.edges(axis, line, scope);
        if edges == 0 {
            return None;
        }
        let terms = &self.terms[axis as usize];
        let (from, to) = scope.range[axis.other() as usize];
        let view = self.canvas.view(axis);
        let length = view.spans[to] - view.spans[from];
        let row = line * (terms.span + 1);
        let corners = |sums: &[u32]| sums[row + to] - sums[row + from + 1];
        let cuts = match rule {
            Rule::NoCrossing if corners(&terms.crossings) > 0 => return None,
            Rule::NoCut if corners(&terms.cuts) > 0 => return None,
            Rule::Whole if edges < (to - from) as u32 => return None,
            Rule::Any => corners(&terms.cuts),
            _ => 0,
        };
        let edge = terms.length[row + to] - terms.length[row + from];
        let affinity = terms.affinity[row + to] - terms.affinity[row + from];
        let whole = view.spans[terms.span] - view.spans[0];
        let (missing, w) = match parameters.extent {
            Extent::Scope => (length - edge, length),
            Extent::Facade => (length - edge, whole),
            Extent::Line => (whole - edge, whole),
        };
        let energy = parameters.alpha * missing / w + (1.0 - parameters.alpha) * affinity / w;
        Some((energy, cuts))
    }

    /// Number of cells of the scope on which the line is an edge.
    fn edges(&self, axis: Axis, line: usize, scope: &Scope) -> u32 {
        let terms = &self.terms[axis as usize];
        let (from, to) = scope.range[axis.other() as usize];
        let row = line * (terms.span + 1);
        terms.edges[row + to] - terms.edges[row + from]
    }
}

fn terms(
    canvas: &Canvas,
    axis: Axis,
    coefficients: &Coefficients,
    parameters: &Parameters,
) -> Terms {
    let view = canvas.view(axis);
    let (depth, span) = (view.depth(), view.span());
    let mut terms = Terms {
        span,
        edges: vec![0; depth * (span + 1)],
        length: vec![0.0; depth * (span + 1)],
        affinity: vec![0.0; depth * (span + 1)],
        crossings: vec![0; depth * (span + 1)],
        cuts: vec![0; depth * (span + 1)],
    };
    for_each_edge(&view, parameters.facing, |edge| {
        let entry = edge.line * (span + 1) + edge.cell + 1;
        let length = view.spans[edge.cell + 1] - view.spans[edge.cell];
        let affinity: f64 = edge
            .pairs
            .into_iter()
            .flatten()
            .map(|(own, facing, _)| coefficients.get(axis, own, facing) / 2.0)
            .sum();
        terms.edges[entry] = 1;
        terms.length[entry] = length;
        terms.affinity[entry] = affinity * length;
    });
    for line in 1..depth {
        let row = line * (span + 1);
        for t in 0..span {
            terms.edges[row + t + 1] += terms.edges[row + t];
            terms.length[row + t + 1] += terms.length[row + t];
            terms.affinity[row + t + 1] += terms.affinity[row + t];
            let (mut crossing, mut cut) = (0, 0);
            if t > 0 {
                let [a, b] = [view.asset(line - 1, t - 1), view.asset(line - 1, t)];
                let [c, d] = [view.asset(line, t - 1), view.asset(line, t)];
                crossing = u32::from(a != b && c != d && (a == c || b == d));
                cut = u32::from(a == c && b == d && a != b);
            }
            terms.crossings[row + t + 1] = terms.crossings[row + t] + crossing;
            terms.cuts[row + t + 1] = terms.cuts[row + t] + cut;
        }
    }
    terms
}
