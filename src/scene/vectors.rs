//! Arithmetic of vectors of three numbers.

pub(super) use edifice_shape::vec3::{add, cross, dot, sub};

/// A point or direction.
pub(super) type V = [f32; 3];

pub(super) fn times(a: V, k: f32) -> V {
    a.map(|v| v * k)
}

/// The direction of a vector; upwards for none.
pub(super) fn unit(a: V) -> V {
    let length = dot(a, a).sqrt();
    match length > 0.0 {
        true => times(a, 1.0 / length),
        false => [0.0, 1.0, 0.0],
    }
}
