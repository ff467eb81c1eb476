//! Meshes as arrays.

use numpy::PyArray2;
use pyo3::prelude::*;

use super::errors::failed;

/// Corners `(n, 3)` and triangles `(m, 3)`.
pub type MeshArrays<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>);

/// The arrays of a mesh.
///
/// # Errors
/// None that can be met: each row has three numbers.
pub fn mesh<'py>(
    py: Python<'py>,
    corners: &[[f64; 3]],
    triangles: impl Iterator<Item = [u32; 3]>,
) -> PyResult<MeshArrays<'py>> {
    let corners: Vec<Vec<f64>> = corners.iter().map(|p| p.to_vec()).collect();
    let triangles: Vec<Vec<i64>> = triangles.map(|t| t.map(i64::from).to_vec()).collect();
    let shaped = |empty: bool| empty.then_some([0, 3]);
    let corners = match shaped(corners.is_empty()) {
        Some(shape) => PyArray2::zeros(py, shape, false),
        None => PyArray2::from_vec2(py, &corners).map_err(failed)?,
    };
    let triangles = match shaped(triangles.is_empty()) {
        Some(shape) => PyArray2::zeros(py, shape, false),
        None => PyArray2::from_vec2(py, &triangles).map_err(failed)?,
    };
    Ok((corners, triangles))
}
