//! Procedural logic: rules, baselines, noise and commands.

#[path = "../common/mod.rs"]
mod common;

mod baseline;
mod cli;
mod inference;
mod noise;
mod shipped;
