//! Split grammars: rules, cost, derivation, text. Shared by three papers.
//!
//! A grammar `G(T, NT, s0, P)` maps non-terminal symbols to splitting operations on rectangles
//! (Wu et al. 2014, Sec. 3.1). A symbol with a rule is a non-terminal; one without is a terminal
//! label. One independent evaluator computes cost ([`Costs`]) and derives; no method reports its
//! own cost.

mod cost;
mod rule;

pub use cost::Costs;
pub use rule::{Grammar, Operation, Rule, Size, Start, Successor};
