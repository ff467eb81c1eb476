//! The plan cut into convex cells over which the union of prisms is a fixed stack of intervals.

use std::cmp::Ordering;

use super::Prism;
use super::exact::{Line, Plane, Point};

/// A convex polygon, counterclockwise; edge `i` runs from vertex `i` to the next on `lines[i]`.
#[derive(Debug, Clone)]
pub struct Polygon {
    /// Vertices.
    pub vertices: Vec<Point>,
    /// Lines of the edges, in any direction.
    pub lines: Vec<Line>,
}

/// A cell of the arrangement that something stands on.
#[derive(Debug, Clone)]
pub struct Cell {
    /// Its outline.
    pub polygon: Polygon,
    /// Indices of the prisms over it.
    pub prisms: Vec<usize>,
    /// The union of the prisms: planes from below, intervals that neither overlap nor touch all over.
    pub intervals: Vec<(Plane, Plane)>,
}

/// A prism that stands, as far as is known, on a part of the polygon: some of its sides may still cut it.
#[derive(Clone)]
struct Candidate {
    prism: usize,
    /// Sides that ran across the polygon before its last cut; the polygon is left of all others.
    sides: Vec<Line>,
}

/// Cuts the plan.
pub fn cells(prisms: &[Prism]) -> Vec<Cell> {
    let mut cells = Vec::new();
    let all = prisms.iter().enumerate().map(|(prism, p)| Candidate {
        prism,
        sides: p.region.clone(),
    });
    if let Some(polygon) = frame(prisms) {
        subdivide(polygon, &all.collect::<Vec<_>>(), prisms, &mut cells);
    }
    cells
}

/// A rectangle around all regions, from their lines along the axes.
fn frame(prisms: &[Prism]) -> Option<Polygon> {
    let lines = || prisms.iter().flat_map(|p| &p.region);
    let xs = lines().filter(|l| l.b == 0).map(|l| -l.c / l.a);
    let ys = lines().filter(|l| l.a == 0).map(|l| -l.c / l.b);
    // Regions with other sides reach no further than their own extent from these.
    let margin = 1_000_000;
    let (x0, x1) = (xs.clone().min()? - margin, xs.max()? + margin);
    let (y0, y1) = (ys.clone().min()? - margin, ys.max()? + margin);
    let corner = |x, y| Point::new(x, y, 1);
    Some(Polygon {
        vertices: vec![
            corner(x0, y0),
            corner(x1, y0),
            corner(x1, y1),
            corner(x0, y1),
        ],
        lines: vec![
            Line::new(0, 1, -y0),
            Line::new(1, 0, -x1),
            Line::new(0, 1, -y1),
            Line::new(1, 0, -x0),
        ],
    })
}

fn subdivide(polygon: Polygon, candidates: &[Candidate], prisms: &[Prism], out: &mut Vec<Cell>) {
    let mut over: Vec<Candidate> = Vec::with_capacity(candidates.len());
    let mut cut = None;
    for candidate in candidates {
        let mut sides = Vec::new();
        let mut outside = false;
        for line in &candidate.sides {
            match polygon.against(line) {
                Position::Right => {
                    outside = true;
                    break;
                }
                Position::Across => sides.push(*line),
                Position::Left => {}
            }
        }
        if !outside {
            cut = cut.or(sides.last().copied());
            let prism = candidate.prism;
            over.push(Candidate { prism, sides });
        }
    }
    if over.is_empty() {
        return;
    }
    let standing = || over.iter().map(|c| c.prism);
    let cut = cut.or_else(|| crossing_planes(&polygon, standing(), prisms));
    if let Some(line) = cut {
        let (left, right) = polygon.split(&line);
        subdivide(left, &over, prisms, out);
        subdivide(right, &over, prisms, out);
        return;
    }
    let over: Vec<usize> = standing().collect();
    let intervals = intervals(&polygon, &over, prisms);
    if !intervals.is_empty() {
        out.push(Cell {
            polygon,
            prisms: over,
            intervals,
        });
    }
}

