//! Boxes whose edges lie on named lines, some of them free.

use super::target::{MassTarget, PARTS, bounds, part_of};
use edifice_shape::{BoxStyle, Building, MassBox, Ridge, Roof, RoofStyle};

/// A line across one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum GridLine {
    Fixed(f64),
    /// The position is the variable of this index.
    Free(usize),
}

/// A box on lines: indices of its lower and upper line along x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OnLines {
    pub style: BoxStyle,
    pub lines: [[usize; 2]; 2],
    pub height: f64,
    pub roof: Roof,
}

/// A topology with its lines.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scheme {
    pub boxes: Vec<OnLines>,
    /// Lines along x and along y.
    pub lines: [Vec<GridLine>; 2],
    /// Start values of the variables, in metres.
    pub start: Vec<f64>,
}

/// A general box in metres from the corner of the bounding box, with its floors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Edges along x and along y.
    pub edges: [[f64; 2]; 2],
    /// Number of floors.
    pub floors: usize,
    /// Its roof.
    pub roof: Roof,
    /// Stays exactly where it is.
    pub frozen: bool,
}

/// A roof to start with.
pub(super) const PLAIN: Roof = Roof {
    style: RoofStyle::Gable,
    pitch: 30.0,
    ridge: Ridge::X,
};

/// Edges of a donor nearer than this are one line.
const SAME: f64 = 1e-3;

impl Scheme {
    /// The scheme of general boxes with the garage and the porches of the target in their places. `roofs` are
    /// those of garage and porches.
    pub(super) fn new(blocks: &[Block], roofs: [Roof; 3], target: &MassTarget) -> Self {
        let mut scheme = Self {
            boxes: Vec::new(),
            lines: [Vec::new(), Vec::new()],
            start: Vec::new(),
        };
        let lines = [0, 1].map(|axis| scheme.general_lines(blocks, axis, target));
        for (i, block) in blocks.iter().enumerate() {
            scheme.boxes.push(OnLines {
                style: BoxStyle::Main,
                lines: [lines[0][i], lines[1][i]],
                height: block.floors as f64 * target.floor_height,
                roof: block.roof,
            });
        }
        for (k, part) in target.parts.iter().enumerate() {
            let Some(part) = part else { continue };
            let mut fixed = |axis: usize, at: f64| {
                scheme.lines[axis].push(GridLine::Fixed(at));
                scheme.lines[axis].len() - 1
            };
            let lines = [
                [fixed(0, part.x[0]), fixed(0, part.x[1])],
                [fixed(1, part.y[0]), fixed(1, part.y[1])],
            ];
            scheme.boxes.push(OnLines {
                style: PARTS[k].2,
                lines,
                height: part.height,
                roof: roofs[k],
            });
        }
        scheme
    }

    /// Lines of the general boxes along an axis: distinct edges, the outermost ones fixed unless a part takes
    /// their place.
    fn general_lines(
        &mut self,
        blocks: &[Block],
        axis: usize,
        target: &MassTarget,
    ) -> Vec<[usize; 2]> {
        let mut values: Vec<f64> = blocks.iter().flat_map(|b| b.edges[axis]).collect();
        values.sort_by(f64::total_cmp);
        values.dedup_by(|next, kept| *next - *kept < SAME);
        let extent = target.extent(axis);
        let touched = |end: f64| {
            let parts = target.parts.iter().flatten();
            let edges = parts.flat_map(|p| [p.x, p.y][axis]);
            edges.into_iter().any(|v| v == end)
        };
        let first = self.lines[axis].len();
        let last = values.len() - 1;
        for (k, &value) in values.iter().enumerate() {
            let is_frozen = blocks
                .iter()
                .any(|b| b.frozen && b.edges[axis].iter().any(|e| (e - value).abs() < SAME));
            let line = if is_frozen {
                GridLine::Fixed(value)
            } else if k == 0 && (value < 0.01 || !touched(0.0)) {
                GridLine::Fixed(0.0)
            } else if k == last && (value > extent - 0.01 || !touched(extent)) {
                GridLine::Fixed(extent)
            } else {
                self.start.push(value);
                GridLine::Free(self.start.len() - 1)
            };
            self.lines[axis].push(line);
        }
        let find = |value: f64| first + values.partition_point(|&v| v < value - SAME);
        blocks.iter().map(|b| b.edges[axis].map(find)).collect()
    }

    /// Position of a line, in metres.
    pub(super) fn at(&self, axis: usize, line: usize, x: &[f64]) -> f64 {
        match self.lines[axis][line] {
            GridLine::Fixed(at) => at,
            GridLine::Free(variable) => x[variable],
        }
    }

    /// The building with the variables at `x`; edges of inverted boxes are swapped.
    pub(super) fn building(&self, x: &[f64], floor_height: f64) -> Building {
        let boxes = self.boxes.iter().map(|b| {
            let [x, y] = [0, 1].map(|axis| {
                let [a, b] = b.lines[axis].map(|line| self.at(axis, line, x));
                (a.min(b), (b - a).abs().max(1e-9))
            });
            MassBox {
                style: b.style,
                x: x.0 + x.1 / 2.0,
                y: y.0 + y.1 / 2.0,
                width: x.1,
                depth: y.1,
                height: b.height,
                roof: b.roof,
            }
        });
        Building {
            name: String::new(),
            unit: String::new(),
            floor_height,
            boxes: boxes.collect(),
            facades: Vec::new(),
            special: Vec::new(),
            unobserved: Vec::new(),
        }
    }

