//! Reasons that a layout is not regularized.

use edifice_optim::qp::QpError;
use edifice_shape::{GridError, LayoutError};

/// Why a layout cannot be regularized.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegularizeError {
    /// The tolerance is negative or not a number.
    #[error("the tolerance is {0}, expected a number from 0")]
    Tolerance(f64),
    /// A length that must be positive is not.
    #[error("the length is {0}, expected a positive number")]
    NotPositive(f64),
    /// The label grid is not valid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// Not every region has a kind.
    #[error("{found} kinds are given for {expected} regions")]
    Kinds {
        /// Number of kinds.
        found: usize,
        /// Number of regions.
        expected: usize,
    },
    /// The layout is not a tiling.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The quadratic program failed.
    #[error(transparent)]
    Qp(#[from] QpError),
}
