//! Types of buildings, as many as the buildings ask for.
//!
//! Types of components (Sec. IV.D) are scaled to the box of what they replace, so that all prisms over a rectangle may be
//! one template. Types of buildings keep sizes: buildings of one type are stacks of like components
//! of like sizes. They are what stands together in patterns.
//!
//! Features of a stack of s components, without units: of each, the logarithms of width, depth and height (above the
//! first: against the component below), the principal components of the height map, and, above the first, the shift and
//! the turn against the first one. Stacks of different s are of different types; among equals Ward's hierarchy is cut where
//! the description of the features is shortest ([`shortest_description`]): repeated buildings become types without anyone
//! saying how many.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::component::{CELLS, Component};
use super::features::Points;
use super::orientation::is_symmetric;
use super::principal_axes::principal_axes;
use super::settings::ProceduralizeError;
use edifice_cluster::{shortest_description, ward};

/// Differences of features below this are no differences: half a per cent of a length.
const PRECISION: f64 = 0.005;
/// Principal components of a height map that are features of a building.
const SHAPE: usize = 6;
/// Features of a stack are projected on so many principal components.
const MOST_FEATURES: usize = 14;

/// The types of buildings.
#[derive(Debug, Clone, PartialEq)]
pub struct BuildingTypes {
    /// The type of each building, from 0; `None` where it has no component.
    pub labels: Vec<Option<usize>>,
    /// Components of each building, from the ground up: indices.
    pub parts: Vec<Vec<usize>>,
    /// The buildings that have components, in the order of those.
    pub order: Vec<usize>,
    /// Number of types.
    pub count: usize,
    /// For each type, true if half a turn does not change its buildings; most of its buildings decide.
    pub symmetric: Vec<bool>,
}

/// Types of the buildings of a city of `buildings` buildings that is cut into `components`; `shape`: their
/// [`super::features::geometric_features`].
///
/// # Errors
/// [`ProceduralizeError::Ward`].
pub fn building_types(
    components: &[Component],
    shape: &Points,
    buildings: usize,
) -> Result<BuildingTypes, ProceduralizeError> {
    let (parts, order) = stacks(components, buildings);
    let most = parts.iter().map(Vec::len).max().unwrap_or(0);
    let classes: Vec<Vec<usize>> = (1..=most)
        .map(|s| {
            let own = order.iter().copied();
            own.filter(|&b| parts[b].len() == s).collect()
        })
        .collect();
    let found: Vec<Vec<usize>> = classes
        .par_iter()
        .map(|class: &Vec<usize>| {
            let rows = class.iter().map(|&b| row(components, &parts[b], shape));
            labels_of(rows.collect())
        })
        .collect::<Result<_, _>>()?;
    let mut out = BuildingTypes {
        labels: vec![None; buildings],
        parts,
        order,
        count: 0,
        symmetric: Vec::new(),
    };
    for (class, labels) in classes.iter().zip(found) {
        for (&b, &l) in class.iter().zip(&labels) {
            out.labels[b] = Some(out.count + l);
        }
        out.count += labels.iter().max().map_or(0, |m| m + 1);
    }
    let mut votes = vec![0i64; out.count];
    for (label, parts) in out.labels.iter().zip(&out.parts) {
        if let Some(l) = label {
            let symmetric = is_symmetric(parts.iter().map(|&i| &components[i]));
            votes[*l] += if symmetric { 1 } else { -1 };
        }
    }
    out.symmetric = votes.into_iter().map(|v| v > 0).collect();
    Ok(out)
}

impl BuildingTypes {
    /// A type for each building that has components.
    pub(crate) fn apart(components: &[Component], buildings: usize) -> Self {
        let (parts, order) = stacks(components, buildings);
        let mut labels = vec![None; buildings];
        for (label, &b) in order.iter().enumerate() {
            labels[b] = Some(label);
        }
        Self {
            labels,
            parts,
            count: order.len(),
            symmetric: vec![false; order.len()],
            order,
        }
    }
}

/// The components of each building, and the buildings that have any, in the order of those.
fn stacks(components: &[Component], buildings: usize) -> (Vec<Vec<usize>>, Vec<usize>) {
    let mut parts: Vec<Vec<usize>> = vec![Vec::new(); buildings];
    let mut order = Vec::new();
    for (i, c) in components.iter().enumerate() {
        if parts[c.building].is_empty() {
            order.push(c.building);
        }
        parts[c.building].push(i);
    }
    (parts, order)
}

/// The features of a stack.
fn row(components: &[Component], parts: &[usize], shape: &Points) -> Vec<f64> {
    let cells = (CELLS * CELLS) as f64;
    let mut row = Vec::new();
    for (k, &i) in parts.iter().enumerate() {
        let c = &components[i];
        let below = k.checked_sub(1).map(|k| components[parts[k]].frame.size);
        for axis in 0..3 {
            row.push(c.frame.size[axis].ln() - below.map_or(0.0, |b| b[axis].ln()));
        }
        // Root mean square over the cells.
        let shape = shape.row(i).iter().take(SHAPE);
        row.extend(shape.map(|v| v / cells.sqrt()));
        if k > 0 {
            let first = &components[parts[0]].frame;
            let [x, y, _] = first.to_unit(c.frame.base);
            // A square has no direction.
            let long = 1.0 - c.frame.size[1] / c.frame.size[0];
            let (sin, cos) = (2.0 * (c.frame.angle - first.angle)).sin_cos();
            row.extend([x, y, long * sin / 2.0, long * cos / 2.0]);
        }
    }
    row
}

/// Labels from 0 of rows of one length.
fn labels_of(rows: Vec<Vec<f64>>) -> Result<Vec<usize>, ProceduralizeError> {
    if rows.len() < 2 {
        return Ok(vec![0; rows.len()]);
    }
    let (points, d) = projected(&rows);
    let tree = ward(&points, d, &vec![1.0; rows.len()])?;
    let k = shortest_description(&tree, &points, &vec![PRECISION; d]);
    Ok(tree.cut(k))
}

/// Rows on their principal axes, where there are more than [`MOST_FEATURES`] features; and the dimension.
pub(super) fn projected(rows: &[Vec<f64>]) -> (Vec<f64>, usize) {
    let (n, d) = (rows.len(), rows[0].len());
    if d <= MOST_FEATURES {
        return (rows.concat(), d);
    }
    let mean: Vec<f64> = (0..d)
        .map(|j| rows.iter().map(|r| r[j]).sum::<f64>() / n as f64)
        .collect();
    let table = DMatrix::from_fn(d, n, |j, i| rows[i][j] - mean[j]);
    let axes = principal_axes(&table * table.transpose(), &table, MOST_FEATURES);
    let points = (0..n).flat_map(|i| {
        let point = table.column(i);
        axes.iter().map(move |axis| axis.dot(&point))
    });
    (points.collect(), axes.len())
}
