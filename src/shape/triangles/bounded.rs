//! Plane regions as triangles, no corner added or left out.

use rustc_hash::{FxHashMap, FxHashSet};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// Triangles of the region to the left of directed edges, by constrained Delaunay triangulation: holes are to the right
/// of their edges, and every corner of an edge stays one. `place` gives the point of a corner in the plane.
///
/// Complexity: `O(n log n)` in the number of edges, on average. `None` when edges cross, when two corners share a point, or when the edges bound nothing.
pub fn bounded_triangles(
    edges: &[[u32; 2]],
    place: impl Fn(u32) -> [f64; 2],
) -> Option<Vec<[u32; 3]>> {
    let mut triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut handles = FxHashMap::default();
    let mut vertices = FxHashMap::default();
    for &v in edges.iter().flatten() {
        if handles.contains_key(&v) {
            continue;
        }
        let [x, y] = place(v);
        let handle = triangulation.insert(Point2::new(x, y)).ok()?;
        handles.insert(v, handle);
        vertices.insert(handle.index(), v);
    }
    if vertices.len() != handles.len() {
        return None;
    }
    let boundary: FxHashSet<[u32; 2]> = edges.iter().copied().collect();
    for [v, w] in &boundary {
        let (v, w) = (handles[v], handles[w]);
        if !triangulation.can_add_constraint(v, w) {
            return None;
        }
        triangulation.add_constraint(v, w);
    }
    let mut left: FxHashMap<[u32; 2], usize> = FxHashMap::default();
    let mut triangles = Vec::new();
    for triangle in triangulation.inner_faces() {
        let corners = triangle.vertices().map(|v| vertices[&v.fix().index()]);
        for k in 0..3 {
            left.insert([corners[k], corners[(k + 1) % 3]], triangles.len());
        }
        triangles.push(corners);
    }
    // Inside is left of the boundary; from there it spreads over edges that are no boundary.
    let mut inside = vec![false; triangles.len()];
    let mut queue = Vec::new();
    for edge in &boundary {
        queue.push(*left.get(edge)?);
    }
    while let Some(k) = queue.pop() {
        if std::mem::replace(&mut inside[k], true) {
            continue;
        }
        for i in 0..3 {
            let (v, w) = (triangles[k][i], triangles[k][(i + 1) % 3]);
            if !boundary.contains(&[v, w])
                && let Some(&next) = left.get(&[w, v])
            {
                queue.push(next);
            }
        }
    }
    let kept = triangles.into_iter().zip(inside).filter(|(_, i)| *i);
    Some(kept.map(|(t, _)| t).collect())
}
