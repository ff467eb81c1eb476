//! The attributes that a mass model is to reach.

use super::MASS;
use edifice_shape::{BoxStyle, Building, MassBox};

/// Columns of garage, front porch and back porch.
pub const PARTS: [(&str, usize, BoxStyle); 3] = [
    ("garage", 9, BoxStyle::Garage),
    ("porch.front", 15, BoxStyle::Porch),
    ("porch.back", 21, BoxStyle::Porch),
];

/// A floor is there when its share is above this.
pub const FLOOR_SHARE: f64 = 0.02;

/// A garage or porch in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartTarget {
    /// Edges along x, from the left end of the bounding box.
    pub x: [f64; 2],
    /// Edges along y, from the front.
    pub y: [f64; 2],
    /// Height.
    pub height: f64,
}

/// The wanted columns and what follows from them.
#[derive(Debug, Clone, PartialEq)]
pub struct MassTarget {
    /// The 27 wanted columns.
    pub wanted: [f64; MASS],
    /// Floors with a share of their own, 1 to 3.
    pub floors: usize,
    /// Height over the number of floors.
    pub floor_height: f64,
    /// Garage, front porch, back porch.
    pub parts: [Option<PartTarget>; 3],
}

impl MassTarget {
    /// Reads 27 columns that are free of contradictions.
    pub fn new(wanted: [f64; MASS]) -> Self {
        let floors = floors(&wanted);
        let parts = PARTS.map(|(_, c, _)| part(&wanted, c));
        Self {
            floors,
            floor_height: wanted[2] / floors as f64,
            parts,
            wanted,
        }
    }

    /// Extent along an axis: 0 is x, 1 is y.
    pub fn extent(&self, axis: usize) -> f64 {
        self.wanted[axis]
    }

    /// Presence of the garage, the front porch and the back porch, in this order.
    pub fn presence(&self) -> [bool; 3] {
        self.parts.map(|p| p.is_some())
    }
}

/// Floors that have a share.
pub fn floors(wanted: &[f64]) -> usize {
    1 + usize::from(wanted[7] > FLOOR_SHARE) + usize::from(wanted[8] > FLOOR_SHARE)
}

/// The garage or porch whose columns start at `c`; `None` without one.
pub fn part(wanted: &[f64], c: usize) -> Option<PartTarget> {
    let (w, d) = (wanted[c + 2], wanted[c + 3]);
    if w <= 0.0 || d <= 0.0 {
        return None;
    }
    let (x, y) = (wanted[c] * wanted[0], wanted[c + 1] * wanted[1]);
    // Rounding must not push a part that touches the bounding box through it.
    let snapped = |v: f64, extent: f64| match v {
        v if v.abs() < 1e-3 => 0.0,
        v if (v - extent).abs() < 1e-3 => extent,
        v => v,
    };
    Some(PartTarget {
        x: [x - w / 2.0, x + w / 2.0].map(|v| snapped(v, wanted[0])),
        y: [y - d / 2.0, y + d / 2.0].map(|v| snapped(v, wanted[1])),
        height: wanted[c + 4],
    })
}

/// Garage, front porch or back porch of a building as its place in [`PARTS`]; `None` for a general box.
pub fn part_of(b: &MassBox, middle: f64) -> Option<usize> {
    match b.style {
        BoxStyle::Main => None,
        BoxStyle::Garage => Some(0),
        BoxStyle::Porch if b.y < middle => Some(1),
        BoxStyle::Porch => Some(2),
    }
}

/// Lower and upper end of the plan along x and y.
pub fn bounds(building: &Building) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for b in &building.boxes {
        for (axis, (centre, extent)) in [(b.x, b.width), (b.y, b.depth)].into_iter().enumerate() {
            bounds[axis][0] = bounds[axis][0].min(centre - extent / 2.0);
            bounds[axis][1] = bounds[axis][1].max(centre + extent / 2.0);
        }
    }
    bounds
}
