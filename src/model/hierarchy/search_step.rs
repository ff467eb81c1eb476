//! A configuration that a search accepted.

/// One accepted configuration of the search, for [`Learned::trace`](super::Learned::trace) and [`Observer`](super::Observer)s.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SearchStep {
    /// |S|.
    pub styles: usize,
    /// |H_g| of every real group, in order.
    pub cardinalities: Vec<usize>,
    /// Number of lateral edges.
    pub lateral_edges: usize,
    /// Cheeseman-Stutz score, nats, on standardised columns of the rows searched.
    pub score: f64,
}
