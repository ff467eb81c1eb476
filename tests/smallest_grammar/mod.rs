//! The smallest split grammar of small layouts, by exact search over sets of region types.
//!
//! This is the reference that inference is judged by, so it shares no code with it. It knows no places: a
//! *type* is a [`Content`], the terminals of a rectangle in integer coordinates from its own corner, and two
//! regions have one type when their contents are equal. A grammar is a set of non-terminal types that holds
//! the facades, with one rule for each. Given the set, rules are independent of each other, so
//!
//! ```text
//! cost(S) = sum over t in S of the cheapest rule of t whose non-terminal successors all lie in S.
//! ```
//!
//! - [`smallest()`] minimizes `cost(S)` by branch and bound: a type is in `S` or not.
//! - [`brute_force()`] enumerates rules as sequences of parts, and whole grammars of them, without any bound. It
//!   judges [`smallest()`] on tiny layouts.

mod brute_force;
mod catalogue;
pub mod compare;
mod content;
mod landmarks;
pub mod layouts;
mod network;
mod search;
mod write;

pub use brute_force::brute_force;
pub use content::Content;
pub use search::{Limits, smallest};

use edifice_facade_grammar::Operations;

/// Every set of operations: the split always, each other operation or not.
pub fn operation_sets() -> impl Iterator<Item = Operations> {
    (0..16).map(|bits| Operations {
        repeat: bits & 1 != 0,
        repeat_aba: bits & 2 != 0,
        sym_split: bits & 4 != 0,
        grid_split: bits & 8 != 0,
    })
}
