//! Numbers of distinct sizes.

use std::collections::{BTreeMap, BTreeSet};

use super::classes::levels;
use super::lattice::SAME;
use edifice_shape::{Facade, LabelGrid, Span, components};

/// Number of distinct sizes (width and height) of each label; those within a ten-millionth of the longer
/// side of the layout are one.
fn distinct(longer: f64, sizes: &[(&str, f64, f64)]) -> BTreeMap<String, usize> {
    let numbers = |of: fn(&(&str, f64, f64)) -> f64| {
        levels(sizes.iter().map(of).collect::<Vec<_>>(), SAME * longer)
    };
    let (widths, heights) = (numbers(|s| s.1), numbers(|s| s.2));
    let mut found: BTreeMap<String, BTreeSet<(usize, usize)>> = BTreeMap::new();
    for (k, (label, ..)) in sizes.iter().enumerate() {
        let of_label = found.entry(label.to_string()).or_default();
        of_label.insert((widths[k], heights[k]));
    }
    let count = |(label, sizes): (String, BTreeSet<_>)| (label, sizes.len());
    found.into_iter().map(count).collect()
}

/// Number of distinct sizes of the areas of each label; of those that are not rectangles, the sizes of
/// the rectangles around them. And the number of areas of each label.
pub(super) fn of_areas(grid: &LabelGrid) -> (BTreeMap<String, usize>, BTreeMap<String, usize>) {
    let (columns, rows) = (grid.columns(), grid.rows());
    let whole = Span {
        left: 0,
        right: columns,
        bottom: 0,
        top: rows,
    };
    let mut sizes = Vec::new();
    let mut count = BTreeMap::new();
    for area in components(grid, whole, &mut vec![0; grid.cells.len()]) {
        let b = area.bounds;
        let width = grid.xs[b.right] - grid.xs[b.left];
        let height = grid.ys[b.top] - grid.ys[b.bottom];
        let label = grid.labels[usize::from(area.label)].as_str();
        sizes.push((label, width, height));
        *count.entry(label.to_string()).or_default() += 1;
    }
    (distinct(grid.xs[columns].max(grid.ys[rows]), &sizes), count)
}

/// Number of distinct sizes of the regions of each label.
pub(super) fn of_regions(facade: &Facade) -> BTreeMap<String, usize> {
    let size = |r: &edifice_shape::Region| (r.rect.width, r.rect.height);
    let sizes: Vec<(&str, f64, f64)> = (facade.regions.iter())
        .map(|r| (r.label.as_str(), size(r).0, size(r).1))
        .collect();
    distinct(facade.width.max(facade.height), &sizes)
}
