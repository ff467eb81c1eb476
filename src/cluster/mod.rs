//! Grouping and ranking by distance: generic, no buildings.
//!
//! - [`chi_square`]: distance between two histograms.
//! - [`agglomerate`]: hierarchical clustering of a distance matrix, with its [`Dendrogram`].
//! - [`cumulative_match`]: how soon a ranked retrieval finds what is relevant; [`purity`].
//! - [`adjusted_rand_index`]: agreement of two partitions.

mod agglomerative;
mod agreement;
mod chi_square;
mod retrieval;

pub use agglomerative::{Dendrogram, DistanceError, Linkage, Merge, agglomerate};
pub use agreement::adjusted_rand_index;
pub use chi_square::{Histogram, chi_square};
pub use retrieval::{
    MatchCurve, Protocol, Query, Ties, Unmatched, cumulative_match, match_curve, purity,
};
