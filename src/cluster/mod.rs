//! Grouping and ranking by distance: generic, no buildings.
//!
//! - [`chi_square`]: distance between two histograms.
//! - [`agglomerate`]: hierarchical clustering of a distance matrix, with its [`Dendrogram`].
//! - [`ward()`]: Ward's hierarchy of points in near-linear time; [`kmeans()`],
//!   [`kmeans_unweighted`] and [`lloyd`].
//! - [`shortest_description`]: how many clusters of a hierarchy the points ask for.
//! - [`girvan_newman`], [`louvain`], [`leiden`]: communities of graphs, and their [`modularity`].
//! - [`cumulative_match`]: how soon a ranked retrieval finds what is relevant; [`purity`].
//! - [`adjusted_rand_index`]: agreement of two partitions.

mod agglomerative;
mod agreement;
mod chi_square;
mod communities;
mod description;
mod kd_tree;
mod kmeans;
mod leiden;
mod moves;
mod retrieval;
mod ward;

/// The version of `nalgebra` whose matrices are in signatures here.
pub use nalgebra;
/// The version of `rand` whose generators the functions here take.
pub use rand;

pub use agglomerative::{Dendrogram, DistanceError, Linkage, Merge, agglomerate};
pub use agreement::adjusted_rand_index;
pub use chi_square::{Histogram, chi_square};
pub use communities::{
    Communities, WeightedGraph, girvan_newman, louvain, modularity, weighted_graph,
};
pub use description::shortest_description;
pub use kd_tree::KdTree;
pub use kmeans::{KMeans, kmeans, kmeans_unweighted, lloyd, means, sum_of_squares};
pub use leiden::leiden;
pub use retrieval::{
    MatchCurve, Protocol, Query, Ties, Unmatched, cumulative_match, match_curve, purity,
};
pub use ward::{WardError, WardMerge, WardTree, ward};
