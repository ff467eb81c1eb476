//! Buildings as stacks of levels over one box, to be compared whatever their width, depth and heights are.
//!
//! A building of n components has n levels, from the ground up; its base is the box of the lowest. Each level is a map of
//! [`CELLS`] x [`CELLS`] cells over the base: which share of the level's height is solid above the cell. A rule with parameters
//! (w, d, h1, ..., hn) that is made from one building, put into the box and heights of another, differs from it by
//! the sum over the levels of w d h_k times the mean difference of their maps: the mismatched volume, in cubic metres.

use std::f64::consts::FRAC_PI_2;

use super::component::{CELLS, Component};
use super::components::SAMPLES;
use super::types::Types;
use edifice_shape::triangles::{OrientedBox, TriangleMesh, height_map};

/// Cells of a map.
const AREA: usize = CELLS * CELLS;

/// A building as levels.
pub(super) struct Stack {
    /// Maps of the levels, one after the other.
    maps: Vec<f32>,
    /// w d h_k of each level, in cubic metres.
    boxes: Vec<f64>,
    /// Volume of the components in cubic metres.
    pub(super) volume: f64,
    /// Depth over width of the base.
    pub(super) aspect: f64,
}

impl Stack {
    /// The stack of the components with these indices, from the ground up.
    pub(super) fn of(components: &[Component], parts: &[usize]) -> Self {
        let base = components[parts[0]].frame;
        let mut maps = components[parts[0]].heights.clone();
        for &i in &parts[1..] {
            let c = &components[i];
            maps.extend(map_over(&base, &c.frame, &c.mesh));
        }
        let plan = base.size[0] * base.size[1];
        let boxes = parts.iter().map(|&i| plan * components[i].frame.size[2]);
        Self {
            maps,
            boxes: boxes.collect(),
            volume: parts.iter().map(|&i| components[i].volume).sum(),
            aspect: base.size[1] / base.size[0],
        }
    }

    /// The maps of the rule that is made from a building: its components' types in their place.
    pub(super) fn ruled(components: &[Component], parts: &[usize], types: &Types) -> Vec<f32> {
        let base = components[parts[0]].frame;
        let mut maps = Vec::with_capacity(parts.len() * AREA);
        for &i in parts {
            let (c, used) = (&components[i], types.uses[i]);
            let mesh = &components[types.representatives[used.kind]].mesh;
            let mut frame = c.frame;
            frame.angle += FRAC_PI_2 * f64::from(used.quarter);
            if !used.quarter.is_multiple_of(2) {
                frame.size.swap(0, 1);
            }
            maps.extend(map_over(&base, &frame, mesh));
        }
        maps
    }

    /// Mismatched volume, in cubic metres, when a rule with these maps stands for the building, turned by quarters.
    pub(super) fn mismatch(&self, rule: &[f32], quarter: u8) -> f64 {
        let mut sum = 0.0;
        for (k, volume) in self.boxes.iter().enumerate() {
            let level = k * AREA..(k + 1) * AREA;
            let (own, rule) = (&self.maps[level.clone()], &rule[level]);
            let apart: f32 = (0..AREA)
                .map(|i| (own[i] - rule[turned(i, quarter)]).abs())
                .sum();
            sum += volume * f64::from(apart) / AREA as f64;
        }
        sum
    }

    /// Features to cluster stacks by: means of `side` x `side` cells of each level, weighted by its share of the volume.
    pub(super) fn features(&self, side: usize) -> Vec<f64> {
        let total: f64 = self.boxes.iter().sum();
        let block = CELLS / side;
        let mut out = Vec::with_capacity(self.boxes.len() * side * side);
        for (k, volume) in self.boxes.iter().enumerate() {
            let weight = (volume / total.max(f64::MIN_POSITIVE)).sqrt();
            let mut means = vec![0.0; side * side];
            for (i, v) in self.maps[k * AREA..(k + 1) * AREA].iter().enumerate() {
                let cell = i / CELLS / block * side + i % CELLS / block;
                means[cell] += f64::from(*v) / (block * block) as f64;
            }
            out.extend(means.into_iter().map(|v| v * weight));
        }
        out
    }
}

/// The cell of a map that stands at `i` when the map is turned by quarters counterclockwise.
fn turned(i: usize, quarter: u8) -> usize {
    let (x, y, last) = (i % CELLS, i / CELLS, CELLS - 1);
    let (u, v) = match quarter {
        0 => (x, y),
        1 => (y, last - x),
        2 => (last - x, last - y),
        _ => (last - y, x),
    };
    v * CELLS + u
}

/// The map over `base` of a mesh in the unit box that `frame` puts into its place; heights are shares of `frame`'s.
fn map_over(base: &OrientedBox, frame: &OrientedBox, unit: &TriangleMesh) -> Vec<f32> {
    let place = |p: &[f64; 3]| {
        let [x, y, _] = base.to_unit(frame.from_unit(*p));
        [x, y, p[2]]
    };
    let mesh = TriangleMesh {
        positions: unit.positions.iter().map(place).collect(),
        triangles: unit.triangles.clone(),
    };
    height_map(&mesh, CELLS, SAMPLES)
}
