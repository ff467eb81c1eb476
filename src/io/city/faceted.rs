//! Meshes whose triangles have normals of their own, as lit walls and roofs need.

use rustc_hash::FxHashMap;

use edifice_shape::triangles::{TriangleMesh, normal};
use edifice_shape::vec3::norm;

/// Directions within so many steps of a unit are one.
const STEPS: f64 = 1000.0;

/// A mesh whose corners are shared only by triangles of one direction.
pub(super) struct Faceted {
    pub(super) mesh: TriangleMesh,
    /// The unit normal of each corner.
    pub(super) normals: Vec<[f64; 3]>,
}

impl Faceted {
    /// The triangles of a mesh, in order; those without area are left out.
    pub(super) fn new(mesh: &TriangleMesh) -> Self {
        let mut out = Self {
            mesh: TriangleMesh::default(),
            normals: Vec::new(),
        };
        let mut place = FxHashMap::default();
        for (t, corners) in mesh.triangles.iter().zip(mesh.corners()) {
            let Some(n) = unit(normal(&corners)) else {
                continue;
            };
            let direction = n.map(|v| (v * STEPS).round() as i64);
            let corner = |i: u32| {
                *place.entry((i, direction)).or_insert_with(|| {
                    out.mesh.positions.push(mesh.positions[i as usize]);
                    out.normals.push(n);
                    out.normals.len() as u32 - 1
                })
            };
            out.mesh.triangles.push(t.map(corner));
        }
        out
    }
}

/// The vector of length 1 in a direction, if it is one.
pub(super) fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = norm(v);
    (length > 0.0 && length.is_finite()).then(|| v.map(|v| v / length))
}
