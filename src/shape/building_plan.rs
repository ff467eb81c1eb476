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
    /// Column-major with a border of outside cells all around, so that every cell of the grid has four neighbours: cell (i, j) at
    /// `(i + 1) * (rows + 2) + j + 1`.
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
        let inside = cells(&xs, &ys, rectangles);
        Self { xs, ys, inside }
    }

    #[inline]
    fn columns(&self) -> usize {
        self.xs.len().saturating_sub(1)
    }

    #[inline]
    fn rows(&self) -> usize {
        self.ys.len().saturating_sub(1)
    }

    /// Place of a cell of the grid; its neighbours across are a [`PlanUnion::column`] away, those along one.
    #[inline]
    fn place(&self, i: usize, j: usize) -> usize {
        (i + 1) * self.column() + j + 1
    }

    /// Cells from one column to the next.
    #[inline]
    fn column(&self) -> usize {
        self.rows() + 2
    }

    #[inline]
    fn cell(&self, i: usize, j: usize) -> bool {
        self.inside[self.place(i, j)]
    }

    /// Area, in squared units.
    pub fn area(&self) -> f64 {
        let mut area = 0.0;
        for i in 0..self.columns() {
            for j in 0..self.rows() {
                if self.cell(i, j) {
                    area += (self.xs[i + 1] - self.xs[i]) * (self.ys[j + 1] - self.ys[j]);
                }
            }
        }
        area
    }

    /// Length of the whole boundary, courtyards included.
    pub fn perimeter(&self) -> f64 {
        let mut perimeter = 0.0;
        self.edges(|edge, _| perimeter += edge.end - edge.start);
        perimeter
    }

    /// Smallest rectangle around the union; `None` when it is empty.
    pub fn bounding_box(&self) -> Option<Rect> {
        let (x0, x1) = (*self.xs.first()?, *self.xs.last()?);
        let (y0, y1) = (*self.ys.first()?, *self.ys.last()?);
        Some(Rect::new(x0, y0, x1 - x0, y1 - y0))
    }

    /// The boundary as maximal straight edges, by side, place and start.
    pub fn outline(&self) -> Vec<PlanEdge> {
        let mut edges = Vec::new();
        self.edges(|edge, _| edges.push(edge));
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

    /// Tells the sides of inside cells that border an outside cell, each with the place of that outside cell: cell by cell, and of a cell in
    /// the order of [`Side::ALL`].
    fn edges(&self, mut tell: impl FnMut(PlanEdge, usize)) {
        for i in 0..self.columns() {
            for j in 0..self.rows() {
                if self.cell(i, j) {
                    self.edges_of(i, j, &mut tell);
                }
            }
        }
    }

    fn edges_of(&self, i: usize, j: usize, tell: &mut impl FnMut(PlanEdge, usize)) {
        let place = self.place(i, j);
        for side in Side::ALL {
            let outside = match side {
                Side::Front => place - 1,
                Side::Back => place + 1,
                Side::Left => place - self.column(),
                Side::Right => place + self.column(),
            };
            if self.inside[outside] {
                continue;
            }
            let (at, [start, end]) = match side {
                Side::Front => (self.ys[j], [self.xs[i], self.xs[i + 1]]),
                Side::Back => (self.ys[j + 1], [self.xs[i], self.xs[i + 1]]),
                Side::Left => (self.xs[i], [self.ys[j], self.ys[j + 1]]),
                Side::Right => (self.xs[i + 1], [self.ys[j], self.ys[j + 1]]),
            };
            let edge = PlanEdge {
                side,
                at,
                start,
                end,
            };
            tell(edge, outside);
        }
    }

    /// Outside cells that are joined to the far outside, by their places; the border is.
    fn open_air(&self) -> Vec<bool> {
        let (columns, rows, column) = (self.columns(), self.rows(), self.column());
        let mut open = vec![true; self.inside.len()];
        for i in 0..columns {
            let first = self.place(i, 0);
            open[first..first + rows].fill(false);
        }
        // From the border inwards.
        let across = (0..columns).flat_map(|i| [(i, 0), (i, rows.saturating_sub(1))]);
        let along = (0..rows).flat_map(|j| [(0, j), (columns.saturating_sub(1), j)]);
        let mut queue: Vec<usize> = Vec::new();
        for (i, j) in across.chain(along) {
            let place = self.place(i, j);
            if !self.inside[place] && !open[place] {
                open[place] = true;
                queue.push(place);
            }
        }
        while let Some(place) = queue.pop() {
            for next in [place - 1, place + 1, place - column, place + column] {
                if !self.inside[next] && !open[next] {
                    open[next] = true;
                    queue.push(next);
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
    let whole = PlanUnion::new(whole);
    let open = whole.open_air();
    let inside = cells(&whole.xs, &whole.ys, part);
    let part = PlanUnion { inside, ..whole };
    let (mut perimeter, mut visible) = (0.0, 0.0);
    part.edges(|edge, outside| {
        perimeter += edge.end - edge.start;
        if open[outside] {
            visible += edge.end - edge.start;
        }
    });
    Visibility { perimeter, visible }
}

/// The cells that some rectangle covers, in the order of [`PlanUnion`].
fn cells(xs: &[f64], ys: &[f64], rectangles: &[Rect]) -> Vec<bool> {
    let column = ys.len().saturating_sub(1) + 2;
    let mut inside = vec![false; (xs.len().saturating_sub(1) + 2) * column];
    for r in rectangles {
        let (i0, i1) = (nearest(xs, r.x), nearest(xs, r.right()));
        let (j0, j1) = (nearest(ys, r.y), nearest(ys, r.top()));
        for i in i0..i1 {
            let first = (i + 1) * column + 1;
            inside[first + j0..first + j1].fill(true);
        }
    }
    inside
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

#[cfg(test)]
mod tests;
