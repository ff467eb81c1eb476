//! The order in which buildings are worked on: by where and what they are, not by how they are listed, so that a city's
//! grammar does not depend on the order of its buildings.

use std::cmp::Ordering;

use rayon::prelude::*;

use edifice_shape::triangles::{City, TriangleMesh};

/// The buildings of a city by their bounds, then by their meshes. Buildings that are the same keep their order, which
/// changes nothing but which identifier stands with which.
pub(super) fn canonical_order(city: &City) -> Vec<usize> {
    let keys: Vec<[f64; 6]> = city.buildings.par_iter().map(|b| bounds(&b.mesh)).collect();
    let mut order: Vec<usize> = (0..city.buildings.len()).collect();
    order.par_sort_by(|&a, &b| {
        let meshes = || compare(&city.buildings[a].mesh, &city.buildings[b].mesh);
        numbers(&keys[a], &keys[b]).then_with(meshes)
    });
    order
}

fn bounds(mesh: &TriangleMesh) -> [f64; 6] {
    let ([x, y, z], [u, v, w]) = mesh.bounds().unwrap_or_default();
    [x, y, z, u, v, w]
}

fn compare(a: &TriangleMesh, b: &TriangleMesh) -> Ordering {
    let flat = |m: &TriangleMesh| m.positions.as_flattened().to_vec();
    let triangles = || a.triangles.cmp(&b.triangles);
    numbers(&flat(a), &flat(b)).then_with(triangles)
}

fn numbers(a: &[f64], b: &[f64]) -> Ordering {
    let unequal = a.iter().zip(b).map(|(x, y)| x.total_cmp(y));
    let first = unequal.into_iter().find(|o| o.is_ne());
    first.unwrap_or_else(|| a.len().cmp(&b.len()))
}
