//! Regions of facades, and region *types*: regions with equal contents.
//!
//! Two non-terminal regions share a symbol when their contents are equal, terminal by terminal, in
//! label, offset and size (translational symmetry, Wu et al. 2014, Sec. 4.3). A terminal region's
//! type is its label, whatever its size.

mod cells;
mod sheet;
mod types;

pub(crate) use cells::Cells;
pub(crate) use sheet::{Region, Sheet};
pub(crate) use types::{Strips, TypeId, Types, ends, part};