/// A line in which two planes cross over the polygon: one is higher at one vertex, the other at another.
fn crossing_planes(
    polygon: &Polygon,
    over: impl Iterator<Item = usize>,
    prisms: &[Prism],
) -> Option<Line> {
    let mut planes: Vec<Plane> = over
        .flat_map(|i| [prisms[i].lower, prisms[i].upper])
        .collect();
    planes.sort_unstable();
    planes.dedup();
    let corners = &polygon.vertices;
    let heights: Vec<i128> = planes
        .iter()
        .flat_map(|p| corners.iter().map(|v| p.at(v)))
        .collect();
    let of = |i: usize| &heights[i * corners.len()..(i + 1) * corners.len()];
    for i in 0..planes.len() {
        for j in i + 1..planes.len() {
            let both = || of(i).iter().zip(of(j));
            if both().any(|(p, q)| p > q) && both().any(|(p, q)| p < q) {
                return planes[i].above(&planes[j]);
            }
        }
    }
    None
}

/// The union of the prisms over a polygon in which no planes cross.
fn intervals(polygon: &Polygon, over: &[usize], prisms: &[Prism]) -> Vec<(Plane, Plane)> {
    let order = |p: &Plane, q: &Plane| {
        let each = polygon.vertices.iter().map(|v| p.at(v).cmp(&q.at(v)));
        each.into_iter()
            .find(|o| *o != Ordering::Equal)
            .unwrap_or(Ordering::Equal)
    };
    let solid = over.iter().map(|&i| (prisms[i].lower, prisms[i].upper));
    let mut solid: Vec<(Plane, Plane)> = solid.filter(|(l, u)| order(l, u).is_lt()).collect();
    solid.sort_by(|a, b| order(&a.0, &b.0));
    let mut union: Vec<(Plane, Plane)> = Vec::new();
    for (lower, upper) in solid {
        match union.last_mut() {
            Some(last) if order(&lower, &last.1).is_le() => {
                if order(&upper, &last.1).is_gt() {
                    last.1 = upper;
                }
            }
            _ => union.push((lower, upper)),
        }
    }
    union
}

/// The position of a polygon relative to a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Position {
    Left,
    Right,
    Across,
}

impl Polygon {
    fn against(&self, line: &Line) -> Position {
        let (mut left, mut right) = (false, false);
        for v in &self.vertices {
            match line.side(v) {
                Ordering::Greater => left = true,
                Ordering::Less => right = true,
                Ordering::Equal => {}
            }
            if left && right {
                return Position::Across;
            }
        }
        match right {
            true => Position::Right,
            false => Position::Left,
        }
    }

    /// The parts left and right of a line that lies across.
    fn split(&self, line: &Line) -> (Polygon, Polygon) {
        let sides: Vec<Ordering> = self.vertices.iter().map(|v| line.side(v)).collect();
        let part = |keep: Ordering| {
            let mut part = Polygon {
                vertices: Vec::with_capacity(self.vertices.len() + 1),
                lines: Vec::with_capacity(self.vertices.len() + 1),
            };
            let mut push = |v: Point, l: Line| {
                part.vertices.push(v);
                part.lines.push(l);
            };
            for i in 0..sides.len() {
                let (here, next) = (sides[i], sides[(i + 1) % sides.len()]);
                let own = self.lines[i];
                // An edge that changes sides is not parallel to the line.
                let crossing = || own.crossing(line).unwrap_or(self.vertices[i]);
                if here == keep {
                    push(self.vertices[i], own);
                    if next == keep.reverse() {
                        push(crossing(), *line);
                    }
                } else if here == Ordering::Equal && next == keep {
                    push(self.vertices[i], own);
                } else if here == Ordering::Equal {
                    push(self.vertices[i], *line);
                } else if next == keep {
                    push(crossing(), own);
                }
            }
            part
        };
        (part(Ordering::Greater), part(Ordering::Less))
    }
}
