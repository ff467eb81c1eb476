//! Features by which components are compared.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::component::Component;
use super::principal_axes::principal_axes;
use edifice_shape::triangles::convex_hull;

/// Names of the eleven features of the paper, in order; the names that weights are given by.
pub const PAPER_FEATURES: [&str; 11] = [
    "vertices",
    "window_width",
    "window_height",
    "x_spacing",
    "y_spacing",
    "emptiness",
    "intensity",
    "width",
    "height",
    "depth",
    "rotation",
];

/// Tolerance of the simplified outline, as a share of the box's diagonal.
const SIMPLIFY: f64 = 0.02;

/// Features whose standard deviation is below this share of their mean are equal.
const EQUAL: f64 = 1e-9;

/// A table of points, row after row.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// The values, row after row.
    pub values: Vec<f64>,
    /// Number of values in a row.
    pub dimension: usize,
}

impl Points {
    /// The values of row `i`.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.dimension..(i + 1) * self.dimension]
    }
}

/// The eleven features of the paper (Sec. IV.C), standardized and multiplied by `weights` (Eq. 1). Window features that a
/// component does not have are the mean of those of the others; features that are all equal fall out.
pub fn paper_features(components: &[Component], weights: &[f64; 11]) -> Points {
    let raw: Vec<[f64; 11]> = components
        .par_iter()
        .map(|c| {
            let [w, d, h] = c.frame.size;
            let mut row = [f64::NAN; 11];
            if let Some(windows) = &c.windows {
                row[1..7].copy_from_slice(windows);
            }
            row[0] = outline_vertices(c) as f64;
            row[7] = w;
            row[8] = h;
            row[9] = d;
            row[10] = c.frame.angle.rem_euclid(std::f64::consts::PI);
            row
        })
        .collect();
    let mut columns: Vec<(usize, f64, f64)> = Vec::new();
    for k in 0..11 {
        let known = || raw.iter().map(|r| r[k]).filter(|v| !v.is_nan());
        let n = known().count().max(1) as f64;
        let mean = known().sum::<f64>() / n;
        let variance = known().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
        // Equal numbers have a variance of rounding.
        if variance > (EQUAL * mean).powi(2) && weights[k] != 0.0 {
            columns.push((k, mean, weights[k] / variance.sqrt()));
        }
    }
    if columns.is_empty() {
        columns.push((0, 0.0, 0.0));
    }
    let dimension = columns.len();
    let value = |r: &[f64; 11], &(k, mean, factor): &(usize, f64, f64)| match r[k].is_nan() {
        true => 0.0,
        false => (r[k] - mean) * factor,
    };
    let values = raw
        .iter()
        .flat_map(|r| columns.iter().map(move |c| value(r, c)));
    Points {
        values: values.collect(),
        dimension,
    }
}

/// Vertices of the plan's hull after Douglas and Peucker (1973).
fn outline_vertices(component: &Component) -> usize {
    let [w, d, _] = component.frame.size;
    let plan = component
        .mesh
        .positions
        .iter()
        .map(|p| [p[0] * w, p[1] * d]);
    let hull = convex_hull(plan.collect());
    let tolerance = SIMPLIFY * w.hypot(d);
    if hull.len() < 4 {
        return hull.len();
    }
    // A closed ring is two chains between its first corner and the one farthest from it.
    let far = |i: &usize| (hull[*i][0] - hull[0][0]).hypot(hull[*i][1] - hull[0][1]);
    let split = (1..hull.len())
        .max_by(|a, b| far(a).total_cmp(&far(b)))
        .unwrap_or(1);
    let mut ring = hull.clone();
    ring.push(hull[0]);
    inner_vertices(&ring[..=split], tolerance) + inner_vertices(&ring[split..], tolerance) + 2
}

