//! Exact unions of axis-parallel rectangles in plan: area, perimeter, bounding box, outline.
//!
//! The edges of the rectangles cut the plane into an irregular grid of cells; a cell is inside
//! when some rectangle covers it. All measures are then sums over cells and their sides, whatever
//! the way in which a shape was cut into rectangles. Edges closer than 1e-9 of the extent are one
//! edge, so that rounding (`0.1 + 0.2`) leaves no hairline gap between neighbours.

mod soundness;

use super::{Rect, Side};
pub use soundness::Soundness;

/// A union of rectangles in plan.
#[derive(Debug, Clone)]
pub struct PlanUnion {
    xs: Vec<f64>,
    ys: Vec<f64>,
    /// Column-major: cell (i, j) at `i * rows + j`.
    inside: Vec<bool>,
}

/// A straight part of the outline of a union.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanEdge {
    /// The side it faces.
    pub side: Side,
    /// Its coordinate across: y for front and back, x for left and right.
    pub at: f64,
    /// Its start: x for front and back, y for left and right.
    pub start: f64,
    /// Its end, on the same axis.
    pub end: f64,
}

impl PlanUnion {
    /// The union of the rectangles; none give the empty union.
    ///
    /// Complexity: `O(n^3)` for `n` rectangles, meant for the few boxes of a house.
    pub fn new(rectangles: &[Rect]) -> Self {
        let (xs, ys) = grid_lines(rectangles);
        Self::on_grid(xs, ys, rectangles)
    }

    fn on_grid(xs: Vec<f64>, ys: Vec<f64>, rectangles: &[Rect]) -> Self {
        let (columns, rows) = (xs.len().saturating_sub(1), ys.len().saturating_sub(1));
        let mut inside = vec![false; columns * rows];
        for r in rectangles {
            let (i0, i1) = (nearest(&xs, r.x), nearest(&xs, r.right()));
            let (j0, j1) = (nearest(&ys, r.y), nearest(&ys, r.top()));
            for i in i0..i1 {
                inside[i * rows + j0..i * rows + j1].fill(true);
            }
        }
        Self { xs, ys, inside }
    }

    fn columns(&self) -> usize {
        self.xs.len().saturating_sub(1)
    }

    fn rows(&self) -> usize {
        self.ys.len().saturating_sub(1)
    }

    fn cell(&self, i: isize, j: isize) -> bool {
        let (columns, rows) = (self.columns() as isize, self.rows() as isize);
        (0..columns).contains(&i) && (0..rows).contains(&j) && self.inside[(i * rows + j) as usize]
    }

    /// Area, in squared units.
    pub fn area(&self) -> f64 {
        let mut area = 0.0;
        for i in 0..self.columns() {
            for j in 0..self.rows() {
                if self.cell(i as isize, j as isize) {
                    area += (self.xs[i + 1] - self.xs[i]) * (self.ys[j + 1] - self.ys[j]);
                }
            }
        }
        area
    }

    /// Length of the whole boundary, courtyards included.
    pub fn perimeter(&self) -> f64 {
        self.edges().map(|(edge, _)| edge.end - edge.start).sum()
    }

    /// Smallest rectangle around the union; `None` when it is empty.
    pub fn bounding_box(&self) -> Option<Rect> {
        let (x0, x1) = (*self.xs.first()?, *self.xs.last()?);
        let (y0, y1) = (*self.ys.first()?, *self.ys.last()?);
        Some(Rect::new(x0, y0, x1 - x0, y1 - y0))
    }

