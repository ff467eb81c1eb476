//! The squares of the new city that are filled one after the other.

use super::exemplar::{COMPARED, Exemplar};
use super::shape::{Shape, rotated};

/// A square to be filled.
#[derive(Clone, Copy)]
pub(super) struct Square {
    pub(super) middle: [f64; 2],
    pub(super) side: f64,
}

/// Points of a square of so many metres about its middle.
fn offsets(side: f64) -> impl Iterator<Item = [f64; 2]> {
    let n = (side / COMPARED).round().max(1.0) as i64;
    let at = move |i: i64| ((i as f64 + 0.5) / n as f64 - 0.5) * side;
    (0..n).flat_map(move |j| (0..n).map(move |i| [at(i), at(j)]))
}

/// Points of a square of so many metres about the middle of another, turned by so many degrees, a cell of side [`COMPARED`] apart.
pub(super) fn points(square: Square, side: f64, degrees: f64) -> Vec<[f64; 2]> {
    offsets(side)
        .map(|p| rotated(p, degrees))
        .map(|[x, y]| [square.middle[0] + x, square.middle[1] + y])
        .collect()
}

/// The share of a square, turned by so many degrees, that lies inside the shape.
pub(super) fn inside(shape: &Shape, square: Square, degrees: f64) -> f64 {
    let points = points(square, square.side, degrees);
    let within = points.iter().filter(|p| shape.contains(**p)).count();
    within as f64 / points.len() as f64
}

/// The squares of a lattice that reach into the shape, row by row; the lattice is moved by a share of their side.
pub(super) fn lattice(city: &Exemplar, shape: &Shape, side: f64, offset: [f64; 2]) -> Vec<Square> {
    let Some((low, high)) = shape.bounds() else {
        return Vec::new();
    };
    let middle = [0, 1].map(|k| (low[k] + high[k]) / 2.0);
    let reach = (high[0] - low[0]).hypot(high[1] - low[1]) / 2.0;
    let most = (reach / side).ceil() as i64 + 1;
    let mut out = Vec::new();
    for j in -most..=most {
        for i in -most..=most {
            let steps = [i as f64 + offset[0], j as f64 + offset[1]];
            let [x, y] = rotated(steps.map(|v| v * side), city.axis);
            let square = Square {
                middle: [middle[0] + x, middle[1] + y],
                side,
            };
            if inside(shape, square, city.axis) > 0.0 {
                out.push(square);
            }
        }
    }
    out
}
