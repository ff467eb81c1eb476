//! Regions of facades, and region *types*: regions with equal contents.
//!
//! Two non-terminal regions share a symbol when their contents are equal, terminal by terminal, in
//! label, offset and size up to floating-point noise (translational symmetry, Wu et al. 2014, Sec. 4.3). A terminal region's
//! type is its label, whatever its size.

mod cells;
mod layout_index;
mod lengths;
mod region;
mod strips;
mod types;

pub(crate) use cells::Cells;
pub(crate) use layout_index::LayoutIndex;
pub(crate) use region::{Region, TypeId, ends, part};
pub(crate) use strips::{Offsets, Strips};
pub(crate) use types::Types;
