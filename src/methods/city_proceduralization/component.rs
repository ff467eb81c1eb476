//! A component: the volume of a building between two cut planes (Sec. IV.B).

use std::sync::Arc;

use super::windows::WindowFeatures;
use edifice_shape::triangles::{OrientedBox, TriangleMesh};

/// Cells along a side of the height map.
pub const CELLS: usize = 16;

/// The volume of a building between two cut planes.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Index of the building.
    pub building: usize,
    /// Index of the slab in the building, from the ground up.
    pub slab: usize,
    /// The oriented box; its angle, from 0 to 2π, includes the canonical half turn.
    pub frame: OrientedBox,
    /// The slab with its lid, in unit coordinates of the box.
    pub mesh: TriangleMesh,
    /// Solid share of each column of the box, 0 to 1, 16 x 16 columns.
    pub heights: Vec<f32>,
    /// Volume in cubic metres, at least 0.
    pub volume: f64,
    /// True if half a turn does not change it.
    pub symmetric: bool,
    /// The template that it is an instance of, where the input says it.
    pub stated: Option<usize>,
    /// The window features, where its sides are painted.
    pub windows: Option<WindowFeatures>,
    /// Greys of its four sides, 4 x 4 each, from 0 (black) to 1; empty where it shows no texture.
    pub looks: Vec<f32>,
    /// Bytes of the textures that it shows, by texels.
    pub texture_bytes: f64,
    /// The picture file of its box mapping, where the input says it.
    pub texture: Option<Arc<[u8]>>,
}
