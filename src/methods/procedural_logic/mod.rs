//! Procedural logic: rules, retrieval and new facades from labelled images.
//!
//! Weissenberg, Riemenschneider, Prasad, Van Gool: *Is there a Procedural Logic to Architecture?*,
//! CVPR 2013.
//!
//! # The method
//! A facade is a picture of labels `l` of an alphabet `L`; an *edge* is a straight line between
//! different labels. A scope is split at the proposal `p` (a full line of the scope with an edge on
//! it that crosses no perpendicular edge) of least energy
//! ```text
//! f(p) = b_h(p) b_p(p) ( alpha 1/W sum_x e_x + (1 - alpha) 1/W sum_x v_d(x, y) )        (Eq. 3)
//! ```
//! where `e_x` is 0 on an edge and 1 elsewhere, `v_d` the affinity `c_d(l, l*)` between an edge's
//! asset and the one that faces it (Eq. 6, 7), `b_h <= 1` on horizontal lines (Eq. 4), and
//! `b_p <= 1` on lines in the direction of the last split (Eq. 5). Affinities are co-occurrences of
//! facing assets over all facades, weighted by their distance (Eq. 8). The recursion gives a binary
//! split tree ([`parse`]).
//!
//! Nested splits in one direction become one n-ary split ([`NaryTree`], Eq. 9). Nodes with the same
//! operation and the same children, whatever their sizes, become one parametric rule, bottom-up and
//! online ([`RuleSet`], Eq. 10); a facade is then a starting rule and a parameter vector
//! ([`Instance`]). [`fewest_rules`] minimizes `|R|` over `alpha`, `b_p`, `b_h` (Eq. 12);
//! [`Measure`] compares facades (Sec. 4.3); [`Style`] draws new ones (Sec. 4.4);
//! [`split_grammar`] writes one facade as a split grammar; [`baseline_grammar`] does so for a tiling
//! whose regions stay whole, the baseline of Wu et al. 2014, Table 2.
//!
//! # Deviations and readings
//! - *`W` in Eq. 3* ("the size of the facade"): pixels of the facade's width outside the scope count
//!   `e_x = 1`, so that long lines are cheap, as the text wants ([`Extent::Line`]). Under this
//!   reading, and only under it, ECP2011 gives 68 rules for all parameters of Sec. 5.3, the paper's
//!   number. The other readings stay available ([`Extent`]).
//! - *Crossing* (condition b): a line is blocked where a perpendicular edge of one asset passes
//!   through it; where four different pieces meet in a corner, it is not. When no line of a scope
//!   qualifies, lines that only touch corners are tried, then those that cut fewest edges
//!   ([`BinaryTree::forced`] counts them): so every picture parses, and losslessly.
//! - *Facing edge* (Eq. 6): the asset beyond the next edge along the normal, across what lies
//!   between ([`Facing::Across`]); of the two sides of an edge the mean is taken, no facing asset
//!   counts zero. [`Facing::Adjacent`] takes the asset on the other side of the edge itself.
//! - *"Normalized"* (Eq. 8): each matrix is divided by its largest entry.
//! - *Ties* go to horizontal lines, then to the lowest coordinate, so that equal layouts parse equal.
//! - *N-ary splits of one facade's grammar* ([`baseline_grammar`]): all nested splits of one direction are joined first (Eq. 9)
//!   and equal parts found then (Eq. 10), in the order of the text. So the order of lines in one direction is forgotten, and the
//!   parameters decide only about parts that full lines split in both directions. [`Joining`] has two other readings, which
//!   no table's column uses: equal parts first, or no joining at all.
//! - *Counting rules*: split rules; an insert belongs to the rule that calls it. Eq. 11 counts
//!   inserts too before inference, and absorbs them afterwards.
//! - *Powersets*: every node of the binary tree, leaves included, counts for the set of operations
//!   and labels at and below it.
//! - *Common rules*: the chi-square runs over the rules that both facades use, as the text says; over
//!   the rules of either it retrieves far better ([`Measure::AllRules`]).
//! - *Synthesis*: width and height join the parameter vector, so that mean, components and samples
//!   all fill the facade; draws with a size that is not positive are thrown away. A starting rule that
//!   one facade has borrows the proportions of the facades with the most similar structures
//!   ([`Style::similar`]); the paper does not say what becomes of it.
//! - *Labels with noise* (from a segmentation) are cleaned before the method sees them
//!   ([`clean`](edifice_shape::clean)), when asked: the method itself stays lossless.

mod affinity;
mod features;
mod inference;
mod model;
mod model_file;
mod parameters;
mod parsing;
mod rules;
mod search;
mod split_grammar;
mod synthesis;

/// The version of `nalgebra` whose matrices are in signatures here.
pub use nalgebra;
/// The version of `rand` whose generators the functions here take.
pub use rand;

use parsing::{alphabet, canvas, lines, nary, parse};
use split_grammar::{baseline, joining};

pub use affinity::{Affinity, Coefficients};
pub use alphabet::Alphabet;
pub use baseline::{BaselineError, baseline_grammar, baseline_grammar_joining, picture_grammar};
pub use canvas::Canvas;
pub use features::{AssetSet, Measure, Profile};
pub use inference::{Inference, learn_affinity};
pub use joining::Joining;
pub use model::{FitError, Known, Model, ProfileError};
pub use model_file::{MODEL_FORMAT, MODEL_VERSION, ModelFile, ModelFileError};
pub use nary::{NaryNode, NaryTree};
pub use parameters::{Extent, Facing, ParameterError, Parameters};
pub use parsing::parse::{BinaryNode, BinaryTree, NoSplit, parse};
pub use rules::{Call, Instance, InstanceError, ParametricRule, RuleSet};
pub use search::{fewest_rules, search_axes};
pub use split_grammar::split_grammar;
pub use synthesis::{Style, StyleError, starting_rules, vector};
