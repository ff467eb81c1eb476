//! Buildings of one heap of triangles, where a file names none.
//!
//! Triangles that share corners are of one surface; a surface whose middle lies in the plan of a larger one (its convex
//! hull) is of the same building: what stands on a roof. Where hardly any triangles share corners, corners of equal place count
//! as shared, over edges of exactly two triangles: houses in a row touch in edges of four.

use rustc_hash::FxHashMap;

use edifice_shape::triangles::{TriangleMesh, convex_hull};

/// Surfaces of fewer triangles in the mean are no bodies: corners of equal place count as shared.
const BODY: usize = 10;
/// Corners nearer than this are at one place, in metres.
const PLACE: f64 = 1e-3;
/// A middle this far outside of a plan still is of it, in metres.
const NEAR: f64 = 0.01;
/// Side of the cells in which plans are looked up, in metres, and most cells of a plan; larger ones are looked up everywhere.
const CELL: f64 = 25.0;
const MOST_CELLS: f64 = 4096.0;

/// The building of each triangle, numbered by their first triangles.
pub(super) fn buildings(mesh: &TriangleMesh) -> Vec<usize> {
    let n = mesh.triangles.len();
    let mut sets = Sets::new(mesh.positions.len());
    for t in &mesh.triangles {
        sets.join(t[0] as usize, t[1] as usize);
        sets.join(t[0] as usize, t[2] as usize);
    }
    let mut labels: Vec<usize> = (mesh.triangles.iter())
        .map(|t| sets.root(t[0] as usize))
        .collect();
    if numbered(&mut labels) * BODY > n {
        labels = over_edges(mesh);
    }
    let count = numbered(&mut labels);
    let plans = plans(mesh, &labels, count);
    let mut joined = Sets::new(count);
    for (part, whole) in on_others(&plans) {
        joined.join(part, whole);
    }
    labels.iter_mut().for_each(|l| *l = joined.root(*l));
    numbered(&mut labels);
    labels
}

/// A surface for each triangle: joined over edges, by place, of exactly two triangles.
fn over_edges(mesh: &TriangleMesh) -> Vec<usize> {
    let mut known: FxHashMap<[i64; 3], u32> = FxHashMap::default();
    let mut place = |i: u32| {
        let key = mesh.positions[i as usize].map(|v| (v / PLACE).round() as i64);
        let next = known.len() as u32;
        *known.entry(key).or_insert(next)
    };
    let mut edges: FxHashMap<(u32, u32), Vec<usize>> = FxHashMap::default();
    for (i, t) in mesh.triangles.iter().enumerate() {
        let t = t.map(&mut place);
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            edges.entry((a.min(b), a.max(b))).or_default().push(i);
        }
    }
    let mut sets = Sets::new(mesh.triangles.len());
    for pair in edges.values() {
        if let [a, b] = pair[..] {
            sets.join(a, b);
        }
    }
    (0..mesh.triangles.len()).map(|i| sets.root(i)).collect()
}

/// The convex hull of a surface in plan, and its bounds.
struct PlanHull {
    hull: Vec<[f64; 2]>,
    middle: [f64; 2],
    low: [f64; 2],
    high: [f64; 2],
}

impl PlanHull {
    fn area(&self) -> f64 {
        let n = self.hull.len();
        let cross = |i: usize| {
            let (p, q) = (self.hull[i], self.hull[(i + 1) % n]);
            p[0] * q[1] - p[1] * q[0]
        };
        (0..n).map(cross).sum::<f64>() / 2.0
    }

    /// True if a point lies in the hull, which is counterclockwise, or near to it.
    fn has(&self, point: [f64; 2]) -> bool {
        let n = self.hull.len();
        (0..n).all(|i| {
            let (p, q) = (self.hull[i], self.hull[(i + 1) % n]);
            let d = [q[0] - p[0], q[1] - p[1]];
            let side = d[0] * (point[1] - p[1]) - d[1] * (point[0] - p[0]);
            side >= -NEAR * d[0].hypot(d[1])
        })
    }
}

