//! The repository itself: shipped data, sizes, installed program, artefacts.

#[path = "../common/cases.rs"]
mod cases;
mod datasets;
mod experiments;
mod formats;
#[cfg(unix)]
mod help_examples;
mod installed;
mod lines;
mod program;
mod programs;
mod prose;
mod quoted;
mod reports;
#[cfg(unix)]
mod sizes;
