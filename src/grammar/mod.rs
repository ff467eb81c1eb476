//! Split grammars: rules, cost, derivation, text. Shared by three papers.
//!
//! A grammar `G(T, NT, s0, P)` maps non-terminal symbols to splitting operations on rectangles
//! (Wu et al. 2014, Sec. 3.1). A symbol with a rule is a non-terminal; one without is a terminal
//! label. One independent evaluator ([`evaluate()`]) computes cost ([`Costs`]) and derives
//! ([`derive()`]); no method reports its own cost.

mod check;
mod combine;
mod cost;
mod derive;
mod error;
mod evaluate;
pub mod instance;
mod limits;
mod listing;
pub mod parametric;
mod place;
mod resize;
mod rule;
mod sample;
mod table;
#[cfg(test)]
mod tests;
mod tiling;
mod weights;

/// The version of `rand` whose generators the functions here take.
pub use rand;

pub use check::check;
pub use combine::{LEAST_SIMILARITY, combine};
pub use cost::{CostError, Costs};
pub use derive::{Derivation, NonTerminal, derivation, derive};
pub use error::{GrammarError, Warning};
pub use evaluate::{EvaluateError, Evaluation, evaluate};
pub use limits::{REGION_LIMIT, TOLERANCE};
pub use listing::listing;
pub use place::{LEAST_SHARE, laid_out};
pub use resize::{THIN_OF_FACADE, THIN_OF_NEIGHBOUR, scaled, size_independent};
pub use rule::{Grammar, Operation, Rule, Size, Start, Successor};
pub use sample::{Sampler, derive_at};
pub use tiling::{Difference, same_tiling, tiling_difference};
pub use weights::summable;
