//! Plane faces with holes to triangles, no vertex added.

use super::check::SurfaceError;
use super::{Face, FaceKey, Faces, Surface};
use crate::triangles::bounded_triangles;

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
fn flat(key: &FaceKey, p: [f64; 3]) -> [f64; 2] {
    match key {
        FaceKey::Top(_) => [p[0], p[1]],
        FaceKey::Bottom(_) => [p[1], p[0]],
        FaceKey::Wall(line) => {
            let (a, b) = (line.a as f64, line.b as f64);
            [(b * p[0] - a * p[1]) / a.hypot(b), p[2]]
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
    bounded_triangles(&face.edges, |v| flat(&face.key, positions[v as usize])).ok_or_else(fail)
}
