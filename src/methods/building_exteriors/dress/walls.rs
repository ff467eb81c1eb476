//! The walls of a triangle mesh: connected upright faces in one plane.

use std::collections::HashMap;

use edifice_shape::triangles::{Corners, TriangleMesh, normal};
use edifice_shape::vec3::{dot, norm};

use crate::survey::is_wall;

/// Triangles are in one plane if their normals have at least this cosine and no corner is farther from it (m).
const COPLANAR: f64 = 0.9995;
const FLAT: f64 = 0.03;
/// Distance from a wall at which is looked for the building's own roof (m).
const BEHIND: f64 = 0.08;

/// Distance of the columns at which is looked for what stands before a wall (m), and most of them.
const COLUMN: f64 = 0.25;
const MOST_COLUMNS: f64 = 1e5;

/// A rectangle on a wall: along it, seen from outside to the right, then upwards, in metres.
pub(super) type Span = [[f64; 2]; 2];

/// A mesh whose corners are each stored once.
pub(super) struct Welded {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Welded {
    /// Joins corners with the same bits; triangles without area are left out.
    fn new(mesh: &TriangleMesh) -> Self {
        let mut known = HashMap::new();
        let mut positions = Vec::new();
        let mut index = |p: [f64; 3]| {
            // Minus zero is zero.
            let bits = p.map(|v| (v + 0.0).to_bits());
            *known.entry(bits).or_insert_with(|| {
                positions.push(p);
                positions.len() as u32 - 1
            })
        };
        let proper = |t: &Corners| norm(normal(t)) > 0.0;
        let triangles = mesh.corners().filter(proper).map(|t| t.map(&mut index));
        let triangles = triangles.collect();
        Self {
            positions,
            triangles,
        }
    }

    pub(super) fn corners(&self, triangle: usize) -> Corners {
        self.triangles[triangle].map(|v| self.positions[v as usize])
    }
}

/// An upright face of a building.
pub(super) struct WallFace {
    /// Unit vector outwards, in plan.
    pub(super) outward: [f64; 2],
    /// Distance of the plane from the origin along `outward` (m).
    pub(super) distance: f64,
    /// Its triangles.
    pub(super) triangles: Vec<usize>,
    /// The edges of its outline, the face to their left seen from outside.
    pub(super) outline: Vec<[u32; 2]>,
    /// The ends of the outline's edges on the wall, along it and upwards (m).
    edges: Vec<[[f64; 2]; 2]>,
    /// Extent along the wall and upwards (m).
    pub(super) bounds: Span,
    /// Square metres.
    pub(super) area: f64,
    /// Height of what stands before the wall at each of its columns (m); empty where nothing was looked for.
    pub(super) before: Vec<f64>,
}

/// A building's surface and its walls.
pub(super) struct Faces {
    pub(super) mesh: Welded,
    pub(super) walls: Vec<WallFace>,
    /// Height of the lowest corner (m).
    pub(super) ground: f64,
}

/// The walls of a mesh, in the order of their first triangles. Triangles whose winding is wrong are turned: `covers`
/// says whether a point lies below the building's own roof.
pub(super) fn faces(mesh: &TriangleMesh, covers: impl Fn([f64; 3]) -> bool) -> Faces {
    let mut mesh = Welded::new(mesh);
    let mut upright: Vec<Upright> = Vec::new();
    for k in 0..mesh.triangles.len() {
        let corners = mesh.corners(k);
        let n = normal(&corners);
        if !is_wall(n, norm(n)) {
            continue;
        }
        let level = n[0].hypot(n[1]);
        let mut outward = [n[0] / level, n[1] / level];
        let middle: [f64; 3] =
            std::array::from_fn(|i| corners.iter().map(|p| p[i]).sum::<f64>() / 3.0);
        let at = |by: f64| {
            [
                middle[0] + by * outward[0],
                middle[1] + by * outward[1],
                middle[2],
            ]
        };
        if covers(at(BEHIND)) && !covers(at(-BEHIND)) {
            mesh.triangles[k].swap(1, 2);
            outward = outward.map(|v| -v);
        }
        upright.push(Upright {
            triangle: k,
            outward,
            middle,
        });
    }
    let walls = connected(&mesh, &upright);
    let walls = walls
        .into_iter()
        .filter_map(|own| WallFace::new(&mesh, own))
        .collect();
    let ground = mesh.positions.iter().map(|p| p[2]);
    let ground = ground.fold(f64::INFINITY, f64::min);
    Faces {
        mesh,
        walls,
        ground,
    }
}

/// An upright triangle.
struct Upright {
    triangle: usize,
    /// Unit normal in plan.
    outward: [f64; 2],
    middle: [f64; 3],
}

impl Upright {
    /// True if the other one lies in the plane of this one.
    fn is_in_plane(&self, mesh: &Welded, other: &Self) -> bool {
        let [x, y] = self.outward;
        let off = |p: &[f64; 3]| x * (p[0] - self.middle[0]) + y * (p[1] - self.middle[1]);
        x * other.outward[0] + y * other.outward[1] > COPLANAR
            && mesh
                .corners(other.triangle)
                .iter()
                .all(|p| off(p).abs() < FLAT)
    }
}

/// Triangles that hang together over edges in the plane of the first, in the order of their first ones.
fn connected(mesh: &Welded, upright: &[Upright]) -> Vec<Vec<usize>> {
    let mut by_edge: HashMap<[u32; 2], usize> = HashMap::new();
    for (i, own) in upright.iter().enumerate() {
        let t = mesh.triangles[own.triangle];
        for e in 0..3 {
            by_edge.insert([t[e], t[(e + 1) % 3]], i);
        }
    }
    let mut is_taken = vec![false; upright.len()];
    let mut found = Vec::new();
    for (start, seed) in upright.iter().enumerate() {
        if std::mem::replace(&mut is_taken[start], true) {
            continue;
        }
        let mut queue = vec![start];
        let mut members = Vec::new();
        while let Some(i) = queue.pop() {
            let own = upright[i].triangle;
            members.push(own);
            let t = mesh.triangles[own];
            for e in 0..3 {
                let next = by_edge.get(&[t[(e + 1) % 3], t[e]]).copied();
                if let Some(next) = next.filter(|k| !is_taken[*k])
                    && seed.is_in_plane(mesh, &upright[next])
                {
                    is_taken[next] = true;
                    queue.push(next);
                }
            }
        }
        members.sort_unstable();
        found.push(members);
    }
    found
}

impl WallFace {
    /// The face of some triangles; `None` when their outline does not close.
    fn new(mesh: &Welded, triangles: Vec<usize>) -> Option<Self> {
        let mut sum = [0.0; 3];
        for &k in &triangles {
            let n = normal(&mesh.corners(k));
            (0..3).for_each(|i| sum[i] += n[i]);
        }
        let level = sum[0].hypot(sum[1]);
        let outward = [sum[0] / level, sum[1] / level];
        let mut edges = std::collections::HashSet::new();
        let all = || triangles.iter().map(|&k| mesh.triangles[k]);
        for t in all() {
            for e in 0..3 {
                if !edges.insert([t[e], t[(e + 1) % 3]]) {
                    return None;
                }
            }
        }
        let outline = all().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
        let outline: Vec<[u32; 2]> = outline
            .filter(|[v, w]| !edges.contains(&[*w, *v]))
            .collect();
        let mut face = Self {
            outward,
            distance: 0.0,
            area: level / 2.0,
            before: Vec::new(),
            triangles,
            outline,
            edges: Vec::new(),
            bounds: [[f64::INFINITY, f64::NEG_INFINITY]; 2],
        };
        let ends = face
            .outline
            .iter()
            .map(|e| e.map(|v| mesh.positions[v as usize]));
        let ends: Vec<[[f64; 3]; 2]> = ends.collect();
        for p in ends.iter().flatten() {
            face.distance += (outward[0] * p[0] + outward[1] * p[1]) / (2 * ends.len()) as f64;
            let flat = face.flat(*p);
            for (bound, v) in face.bounds.iter_mut().zip(flat) {
                *bound = [bound[0].min(v), bound[1].max(v)];
            }
        }
        face.edges = ends.iter().map(|e| e.map(|p| face.flat(p))).collect();
        face.distance.is_finite().then_some(face)
    }

