//! Horizontal sections as triangles: what closes a part that was cut off.

use rustc_hash::FxHashMap;

use super::TriangleMesh;
use super::clip::crossing;
use super::triangulate::{nest, ring_area, triangles};

/// Rings of less than this area are left out, in square metres.
const LEAST_AREA: f64 = 1e-4;

/// The section of a welded mesh just above the height `z`, as triangles facing up.
///
/// The crossings of mesh edges with the plane are chained into rings by the edges they lie on, so that
/// no distance decides. Corners on the plane count as below it. Where the mesh is open, a chain is
/// closed by a straight line.
pub fn section_lid(mesh: &TriangleMesh, z: f64) -> TriangleMesh {
    let rings: Vec<Vec<[f64; 2]>> = rings(mesh, z)
        .into_iter()
        .filter(|ring| ring.len() > 2 && ring_area(ring).abs() > LEAST_AREA)
        .collect();
    let mut lid = TriangleMesh::default();
    for polygon in nest(&rings) {
        let parts: Vec<&[[f64; 2]]> = polygon.iter().map(|&i| rings[i].as_slice()).collect();
        for t in triangles(&parts) {
            let corners = t.map(|(r, k)| [parts[r][k][0], parts[r][k][1], z]);
            let up = super::mesh::plan_area(&corners);
            match up > 0.0 {
                true => lid.push(corners),
                false => lid.push([corners[0], corners[2], corners[1]]),
            }
        }
    }
    lid.welded(1e-6)
}

/// The rings of the section, material to the left.
fn rings(mesh: &TriangleMesh, z: f64) -> Vec<Vec<[f64; 2]>> {
    type Edge = (u32, u32);
    let mut next: FxHashMap<Edge, Vec<Edge>> = FxHashMap::default();
    let mut ends: FxHashMap<Edge, usize> = FxHashMap::default();
    let mut order: Vec<Edge> = Vec::new();
    for t in &mesh.triangles {
        let above = t.map(|i| mesh.positions[i as usize][2] > z);
        if above[0] == above[1] && above[1] == above[2] {
            continue;
        }
        let (mut from, mut to) = ((0, 0), (0, 0));
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            let edge = (a.min(b), a.max(b));
            match (above[k], above[(k + 1) % 3]) {
                // Seen from outside, the edge that leads down is on the left.
                (true, false) => from = edge,
                (false, true) => to = edge,
                _ => {}
            }
        }
        next.entry(from).or_default().push(to);
        *ends.entry(to).or_default() += 1;
        order.push(from);
    }
    // Chains of open meshes begin where nothing ends; take those first, so that they stay whole.
    let is_end = |edge: &Edge| ends.contains_key(edge);
    let (closed, open): (Vec<Edge>, Vec<Edge>) = order.into_iter().partition(is_end);
    let mut rings = Vec::new();
    for start in open.into_iter().chain(closed) {
        let mut ring = Vec::new();
        let mut at = start;
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            ring.push(point(mesh, at, z));
            at = to;
            if at == start {
                break;
            }
        }
        if !ring.is_empty() {
            if at != start {
                ring.push(point(mesh, at, z));
            }
            rings.push(ring);
        }
    }
    rings
}

fn point(mesh: &TriangleMesh, edge: (u32, u32), z: f64) -> [f64; 2] {
    let [p, q] = [edge.0, edge.1].map(|i| mesh.positions[i as usize]);
    let cut = crossing(p, q, z);
    [cut[0], cut[1]]
}
