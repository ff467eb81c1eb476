//! The trivial baseline of retrieval: how many connected areas of each label a facade has.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use edifice_shape::{LabelGrid, Span, components};

/// Name in files.
pub const NAME: &str = "component_counts";

/// `L1` distances between the counts of connected areas per label; it knows no splits and no rules.
pub fn distances(grids: &[LabelGrid]) -> DMatrix<f64> {
    let counts: Vec<BTreeMap<&str, f64>> = grids.iter().map(counts).collect();
    DMatrix::from_fn(grids.len(), grids.len(), |a, b| {
        let (a, b) = (&counts[a], &counts[b]);
        let other = |of: &BTreeMap<&str, f64>, label: &str| of.get(label).copied().unwrap_or(0.0);
        let own: f64 = a.iter().map(|(label, n)| (n - other(b, label)).abs()).sum();
        let missing = b.iter().filter(|(label, _)| !a.contains_key(*label));
        own + missing.map(|(_, n)| n).sum::<f64>()
    })
}

/// Number of connected areas of each label.
fn counts(grid: &LabelGrid) -> BTreeMap<&str, f64> {
    let whole = Span {
        left: 0,
        right: grid.columns(),
        bottom: 0,
        top: grid.rows(),
    };
    let mut counts = BTreeMap::new();
    for component in components(grid, whole, &mut vec![0; grid.cells.len()]) {
        let label = grid.labels[usize::from(component.label)].as_str();
        *counts.entry(label).or_insert(0.0) += 1.0;
    }
    counts
}
