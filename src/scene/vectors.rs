//! Arithmetic of vectors of three numbers.

/// A point or direction.
pub(super) type V = [f32; 3];

pub(super) fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn times(a: V, k: f32) -> V {
    a.map(|v| v * k)
}

pub(super) fn dot(a: V, b: V) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The direction of a vector; upwards for none.
pub(super) fn unit(a: V) -> V {
    let length = dot(a, a).sqrt();
    match length > 0.0 {
        true => times(a, 1.0 / length),
        false => [0.0, 1.0, 0.0],
    }
}
