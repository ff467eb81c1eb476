//! The papers' shared nouns: geometry of facades and buildings.
//!
//! - [`Rect`]: an axis-parallel rectangle, origin at the lower left, y up.
//! - [`Facade`]: labelled rectangles inside a rectangular domain (Wu et al. 2014, Sec. 3.1).
//! - [`LabelGrid`]: a labelled image or any overlay of rectangles, as an irregular grid of cells.

mod components;
mod cuts;
mod decompose;
mod facade;
mod label_grid;
mod rect;
mod splittable;
mod tiling;

pub use cuts::Cuts;
pub use decompose::{Decomposition, decompose};
pub use facade::{Facade, LayoutError, Region};
pub use label_grid::{GridError, LabelGrid};
pub use rect::{Axis, Rect};
pub use splittable::splittable;
pub use tiling::{IndexedLayout, RELATIVE_TOLERANCE, Span};
