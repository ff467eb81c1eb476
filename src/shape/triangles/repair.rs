//! The faults of a mesh, and the repair that measuring needs: duplicated and degenerate triangles are dropped, a mesh
//! that is inside out is turned.

use rustc_hash::FxHashMap;

use super::TriangleMesh;
use super::mesh::normal;
use crate::vec3::norm;

/// Positions closer than this are the same, in metres.
const WELD: f64 = 1e-4;
/// Triangles of less than this area are degenerate, in square metres.
const LEAST_AREA: f64 = 1e-9;

/// The faults of a mesh; all zero for a sound one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MeshFaults {
    /// Edges of one triangle only.
    pub open_edges: usize,
    /// Edges of three or more triangles.
    pub non_manifold_edges: usize,
    /// Triangles without area.
    pub degenerate: usize,
    /// Triangles that occur more than once.
    pub duplicated: usize,
    /// True if the triangles faced inwards.
    pub inverted: bool,
}

impl MeshFaults {
    /// True if there is any fault.
    pub fn any(&self) -> bool {
        *self != Self::default()
    }
}

/// Welds a mesh, drops degenerate and duplicated triangles, and turns it when its volume above its own
/// lowest point is negative. Open and non-manifold edges are counted and left as they are.
pub fn repair(mesh: &TriangleMesh) -> (TriangleMesh, MeshFaults) {
    let mut faults = MeshFaults::default();
    let mut welded = mesh.welded(WELD);
    faults.degenerate = mesh.triangles.len() - welded.triangles.len();
    let mut seen = rustc_hash::FxHashSet::default();
    let positions = &welded.positions;
    welded.triangles.retain(|t| {
        let corners = t.map(|i| positions[i as usize]);
        if norm(normal(&corners)) / 2.0 < LEAST_AREA {
            faults.degenerate += 1;
            return false;
        }
        // The same corners facing the other way are another triangle: a thin sheet.
        let first = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
        let new = seen.insert([t[first], t[(first + 1) % 3], t[(first + 2) % 3]]);
        faults.duplicated += usize::from(!new);
        new
    });
    if let Some((low, _)) = welded.bounds()
        && welded.volume_above(low[2]) < 0.0
    {
        faults.inverted = true;
        welded.flip();
    }
    let mut edges: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    for t in &welded.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry((a.min(b), a.max(b))).or_default() += 1;
        }
    }
    faults.open_edges = edges.values().filter(|&&n| n == 1).count();
    faults.non_manifold_edges = edges.values().filter(|&&n| n > 2).count();
    (welded, faults)
}
