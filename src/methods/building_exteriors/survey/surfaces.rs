//! Triangles of a building: walls, roof, and the ground that it stands on.

use edifice_shape::triangles::{Corners, TriangleMesh, normal, plan_area as signed_plan_area};
use edifice_shape::vec3::norm;

/// True if the triangle is upright.
pub(crate) fn is_wall(n: [f64; 3], length: f64) -> bool {
    n[2].abs() <= LEVEL * length
}

/// Area of the plan: that of the bottom faces, else of the roof; 0 without either.
pub(super) fn plan_area(mesh: &TriangleMesh) -> f64 {
    let ground: f64 = ground(mesh).map(|t| signed_plan_area(&t).abs()).sum();
    if ground > 0.0 {
        return ground;
    }
    roof(mesh).map(|t| signed_plan_area(&t).abs()).sum()
}

/// Largest height above the lowest corner at which a level triangle is still ground (m).
const GROUND: f64 = 0.5;

/// Level triangles near the lowest corner.
pub(super) fn ground(mesh: &TriangleMesh) -> impl Iterator<Item = Corners> + '_ {
    let base = mesh.bounds().map_or(0.0, |(low, _)| low[2]);
    mesh.corners().filter(move |t| {
        let n = normal(t);
        let middle = (t[0][2] + t[1][2] + t[2][2]) / 3.0;
        n[2].abs() > 0.95 * norm(n) && middle < base + GROUND && n[2] != 0.0
    })
}

/// Triangles that are neither walls nor ground.
pub(super) fn roof(mesh: &TriangleMesh) -> impl Iterator<Item = Corners> + '_ {
    let base = mesh.bounds().map_or(0.0, |(low, _)| low[2]);
    mesh.corners().filter(move |t| {
        let n = normal(t);
        let middle = (t[0][2] + t[1][2] + t[2][2]) / 3.0;
        let length = norm(n);
        length > 0.0 && !is_wall(n, length) && middle >= base + GROUND
    })
}

/// A triangle whose normal is this near to level is a wall (sine of the slope).
const LEVEL: f64 = 0.05;