    /// The boundary as maximal straight edges, by side, place and start.
    pub fn outline(&self) -> Vec<PlanEdge> {
        let mut edges: Vec<PlanEdge> = self.edges().map(|(edge, _)| edge).collect();
        edges.sort_by(|a, b| {
            let key = |e: &PlanEdge| (e.side as usize, e.at, e.start);
            key(a)
                .partial_cmp(&key(b))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let mut merged: Vec<PlanEdge> = Vec::new();
        for edge in edges {
            match merged.last_mut() {
                Some(last)
                    if last.side == edge.side && last.at == edge.at && last.end == edge.start =>
                {
                    last.end = edge.end;
                }
                _ => merged.push(edge),
            }
        }
        merged
    }

    /// Sides of inside cells that border an outside cell, with that outside cell.
    fn edges(&self) -> impl Iterator<Item = (PlanEdge, (isize, isize))> + '_ {
        let cells = (0..self.columns()).flat_map(|i| (0..self.rows()).map(move |j| (i, j)));
        cells
            .filter(|&(i, j)| self.cell(i as isize, j as isize))
            .flat_map(|(i, j)| Side::ALL.map(|side| (i, j, side)))
            .filter_map(|(i, j, side)| {
                let (a, b) = (i as isize, j as isize);
                let (at, start, end, outside) = match side {
                    Side::Front => (self.ys[j], self.xs[i], self.xs[i + 1], (a, b - 1)),
                    Side::Back => (self.ys[j + 1], self.xs[i], self.xs[i + 1], (a, b + 1)),
                    Side::Left => (self.xs[i], self.ys[j], self.ys[j + 1], (a - 1, b)),
                    Side::Right => (self.xs[i + 1], self.ys[j], self.ys[j + 1], (a + 1, b)),
                };
                let edge = PlanEdge {
                    side,
                    at,
                    start,
                    end,
                };
                (!self.cell(outside.0, outside.1)).then_some((edge, outside))
            })
    }

    /// Outside cells that are joined to the far outside, with a margin of one cell around the grid.
    fn open_air(&self) -> Vec<bool> {
        let (columns, rows) = (self.columns() as isize + 2, self.rows() as isize + 2);
        let index = |i: isize, j: isize| ((i + 1) * rows + j + 1) as usize;
        let mut open = vec![false; (columns * rows) as usize];
        let mut queue = vec![(-1, -1)];
        open[0] = true;
        while let Some((i, j)) = queue.pop() {
            for (a, b) in [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)] {
                let in_grid = (-1..columns - 1).contains(&a) && (-1..rows - 1).contains(&b);
                if in_grid && !self.cell(a, b) && !open[index(a, b)] {
                    open[index(a, b)] = true;
                    queue.push((a, b));
                }
            }
        }
        open
    }
}

/// Boundary of a part of a plan: all of it, and what is seen from outside the whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Visibility {
    /// Length of the part's own boundary.
    pub perimeter: f64,
    /// Length of that boundary that borders the open air, courtyards excluded.
    pub visible: f64,
}

/// The length of the boundary of the union of `part`, and of the share that is seen from outside the union of `whole`.
/// The rectangles of `part` are among those of `whole`.
pub fn visibility(part: &[Rect], whole: &[Rect]) -> Visibility {
    let (xs, ys) = grid_lines(whole);
    let whole = PlanUnion::on_grid(xs.clone(), ys.clone(), whole);
    let part = PlanUnion::on_grid(xs, ys, part);
    let open = whole.open_air();
    let rows = whole.rows() as isize + 2;
    let (mut perimeter, mut visible) = (0.0, 0.0);
    for (edge, (i, j)) in part.edges() {
        perimeter += edge.end - edge.start;
        if open[((i + 1) * rows + j + 1) as usize] {
            visible += edge.end - edge.start;
        }
    }
    Visibility { perimeter, visible }
}

/// The distinct vertical and horizontal edge coordinates of the rectangles.
fn grid_lines(rectangles: &[Rect]) -> (Vec<f64>, Vec<f64>) {
    let xs = rectangles.iter().flat_map(|r| [r.x, r.right()]);
    let ys = rectangles.iter().flat_map(|r| [r.y, r.top()]);
    (distinct(xs.collect()), distinct(ys.collect()))
}

fn distinct(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    let extent = match (values.first(), values.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    };
    values.dedup_by(|next, kept| *next - *kept <= 1e-9 * extent);
    values
}

/// Index of the grid line nearest to `value`.
fn nearest(lines: &[f64], value: f64) -> usize {
    let after = lines.partition_point(|&line| line < value);
    if after == 0 {
        return 0;
    }
    if after == lines.len() || value - lines[after - 1] <= lines[after] - value {
        return after - 1;
    }
    after
}