/// Vertices that Douglas-Peucker keeps between the ends of a chain.
fn inner_vertices(chain: &[[f64; 2]], tolerance: f64) -> usize {
    let (a, b) = (chain[0], chain[chain.len() - 1]);
    let length = (b[0] - a[0]).hypot(b[1] - a[1]).max(1e-12);
    let off = |p: &[f64; 2]| {
        ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).abs() / length
    };
    let inner = 1..chain.len().saturating_sub(1);
    match inner.max_by(|&i, &j| off(&chain[i]).total_cmp(&off(&chain[j]))) {
        Some(i) if off(&chain[i]) > tolerance => {
            1 + inner_vertices(&chain[..=i], tolerance) + inner_vertices(&chain[i..], tolerance)
        }
        _ => 0,
    }
}

/// Components of the covariance that are kept.
const PRINCIPAL: usize = 12;
/// The covariance is taken over at most so many components, evenly spread over them.
const SAMPLE: usize = 20_000;

/// The distance between a component with a texture and one without: as half of the greys of [`Component::looks`] would put them.
const PAINTED: f32 = 4.0;

/// Heights; and, where any component of the city shows a texture, so many looks and whether it does. One that shows none is of a
/// middle grey.
fn values(component: &Component, looks: usize) -> impl Iterator<Item = f32> {
    let shown = match (looks, component.looks.is_empty()) {
        (0, _) => Vec::new(),
        (_, true) => [vec![0.5; looks], vec![0.0]].concat(),
        (_, false) => [&component.looks[..], &[PAINTED]].concat(),
    };
    component.heights.iter().copied().chain(shown)
}

/// Height maps, and looks where there are any (from 0 to 1 both: 256 shares of the height and 64 greys), projected on their 12
/// principal components.
pub fn geometric_features(components: &[Component]) -> Points {
    let looks = components.iter().map(|c| c.looks.len()).max().unwrap_or(0);
    let d = components.first().map_or(1, |c| values(c, looks).count());
    let stride = components.len().div_ceil(SAMPLE).max(1);
    let sample: Vec<&Component> = components.iter().step_by(stride).collect();
    let n = sample.len().max(1) as f64;
    let mut mean = vec![0.0; d];
    for c in &sample {
        for (m, h) in mean.iter_mut().zip(values(c, looks)) {
            *m += f64::from(h) / n;
        }
    }
    let rows: Vec<Vec<f32>> = sample.iter().map(|c| values(c, looks).collect()).collect();
    let table = DMatrix::from_fn(d, sample.len(), |i, j| f64::from(rows[j][i]) - mean[i]);
    let covariance = &table * table.transpose() / n;
    let axes = principal_axes(covariance, &table, PRINCIPAL);
    let project = |c: &Component| -> Vec<f64> {
        let along = |axis: &DVector<f64>| {
            let values = values(c, looks).zip(&mean).zip(axis.iter());
            values.map(|((h, m), a)| (f64::from(h) - m) * a).sum()
        };
        axes.iter().map(along).collect()
    };
    let rows: Vec<Vec<f64>> = components.par_iter().map(project).collect();
    Points {
        values: rows.concat(),
        dimension: axes.len(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_nearer_to_their_chain_than_the_tolerance_are_left_out() {
        // A bow of heights 0, 1, 1.2, 0.6, 0 over 0 to 8, moved and turned: the third point is 1.2 from the chord, then the second
        // 0.4 from the chord of the first and third, and the fourth as near to that of the third and fifth.
        let bow = [[0.0, 0.0], [2.0, 1.0], [4.0, 1.2], [6.0, 0.6], [8.0, 0.0]];
        for (x, y, turn) in [(0.0, 0.0, 0.0_f64), (5.0, -3.0, 0.7), (-400.0, 900.0, 2.5)] {
            let (sin, cos) = turn.sin_cos();
            let moved = bow.map(|[u, v]| [x + u * cos - v * sin, y + u * sin + v * cos]);
            let kept = |tolerance| inner_vertices(&moved, tolerance);
            assert_eq!(kept(1.3), 0);
            assert_eq!(kept(0.5), 1);
            assert_eq!(kept(0.1), 2);
        }
        assert_eq!(inner_vertices(&bow[..2], 0.0), 0);
    }
}
