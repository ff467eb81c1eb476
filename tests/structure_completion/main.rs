//! Structure completion: search, score, chain, weights and commands.

mod bad_input;
#[path = "../common/cases.rs"]
mod cases;
mod chain;
mod coherence;
mod commands;
#[path = "../common/doors.rs"]
mod doors;
mod meaning;
mod optimizers;
mod policy;
mod score;
mod search;
mod support;
mod weights;