    /// Unit vector to the right, seen from outside.
    pub(super) fn along(&self) -> [f64; 2] {
        [-self.outward[1], self.outward[0]]
    }

    /// A point on the wall: along it, and its height.
    pub(super) fn flat(&self, p: [f64; 3]) -> [f64; 2] {
        let [x, y] = self.along();
        [dot([x, y, 0.0], p), p[2]]
    }

    /// The point of the wall's plane moved inwards by `depth` (m).
    pub(super) fn place(&self, [u, z]: [f64; 2], depth: f64) -> [f64; 3] {
        let (along, d) = (self.along(), self.distance - depth);
        [
            along[0] * u + self.outward[0] * d,
            along[1] * u + self.outward[1] * d,
            z,
        ]
    }

    /// Places along the wall at which is looked for what stands before it (m).
    pub(super) fn columns(&self) -> impl Iterator<Item = f64> + use<> {
        let [start, end] = self.bounds[0];
        let count = ((end - start) / COLUMN).ceil().clamp(0.0, MOST_COLUMNS) as usize;
        (0..=count).map(move |k| start + k as f64 * COLUMN)
    }

    /// True if nothing stands before a rectangle on the wall.
    fn is_free(&self, [[u0, u1], [z0, _]]: Span) -> bool {
        let column = |u: f64| ((u - self.bounds[0][0]) / COLUMN).max(0.0);
        let first = column(u0).floor() as usize;
        let last = column(u1).ceil() as usize;
        let mut here = self.before.iter().take(last + 1).skip(first);
        here.all(|z| *z <= z0)
    }

    /// True if the rectangle lies inside the face, and nothing stands before it.
    pub(super) fn has_room(&self, rect: Span) -> bool {
        if !self.is_free(rect) {
            return false;
        }
        let [u, z] = rect.map(|[low, high]| (low + high) / 2.0);
        let mut odd = false;
        for &[a, b] in &self.edges {
            if touches(a, b, rect) {
                return false;
            }
            if (a[1] > z) != (b[1] > z) {
                odd ^= a[0] + (z - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > u;
            }
        }
        odd
    }
}

/// True if a line between two points has a point in common with a rectangle (Liang and Barsky 1984).
fn touches(a: [f64; 2], b: [f64; 2], rect: Span) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for i in 0..2 {
        let d = b[i] - a[i];
        let [low, high] = rect[i].map(|v| v - a[i]);
        if d == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
            continue;
        }
        let [t0, t1] = [low / d, high / d];
        from = from.max(t0.min(t1));
        to = to.min(t0.max(t1));
    }
    from <= to
}
