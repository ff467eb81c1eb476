//! Limits of derivation: how exact sizes are, and how much one grammar may make.

/// Lengths are equal when they differ by at most this fraction of the facade's larger side.
pub const TOLERANCE: f64 = 1e-6;

/// A derivation of more regions than this, terminals and non-terminals, is refused: a grammar of a
/// few lines can describe more regions than there is memory.
pub const REGION_LIMIT: usize = 5_000_000;
