//! Everything that full lines along both axes can cut out of a region.

use super::region::{Region, TypeId, part};
use super::strips::Strips;
use edifice_shape::Axis;

/// Rectangles that a region may have between its full lines for grids of it to be looked for: about
/// ten lines each way. A larger grid hardly ever pays: each of its cells is a successor.
const MAX_RECTANGLES: usize = 4_000;

/// Types of the rectangles between two full lines along x and two along y.
#[derive(Debug)]
pub(crate) struct Cells {
    across: u16,
    up: u16,
    types: Vec<TypeId>,
}

/// Index of the interval from `a` to `b` among all.
fn place((a, b): (u16, u16)) -> usize {
    let (a, b) = (usize::from(a), usize::from(b));
    b * (b - 1) / 2 + a
}

impl Cells {
    /// The rectangles between the full lines of a region along x and y; `None` when there are too many. `intern` gives a
    /// rectangle's type.
    pub(crate) fn new(
        region: Region,
        [xs, ys]: [&Strips; 2],
        mut intern: impl FnMut(Region) -> TypeId,
    ) -> Option<Self> {
        let count = |n: usize| n * (n + 1) / 2;
        if count(xs.intervals()) * count(ys.intervals()) > MAX_RECTANGLES {
            return None;
        }
        let intervals = |cuts: &[u16]| -> Vec<(u16, u16)> {
            (1..cuts.len())
                .flat_map(|b| (0..b).map(move |a| (a, b)))
                .map(|(a, b)| (cuts[a], cuts[b]))
                .collect()
        };
        let mut types = Vec::new();
        for (x0, x1) in intervals(&xs.cuts) {
            let column: Region = part(region, Axis::X, x0, x1);
            for (y0, y1) in intervals(&ys.cuts) {
                types.push(intern(part(column, Axis::Y, y0, y1)));
            }
        }
        Some(Self {
            across: xs.intervals() as u16,
            up: ys.intervals() as u16,
            types,
        })
    }

    /// Elementary intervals along x and y.
    pub(crate) fn intervals(&self) -> (u16, u16) {
        (self.across, self.up)
    }

    /// Type of the rectangle between two cuts along x and two along y.
    pub(crate) fn cell(&self, x: (u16, u16), y: (u16, u16)) -> TypeId {
        let up = usize::from(self.up);
        self.types[place(x) * (up * (up + 1) / 2) + place(y)]
    }

    /// Types of all rectangles.
    pub(crate) fn all(&self) -> &[TypeId] {
        &self.types
    }
}
