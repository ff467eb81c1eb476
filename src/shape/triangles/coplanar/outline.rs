//! Outlines of plane regions as rings of corners, and their triangles.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::triangles::TriangleMesh;
use crate::triangles::mesh::normal;
use crate::triangles::triangulate::{nest, ring_area, triangles};
use crate::vec3::{cross, dot, norm};

/// The outline of a region: rings of corners, the region on their left, in a plane.
pub(super) struct Outline<'a> {
    mesh: &'a TriangleMesh,
    /// Axes in the plane, right-handed with the normal.
    axes: [[f64; 3]; 2],
    rings: Vec<Vec<u32>>,
    area: f64,
}

impl<'a> Outline<'a> {
    /// The outline of the triangles `members` with the normal `n`; `None` where it is not made of rings.
    pub(super) fn of(mesh: &'a TriangleMesh, members: &[usize], n: [f64; 3]) -> Option<Self> {
        let own = || members.iter().map(|&m| &mesh.triangles[m]);
        let inner: FxHashSet<(u32, u32)> = own().flat_map(edges).collect();
        let mut boundary: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
        let mut order = Vec::new();
        for (a, b) in own().flat_map(edges) {
            if !inner.contains(&(b, a)) {
                boundary.entry(a).or_default().push(b);
                order.push(a);
            }
        }
        let seed = if n[2].abs() < 0.9 {
            [0.0, 0.0, 1.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        let u = cross(seed, n);
        let u = u.map(|v| v / norm(u));
        let positions = &mesh.positions;
        let area = |t: &[u32; 3]| norm(normal(&t.map(|i| positions[i as usize]))) / 2.0;
        let mut outline = Self {
            mesh,
            axes: [u, cross(n, u)],
            rings: Vec::new(),
            area: own().map(area).sum(),
        };
        for start in order {
            let Some(mut to) = boundary.get_mut(&start).and_then(Vec::pop) else {
                continue;
            };
            let mut ring = vec![start];
            while to != start {
                let from = ring[ring.len() - 1];
                let ends = boundary.get_mut(&to)?;
                let next = outline.nearest_turn(from, to, ends)?;
                ring.push(to);
                to = ends.swap_remove(next);
            }
            outline.rings.push(ring);
        }
        Some(outline)
    }

    /// A corner in the plane.
    fn flat(&self, i: u32) -> [f64; 2] {
        self.axes
            .map(|axis| dot(self.mesh.positions[i as usize], axis))
    }

    /// Which of the edges from `at` to `ends` is met first, clockwise from the one that leads back to `from`: it bounds the same part
    /// of the region, which lies on the left of both, where the outline passes a corner more than once.
    fn nearest_turn(&self, from: u32, at: u32, ends: &[u32]) -> Option<usize> {
        let origin = self.flat(at);
        let away = |i: u32| {
            let p = self.flat(i);
            [p[0] - origin[0], p[1] - origin[1]]
        };
        let back = away(from);
        let clockwise = |&end: &u32| {
            let d = away(end);
            let sin = d[0] * back[1] - d[1] * back[0];
            let cos = d[0] * back[0] + d[1] * back[1];
            match sin.atan2(cos) {
                angle if angle > 0.0 => angle,
                angle => angle + std::f64::consts::TAU,
            }
        };
        let turns: Vec<f64> = ends.iter().map(clockwise).collect();
        (0..ends.len()).min_by(|&a, &b| turns[a].total_cmp(&turns[b]))
    }

    /// The rings without corners that lie within `tolerance` of the line between their neighbours.
    pub(super) fn straightened(&self, tolerance: f64) -> Vec<Vec<u32>> {
        let straight = |ring: &Vec<u32>| {
            let n = ring.len();
            let mut kept: Vec<u32> = Vec::with_capacity(n);
            for k in 0..n {
                let before = kept.last().copied().unwrap_or(ring[n - 1]);
                let [p, q, r] = [before, ring[k], ring[(k + 1) % n]].map(|i| self.flat(i));
                let d = [r[0] - p[0], r[1] - p[1]];
                let length = d[0].hypot(d[1]);
                let e = [q[0] - p[0], q[1] - p[1]];
                let off = (d[0] * e[1] - d[1] * e[0]).abs();
                let along = (d[0] * e[0] + d[1] * e[1]) / (length * length).max(1e-12);
                if off > tolerance * length || !(0.0..=1.0).contains(&along) {
                    kept.push(ring[k]);
                }
            }
            kept
        };
        self.rings.iter().map(straight).collect()
    }

    /// The rings with those corners that stay.
    pub(super) fn with_corners(&self, stays: &[bool]) -> Vec<Vec<u32>> {
        let kept = |ring: &Vec<u32>| {
            let corners = ring.iter().copied();
            corners.filter(|&i| stays[i as usize]).collect()
        };
        self.rings.iter().map(kept).collect()
    }

    /// The triangles of these rings, in which each of their corners is one of a triangle; `None` when they have not the region's area.
    pub(super) fn triangulated(&self, rings: &[Vec<u32>], tolerance: f64) -> Option<Vec<[u32; 3]>> {
        let rings: Vec<&Vec<u32>> = rings.iter().filter(|r| r.len() > 2).collect();
        let flat: Vec<Vec<[f64; 2]>> = rings
            .iter()
            .map(|r| r.iter().map(|&i| self.flat(i)).collect())
            .collect();
        let area: f64 = flat.iter().map(|r| ring_area(r)).sum();
        let mut found = Vec::new();
        let mut made = 0.0;
        for polygon in nest(&flat) {
            let parts: Vec<&[[f64; 2]]> = polygon.iter().map(|&i| flat[i].as_slice()).collect();
            let mut own = Vec::new();
            for t in triangles(&parts) {
                let a = ring_area(&t.map(|(r, k)| parts[r][k]));
                made += a.abs();
                own.push(if a >= 0.0 { t } else { [t[0], t[2], t[1]] });
            }
            let corners: Vec<&[u32]> = polygon.iter().map(|&i| rings[i].as_slice()).collect();
            found.extend(with_all_corners(own, &corners));
        }
        let same = |a: f64| (a - self.area).abs() <= 1e-3 * self.area + tolerance;
        (same(area) && same(made)).then_some(found)
    }
}

/// The directed edges of a triangle.
pub(super) fn edges(t: &[u32; 3]) -> [(u32, u32); 3] {
    [0, 1, 2].map(|k| (t[k], t[(k + 1) % 3]))
}

/// A corner of a polygon: its ring, and its place in it.
type Corner = (usize, usize);

/// Triangles of the polygon with these rings, those corners put in that lie in the middle of a side: the triangulation leaves them out.
fn with_all_corners(triangles: Vec<[Corner; 3]>, rings: &[&[u32]]) -> Vec<[u32; 3]> {
    let used: FxHashSet<Corner> = triangles.iter().flatten().copied().collect();
    // The corners of the ring between two of a triangle's, if none of them is used.
    let between = |(ring, from): Corner, (other, to): Corner| -> Vec<u32> {
        let n = rings[ring].len();
        let mut left_out = Vec::new();
        let mut k = (from + 1) % n;
        while ring == other && k != to {
            if used.contains(&(ring, k)) || k == from {
                return Vec::new();
            }
            left_out.push(rings[ring][k]);
            k = (k + 1) % n;
        }
        left_out
    };
    let mut out = Vec::new();
    for t in triangles {
        let sides = [0, 1, 2].map(|k| between(t[k], t[(k + 1) % 3]));
        split(t.map(|(r, k)| rings[r][k]), sides, &mut out);
    }
    out
}

/// A triangle with corners in the middle of its sides, as triangles.
fn split(t: [u32; 3], sides: [Vec<u32>; 3], out: &mut Vec<[u32; 3]>) {
    let Some(k) = (0..3).find(|&k| !sides[k].is_empty()) else {
        out.push(t);
        return;
    };
    // From the corner opposite to the side to all corners on it; the other sides belong to the first and last triangle.
    let [a, b, c] = [0, 1, 2].map(|i| t[(k + i) % 3]);
    let [mut middle, after, before] = [0, 1, 2].map(|i| sides[(k + i) % 3].clone());
    middle.insert(0, a);
    middle.push(b);
    let last = middle.len() - 2;
    for (i, pair) in middle.windows(2).enumerate() {
        let after = if i == last { after.clone() } else { Vec::new() };
        let before = if i == 0 { before.clone() } else { Vec::new() };
        split([pair[0], pair[1], c], [Vec::new(), after, before], out);
    }
}
