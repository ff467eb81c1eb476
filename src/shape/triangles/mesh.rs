//! Triangle meshes.

use crate::vec3::{cross, norm, sub};

/// The corners of a triangle.
pub type Corners = [[f64; 3]; 3];

/// A triangle mesh: positions in metres, z up; triangles are counterclockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TriangleMesh {
    /// Corners.
    pub positions: Vec<[f64; 3]>,
    /// Three indices into `positions` each.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The corners of every triangle, in order.
    pub fn corners(&self) -> impl Iterator<Item = Corners> + '_ {
        let at = |i: u32| self.positions[i as usize];
        self.triangles.iter().map(move |t| t.map(at))
    }

    /// Appends a triangle with its own corners.
    pub fn push(&mut self, corners: Corners) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners);
        self.triangles.push([first, first + 1, first + 2]);
    }

    /// Appends another mesh.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        let shifted = other.triangles.iter().map(|t| t.map(|i| i + first));
        self.triangles.extend(shifted);
    }

    /// Smallest and largest coordinates over all positions; `None` without positions.
    pub fn bounds(&self) -> Option<([f64; 3], [f64; 3])> {
        let first = *self.positions.first()?;
        let (mut low, mut high) = (first, first);
        for p in &self.positions {
            for i in 0..3 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
            }
        }
        Some((low, high))
    }

    /// Signed volume between the mesh and the plane `z = floor`: positive for a mesh whose
    /// triangles face outwards, also when it has no bottom face.
    pub fn volume_above(&self, floor: f64) -> f64 {
        self.corners()
            .map(|t| plan_area(&t) * ((t[0][2] + t[1][2] + t[2][2]) / 3.0 - floor))
            .sum()
    }

    /// Total area of the triangles.
    pub fn area(&self) -> f64 {
        self.corners().map(|t| norm(normal(&t)) / 2.0).sum()
    }

    /// The same triangles facing the other way.
    pub fn flip(&mut self) {
        for t in &mut self.triangles {
            t.swap(1, 2);
        }
    }

    /// The same mesh with equal positions (on a grid of `step`) stored once, unused ones dropped and
    /// triangles that collapse left out.
    pub fn welded(&self, step: f64) -> Self {
        let mut known = rustc_hash::FxHashMap::default();
        let mut out = Self::default();
        for t in &self.triangles {
            let corners = t.map(|i| self.positions[i as usize]);
            let keys = corners.map(|p| p.map(|v| (v / step).round() as i64));
            if keys[0] == keys[1] || keys[1] == keys[2] || keys[2] == keys[0] {
                continue;
            }
            out.triangles.push(std::array::from_fn(|k| {
                *known.entry(keys[k]).or_insert_with(|| {
                    out.positions.push(corners[k]);
                    out.positions.len() as u32 - 1
                })
            }));
        }
        out
    }
}

/// Signed area of a triangle's plan: positive when it faces up.
pub fn plan_area(t: &Corners) -> f64 {
    let [a, b, c] = t;
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
}

/// Normal of a triangle by the right hand, twice its area long.
pub fn normal(t: &Corners) -> [f64; 3] {
    let [a, b, c] = t;
    cross(sub(*b, *a), sub(*c, *a))
}
