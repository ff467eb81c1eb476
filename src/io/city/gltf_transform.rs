//! Transforms of glTF's nodes: 4 x 4 matrices, column after column.

use edifice_shape::triangles::OrientedBox;

/// Share of a length by which an axis may be askew: single precision.
const ALIGNED: f64 = 1e-6;

/// A matrix.
pub(super) type Matrix = [f64; 16];

/// Leaves everything where it is.
pub(super) const IDENTITY: Matrix = [
    1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0,
];

/// The matrix that moves.
pub(super) const fn shift([x, y, z]: [f64; 3]) -> Matrix {
    let mut matrix = IDENTITY;
    (matrix[12], matrix[13], matrix[14]) = (x, y, z);
    matrix
}

/// The inverse of a matrix that turns and moves.
pub(super) fn rigid_inverse(m: &Matrix) -> Matrix {
    let mut inverse = IDENTITY;
    for column in 0..3 {
        for row in 0..3 {
            inverse[4 * column + row] = m[4 * row + column];
            inverse[12 + row] -= m[4 * row + column] * m[12 + column];
        }
    }
    inverse
}

/// Scale, then rotation (a quaternion x, y, z, w), then translation.
pub(super) fn composed(t: Option<[f64; 3]>, r: Option<[f64; 4]>, s: Option<[f64; 3]>) -> Matrix {
    let [tx, ty, tz] = t.unwrap_or_default();
    let [x, y, z, w] = r.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let [a, b, c] = s.unwrap_or([1.0; 3]);
    let (xx, yy, zz) = (2.0 * x * x, 2.0 * y * y, 2.0 * z * z);
    let (xy, xz, yz) = (2.0 * x * y, 2.0 * x * z, 2.0 * y * z);
    let (wx, wy, wz) = (2.0 * w * x, 2.0 * w * y, 2.0 * w * z);
    [
        a * (1.0 - yy - zz),
        a * (xy + wz),
        a * (xz - wy),
        0.0,
        b * (xy - wz),
        b * (1.0 - xx - zz),
        b * (yz + wx),
        0.0,
        c * (xz + wy),
        c * (yz - wx),
        c * (1.0 - xx - yy),
        0.0,
        tx,
        ty,
        tz,
        1.0,
    ]
}

/// `a` after `b`.
pub(super) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| (0..4).map(|k| a[4 * k + i % 4] * b[i / 4 * 4 + k]).sum())
}

/// A point where the matrix puts it.
pub(super) fn applied(m: &Matrix, p: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i])
}

/// Below 0 where the matrix mirrors.
pub(super) fn determinant(m: &Matrix) -> f64 {
    m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2])
        + m[8] * (m[1] * m[6] - m[5] * m[2])
}

/// The unit box, z up, in its place: where the matrix scales along the axes, turns about the vertical and shifts.
pub(super) fn upright_box(m: &Matrix) -> Option<OrientedBox> {
    let turned = |[x, y, z]: [f64; 3]| [x, -z, y];
    let base = turned([m[12], m[13], m[14]]);
    let x = turned([m[0], m[1], m[2]]);
    let y = turned([-m[8], -m[9], -m[10]]);
    let z = turned([m[4], m[5], m[6]]);
    let size = [x[0].hypot(x[1]), y[0].hypot(y[1]), z[2]];
    let least = ALIGNED * (size[0] + size[1] + size[2]);
    let level = x[2].abs().max(y[2].abs()).max(z[0].abs()).max(z[1].abs()) <= least;
    let along = x[0] * y[0] + x[1] * y[1];
    let right = along.abs() <= ALIGNED * size[0] * size[1] && x[0] * y[1] > x[1] * y[0];
    let upright = level && right && size.iter().all(|&s| s > 0.0 && s.is_finite());
    upright.then(|| OrientedBox {
        base,
        size,
        angle: x[1].atan2(x[0]),
    })
}
