//! Meshes of templates as CGA inserts them.

use std::fmt::Write;

use super::error::CgaCityError;
use edifice_grammar::instance::Template;
use edifice_shape::triangles::TriangleMesh;

/// Extents below this are none.
const FLAT: f64 = 1e-9;
/// Units of an asset that a unit box is wide: edges of a thousandth of it are far from what CityEngine cleans up.
const WIDTH: f64 = 100.0;

/// Smallest and largest coordinates.
pub(super) type Bounds = ([f64; 3], [f64; 3]);

/// The box that a template's mesh fills, or `None` for a mesh without triangles.
pub(super) fn bounds(template: &Template) -> Result<Option<Bounds>, CgaCityError> {
    let mesh = &template.mesh;
    let Some((low, high)) = mesh.bounds().filter(|_| !mesh.triangles.is_empty()) else {
        return Ok(None);
    };
    match (0..3).find(|&k| high[k] - low[k] < FLAT) {
        None => Ok(Some((low, high))),
        Some(k) => Err(CgaCityError::Flat {
            template: template.symbol.clone(),
            axis: ['x', 'y', 'z'][k],
        }),
    }
}

/// True if a mesh is the surface of the box from `low` to `high`, faces outwards.
pub(super) fn is_box(mesh: &TriangleMesh, low: [f64; 3], high: [f64; 3]) -> bool {
    let on = |p: &[f64; 3], k: usize, side: &[f64; 3]| (p[k] - side[k]).abs() < FLAT;
    let is_corner = |p: &[f64; 3]| (0..3).all(|k| on(p, k, &low) || on(p, k, &high));
    let faces: f64 = (0..3)
        .map(|k| (high[k] - low[k]) * (high[(k + 1) % 3] - low[(k + 1) % 3]))
        .sum();
    let volume: f64 = (0..3).map(|k| high[k] - low[k]).product();
    // Twelve triangles on the box's sides, of its area and volume.
    mesh.triangles.len() == 12
        && mesh.positions.iter().all(is_corner)
        && mesh
            .corners()
            .all(|t| (0..3).any(|k| [low, high].iter().any(|s| t.iter().all(|p| on(p, k, s)))))
        && (mesh.area() - 2.0 * faces).abs() < FLAT
        && (mesh.volume_above(low[2]) - volume).abs() < FLAT
}

/// A mesh as Wavefront OBJ, y up.
pub(super) fn obj(template: &Template) -> String {
    let mut out = format!("# {}, y up\n", template.symbol.escape_debug());
    for p in &template.mesh.positions {
        let [x, y, z] = p.map(|v| (v * WIDTH * 1e6).round() / 1e6 + 0.0);
        // Writing to a String cannot fail.
        let _ = writeln!(out, "v {x} {z} {}", -y + 0.0);
    }
    for t in &template.mesh.triangles {
        let [i, j, k] = t.map(|i| i + 1);
        let _ = writeln!(out, "f {i} {j} {k}");
    }
    out
}
