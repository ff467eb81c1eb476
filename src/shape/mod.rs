//! The papers' shared nouns: geometry of facades and buildings.
//!
//! - [`Rect`]: an axis-parallel rectangle, origin at the lower left, y up.
//! - [`Facade`]: labelled rectangles inside a rectangular domain (Wu et al. 2014, Sec. 3.1).
//! - [`Building`]: boxes, roofs and facade pieces (Fan and Wonka 2016, Sec. 4.1).
//! - [`solid`]: houses as unions of prisms, and their closed surface.
//! - [`triangles`]: cities and buildings as triangles, and what is measured on them.
//! - [`vec3`]: arithmetic of points and directions.
//! - [`LabelGrid`]: a labelled image or any overlay of rectangles, as an irregular grid of cells.

mod annotated;
mod building;
mod building_error;
mod building_plan;
mod cleaning;
pub mod comparison;
mod components;
mod cuts;
mod decompose;
mod detailed;
mod elements;
mod facade;
mod hidden;
mod label_difference;
mod label_grid;
mod labelled;
mod photograph;
mod rect;
pub mod rectification;
pub mod solid;
mod splittable;
#[cfg(test)]
mod tests;
mod tiling;
pub mod triangles;
pub mod vec3;

/// The version of `rand` whose generators the functions here take.
pub use rand;

pub use annotated::{AnnotatedFacade, AnnotationError, Note};
pub use building::{
    BoxStyle, Building, ElementStyle, FacadeElement, FacadePiece, MassBox, Ridge, Roof, RoofStyle,
    Side, Special,
};
pub use building_error::BuildingError;
pub use building_plan::{PlanEdge, PlanUnion, Soundness, Visibility, visibility};
pub use cleaning::{
    DoorPlace, Lattice, ToleranceError, absorb_specks, clean, on_lattice, straighten,
};
pub use components::{Component, components};
pub use cuts::Cuts;
pub use decompose::{Decomposition, decompose};
pub use detailed::{DetailedBuilding, Part, PartKind, WallRect};
pub use elements::{BACKGROUND_LABELS, elements_of_facade, elements_of_grid, is_background};
pub use facade::{Facade, LayoutError, Region};
pub use hidden::Hidden;
pub use label_grid::{GridError, LabelGrid};
pub use labelled::Labelled;
pub use photograph::{Photograph, PhotographError, PhotographFormat};
pub use rect::{Axis, Rect};
pub use splittable::splittable;
pub use tiling::{IndexedLayout, RELATIVE_TOLERANCE, Span};
