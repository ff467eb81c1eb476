//! Facade grammars: inference, bounds, claims and invariances.

#[path = "../common/mod.rs"]
mod common;

mod board;
mod bound;
mod claims;
mod exact;
mod inference;
mod invariance;
mod operations;
mod regularization;
