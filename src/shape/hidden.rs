//! Parts of a house that have not been looked at.

use serde::{Deserialize, Serialize};

/// A part of a house that has not been looked at: whether there is one, and of what kind, is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hidden {
    /// Garages.
    Garage,
    /// Porches.
    Porch,
    /// Windows and doors of all sides.
    Facades,
    /// Kinds of roofs.
    Roof,
    /// Chimneys and towers.
    Special,
}

impl Hidden {
    /// All parts, in the order of the attributes.
    pub const ALL: [Hidden; 5] = [
        Hidden::Garage,
        Hidden::Porch,
        Hidden::Facades,
        Hidden::Roof,
        Hidden::Special,
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Hidden::Garage => "garage",
            Hidden::Porch => "porch",
            Hidden::Facades => "facades",
            Hidden::Roof => "roof",
            Hidden::Special => "special",
        }
    }
}
