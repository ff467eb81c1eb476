//! Meshes without gaps: what is combinatorially open, though its edges touch, is closed.
//!
//! A directed edge (a, b) of a triangle is open where no triangle has (b, a). Two kinds of open edges are mended:
//! edges that other corners lie on (T-junctions), by splitting their triangles there, and rings of open edges, by the
//! triangles of the polygon that they go round.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::mesh::{cross, dot, norm, normal, sub};
use super::{TriangleMesh, polygon_triangles};

/// Rounds of splitting: a triangle is split along one of its edges in each.
const ROUNDS: usize = 8;
/// Meshes with more corners at open edges than this are left as they are: they are no surfaces with gaps.
const MOST_CORNERS: usize = 2048;

/// The mesh with triangles split where corners lie within `tolerance` of an open edge, and without triangles that are lower
/// than `tolerance`, whose neighbours meet instead. Complexity: triangles with open edges times corners at open edges.
pub fn stitched(mesh: &TriangleMesh, tolerance: f64) -> TriangleMesh {
    let mut out = mesh.clone();
    let positions = &out.positions;
    out.triangles.retain(|t| {
        let corners = t.map(|i| positions[i as usize]);
        let sides = [0, 1, 2].map(|k| norm(sub(corners[(k + 1) % 3], corners[k])));
        let longest = sides.into_iter().fold(0.0, f64::max);
        norm(normal(&corners)) > tolerance * longest
    });
    for _ in 0..ROUNDS {
        let open = open_edges(&out.triangles);
        let mut corners: Vec<u32> = open.keys().flat_map(|&(a, b)| [a, b]).collect();
        corners.sort_unstable();
        corners.dedup();
        if corners.is_empty() || corners.len() > MOST_CORNERS {
            break;
        }
        let mut next = Vec::with_capacity(out.triangles.len());
        let mut changed = false;
        for &t in &out.triangles {
            let split = (0..3).find_map(|k| {
                let edge = (t[k], t[(k + 1) % 3]);
                let on = open
                    .contains_key(&edge)
                    .then(|| between(&out.positions, edge, &corners, tolerance))?;
                (!on.is_empty()).then_some((k, on))
            });
            let Some((k, on)) = split else {
                next.push(t);
                continue;
            };
            changed = true;
            let (mut before, end, apex) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            for corner in on.into_iter().chain([end]) {
                // The third corner itself may lie on the edge.
                if before != apex && corner != apex {
                    next.push([before, corner, apex]);
                }
                before = corner;
            }
        }
        out.triangles = next;
        if !changed {
            break;
        }
    }
    out
}

/// The mesh with the triangles of the polygons that its open edges go round, then stitched with `tolerance`. Edges that are part
/// of no ring stay open.
pub fn filled(mesh: &TriangleMesh, tolerance: f64) -> TriangleMesh {
    let open = open_edges(&mesh.triangles);
    if open.is_empty() || open.len() > MOST_CORNERS {
        return mesh.clone();
    }
    // A triangle beyond an open edge has it the other way round.
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut sorted: Vec<(&(u32, u32), &i32)> = open.iter().collect();
    sorted.sort_unstable();
    for (&(a, b), &times) in sorted {
        let list = next.entry(b).or_default();
        list.extend((0..times).map(|_| a));
    }
    let mut out = mesh.clone();
    let starts: Vec<u32> = next.keys().copied().collect();
    for start in starts {
        let mut path = vec![start];
        while let Some(to) = path.last().and_then(|at| next.get_mut(at)?.pop()) {
            match path.iter().position(|&p| p == to) {
                None => path.push(to),
                Some(first) => {
                    let ring = path[first..].iter().map(|&i| mesh.positions[i as usize]);
                    let ring: Vec<[f64; 3]> = ring.collect();
                    if ring.len() > 2 {
                        polygon_triangles(&[ring])
                            .into_iter()
                            .for_each(|t| out.push(t));
                    }
                    path.truncate(first + 1);
                }
            }
        }
    }
    stitched(&out.welded(tolerance), tolerance)
}

/// True if every edge of every triangle is met by another triangle.
pub fn is_closed(mesh: &TriangleMesh) -> bool {
    open_edges(&mesh.triangles).is_empty()
}