    /// The general boxes with the variables at `x`, to start anew from.
    pub(super) fn blocks(&self, x: &[f64], floor_height: f64) -> Vec<Block> {
        let general = self.boxes.iter().filter(|b| b.style == BoxStyle::Main);
        let blocks = general.map(|b| Block {
            edges: [0, 1].map(|axis| {
                let [p, q] = b.lines[axis].map(|line| self.at(axis, line, x));
                [p.min(q), p.max(q)]
            }),
            floors: ((b.height / floor_height).round() as usize).max(1),
            roof: b.roof,
            frozen: false,
        });
        blocks.collect()
    }

    /// Signed extents of the general boxes.
    pub(super) fn thicknesses<'a>(&'a self, x: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let general = self.boxes.iter().filter(|b| b.style == BoxStyle::Main);
        general.flat_map(move |b| {
            [0, 1].map(|axis| {
                let [a, b] = b.lines[axis].map(|line| self.at(axis, line, x));
                b - a
            })
        })
    }

    /// The scheme with lines nearer than `reach` made one, or `None` when there are none.
    pub(super) fn snapped(&self, x: &[f64], reach: f64) -> Option<Self> {
        let mut out = self.clone();
        out.start = x.to_vec();
        let mut changed = false;
        for axis in [0, 1] {
            for i in 0..out.lines[axis].len() {
                let GridLine::Free(variable) = out.lines[axis][i] else {
                    continue;
                };
                let here = out.start[variable];
                let others = (0..out.lines[axis].len())
                    .filter(|&j| out.lines[axis][j] != GridLine::Free(variable));
                let near = others
                    .map(|j| {
                        (
                            out.lines[axis][j],
                            (out.at(axis, j, &out.start) - here).abs(),
                        )
                    })
                    .filter(|(_, distance)| *distance < reach)
                    .min_by(|a, b| a.1.total_cmp(&b.1));
                if let Some((line, _)) = near {
                    changed = true;
                    for l in &mut out.lines[axis] {
                        if *l == GridLine::Free(variable) {
                            *l = line;
                        }
                    }
                }
            }
        }
        changed.then_some(out)
    }
}

/// The general boxes of a donor and the roofs of its parts, warped so that its bounding box and, where the
/// order allows it, its garage and porches come to lie on those of the target.
pub(super) fn donated(
    donor: &Building,
    mirrored: bool,
    target: &MassTarget,
) -> (Vec<Block>, [Roof; 3]) {
    let b = bounds(donor);
    let middle = (b[1][0] + b[1][1]) / 2.0;
    let flip = |axis: usize, v: f64| match mirrored && axis == 0 {
        true => b[0][1] - v,
        false => v - b[axis][0],
    };
    let edges = |m: &MassBox| {
        let plan = m.plan();
        [[plan.x, plan.right()], [plan.y, plan.top()]]
    };
    let mut roofs = [PLAIN; 3];
    let mut knots: [Vec<(f64, f64)>; 2] =
        [0, 1].map(|axis| vec![(0.0, 0.0), (b[axis][1] - b[axis][0], target.extent(axis))]);
    for m in &donor.boxes {
        let Some(k) = part_of(m, middle) else {
            continue;
        };
        roofs[k] = m.roof;
        if let Some(part) = &target.parts[k] {
            for (axis, knots) in knots.iter_mut().enumerate() {
                let mut from = edges(m)[axis].map(|v| flip(axis, v));
                from.sort_by(f64::total_cmp);
                knots.extend(from.into_iter().zip([part.x, part.y][axis]));
            }
        }
    }
    let warps = knots.map(Warp::new);
    let general = donor.boxes.iter().filter(|m| m.style == BoxStyle::Main);
    let floors = donor.floors();
    let blocks = general.map(|m| {
        let edges = edges(m);
        let edges = [0, 1].map(|axis| {
            let mut e = edges[axis].map(|v| warps[axis].at(flip(axis, v)));
            e.sort_by(f64::total_cmp);
            e
        });
        let own = donor.floors_of(m);
        Block {
            edges,
            // The tallest boxes of the donor are the tallest here.
            floors: if own == floors {
                target.floors
            } else {
                own.min(target.floors)
            },
            roof: m.roof,
            frozen: false,
        }
    });
    (blocks.collect(), roofs)
}

/// A monotone piecewise linear map; knots out of order leave only the two ends.
struct Warp(Vec<(f64, f64)>);

impl Warp {
    fn new(mut knots: Vec<(f64, f64)>) -> Self {
        let ends = [knots[0], knots[1]];
        knots.sort_by(|a, b| a.0.total_cmp(&b.0));
        knots.dedup_by(|next, kept| next.0 - kept.0 < SAME && (next.1 - kept.1).abs() < SAME);
        // Steep or inverted pieces would tear the donor apart.
        let gentle = |w: &[(f64, f64)]| {
            let slope = (w[1].1 - w[0].1) / (w[1].0 - w[0].0);
            w[1].0 - w[0].0 > SAME && (0.2..=5.0).contains(&slope)
        };
        if knots.windows(2).all(gentle) {
            return Self(knots);
        }
        Self(ends.to_vec())
    }

    fn at(&self, v: f64) -> f64 {
        let k = self.0.partition_point(|knot| knot.0 <= v);
        let k = k.clamp(1, self.0.len() - 1);
        let (a, b) = (self.0[k - 1], self.0[k]);
        a.1 + (v - a.0) / (b.0 - a.0) * (b.1 - a.1)
    }
}
