//! Plane faces with holes to triangles, no vertex added.

use rustc_hash::{FxHashMap, FxHashSet};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::check::SurfaceError;
use super::{Face, FaceKey, Faces, Surface};

/// Triangulates all faces.
pub(super) fn triangulate(faces: Faces) -> Result<Surface, SurfaceError> {
    let mut triangles = Vec::new();
    for face in &faces.faces {
        let own = delaunay(face, &faces.positions)?;
        triangles.extend(own.into_iter().map(|t| (t, face.finish)));
    }
    for ([a, b, c, d], finish) in &faces.quads {
        triangles.extend([([*a, *b, *c], *finish), ([*a, *c, *d], *finish)]);
    }
    Ok(Surface {
        positions: faces.positions,
        triangles,
    })
}

/// Coordinates in the plane of a face, counterclockwise seen from outside.
fn flat(key: &FaceKey, p: [f64; 3]) -> Point2<f64> {
    match key {
        FaceKey::Top(_) => Point2::new(p[0], p[1]),
        FaceKey::Bottom(_) => Point2::new(p[1], p[0]),
        FaceKey::Wall(line) => {
            let (a, b) = (line.a as f64, line.b as f64);
            Point2::new((b * p[0] - a * p[1]) / a.hypot(b), p[2])
        }
    }
}

fn delaunay(face: &Face, positions: &[[f64; 3]]) -> Result<Vec<[u32; 3]>, SurfaceError> {
    if let [[a, b], [c, d], [e, f]] = face.edges[..] {
        let third = [(b == c, d), (b == e, f)];
        if let Some((_, third)) = third.into_iter().find(|(next, _)| *next) {
            return Ok(vec![[a, b, third]]);
        }
    }
    let fail = || SurfaceError::Face {
        corner: positions[face.edges[0][0] as usize],
    };
    let mut triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut handles = FxHashMap::default();
    let mut vertices = FxHashMap::default();
    for &v in face.edges.iter().flatten() {
        if handles.contains_key(&v) {
            continue;
        }
        let point = flat(&face.key, positions[v as usize]);
        let handle = triangulation.insert(point).map_err(|_| fail())?;
        handles.insert(v, handle);
        vertices.insert(handle.index(), v);
    }
    if vertices.len() != handles.len() {
        return Err(fail());
    }
    let boundary: FxHashSet<[u32; 2]> = face.edges.iter().copied().collect();
    for [v, w] in &boundary {
        let (v, w) = (handles[v], handles[w]);
        if !triangulation.can_add_constraint(v, w) {
            return Err(fail());
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
        queue.push(*left.get(edge).ok_or_else(fail)?);
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
    Ok(kept.map(|(t, _)| t).collect())
}
