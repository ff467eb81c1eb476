//! Procedural logic (Weissenberg et al. 2013).

mod affinity;
mod alphabet;
mod baseline;
mod canvas;
mod lines;
mod nary;
mod parameters;
mod parse;
mod rules;

pub use affinity::{Affinity, Coefficients};
pub use alphabet::Alphabet;
pub use baseline::{BaselineError, baseline_grammar};
pub use canvas::Canvas;
pub use nary::{NaryNode, NaryTree};
pub use parameters::{Extent, Facing, ParameterError, Parameters};
pub use parse::{BinaryNode, BinaryTree, NoSplit, parse};
pub use rules::{Call, Instance, InstanceError, ParametricRule, RuleSet};
