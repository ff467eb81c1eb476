//! The height of a building over its plan, on a raster.

use super::planes::Planes;
use super::surfaces::{ground, is_wall};
use edifice_shape::triangles::{Corners, TriangleMesh, normal};
use edifice_shape::vec3::norm;

/// Largest side of a sample (m).
const STEP: f64 = 0.2;
/// Most samples of a raster.
const MOST: f64 = 4e5;
/// No plane.
const NONE: usize = usize::MAX;
/// A smaller share of the plan may lie apart.
const APART: f64 = 0.03;

/// Heights of the highest surface over the middle of each square of the plan.
pub(super) struct HeightMap {
    /// Left front corner.
    corner: [f64; 2],
    /// Sides of a sample along x and y: they divide the extent, so that no sample lies on the outline of a rectangular
    /// plan, where it would count twice as much as it should and rounding would decide what it sees.
    step: [f64; 2],
    /// Samples along x and y.
    size: [usize; 2],
    /// Height of each, 0 outside of the plan.
    height: Vec<f64>,
    /// Plane that is seen.
    plane: Vec<usize>,
    inside: Vec<bool>,
}

/// A sample of the plan.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    pub x: f64,
    pub y: f64,
    pub height: f64,
    pub plane: usize,
}

impl HeightMap {
    /// Rasters a mesh in its own axes; the plan is that of the bottom faces, else of everything. `None` where nothing
    /// covers a sample or the raster would be huge.
    pub(super) fn new(mesh: &TriangleMesh, planes: &Planes) -> Option<Self> {
        let (low, high) = mesh.bounds()?;
        let extent = [0, 1].map(|k| (high[k] - low[k]) / STEP);
        if (extent[0] * extent[1]).is_nan() || extent[0] * extent[1] > MOST {
            return None;
        }
        let size = extent.map(|n| (n - 1e-6).ceil().max(1.0) as usize);
        let count = size[0] * size[1];
        let mut map = Self {
            corner: [low[0], low[1]],
            step: [0, 1].map(|k| (high[k] - low[k]) / size[k] as f64),
            size,
            height: vec![0.0; count],
            plane: vec![NONE; count],
            inside: vec![false; count],
        };
        let has_ground = ground(mesh).next().is_some();
        for (t, plane) in mesh.corners().zip(&planes.of) {
            let n = normal(&t);
            let length = norm(n);
            if length == 0.0 || is_wall(n, length) {
                continue;
            }
            map.covered(&t, |map, k, z| {
                if z > map.height[k] || map.plane[k] == NONE {
                    (map.height[k], map.plane[k]) = (z, *plane);
                }
                map.inside[k] |= !has_ground;
            });
        }
        for t in ground(mesh) {
            map.covered(&t, |map, k, _| map.inside[k] = true);
        }
        for k in 0..count {
            map.inside[k] &= map.plane[k] != NONE;
        }
        map.inside.contains(&true).then_some(map)
    }

