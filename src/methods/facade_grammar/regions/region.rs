//! Regions of layouts, their parts, and the numbers of their types.

use edifice_shape::Axis;

/// A rectangle of grid cells of one layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Region {
    pub layout: u16,
    pub x0: u16,
    pub x1: u16,
    pub y0: u16,
    pub y1: u16,
}

/// Index of a region type. Those below the number of labels are the terminal labels.
pub(crate) type TypeId = u32;

/// Grid indices of a region's ends along an axis.
pub(crate) fn ends(r: Region, axis: Axis) -> (u16, u16) {
    match axis {
        Axis::X => (r.x0, r.x1),
        Axis::Y => (r.y0, r.y1),
    }
}

/// The strip of a region between two grid indices.
pub(crate) fn part(r: Region, axis: Axis, from: u16, to: u16) -> Region {
    match axis {
        Axis::X => Region {
            x0: from,
            x1: to,
            ..r
        },
        Axis::Y => Region {
            y0: from,
            y1: to,
            ..r
        },
    }
}
