//! Procedural logic (Weissenberg et al. 2013).

mod affinity;
mod alphabet;
mod baseline;
mod canvas;
mod features;
mod inference;
mod lines;
mod model;
mod model_file;
mod nary;
mod parameters;
mod parse;
mod rules;
mod search;
mod split_grammar;
mod synthesis;

pub use affinity::{Affinity, Coefficients};
pub use alphabet::Alphabet;
pub use baseline::{BaselineError, baseline_grammar};
pub use canvas::Canvas;
pub use features::{AssetSet, Measure, Profile};
pub use inference::{Inference, learn_affinity};
pub use model::{FitError, Known, Model, ProfileError};
pub use model_file::{MODEL_FORMAT, MODEL_VERSION, ModelFile, ModelFileError};
pub use nary::{NaryNode, NaryTree};
pub use parameters::{Extent, Facing, ParameterError, Parameters};
pub use parse::{BinaryNode, BinaryTree, NoSplit, parse};
pub use rules::{Call, Instance, InstanceError, ParametricRule, RuleSet};
pub use search::{fewest_rules, search_axes};
pub use split_grammar::split_grammar;
pub use synthesis::{Style, StyleError, starting_rules, vector};