fn plans(mesh: &TriangleMesh, labels: &[usize], count: usize) -> Vec<PlanHull> {
    let mut points: Vec<Vec<[f64; 2]>> = vec![Vec::new(); count];
    for (t, &l) in mesh.triangles.iter().zip(labels) {
        points[l].extend(t.iter().map(|&i| {
            let [x, y, _] = mesh.positions[i as usize];
            [x, y]
        }));
    }
    let plan = |points: Vec<[f64; 2]>| {
        let mut plan = PlanHull {
            hull: convex_hull(points),
            middle: [0.0; 2],
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        };
        for p in &plan.hull {
            plan.low = [0, 1].map(|k| plan.low[k].min(p[k]));
            plan.high = [0, 1].map(|k| plan.high[k].max(p[k]));
        }
        plan.middle = [0, 1].map(|k| (plan.low[k] + plan.high[k]) / 2.0);
        plan
    };
    points.into_iter().map(plan).collect()
}

/// Surfaces whose middle lies in the plan of a larger one, with the largest such.
fn on_others(plans: &[PlanHull]) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..plans.len()).collect();
    order.sort_by(|&a, &b| plans[b].area().total_cmp(&plans[a].area()).then(a.cmp(&b)));
    let cell = |v: f64| (v / CELL).floor() as i64;
    let mut cells: FxHashMap<[i64; 2], Vec<usize>> = FxHashMap::default();
    let mut everywhere: Vec<usize> = Vec::new();
    let mut out = Vec::new();
    for i in order {
        let own = &plans[i];
        let here = cells.get(&own.middle.map(cell)).into_iter().flatten();
        let mut found = everywhere.iter().chain(here);
        if let Some(&whole) = found.find(|&&j| plans[j].has(own.middle)) {
            out.push((i, whole));
            continue;
        }
        let [(x0, x1), (y0, y1)] = [0, 1].map(|k| {
            let reach = |v: f64, by: f64| v + by * NEAR;
            (reach(own.low[k], -1.0), reach(own.high[k], 1.0))
        });
        if (x1 - x0) / CELL * ((y1 - y0) / CELL) > MOST_CELLS
            || (x1 - x0).max(y1 - y0) > CELL * MOST_CELLS
        {
            everywhere.push(i);
            continue;
        }
        for x in cell(x0)..=cell(x1) {
            for y in cell(y0)..=cell(y1) {
                cells.entry([x, y]).or_default().push(i);
            }
        }
    }
    out
}

/// Numbers labels by their first occurrence; how many there are.
fn numbered(labels: &mut [usize]) -> usize {
    let mut numbers: FxHashMap<usize, usize> = FxHashMap::default();
    for l in labels {
        let next = numbers.len();
        *l = *numbers.entry(*l).or_insert(next);
    }
    numbers.len()
}

/// Disjoint sets, the root of each its least member.
struct Sets(Vec<usize>);

impl Sets {
    fn new(n: usize) -> Self {
        Self((0..n).collect())
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_of_a_plan_a_centimetre_outside_of_it_whatever_its_size() {
        for side in [0.5, 1.0, 20.0, 300.0] {
            let hull = vec![[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
            let plan = PlanHull {
                hull,
                middle: [side / 2.0; 2],
                low: [0.0; 2],
                high: [side; 2],
            };
            assert_eq!(plan.area(), side * side);
            for turn in 0..4 {
                let at = |beyond: f64| {
                    let (along, across) = (0.4 * side, -beyond);
                    [
                        [along, across],
                        [side - across, along],
                        [along, side - across],
                        [across, along],
                    ][turn]
                };
                assert!(plan.has(at(-0.1)) && plan.has(at(0.9 * NEAR)), "{side}");
                assert!(!plan.has(at(1.1 * NEAR)), "{side}");
            }
        }
    }
}
