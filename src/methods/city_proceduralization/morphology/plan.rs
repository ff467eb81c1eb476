//! The plan of a building: its walls as segments, its size and direction.

use rustc_hash::FxHashSet;

use edifice_shape::triangles::{OrientedBox, TriangleMesh, convex_hull, normal, plan_area};

/// A wall leans by no more than this: the upright part of its unit normal.
const UPRIGHT: f64 = 0.05;

/// The point that stands for a cell, by its side: a little off the middle, so that walls on whole and half metres cover it once.
const MIDDLE: [f64; 2] = [0.5003, 0.5001];

pub(super) type Segment = [[f64; 2]; 2];

/// A building in the plan.
pub(super) struct Building {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
    pub(super) walls: Vec<Segment>,
    /// Direction of a side of the least rectangle around it, in degrees.
    pub(super) angle: f64,
    /// Smaller side, larger side, height.
    pub(super) sizes: [f64; 3],
    /// The triangles that face up.
    tops: Vec<[[f64; 2]; 3]>,
}

/// The plan of a mesh; `None` without triangles.
pub(super) fn building(mesh: &TriangleMesh) -> Option<Building> {
    let (low, high) = mesh.bounds()?;
    let frame = OrientedBox::around(mesh)?;
    let mut walls: Vec<Segment> = Vec::new();
    for t in mesh.corners() {
        let n = normal(&t);
        let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
        if length > 0.0 && n[2].abs() < UPRIGHT * length {
            let p = t.map(|p| [p[0], p[1]]);
            let edges = [[p[0], p[1]], [p[1], p[2]], [p[2], p[0]]];
            let longest = edges.into_iter().max_by(|a, b| long(a).total_cmp(&long(b)));
            walls.extend(longest.map(|[a, b]| if a <= b { [a, b] } else { [b, a] }));
        }
    }
    walls.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    walls.dedup();
    if walls.is_empty() {
        let hull = convex_hull(mesh.positions.iter().map(|p| [p[0], p[1]]).collect());
        walls = (0..hull.len())
            .map(|i| [hull[i], hull[(i + 1) % hull.len()]])
            .collect();
    }
    let [w, d, h] = frame.size;
    let [o, x] = [[0.0; 3], [1.0, 0.0, 0.0]].map(|p| frame.from_unit(p));
    let tops = mesh.corners().filter(|t| plan_area(t) > 0.0);
    Some(Building {
        low: [low[0], low[1]],
        high: [high[0], high[1]],
        angle: (x[1] - o[1]).atan2(x[0] - o[0]).to_degrees(),
        sizes: [w.min(d), w.max(d), h],
        tops: tops.map(|t| t.map(|p| [p[0], p[1]])).collect(),
        walls,
    })
}

impl Building {
    /// The middle of its rectangle along the axes.
    pub(super) fn middle(&self) -> [f64; 2] {
        [0, 1].map(|k| (self.low[k] + self.high[k]) / 2.0)
    }

    /// Distance of a point from that rectangle.
    pub(super) fn from(&self, p: [f64; 2]) -> f64 {
        let [x, y] = [0, 1].map(|k| (self.low[k] - p[k]).max(p[k] - self.high[k]).max(0.0));
        x.hypot(y)
    }

    /// The cells of a side whose points [`MIDDLE`] it covers.
    pub(super) fn cells(&self, side: f64) -> FxHashSet<[i64; 2]> {
        let mut out = FxHashSet::default();
        for t in &self.tops {
            let bound = |k: usize, worse: fn(f64, f64) -> f64| t.iter().map(|p| p[k]).reduce(worse);
            let range = |k: usize| {
                let (low, high) = (
                    bound(k, f64::min).unwrap_or(0.0),
                    bound(k, f64::max).unwrap_or(0.0),
                );
                (low / side - MIDDLE[k]).ceil() as i64..=(high / side - MIDDLE[k]).floor() as i64
            };
            for x in range(0) {
                for y in range(1) {
                    let p = [x as f64 + MIDDLE[0], y as f64 + MIDDLE[1]].map(|v| v * side);
                    let left = |a: [f64; 2], b: [f64; 2]| {
                        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0.0
                    };
                    if left(t[0], t[1]) && left(t[1], t[2]) && left(t[2], t[0]) {
                        out.insert([x, y]);
                    }
                }
            }
        }
        out
    }
}

fn long([a, b]: &Segment) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The least distance between segments of two sets; more than `most` if it is more.
pub(super) fn distance(first: &[Segment], second: &[Segment], most: f64) -> f64 {
    let mut least = f64::INFINITY;
    for a in first {
        for b in second {
            let apart = |k: usize| {
                let span = |s: &Segment| [s[0][k].min(s[1][k]), s[0][k].max(s[1][k])];
                let (p, q) = (span(a), span(b));
                (q[0] - p[1]).max(p[0] - q[1])
            };
            if apart(0).max(apart(1)) > least.min(most) {
                continue;
            }
            least = least.min(between(a, b));
        }
    }
    least
}

/// The distance between two segments: 0 where they cross.
fn between(a: &Segment, b: &Segment) -> f64 {
    let side = |s: &Segment, p: [f64; 2]| {
        (s[1][0] - s[0][0]) * (p[1] - s[0][1]) - (s[1][1] - s[0][1]) * (p[0] - s[0][0])
    };
    let apart = |s: &Segment, t: &Segment| side(s, t[0]) * side(s, t[1]) < 0.0;
    if apart(a, b) && apart(b, a) {
        return 0.0;
    }
    let ends = [(a[0], b), (a[1], b), (b[0], a), (b[1], a)];
    ends.iter()
        .map(|(p, s)| to_segment(*p, s))
        .fold(f64::INFINITY, f64::min)
}

fn to_segment(p: [f64; 2], [a, b]: &Segment) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let t = if square > 0.0 {
        (((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (p[0] - a[0] - t * along[0]).hypot(p[1] - a[1] - t * along[1])
}
