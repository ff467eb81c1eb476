//! The parts that every crate of Edifice shares: errors with their place, seeded random streams, whole files.

pub mod error;
pub mod file;
pub mod rng;

pub use error::{Error, Result};
