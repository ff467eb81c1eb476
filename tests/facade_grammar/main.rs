//! Facade grammars: inference, bounds, claims and invariances.

#[path = "../common/mod.rs"]
mod common;
#[path = "../smallest_grammar/mod.rs"]
mod smallest_grammar;

mod board;
mod bound;
mod claims;
mod exact;
mod inference;
mod invariance;
mod operations;
mod regularization;
