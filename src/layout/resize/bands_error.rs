//! The limit of other sizes by bands, and what can be wrong with them.

use edifice_shape::Axis;

/// Bands are chosen one after another: a facade that becomes larger than so many times its own size is refused.
pub const MOST_TIMES: f64 = 20.0;

/// Why a facade cannot be brought to another size by bands.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BandsError {
    /// The facade is no tiling.
    #[error(transparent)]
    Layout(#[from] edifice_shape::LayoutError),
    /// The new size is too large.
    #[error(
        "{times:.0} times its own size along {axis:?} is more than the {MOST_TIMES} times to which columns and floors are repeated"
    )]
    Size {
        /// The new size over the own one.
        times: f64,
        /// The axis.
        axis: Axis,
    },
}
