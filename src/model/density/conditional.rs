//! A density given a value.

use serde::{Deserialize, Serialize};

use super::LogDensity;
use crate::ModelError;

/// `p(x | g)`: one density of x for each range of g.
///
/// The edges are quantiles of g, halfway between neighbours; below the first and above the last the outermost densities serve.
/// Between ranges the density is not continuous in g. [`Conditional::fit`] sorts n pairs, O(n log n), and fits the parts;
/// [`Conditional::given`] is O(log ranges).
///
/// # Examples
/// ```
/// use edifice_model::density::{Conditional, LogDensity, ScalarMixture};
/// // x is about 1 where g is below 10, and about 5 above.
/// let pairs: Vec<(f64, f64)> = (0..20)
///     .map(|g| (f64::from(g), if g < 10 { 1.0 } else { 5.0 } + 0.1 * f64::from(g % 3)))
///     .collect();
/// let density = Conditional::fit(&pairs, 2, |x| ScalarMixture::fit(x, 0.01, 1))?;
/// assert!(density.given(3.0).at(1.1) > density.given(3.0).at(5.1));
/// assert!(density.given(99.0).at(5.1) > density.given(99.0).at(1.1));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conditional<D> {
    /// The bounds between neighbouring ranges of g, ascending.
    edges: Vec<f64>,
    /// The density of each range; one more than edges.
    parts: Vec<D>,
}

impl<D: LogDensity> Conditional<D> {
    /// Splits pairs (g, x) into `ranges` ranges of g with as many pairs each (equal g stay together, so that
    /// there may be fewer ranges), and fits a density to the x of each.
    ///
    /// # Errors
    /// [`ModelError::Empty`] without pairs; what `fit` reports.
    pub fn fit(
        pairs: &[(f64, f64)],
        ranges: usize,
        mut fit: impl FnMut(&[f64]) -> Result<D, ModelError>,
    ) -> Result<Self, ModelError> {
        let mut sorted = pairs.to_vec();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut edges, mut parts) = (Vec::new(), Vec::new());
        let mut from = 0;
        for range in 1..=ranges.max(1) {
            let mut to = sorted.len() * range / ranges.max(1);
            while to > 0 && to < sorted.len() && sorted[to].0 <= sorted[to - 1].0 {
                to += 1;
            }
            if to <= from {
                continue;
            }
            let values: Vec<f64> = sorted[from..to].iter().map(|p| p.1).collect();
            parts.push(fit(&values)?);
            if to < sorted.len() {
                edges.push(0.5 * (sorted[to - 1].0 + sorted[to].0));
            }
            from = to;
        }
        if parts.is_empty() {
            return Err(ModelError::Empty { what: "pairs" });
        }
        Ok(Self { edges, parts })
    }

    /// The density of x where g is given.
    pub fn given(&self, g: f64) -> &D {
        let range = self.edges.partition_point(|edge| *edge < g);
        // A file may hold fewer parts than ranges; the last then serves for the rest.
        &self.parts[range.min(self.parts.len() - 1)]
    }

    /// True if there is a density for each range and the bounds are finite and ascending.
    pub fn is_whole(&self) -> bool {
        self.parts.len() == self.edges.len() + 1
            && self.edges.iter().all(|e| e.is_finite())
            && self.edges.is_sorted()
    }
}
