//! The sizes that are equal before regularization, and so stay equal.

use std::collections::BTreeMap;

use edifice_shape::Span;

/// Sizes along one axis that are equal, and stay so.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Class {
    /// Background is served after elements.
    pub behind: bool,
    /// Label number; only sizes of one label become equal.
    pub label: u16,
    /// The size, in units of the lattice.
    pub size: f64,
    /// The size across, where only areas that are near in both become equal.
    pub across: Option<f64>,
    /// Edge across, summed.
    pub weight: f64,
    /// Cut lines at both ends of each.
    pub spans: Vec<(usize, usize)>,
}

/// A rectangle between cut lines whose size counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    /// True if it is of the background.
    pub behind: bool,
    /// Label number.
    pub label: u16,
    /// True if it may become equal along one axis to others that are not near across; otherwise only to those that are
    /// near in both.
    pub strict: bool,
    /// Cut lines around it.
    pub span: Span,
}

/// The classes along x and along y. `xs` and `ys` are in units; sizes that differ by less than `same` are equal.
pub(super) fn classes(
    extents: &[Extent],
    xs: &[f64],
    ys: &[f64],
    same: f64,
) -> (Vec<Class>, Vec<Class>) {
    let width = |e: &Extent| xs[e.span.right] - xs[e.span.left];
    let height = |e: &Extent| ys[e.span.top] - ys[e.span.bottom];
    let widths = levels(extents.iter().map(width).collect(), same);
    let heights = levels(extents.iter().map(height).collect(), same);
    let along = |across: bool| {
        let mut found: BTreeMap<(bool, u16, usize, usize), Class> = BTreeMap::new();
        for (k, extent) in extents.iter().enumerate() {
            let s = extent.span;
            let (mine, other, size, weight, span) = match across {
                false => {
                    let span = (s.left, s.right);
                    (widths[k], heights[k], width(extent), height(extent), span)
                }
                true => {
                    let span = (s.bottom, s.top);
                    (heights[k], widths[k], height(extent), width(extent), span)
                }
            };
            let key = (extent.behind, extent.label, mine, other);
            let class = found.entry(key).or_insert_with(|| Class {
                behind: extent.behind,
                label: extent.label,
                size,
                across: (!extent.strict).then_some(weight),
                weight: 0.0,
                spans: Vec::new(),
            });
            class.weight += weight;
            if !class.spans.contains(&span) {
                class.spans.push(span);
            }
        }
        found.into_values().collect()
    };
    (along(false), along(true))
}

/// Numbers sizes so that those that differ by less than `same` from their neighbour have one number.
pub(super) fn levels(sizes: Vec<f64>, same: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&a, &b| sizes[a].total_cmp(&sizes[b]));
    let mut level = vec![0; sizes.len()];
    for pair in order.windows(2) {
        let step = usize::from(sizes[pair[1]] - sizes[pair[0]] > same);
        level[pair[1]] = level[pair[0]] + step;
    }
    level
}
