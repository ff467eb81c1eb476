//! Plans of buildings as cells, and the open ground that belongs to each.

use rustc_hash::{FxHashMap, FxHashSet};

use super::shape::rotated;
use edifice_shape::triangles::{TriangleMesh, plan_area};

/// Side of a cell, in metres.
pub(super) const CELL: f64 = 1.0;
/// Side of a cell of open ground, in metres.
pub(super) const OPEN_CELL: f64 = 2.0;
/// Steps of such cells that open ground reaches from its building.
const OPEN_STEPS: usize = 4;

/// The plan of a building as points of a grid in its frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Footprint {
    /// Points whose four neighbours are covered; all points, if there are none.
    pub(super) inner: Vec<[f64; 2]>,
    /// The points of the plan that are no inner ones.
    pub(super) rim: Vec<[f64; 2]>,
    /// Points of the open ground that belongs to the building.
    pub(super) open: Vec<[f64; 2]>,
}

impl Footprint {
    /// Number of points: square metres of plan.
    pub(super) fn points(&self) -> usize {
        self.inner.len() + self.rim.len()
    }

    /// The mean of its points; the origin if there are none.
    pub(super) fn middle(&self) -> [f64; 2] {
        let n = self.points().max(1) as f64;
        [0, 1].map(|k| self.covered().map(|p| p[k]).sum::<f64>() / n)
    }

    /// The points along the edge of the plan.
    pub(super) fn edge(&self) -> &[[f64; 2]] {
        match self.rim.is_empty() {
            true => &self.inner,
            false => &self.rim,
        }
    }

    /// All points of the plan, in the frame of the building.
    pub(super) fn covered(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.inner.iter().chain(&self.rim).copied()
    }
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
            ..Footprint::default()
        },
        false => Footprint {
            inner: point(inner),
            rim: point(rim),
            open: Vec::new(),
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

/// The open ground of each building of a city, in its frame: cells nearer to it than to others, counted in steps.
pub(super) fn open_ground(prints: &[&Footprint], frames: &[([f64; 3], f64)]) -> Vec<Vec<[f64; 2]>> {
    let cell = |p: [f64; 2]| p.map(|v| (v / OPEN_CELL).floor() as i64);
    let mut owner: FxHashMap<[i64; 2], usize> = FxHashMap::default();
    let mut front: Vec<[i64; 2]> = Vec::new();
    for (i, (print, (at, turn))) in prints.iter().zip(frames).enumerate() {
        for p in print.covered() {
            let [x, y] = rotated(p, *turn);
            let c = cell([at[0] + x, at[1] + y]);
            owner.entry(c).or_insert_with(|| {
                front.push(c);
                i
            });
        }
    }
    let mut open: Vec<Vec<[f64; 2]>> = vec![Vec::new(); prints.len()];
    for _ in 0..OPEN_STEPS {
        let mut next = Vec::new();
        for [x, y] in front {
            let own = owner[&[x, y]];
            for c in [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]] {
                owner.entry(c).or_insert_with(|| {
                    let (at, turn) = frames[own];
                    let p = c.map(|v| (v as f64 + 0.5) * OPEN_CELL);
                    open[own].push(rotated([p[0] - at[0], p[1] - at[1]], -turn));
                    next.push(c);
                    own
                });
            }
        }
        front = next;
    }
    open
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_ground_lies_around_its_building_wherever_that_stands() {
        // A square of 8 m about its frame, alone and with its twin to the east.
        let half: Vec<f64> = (-4..4).map(|v| f64::from(v) + 0.5).collect();
        let covered = half.iter().flat_map(|x| half.iter().map(|y| [*x, *y]));
        let print = Footprint {
            inner: covered.collect(),
            ..Footprint::default()
        };
        for (at, turn) in [
            ([0.0, 0.0, 0.0], 0.0),
            ([5000.0, -3000.0, 7.0], 0.0),
            ([-700.0, 40.0, 0.0], 90.0),
        ] {
            let east = rotated([14.0, 0.0], turn);
            let twin = ([at[0] + east[0], at[1] + east[1], at[2]], turn);
            let alone = &open_ground(&[&print], &[(at, turn)])[0];
            let reach = OPEN_STEPS as f64 * OPEN_CELL;
            // Cells at most so many steps from the square, counted along the axes, in all directions alike.
            let from = |[x, y]: [f64; 2]| (x.abs() - 4.0).max(0.0) + (y.abs() - 4.0).max(0.0);
            assert!(alone.iter().all(|p| from(*p) > 0.0 && from(*p) < reach));
            for k in 0..2 {
                let sum: f64 = alone.iter().map(|p| p[k]).sum();
                assert!((sum / alone.len() as f64).abs() < 1e-6, "{at:?}");
            }
            let beside = &open_ground(&[&print, &print], &[(at, turn), twin])[0];
            assert!(beside.len() < alone.len());
            assert!(beside.iter().all(|p| {
                alone
                    .iter()
                    .any(|q| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-6)
            }));
            assert!(beside.iter().all(|p| p[0] < 8.0), "nearer to the twin");
        }
    }
}
