//! The part of Eq. 5 that counts what a line cuts (Fig. 8).

use super::protection::contains;
use super::symmetry::Repeated;
use crate::regions::{Region, Strips, Types, ends};
use edifice_shape::Axis;

/// Occurrences of repeated regions and their terminals: per layout and bottom row, sorted by left edge.
#[derive(Debug)]
pub(crate) struct Occurrences(Vec<Vec<Vec<(Region, f64)>>>);

impl Occurrences {
    pub(crate) fn new(types: &Types, repeated: &[Repeated]) -> Self {
        let mut occurrences: Vec<Vec<Vec<(Region, f64)>>> = types
            .layouts
            .iter()
            .map(|s| vec![Vec::new(); s.ys.len()])
            .collect();
        for group in repeated {
            for &region in &group.occurrences {
                occurrences[usize::from(region.layout)][usize::from(region.y0)]
                    .push((region, f64::from(group.terminals)));
            }
        }
        for row in occurrences.iter_mut().flatten() {
            row.sort_by_key(|(r, _)| (r.x0, r.x1, r.y1));
        }
        Self(occurrences)
    }

    /// `cost_sl` of every cut of a region (Fig. 8).
    pub(crate) fn line_costs(
        &self,
        region: Region,
        terminals: f64,
        axis: Axis,
        strips: &Strips,
    ) -> Vec<f64> {
        let mut costs = vec![0.0; strips.cuts.len() + 1];
        for row in
            &self.0[usize::from(region.layout)][usize::from(region.y0)..usize::from(region.y1)]
        {
            let first = row.partition_point(|(r, _)| r.x0 < region.x0);
            for (r, weight) in row[first..].iter().take_while(|(r, _)| r.x0 < region.x1) {
                if *r == region || !contains(region, *r) {
                    continue;
                }
                let (from, to) = ends(*r, axis);
                costs[strips.cuts.partition_point(|&c| c <= from)] += weight;
                costs[strips.cuts.partition_point(|&c| c < to)] -= weight;
            }
        }
        let mut sum = 0.0;
        for cost in &mut costs {
            sum += *cost;
            *cost = sum / terminals;
        }
        costs
    }
}