    /// Calls `f` with each sample that a triangle covers and its height there.
    fn covered(&mut self, t: &Corners, mut f: impl FnMut(&mut Self, usize, f64)) {
        let [a, b, c] = t;
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if twice == 0.0 {
            return;
        }
        let range = |k: usize| {
            let low = a[k].min(b[k]).min(c[k]);
            let high = a[k].max(b[k]).max(c[k]);
            let first = ((low - self.corner[k]) / self.step[k] - 0.5)
                .ceil()
                .max(0.0) as usize;
            let last = ((high - self.corner[k]) / self.step[k] - 0.5)
                .floor()
                .max(-1.0);
            first..((last + 1.0) as usize).min(self.size[k])
        };
        let (xs, ys) = (range(0), range(1));
        for i in xs {
            for j in ys.clone() {
                let [x, y] = self.place(i, j);
                let u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / twice;
                let v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / twice;
                if u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9 {
                    let z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]);
                    f(self, i * self.size[1] + j, z);
                }
            }
        }
    }

    fn place(&self, i: usize, j: usize) -> [f64; 2] {
        [
            self.corner[0] + (i as f64 + 0.5) * self.step[0],
            self.corner[1] + (j as f64 + 0.5) * self.step[1],
        ]
    }

    /// Samples of the plan.
    pub(super) fn samples(&self) -> impl Iterator<Item = Sample> + '_ {
        (0..self.inside.len()).filter(|&k| self.inside[k]).map(|k| {
            let [x, y] = self.place(k / self.size[1], k % self.size[1]);
            Sample {
                x,
                y,
                height: self.height[k],
                plane: self.plane[k],
            }
        })
    }

    /// Area of one sample.
    pub(super) fn cell(&self) -> f64 {
        self.step[0] * self.step[1]
    }

    /// Area of the plan.
    pub(super) fn area(&self) -> f64 {
        self.samples().count() as f64 * self.cell()
    }

    /// Ends of the plan along x and y.
    pub(super) fn bounds(&self) -> [[f64; 2]; 2] {
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for s in self.samples() {
            for (axis, v) in [s.x, s.y].into_iter().enumerate() {
                bounds[axis][0] = bounds[axis][0].min(v - self.step[axis] / 2.0);
                bounds[axis][1] = bounds[axis][1].max(v + self.step[axis] / 2.0);
            }
        }
        bounds
    }

    /// Median height.
    pub(super) fn median(&self) -> f64 {
        let mut heights: Vec<f64> = self.samples().map(|s| s.height).collect();
        heights.sort_by(f64::total_cmp);
        heights.get(heights.len() / 2).copied().unwrap_or(0.0)
    }

    /// Share of the plan below planes of less than 10 degrees.
    pub(super) fn flat_share(&self) -> f64 {
        let (mut flat, mut all) = (0.0, 0.0_f64);
        let [n, m] = self.size;
        let most = 10.0_f64.to_radians().tan() * self.step[0].min(self.step[1]);
        for i in 1..n.saturating_sub(1) {
            for j in 1..m.saturating_sub(1) {
                let k = i * m + j;
                let around = [k - m, k + m, k - 1, k + 1];
                let same = |o: usize| self.inside[o] && self.plane[o] == self.plane[k];
                if !self.inside[k] || !around.iter().all(|&o| same(o)) {
                    continue;
                }
                all += 1.0;
                let rise = around
                    .iter()
                    .map(|&o| (self.height[o] - self.height[k]).abs());
                if rise.fold(0.0, f64::max) < most {
                    flat += 1.0;
                }
            }
        }
        flat / all.max(1.0)
    }

    /// True if the plan is in one piece without courtyards, but for crumbs, which are dropped.
    pub(super) fn is_whole(&mut self) -> bool {
        let parts = self.components(true);
        let total: usize = parts.iter().map(Vec::len).sum();
        let Some(largest) = (0..parts.len()).max_by_key(|&i| parts[i].len()) else {
            return false;
        };
        let apart = (total - parts[largest].len()) as f64;
        for (i, part) in parts.iter().enumerate() {
            if i != largest {
                part.iter().for_each(|&k| self.inside[k] = false);
            }
        }
        let holes = self.components(false);
        let [n, m] = self.size;
        let is_outer = |part: &&Vec<usize>| {
            part.iter().any(|&k| {
                let (i, j) = (k / m, k % m);
                i == 0 || j == 0 || i == n - 1 || j == m - 1
            })
        };
        let shut: usize = holes.iter().filter(|p| !is_outer(p)).map(Vec::len).sum();
        apart <= APART * total as f64 && shut as f64 <= APART * total as f64
    }

    /// Connected samples that are inside or not.
    fn components(&self, inside: bool) -> Vec<Vec<usize>> {
        let [n, m] = self.size;
        let mut seen = vec![false; n * m];
        let mut parts = Vec::new();
        for start in 0..n * m {
            if seen[start] || self.inside[start] != inside {
                continue;
            }
            seen[start] = true;
            let (mut part, mut next) = (vec![start], 0);
            while next < part.len() {
                let (i, j) = (part[next] / m, part[next] % m);
                next += 1;
                let mut visit = |k: usize| {
                    if !seen[k] && self.inside[k] == inside {
                        seen[k] = true;
                        part.push(k);
                    }
                };
                if i > 0 {
                    visit((i - 1) * m + j);
                }
                if i + 1 < n {
                    visit((i + 1) * m + j);
                }
                if j > 0 {
                    visit(i * m + j - 1);
                }
                if j + 1 < m {
                    visit(i * m + j + 1);
                }
            }
            parts.push(part);
        }
        parts
    }
}
