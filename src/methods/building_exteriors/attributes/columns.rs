//! Names, units and groups of the 49 attributes.

/// The part of the hierarchical model that a group belongs to (Fig. 4d).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Mass model attributes `M_c`: continuous.
    Mass,
    /// Facade attributes `F_c`: continuous.
    Facade,
    /// Element attributes `E_d`: binary vectors.
    Element,
}

/// A group of attributes: one random variable of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Group {
    /// Name of the group.
    pub name: &'static str,
    /// Part of the model.
    pub level: Level,
    /// Its first column in [`COLUMNS`].
    pub first: usize,
    /// Number of its columns.
    pub len: usize,
}

impl Group {
    const fn new(name: &'static str, level: Level, first: usize, len: usize) -> Self {
        Self {
            name,
            level,
            first,
            len,
        }
    }

    /// Names of its columns.
    pub fn columns(&self) -> &'static [&'static str] {
        &COLUMNS[self.first..self.first + self.len]
    }
}

/// The 13 groups: seven of the mass model, three of the facades, three of the elements.
pub const GROUPS: [Group; 13] = [
    Group::new("bbox", Level::Mass, 0, 3),
    Group::new("bcr", Level::Mass, 3, 1),
    Group::new("bdry", Level::Mass, 4, 1),
    Group::new("far", Level::Mass, 5, 1),
    Group::new("arf", Level::Mass, 6, 3),
    Group::new("garage", Level::Mass, 9, 6),
    Group::new("porch", Level::Mass, 15, 12),
    Group::new("wwr", Level::Facade, 27, 4),
    Group::new("symmetry", Level::Facade, 31, 4),
    Group::new("alignment", Level::Facade, 35, 4),
    Group::new("roof", Level::Element, 39, 3),
    Group::new("window", Level::Element, 42, 5),
    Group::new("special", Level::Element, 47, 2),
];

/// The 49 columns in order. Lengths (`bbox`, sizes) are in the building's unit; all else has none.
pub const COLUMNS: [&str; 49] = [
    "bbox.w",
    "bbox.d",
    "bbox.h",
    "bcr",
    "bdry",
    "far",
    "arf.0",
    "arf.1",
    "arf.2",
    "garage.x",
    "garage.y",
    "garage.w",
    "garage.d",
    "garage.h",
    "garage.visible",
    "porch.front.x",
    "porch.front.y",
    "porch.front.w",
    "porch.front.d",
    "porch.front.h",
    "porch.front.visible",
    "porch.back.x",
    "porch.back.y",
    "porch.back.w",
    "porch.back.d",
    "porch.back.h",
    "porch.back.visible",
    "wwr.front",
    "wwr.back",
    "wwr.left",
    "wwr.right",
    "symmetry.front",
    "symmetry.back",
    "symmetry.left",
    "symmetry.right",
    "alignment.front",
    "alignment.back",
    "alignment.left",
    "alignment.right",
    "roof.flat",
    "roof.gable",
    "roof.hip",
    "window.sash",
    "window.sliding",
    "window.casement",
    "window.bay",
    "window.fixed",
    "special.chimney",
    "special.tower",
];
