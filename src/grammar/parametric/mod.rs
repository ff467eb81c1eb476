//! Parametric grammars: one library of rules for many facades (beyond Wu et al. 2014 and Weissenberg et al. 2013).
//!
//! # Rules without sizes and counts
//! A tiling is cut along all full lines of one direction, and so are its parts: its *parse tree*. Runs of equal
//! periods become repeats. What is left when all sizes and the counts of all repeats are taken out is a *rule*:
//! a direction and items, each a symbol or a repeat of symbols. Two regions share a rule exactly when they
//! agree up to sizes and counts; a facade is a root, and the counts and sizes of its derivation ([`Parse`]).
//!
//! | what | formula | where |
//! | --- | --- | --- |
//! | Wu's cost (Eq. 1 and 2) | `sum over distinct rules of (0.1 or 0.5) + symbols written`, with phrases that rules share | [`Sharing`] |
//! | bits of a facade | `-log2 p(root) - log2 p(W, H) - sum log2 p(counts) - sum log2 p(sizes)` | [`Library::bits`] |
//! | code | the same bits, written and read back | [`Library::encode`], [`Library::decode`] |
//!
//! Probabilities are those of one sequential model. What it knows comes from the library's facades; how far each
//! of its predictors is trusted is learnt by telling each of them by all others. Equal, repeated, mirrored and aligned sizes
//! within a facade share a parameter, since a size that was seen is cheap to say again (`sizes.rs`).
//!
//! | file | what |
//! | --- | --- |
//! | `tree.rs`, `collapse.rs`, `rules.rs` | parse trees, runs as repeats, the table of rules |
//! | `bodies.rs`, `phrases.rs` | rules as strings; shared phrases by an integer program |
//! | `coder.rs` | counting, writing, reading and drawing as one walk |
//! | `structure.rs`, `extents.rs`, `counts.rs`, `sizes.rs`, `codec.rs` | the model, part by part, and its walk |
//! | `library.rs`, `step.rs` | [`Library`]: learn, score, encode, decode |
//! | `separate.rs` | [`Separate`]: facades one by one, without a library |
//! | `draw.rs`, `recombine.rs`, `bands.rs` | new facades: sizes between two, floors of two, columns and floors more or less |
//! | `fixed.rs` | what one facade costs alone, sizes included |
//! | `written.rs`, `show.rs`, `names.rs` | a library as a split grammar, and as text |
//! | `named/`, `regions.rs` | a library, or one facade, as rules with named sizes and counts |
//!
//! # Deviations and readings
//! - Cuts are along horizontal lines where there are any: regions with full lines of both directions are rare in
//!   tilings of label pictures, which are cut floors first ([`edifice_shape::decompose`]).
//! - Repeats have periods of single symbols, without repeats inside.
//! - A proof of the cost holds for this parse and collapse: not over all grammars with parameters.
//! - All lengths are multiples of the library's step (a pixel). Facades off the step are refused, not rounded.

mod bands;
mod bodies;
mod codec;
mod coder;
mod collapse;
mod counts;
mod draw;
mod error;
mod extents;
mod fixed;
mod library;
mod named;
mod names;
mod phrases;
mod program;
mod recombine;
mod regions;
mod rules;
mod separate;
mod show;
mod sizes;
mod step;
mod structure;
#[cfg(test)]
mod tests;
mod texts;
mod tree;
mod written;

pub use bodies::{Bodies, Body, Letter};
pub use codec::Tables;
pub use coder::{Coder, Counter, Decoder, Drawer, Encoder};
pub use error::LibraryError;
pub use fixed::parse_cost;
pub use library::{Code, Library, Member};
pub use named::{AGREED, Attribute, Choice, Named, NamedItem, NamedPart, NamedRule, Spread};
pub use phrases::{LONGEST, Part, Sharing, Written, share};
pub use rules::{Item, Rule, Rules, Symbol};
pub use separate::Separate;
pub use sizes::SizeModel;
pub use tree::{Parse, STEP_LIMIT, Slot, slots};
