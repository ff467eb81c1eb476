//! The parts of a mesh between horizontal planes.

use super::profile::extent;
use super::{Corners, TriangleMesh};

/// Corners closer to a plane than this lie on it, in metres.
const ON_PLANE: f64 = 1e-6;
/// Positions of a part closer than this are stored once, in metres.
const WELD: f64 = 1e-6;

/// Cuts a mesh at the increasing heights `cuts`: part `i` is what lies between `cuts[i - 1]` and
/// `cuts[i]`, the first and last part are unbounded below and above. Areas and, with the lids of
/// [`super::section_lid`], volumes add up to those of the mesh.
///
/// A horizontal triangle on a plane belongs to the part that it bounds: facing up to the part below,
/// facing down to the part above.
pub fn clip_to_slabs(mesh: &TriangleMesh, cuts: &[f64]) -> Vec<TriangleMesh> {
    let mut parts = vec![TriangleMesh::default(); cuts.len() + 1];
    for t in mesh.corners() {
        let (low, high) = extent(&t);
        // Slabs strictly reached: planes at or below the lowest corner are below the triangle.
        let first = cuts.partition_point(|&c| c <= low + ON_PLANE);
        let last = cuts.partition_point(|&c| c < high - ON_PLANE);
        if first > last {
            // Flat, on plane `last`.
            let up = super::mesh::plan_area(&t) > 0.0;
            parts[if up { last } else { first }].push(t);
        } else if first == last {
            parts[first].push(t);
        } else {
            let mut rest: Vec<[f64; 3]> = t.to_vec();
            for slab in first..last {
                let (below, above) = split(&rest, cuts[slab]);
                fan(&below, &mut parts[slab]);
                rest = above;
            }
            fan(&rest, &mut parts[last]);
        }
    }
    parts.iter().map(|p| p.welded(WELD)).collect()
}

/// The parts of a convex polygon below and above a plane.
fn split(polygon: &[[f64; 3]], z: f64) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let (mut below, mut above) = (Vec::new(), Vec::new());
    let side = |p: &[f64; 3]| match p[2] - z {
        d if d.abs() <= ON_PLANE => 0,
        d if d < 0.0 => -1,
        _ => 1,
    };
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (s, r) = (side(p), side(q));
        if s <= 0 {
            below.push(*p);
        }
        if s >= 0 {
            above.push(*p);
        }
        if s * r < 0 {
            let cut = crossing(*p, *q, z);
            below.push(cut);
            above.push(cut);
        }
    }
    (below, above)
}

/// The point where an edge meets a plane: the same bits for both directions of the edge.
pub(super) fn crossing(p: [f64; 3], q: [f64; 3], z: f64) -> [f64; 3] {
    let (a, b) = if p[2] < q[2] { (p, q) } else { (q, p) };
    let s = (z - a[2]) / (b[2] - a[2]);
    [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), z]
}

fn fan(polygon: &[[f64; 3]], part: &mut TriangleMesh) {
    for k in 2..polygon.len() {
        let t: Corners = [polygon[0], polygon[k - 1], polygon[k]];
        part.push(t);
    }
}
