//! The facts known of a house: its attributes, its parts and its floors.

use super::super::attributes::AttributeRow;
use super::super::mass::target::{FLOOR_SHARE, PARTS};

/// The known attributes and parts of a house.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// Its 49 attributes.
    pub row: AttributeRow,
    /// Presence of a garage, a front and a back porch; `None` where it is unknown.
    pub there: [Option<bool>; 3],
    /// Number of floors, 1 to 3.
    pub floors: Option<usize>,
}

impl From<AttributeRow> for Observation {
    /// A part is there when its width and depth are above zero, a floor when its share is above 0.02.
    fn from(row: AttributeRow) -> Self {
        let there = PARTS.map(|(_, c, _)| match (row[c + 2], row[c + 3]) {
            (Some(w), Some(d)) => Some(w > 0.0 && d > 0.0),
            (Some(v), None) | (None, Some(v)) => Some(v > 0.0),
            (None, None) => None,
        });
        let has = |c: usize| row[c].map(|v| v > FLOOR_SHARE);
        let floors = match (row[6], has(7), has(8)) {
            (Some(ground), _, _) if ground > 1.0 - FLOOR_SHARE => Some(1),
            (_, Some(false), _) => Some(1),
            (_, Some(true), Some(false)) => Some(2),
            (_, _, Some(true)) => Some(3),
            _ => None,
        };
        Self { row, there, floors }
    }
}