/// The directed edges that are open, and how often.
fn open_edges(triangles: &[[u32; 3]]) -> FxHashMap<(u32, u32), i32> {
    let mut count: FxHashMap<(u32, u32), i32> = FxHashMap::default();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *count.entry((a, b)).or_default() += 1;
            *count.entry((b, a)).or_default() -= 1;
        }
    }
    count.retain(|_, n| *n > 0);
    count
}

/// The corners within `tolerance` of an edge, but not of its ends, from its beginning on.
fn between(
    positions: &[[f64; 3]],
    (a, b): (u32, u32),
    corners: &[u32],
    tolerance: f64,
) -> Vec<u32> {
    let (from, to) = (positions[a as usize], positions[b as usize]);
    let along = sub(to, from);
    let length = norm(along);
    if length <= 2.0 * tolerance {
        return Vec::new();
    }
    let mut found: Vec<(f64, u32)> = Vec::new();
    for &v in corners.iter().filter(|&&v| v != a && v != b) {
        let away = sub(positions[v as usize], from);
        let at = dot(away, along) / length;
        let off = norm(cross(away, along)) / length;
        if off <= tolerance && at > tolerance && at < length - tolerance {
            found.push((at, v));
        }
    }
    found.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    found.into_iter().map(|f| f.1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube of which the top is missing, and one wall has a corner in the middle of its upper edge.
    fn cube() -> TriangleMesh {
        let p = |x: f64, y: f64, z: f64| [x, y, z];
        let quads = [
            [p(0., 0., 0.), p(0., 1., 0.), p(1., 1., 0.), p(1., 0., 0.)],
            [p(1., 0., 0.), p(1., 1., 0.), p(1., 1., 1.), p(1., 0., 1.)],
            [p(1., 1., 0.), p(0., 1., 0.), p(0., 1., 1.), p(1., 1., 1.)],
            [p(0., 1., 0.), p(0., 0., 0.), p(0., 0., 1.), p(0., 1., 1.)],
        ];
        let mut mesh = TriangleMesh::default();
        for [a, b, c, d] in quads {
            mesh.push([a, b, c]);
            mesh.push([a, c, d]);
        }
        let middle = p(0.5, 0., 1.);
        mesh.push([p(0., 0., 0.), p(1., 0., 0.), middle]);
        mesh.push([p(1., 0., 0.), p(1., 0., 1.), middle]);
        mesh.push([p(0., 0., 0.), middle, p(0., 0., 1.)]);
        mesh.welded(1e-6)
    }

    #[test]
    fn a_missing_face_is_filled_and_corners_on_edges_are_met() {
        let open = cube();
        assert!(!is_closed(&open));
        let closed = filled(&open, 1e-6);
        assert!(is_closed(&closed));
        assert!((closed.volume_above(0.0) - 1.0).abs() < 1e-12);
        assert!((closed.area() - 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_roof_in_one_piece_meets_a_wall_in_two() {
        let mut mesh = cube();
        mesh.push([[0., 0., 1.], [1., 0., 1.], [1., 1., 1.]]);
        mesh.push([[0., 0., 1.], [1., 1., 1.], [0., 1., 1.]]);
        let mesh = mesh.welded(1e-6);
        assert!(!is_closed(&mesh));
        let met = stitched(&mesh, 1e-6);
        assert!(is_closed(&met));
        assert_eq!(met.triangles.len(), mesh.triangles.len() + 1);
        assert!((met.area() - 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_flat_triangle_is_taken_out() {
        // The roof's edge runs by the middle; a triangle without area joins it to the wall.
        let mut mesh = cube();
        mesh.push([[0., 0., 1.], [1., 0., 1.], [1., 1., 1.]]);
        mesh.push([[0., 0., 1.], [1., 1., 1.], [0., 1., 1.]]);
        mesh.push([[1., 0., 1.], [0., 0., 1.], [0.5, 0., 1.]]);
        let mesh = mesh.welded(1e-6);
        let met = stitched(&mesh, 1e-6);
        assert!(is_closed(&met));
        assert!(met.corners().all(|t| norm(normal(&t)) > 1e-3));
    }
}
