//! Which cells meet along which segments, every vertex on a segment being an end of it.

use rustc_hash::FxHashMap;

use super::arrangement::Cell;
use super::exact::{Line, Plane, Point};

/// The cells' outlines with all vertices on them.
pub(super) struct CellOutlines {
    pub points: Vec<Point>,
    /// Outline of each cell: indices of points, counterclockwise.
    pub rings: Vec<Vec<u32>>,
    /// For each ring edge, its line, the cell on its left being the ring's own.
    pub lines: Vec<Vec<Line>>,
    /// The cell left of a directed segment.
    pub left: FxHashMap<(u32, u32), u32>,
}

/// Points of one line in order along it.
type OnLine = Vec<u32>;

pub(super) fn connect(cells: &[Cell]) -> CellOutlines {
    let mut points = Points::default();
    let corners: Vec<Vec<u32>> = cells
        .iter()
        .map(|c| {
            c.polygon
                .vertices
                .iter()
                .map(|v| points.index(*v))
                .collect()
        })
        .collect();
    let mut by_line: FxHashMap<Line, OnLine> = FxHashMap::default();
    for cell in cells {
        for line in &cell.polygon.lines {
            by_line.entry(line.undirected()).or_default();
        }
    }
    for (line, on) in &mut by_line {
        *on = points.on(line);
    }
    let (first, lines) = rings(cells, &corners, &by_line);
    // Where walls of the two sides cross within a segment, it is split once more.
    let left = owners(&first);
    let mut extra: FxHashMap<Line, Vec<u32>> = FxHashMap::default();
    for (k, (ring, lines)) in first.iter().zip(&lines).enumerate() {
        for (i, line) in lines.iter().enumerate() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            let Some(&other) = left.get(&(b, a)) else {
                continue;
            };
            if other < k as u32 {
                continue;
            }
            let ends = [points.list[a as usize], points.list[b as usize]];
            for point in crossings(&cells[k], &cells[other as usize], line, &ends) {
                let index = points.index(point);
                extra.entry(*line).or_default().push(index);
            }
        }
    }
    if extra.is_empty() {
        return CellOutlines {
            points: points.list,
            rings: first,
            lines,
            left,
        };
    }
    for (line, more) in extra {
        if let Some(on) = by_line.get_mut(&line) {
            on.extend(more);
            sort(on, &line, &points.list);
        }
    }
    let (rings, lines) = rings(cells, &corners, &by_line);
    let left = owners(&rings);
    CellOutlines {
        points: points.list,
        rings,
        lines,
        left,
    }
}

/// Points strictly between the ends where a plane of one cell crosses one of the other.
fn crossings(a: &Cell, b: &Cell, line: &Line, ends: &[Point; 2]) -> Vec<Point> {
    let mut found = Vec::new();
    // Planes of one cell never cross inside it or on its edges.
    if a.intervals == b.intervals {
        return found;
    }
    for p in planes(a) {
        let own = ends.each_ref().map(|end| p.at(end));
        for q in planes(b) {
            let sides = [0, 1].map(|k| own[k].cmp(&q.at(&ends[k])));
            if sides[0] == sides[1].reverse() && sides[0].is_ne() {
                found.extend(p.above(&q).and_then(|equal| line.crossing(&equal)));
            }
        }
    }
    found
}

/// Lower and upper planes of the intervals.
fn planes(cell: &Cell) -> impl Iterator<Item = Plane> + '_ {
    cell.intervals.iter().flat_map(|(l, u)| [*l, *u])
}

type Rings = (Vec<Vec<u32>>, Vec<Vec<Line>>);

/// Outlines with every point that lies on them.
fn rings(cells: &[Cell], corners: &[Vec<u32>], by_line: &FxHashMap<Line, OnLine>) -> Rings {
    let (mut rings, mut lines) = (Vec::new(), Vec::new());
    for (cell, corners) in cells.iter().zip(corners) {
        let (mut ring, mut ring_lines) = (Vec::new(), Vec::new());
        for (i, line) in cell.polygon.lines.iter().enumerate() {
            let line = line.undirected();
            let on = &by_line[&line];
            let find = |p: u32| on.iter().position(|&q| q == p).unwrap_or(0);
            let (from, to) = (find(corners[i]), find(corners[(i + 1) % corners.len()]));
            let mut add = |k: usize| {
                ring.push(on[k]);
                ring_lines.push(line);
            };
            if from < to {
                (from..to).for_each(&mut add);
            } else {
                (to + 1..=from).rev().for_each(&mut add);
            }
        }
        rings.push(ring);
        lines.push(ring_lines);
    }
    (rings, lines)
}

fn owners(rings: &[Vec<u32>]) -> FxHashMap<(u32, u32), u32> {
    let mut left = FxHashMap::default();
    left.reserve(rings.iter().map(Vec::len).sum());
    for (k, ring) in rings.iter().enumerate() {
        for i in 0..ring.len() {
            left.insert((ring[i], ring[(i + 1) % ring.len()]), k as u32);
        }
    }
    left
}

/// Distinct points by number.
#[derive(Default)]
struct Points {
    list: Vec<Point>,
    metres: Vec<[f64; 2]>,
    index: FxHashMap<Point, u32>,
}

impl Points {
    fn index(&mut self, point: Point) -> u32 {
        *self.index.entry(point).or_insert_with(|| {
            self.list.push(point);
            self.metres.push(point.metres());
            (self.list.len() - 1) as u32
        })
    }

    /// The points on a line, in order.
    fn on(&self, line: &Line) -> OnLine {
        let (a, b) = (line.a as f64, line.b as f64);
        let norm = a.hypot(b);
        let c = line.c as f64 * super::exact::UNIT;
        // Rounding is far smaller than this; what is nearer is tested exactly.
        let near = |p: &[f64; 2]| ((a * p[0] + b * p[1] + c) / norm).abs() < 1e-6;
        let mut on: OnLine = (0..self.list.len() as u32)
            .filter(|&i| {
                near(&self.metres[i as usize]) && line.side(&self.list[i as usize]).is_eq()
            })
            .collect();
        sort(&mut on, line, &self.list);
        on
    }
}

fn sort(on: &mut OnLine, line: &Line, points: &[Point]) {
    on.sort_by(|&p, &q| line.along(&points[p as usize], &points[q as usize]));
    on.dedup();
}
