//! Buildings of level of detail 3: a surface in named parts, windows and doors among them.
//!
//! Level of detail 3 is that of CityGML 3.0 (Open Geospatial Consortium 20-010): walls and roofs with their openings.

use serde_json::{Map, Value};

use crate::solid::Finish;
use crate::triangles::normal;
use crate::vec3::norm;

/// The class of a part; the names are those of CityJSON 2.0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PartKind {
    /// The underside, which stands on the ground.
    GroundSurface,
    /// An outer wall.
    WallSurface,
    /// A roof.
    RoofSurface,
    /// A surface that is seen from below, such as the ceiling of a passage.
    OuterCeilingSurface,
    /// A surface outside to stand on, such as the floor of a porch.
    OuterFloorSurface,
    /// A window with its frame and its reveals.
    Window,
    /// A door with its frame and its reveals.
    Door,
    /// A piece attached to a building, such as eaves, posts and chimneys.
    BuildingInstallation,
}

impl PartKind {
    /// The name of the class in CityJSON 2.0.
    pub fn name(self) -> &'static str {
        match self {
            PartKind::GroundSurface => "GroundSurface",
            PartKind::WallSurface => "WallSurface",
            PartKind::RoofSurface => "RoofSurface",
            PartKind::OuterCeilingSurface => "OuterCeilingSurface",
            PartKind::OuterFloorSurface => "OuterFloorSurface",
            PartKind::Window => "Window",
            PartKind::Door => "Door",
            PartKind::BuildingInstallation => "BuildingInstallation",
        }
    }

    /// True for windows and doors.
    pub fn is_opening(self) -> bool {
        matches!(self, PartKind::Window | PartKind::Door)
    }
}

/// A rectangle on a vertical plane: where a window or a door sits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallRect {
    /// The lower left corner, seen from outside.
    pub corner: [f64; 3],
    /// Unit vector to the right, seen from outside, level.
    pub along: [f64; 2],
    /// Extent along the wall.
    pub width: f64,
    /// Extent upwards.
    pub height: f64,
}

/// A named part of the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its class.
    pub kind: PartKind,
    /// Its name, different from those of all other parts of the building.
    pub name: String,
    /// Index of the wall that a window or a door lies in.
    pub wall: Option<usize>,
    /// The rectangle of a window or a door.
    pub rect: Option<WallRect>,
    /// Corners of each triangle, counterclockwise seen from outside, and its finish.
    pub triangles: Vec<([u32; 3], Finish)>,
    /// All that is known of it, such as `style`, `floor` and `probability`.
    pub attributes: Map<String, Value>,
}

impl Part {
    /// A part that lies in no wall and of which nothing else is known.
    pub fn new(kind: PartKind, name: String, triangles: Vec<([u32; 3], Finish)>) -> Self {
        Self {
            kind,
            name,
            wall: None,
            rect: None,
            triangles,
            attributes: Map::new(),
        }
    }
}

/// A building in parts. Each triangle of its surface belongs to one part.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DetailedBuilding {
    /// Its name.
    pub name: String,
    /// Corners in metres, z up.
    pub positions: Vec<[f64; 3]>,
    /// Its parts; walls come before what lies in them.
    pub parts: Vec<Part>,
    /// All that is known of the building.
    pub attributes: Map<String, Value>,
}

impl DetailedBuilding {
    /// The triangles of all parts in their order, with the index of the part.
    pub fn triangles(&self) -> impl Iterator<Item = (usize, [u32; 3], Finish)> {
        let parts = self.parts.iter().enumerate();
        parts.flat_map(|(k, part)| part.triangles.iter().map(move |(t, f)| (k, *t, *f)))
    }

    /// Corners of a triangle.
    pub fn corners(&self, triangle: [u32; 3]) -> [[f64; 3]; 3] {
        triangle.map(|v| self.positions[v as usize])
    }

    /// Area of a part in square metres.
    pub fn area(&self, part: &Part) -> f64 {
        let twice = |t: [u32; 3]| norm(normal(&self.corners(t)));
        part.triangles.iter().map(|(t, _)| twice(*t)).sum::<f64>() / 2.0
    }
}
