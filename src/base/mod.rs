//! The parts that every crate of Edifice shares: errors with their place, seeded random streams, whole files, cells of
//! CSV, the progress of long calls.

pub mod csv;
pub mod error;
pub mod file;
pub mod progress;
pub mod rng;

/// The version of `rand` whose generators the functions here take.
pub use rand;

pub use error::{Error, Result};
pub use progress::{Ended, Progress, Watch, Watched, unwatched};
