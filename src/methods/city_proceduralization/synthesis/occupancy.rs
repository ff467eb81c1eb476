//! What ground is taken, on a grid of 1 m.

use rustc_hash::FxHashSet;

use super::{Shape, rotated};
use crate::shape::triangles::{TriangleMesh, plan_area};

/// Side of a cell, in metres.
const CELL: f64 = 1.0;
/// Share of a building's inner points that may lie on others.
const OVERLAP: f64 = 0.004;
/// Share of its points that may lie outside the shape.
const OUTSIDE: f64 = 0.004;

/// The plan of a building as points of a grid in its frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Footprint {
    /// Points whose four neighbours are covered; all points, if there are none.
    inner: Vec<[f64; 2]>,
    /// The other points.
    rim: Vec<[f64; 2]>,
}

/// The plan of a mesh, in the frame at `at`, turned by `turn` degrees.
pub(super) fn footprint(mesh: &TriangleMesh, at: [f64; 3], turn: f64) -> Footprint {
    let mut cells: FxHashSet<[i64; 2]> = FxHashSet::default();
    for t in mesh.corners() {
        let t = t.map(|p| rotated([p[0] - at[0], p[1] - at[1]], -turn));
        let flat = t.map(|p| [p[0], p[1], 0.0]);
        if plan_area(&flat) > 0.0 {
            cover(&t, &mut cells);
        }
    }
    let mut sorted: Vec<[i64; 2]> = cells.iter().copied().collect();
    sorted.sort_unstable();
    let is_inner = |&[i, j]: &[i64; 2]| {
        let around = [[i - 1, j], [i + 1, j], [i, j - 1], [i, j + 1]];
        around.iter().all(|c| cells.contains(c))
    };
    let (inner, rim): (Vec<_>, Vec<_>) = sorted.into_iter().partition(is_inner);
    let point = |c: Vec<[i64; 2]>| -> Vec<[f64; 2]> {
        let middle = |v: i64| (v as f64 + 0.5) * CELL;
        c.into_iter().map(|c| c.map(middle)).collect()
    };
    match inner.is_empty() {
        true => Footprint {
            inner: point(rim),
            rim: Vec::new(),
        },
        false => Footprint {
            inner: point(inner),
            rim: point(rim),
        },
    }
}

/// Marks the cells whose middles a triangle covers.
fn cover(t: &[[f64; 2]; 3], cells: &mut FxHashSet<[i64; 2]>) {
    let low = [0, 1].map(|k| t.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|k| t.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max));
    let first = low.map(|v| (v / CELL - 0.5).ceil() as i64);
    let last = high.map(|v| (v / CELL - 0.5).floor() as i64);
    for i in first[0]..=last[0] {
        for j in first[1]..=last[1] {
            let p = [(i as f64 + 0.5) * CELL, (j as f64 + 0.5) * CELL];
            let inside = (0..3).all(|k| {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0.0
            });
            if inside {
                cells.insert([i, j]);
            }
        }
    }
}

/// Ground that buildings stand on.
#[derive(Debug, Default)]
pub(super) struct Occupancy {
    taken: FxHashSet<[i64; 2]>,
}

impl Occupancy {
    /// Puts a building down, if it lies inside the shape and on nothing else; whether it did.
    pub(super) fn take(
        &mut self,
        footprint: &Footprint,
        at: [f64; 2],
        turn: f64,
        shape: &Shape,
    ) -> bool {
        let place = |p: &[f64; 2]| {
            let [x, y] = rotated(*p, turn);
            [at[0] + x, at[1] + y]
        };
        let cell = |p: [f64; 2]| p.map(|v| (v / CELL).floor() as i64);
        let inner: Vec<[f64; 2]> = footprint.inner.iter().map(place).collect();
        if inner.is_empty() {
            return false;
        }
        let most = (OVERLAP * inner.len() as f64) as usize;
        let hit = |p: &&[f64; 2]| self.taken.contains(&cell(**p));
        if inner.iter().filter(hit).take(most + 1).count() > most {
            return false;
        }
        let rim: Vec<[f64; 2]> = footprint.rim.iter().map(place).collect();
        let edge = if rim.is_empty() { &inner } else { &rim };
        let most = (OUTSIDE * edge.len() as f64) as usize;
        let out = |p: &&[f64; 2]| !shape.contains(**p);
        if edge.iter().filter(out).take(most + 1).count() > most {
            return false;
        }
        self.taken.extend(inner.into_iter().chain(rim).map(cell));
        true
    }
}
