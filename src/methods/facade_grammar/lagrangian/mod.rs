//! Lagrangian bound of the cost of all grammars, and the cheapest grammar met on the way.
//!
//! [`super`] has the theory: weak duality, and why the dual decouples. Here are the program (types, rules, occurrences), the
//! dynamic program over occurrences, the steps that raise the bound, and branch and bound.

mod ascent;
mod branch;
mod cliques;
mod derivation;
mod dual;
mod fixing;
mod incumbent;
mod program;
mod region_type;
mod require;
mod rules;

pub use branch::BoundLimits;
pub(crate) use branch::solve;
pub(crate) use incumbent::{Incumbent, NOISE};
pub(crate) use program::Program;

#[cfg(test)]
mod tests;
