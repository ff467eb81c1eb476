//! Maximal cliques of overlapping occurrences.

use crate::regions::Region;

/// The largest groups of regions that share a corner of one of them, each by its indices.
pub(super) fn cliques(regions: &[Region]) -> Vec<Vec<u32>> {
    let covering = |corner: &Region| -> Vec<u32> {
        let covers = |r: &Region| {
            r.layout == corner.layout
                && (r.x0..r.x1).contains(&corner.x0)
                && (r.y0..r.y1).contains(&corner.y0)
        };
        (0..regions.len() as u32)
            .filter(|&i| covers(&regions[i as usize]))
            .collect()
    };
    let mut groups: Vec<Vec<u32>> = regions.iter().map(covering).collect();
    groups.sort_by(|a, b| b.len().cmp(&a.len()).then_with(|| a.cmp(b)));
    let mut largest: Vec<Vec<u32>> = Vec::new();
    for group in groups {
        let within = |other: &Vec<u32>| group.iter().all(|i| other.binary_search(i).is_ok());
        if !largest.iter().any(within) {
            largest.push(group);
        }
    }
    largest
}
