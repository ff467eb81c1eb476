//! Meshes in a good order for codecs.

use super::super::faceted::Faceted;
use edifice_shape::triangles::TriangleMesh;

/// A mesh with its triangles in an order that is good for caches of corners, and its corners in the order of their first use.
#[derive(Default)]
pub(super) struct Shape {
    pub(super) mesh: TriangleMesh,
    /// The normal of each corner, z up; none where there are no normals.
    pub(super) normals: Vec<[f64; 3]>,
}

impl Shape {
    pub(super) fn new(mesh: &TriangleMesh, with_normals: bool) -> Self {
        let faceted = with_normals.then(|| Faceted::new(mesh));
        let (mesh, normals) = match &faceted {
            Some(f) => (&f.mesh, f.normals.as_slice()),
            None => (mesh, [].as_slice()),
        };
        let indices: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
        let indices = meshopt::optimize_vertex_cache(&indices, mesh.positions.len());
        let mut place = vec![u32::MAX; mesh.positions.len()];
        let mut out = Self::default();
        let mut corner = |i: u32| {
            let own = &mut place[i as usize];
            if *own == u32::MAX {
                *own = out.mesh.positions.len() as u32;
                out.mesh.positions.push(mesh.positions[i as usize]);
                out.normals.extend(normals.get(i as usize));
            }
            *own
        };
        let triangles = indices.chunks_exact(3);
        out.mesh.triangles = triangles
            .map(|t| [corner(t[0]), corner(t[1]), corner(t[2])])
            .collect();
        out
    }
}
