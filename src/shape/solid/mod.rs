//! Solids between planes over convex pieces of a plan, and the closed surface of their union.
//!
//! A [`Prism`] is the space over a convex region of the plan between a lower and an upper plane; a house is a
//! union of them: walls up to roof planes, eaves, porch posts, chimneys. [`faces()`] computes the boundary of
//! the union with every decision exact ([`exact`]):
//!
//! 1. [`arrangement`]: the sides of all regions, and the lines where two planes over one place cross, cut the
//!    plan into convex cells. Over a cell the order of all planes is fixed, and the union is a stack of intervals.
//! 2. `segments`: cells meet along segments; every vertex on a segment splits both of its cells.
//! 3. `faces`: tops and bottoms of the intervals, and walls where the intervals on the two sides of a segment
//!    differ; coplanar neighbours are merged, vertices that bend nothing go.
//! 4. [`openings`](Faces::cut): windows and doors are cut into walls as niches, so that the surface stays closed.
//! 5. [`triangles`](Faces::triangulated): constrained Delaunay triangulation of each face (spade), no vertex added.
//!
//! [`check`](Surface::check) tests a finished surface without knowledge of its making, and [`integral`] computes
//! the volume of the union on another way.
//!
//! Limits: lengths are rounded to a tenth of a millimetre, slopes to a thousandth. Where solids touch in a line
//! only, an edge has four faces and the check says so.

pub mod arrangement;
mod check;
pub mod crossings;
pub mod exact;
mod faces;
pub mod integral;
pub mod openings;
mod segments;
#[cfg(test)]
mod tests;
mod triangles;

pub use check::{Report, SurfaceError};
use exact::{Line, Plane};
pub use faces::{Face, FaceKey, Faces};
pub use openings::{Opening, Panel, Span, Wall};

/// The finish of a piece of surface; where solids overlap, the first in this order shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Finish {
    /// Masonry of a chimney.
    Chimney,
    /// Outer wall.
    Wall,
    /// Sloped or flat roof.
    Roof,
    /// Eaves, posts, beams.
    Trim,
    /// Floor of a porch.
    Deck,
    /// Frames and sills.
    Frame,
    /// Glass.
    Pane,
    /// Leaf of a door.
    Door,
    /// Leaf of a garage door.
    GarageDoor,
}

/// The space over a convex region between two planes.
#[derive(Debug, Clone, PartialEq)]
pub struct Prism {
    /// The region: left of all these lines.
    pub region: Vec<Line>,
    /// Lower plane.
    pub lower: Plane,
    /// Upper plane, nowhere in the region below the lower one.
    pub upper: Plane,
    /// Finish of sides and bottom.
    pub sides: Finish,
    /// Finish of the top.
    pub top: Finish,
}

/// A triangle mesh with finishes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surface {
    /// Corners in metres, z up.
    pub positions: Vec<[f64; 3]>,
    /// Corners of each triangle, counterclockwise seen from outside, and its finish.
    pub triangles: Vec<([u32; 3], Finish)>,
}

/// The boundary of the union of the prisms as merged plane faces.
pub fn faces(prisms: &[Prism]) -> Faces {
    let cells = arrangement::cells(prisms);
    let plan = segments::connect(&cells);
    faces::build(prisms, &cells, &plan)
}

impl Faces {
    /// The triangles of all faces.
    ///
    /// # Errors
    /// [`SurfaceError::Face`] for a face that touches itself: solids touch in a line.
    pub fn triangulated(self) -> Result<Surface, SurfaceError> {
        triangles::triangulate(self)
    }
}
