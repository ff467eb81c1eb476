//! Made layouts: perfect grids for the first test of a method ([`grids`]), and facades with the variety of real ones
//! ([`facades`]).

pub mod facades;
pub mod grids;
