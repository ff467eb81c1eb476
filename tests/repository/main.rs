//! The repository itself: shipped data, sizes, installed program, artefacts.

mod datasets;
mod experiments;
mod installed;
mod prose;
#[cfg(unix)]
mod sizes;
