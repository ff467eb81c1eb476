//! Axes and grid lines from the walls of a building.

use super::heights::HeightMap;
use super::surfaces::is_wall;
use edifice_shape::triangles::{TriangleMesh, normal};
use edifice_shape::vec3::norm;

/// Least share of the wall area within [`SLACK`] of the axes.
pub(super) const RIGHT: f64 = 0.85;
/// Degrees.
const SLACK: f64 = 8.0;
/// Lines nearer than this are one (m), and least wall area of a line (square metres).
const SAME: f64 = 0.35;
const LEAST: f64 = 0.8;

/// Direction of the walls.
pub(super) struct Axes {
    /// Angle of the first axis in radians.
    pub angle: f64,
    /// Share of the wall area along either axis.
    pub share: f64,
}

/// The axes; `None` without walls.
pub(super) fn axes(mesh: &TriangleMesh) -> Option<Axes> {
    let mut walls: Vec<(f64, f64)> = Vec::new();
    for t in mesh.corners() {
        let n = normal(&t);
        let length = norm(n);
        if length > 0.0 && is_wall(n, length) {
            walls.push((n[1].atan2(n[0]), length / 2.0));
        }
    }
    let sum = |f: fn(f64) -> f64| walls.iter().map(|(a, w)| w * f(4.0 * a)).sum::<f64>();
    let angle = sum(f64::sin).atan2(sum(f64::cos)) / 4.0;
    let quarter = std::f64::consts::FRAC_PI_2;
    let off = |a: f64| {
        let r = (a - angle).rem_euclid(quarter);
        r.min(quarter - r)
    };
    let slack = SLACK.to_radians();
    let total: f64 = walls.iter().map(|w| w.1).sum();
    let right: f64 = walls
        .iter()
        .filter(|w| off(w.0) <= slack)
        .map(|w| w.1)
        .sum();
    (total > 0.0).then(|| Axes {
        angle,
        share: right / total,
    })
}

/// The mesh in its own axes, welded, its lowest corner at height 0, its longer extent along x. Corners are moved near the
/// origin first: coordinates of a country lose the millimetres.
pub(super) fn turned(mesh: &TriangleMesh, angle: f64) -> TriangleMesh {
    let (low, _) = mesh.bounds().unwrap_or_default();
    let (s, c) = (-angle).sin_cos();
    let turn = |p: &[f64; 3]| {
        let q = [0, 1, 2].map(|k| p[k] - low[k]);
        [c * q[0] - s * q[1], s * q[0] + c * q[1], q[2]]
    };
    let mut out = TriangleMesh {
        positions: mesh.positions.iter().map(turn).collect(),
        triangles: mesh.triangles.clone(),
    };
    let (low, high) = out.bounds().unwrap_or_default();
    if high[1] - low[1] > high[0] - low[0] {
        out.positions
            .iter_mut()
            .for_each(|p| *p = [p[1], -p[0], p[2]]);
    }
    out.welded(0.01)
}

/// Distinct wall coordinates along x and y, with the ends of the plan.
pub(super) fn lines(mesh: &TriangleMesh, map: &HeightMap) -> [Vec<f64>; 2] {
    let mut walls: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
    let least = SLACK.to_radians().cos();
    for t in mesh.corners() {
        let n = normal(&t);
        let length = norm(n);
        if length == 0.0 || !is_wall(n, length) {
            continue;
        }
        for axis in 0..2 {
            if n[axis].abs() > least * length {
                let at = (t[0][axis] + t[1][axis] + t[2][axis]) / 3.0;
                walls[axis].push((at, length / 2.0));
            }
        }
    }
    let bounds = map.bounds();
    [0, 1].map(|axis| clustered(&mut walls[axis], bounds[axis]))
}

/// Area-weighted means of coordinates nearer than [`SAME`]; the ends are those of the plan.
fn clustered(walls: &mut [(f64, f64)], ends: [f64; 2]) -> Vec<f64> {
    walls.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for (at, area) in walls.iter().copied() {
        match groups.last_mut() {
            // The mean of the group so far.
            Some((sum, weight)) if at - *sum / *weight < SAME => {
                *sum += at * area;
                *weight += area;
            }
            _ => groups.push((at * area, area)),
        }
    }
    let inner = groups.into_iter().filter(|g| g.1 >= LEAST);
    let mut lines: Vec<f64> = inner.map(|(sum, weight)| sum / weight).collect();
    for end in ends {
        if lines.iter().all(|l| (l - end).abs() >= SAME) {
            lines.push(end);
        }
    }
    lines.sort_by(f64::total_cmp);
    lines.retain(|l| *l > ends[0] - SAME && *l < ends[1] + SAME);
    lines
}
