//! The smallest rectangle around a plan, extruded.

use std::f64::consts::PI;

use super::TriangleMesh;

/// Least extent of a side, so that the unit box maps back, in metres.
const LEAST: f64 = 1e-3;

/// A box on a horizontal base, turned about the vertical.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedBox {
    /// Middle of the base.
    pub base: [f64; 3],
    /// Width, depth and height; the width is not less than the depth.
    pub size: [f64; 3],
    /// Angle from the x axis to the width, in radians, from 0 to π.
    pub angle: f64,
}

impl OrientedBox {
    /// The box of least base area around a mesh; `None` without positions.
    pub fn around(mesh: &TriangleMesh) -> Option<Self> {
        let (low, high) = mesh.bounds()?;
        let plan: Vec<[f64; 2]> = mesh.positions.iter().map(|p| [p[0], p[1]]).collect();
        let hull = convex_hull(plan);
        let mut best: Option<(f64, Self)> = None;
        for i in 0..hull.len().max(1) {
            let (p, q) = (hull[i], hull[(i + 1) % hull.len()]);
            // One side of the smallest rectangle lies along an edge of the hull (Freeman, Shapira 1975).
            let direction = (q[1] - p[1]).atan2(q[0] - p[0]);
            let (sin, cos) = direction.sin_cos();
            let (mut l, mut h) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
            for r in &hull {
                let local = [r[0] * cos + r[1] * sin, r[1] * cos - r[0] * sin];
                for k in 0..2 {
                    l[k] = l[k].min(local[k]);
                    h[k] = h[k].max(local[k]);
                }
            }
            let side = [(h[0] - l[0]).max(LEAST), (h[1] - l[1]).max(LEAST)];
            let middle = [(l[0] + h[0]) / 2.0, (l[1] + h[1]) / 2.0];
            let long = side[0] >= side[1];
            let angle = (if long {
                direction
            } else {
                direction + PI / 2.0
            })
            .rem_euclid(PI);
            // Just below π is a rounded 0.
            let angle = if PI - angle < 1e-9 { 0.0 } else { angle };
            let rect = Self {
                base: [
                    middle[0] * cos - middle[1] * sin,
                    middle[0] * sin + middle[1] * cos,
                    low[2],
                ],
                size: [
                    side[0].max(side[1]),
                    side[0].min(side[1]),
                    (high[2] - low[2]).max(LEAST),
                ],
                angle,
            };
            let area = side[0] * side[1];
            // Rectangles of equal area: the smallest angle, so that the order of corners is no matter.
            let better = |(a, b): &(f64, Self)| {
                area < a * (1.0 - 1e-6) || (area < a * (1.0 + 1e-6) && angle < b.angle)
            };
            if best.as_ref().is_none_or(better) {
                best = Some((area, rect));
            }
        }
        best.map(|(_, rect)| rect)
    }

    /// Volume.
    pub fn volume(&self) -> f64 {
        self.size[0] * self.size[1] * self.size[2]
    }

    /// Coordinates in the box: x and y from -1/2 to 1/2, z from 0 to 1.
    pub fn to_unit(&self, p: [f64; 3]) -> [f64; 3] {
        let (sin, cos) = self.angle.sin_cos();
        let [x, y, z] = [0, 1, 2].map(|i| p[i] - self.base[i]);
        [
            (x * cos + y * sin) / self.size[0],
            (y * cos - x * sin) / self.size[1],
            z / self.size[2],
        ]
    }

    /// The inverse of [`OrientedBox::to_unit`].
    pub fn from_unit(&self, p: [f64; 3]) -> [f64; 3] {
        let (sin, cos) = self.angle.sin_cos();
        let [x, y, z] = [0, 1, 2].map(|i| p[i] * self.size[i]);
        [
            self.base[0] + x * cos - y * sin,
            self.base[1] + x * sin + y * cos,
            self.base[2] + z,
        ]
    }

    /// The middle of the box.
    pub fn middle(&self) -> [f64; 3] {
        let [x, y, z] = self.base;
        [x, y, z + self.size[2] / 2.0]
    }
}

/// Convex hull, counterclockwise, without collinear corners (Andrew 1979).
pub fn convex_hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}
