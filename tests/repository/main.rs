//! The repository itself: shipped data, sizes, installed program, artefacts.

mod datasets;
mod experiments;
mod formats;
mod installed;
mod prose;
#[cfg(unix)]
mod sizes;
