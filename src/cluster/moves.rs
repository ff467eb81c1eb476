//! One move of a node among communities: the step that Louvain (Blondel et al. 2008) and Leiden (Traag et al. 2019) share.

use std::collections::BTreeMap;

/// Weight from a node to each label around it; `neighbours` are the other ends of its edges, with their weights.
pub(crate) fn links(neighbours: &[(usize, f64)], label: &[usize]) -> BTreeMap<usize, f64> {
    let mut links = BTreeMap::new();
    for &(w, weight) in neighbours {
        *links.entry(label[w]).or_default() += weight;
    }
    links
}

/// The label by which a node gains most modularity; its own where none is better by more than rounding. `sum` holds the
/// degrees of each label without the node, `total` the weight of all edges. Joining label c, over standing alone, gains
/// `links[c] - degree * sum[c] / (2 total)`, times the total weight.
pub(crate) fn best_label(
    links: &BTreeMap<usize, f64>,
    own: usize,
    degree: f64,
    total: f64,
    sum: &[f64],
) -> usize {
    let gain = |c: usize, weight: f64| weight - degree * sum[c] / (2.0 * total);
    let mut best = (gain(own, links.get(&own).copied().unwrap_or(0.0)), own);
    for (&c, &weight) in links {
        let g = gain(c, weight);
        if g > best.0 + 1e-12 * total {
            best = (g, c);
        }
    }
    best.1
}
