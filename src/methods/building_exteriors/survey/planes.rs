//! Roof planes: triangles that share an edge and a direction.

use std::collections::HashMap;

use super::surfaces::is_wall;
use edifice_shape::triangles::{TriangleMesh, normal};
use edifice_shape::vec3::norm;

/// Least cosine between the normals of one plane's triangles.
const COPLANAR: f64 = 0.995;

/// The plane of each triangle, and the lowest corner of each plane.
pub(super) struct Planes {
    /// Plane of each triangle of the mesh; walls have planes too, which nobody asks for.
    pub of: Vec<usize>,
    /// Height of the lowest corner of each plane.
    pub eave: Vec<f64>,
}

/// Joins the triangles of a welded mesh.
pub(super) fn planes(mesh: &TriangleMesh) -> Planes {
    let directions: Vec<[f64; 3]> = mesh
        .corners()
        .map(|t| {
            let n = normal(&t);
            let length = norm(n).max(f64::MIN_POSITIVE);
            // Winding is not to be relied on.
            let up = if n[2] < 0.0 { -1.0 } else { 1.0 };
            n.map(|v| up * v / length)
        })
        .collect();
    let mut edges: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
    for (i, t) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            edges.entry((a.min(b), a.max(b))).or_default().push(i);
        }
    }
    let mut parent: Vec<usize> = (0..mesh.triangles.len()).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for shared in edges.values() {
        for pair in shared.windows(2) {
            let (a, b) = (directions[pair[0]], directions[pair[1]]);
            let cosine: f64 = (0..3).map(|k| a[k] * b[k]).sum();
            if cosine > COPLANAR && !is_wall(a, 1.0) {
                let (p, q) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
                parent[p.max(q)] = p.min(q);
            }
        }
    }
    let of: Vec<usize> = (0..parent.len()).map(|i| root(&mut parent, i)).collect();
    let mut eave = vec![f64::INFINITY; of.len()];
    for (t, plane) in mesh.corners().zip(&of) {
        for p in t {
            eave[*plane] = eave[*plane].min(p[2]);
        }
    }
    Planes { of, eave }
}
