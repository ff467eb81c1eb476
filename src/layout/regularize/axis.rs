//! Regularization along one axis: which lines and sizes become equal, and where the lines go.

use super::classes::Class;
use super::differences::{Differences, SharedSize};
use super::error::RegularizeError;
use super::groups::{Cluster, Groups};
use super::lattice::Lattice;
use super::strips::Strips;
use edifice_optim::qp::{QpOptions, QuadraticProgram, Row, solve as solve_qp};

/// Cost of a change to the size of an element, relative to that of one of the background.
const ELEMENT: f64 = 8.0;

/// One axis of a layout; lengths are in units of the lattice.
pub(super) struct Axis<'a> {
    /// Positions of the cut lines.
    pub cuts: Vec<f64>,
    /// Length of edge on each line.
    pub weights: Vec<f64>,
    /// The areas between the lines.
    pub strips: Strips<'a>,
    /// Sizes that are equal.
    pub classes: Vec<Class>,
    /// Longest way that a line may move.
    pub reach: f64,
    /// The range of each line's position.
    pub ranges: Vec<[f64; 2]>,
    /// The lattice.
    pub lattice: Lattice,
}

impl Axis<'_> {
    /// New positions of all cut lines, in order, merged ones equal; `None` when no lines and no sizes
    /// become equal that were not.
    pub(super) fn solve(&self) -> Result<Option<Vec<f64>>, RegularizeError> {
        if self.lattice.whole && self.reach + 1e-6 < 1.0 {
            return Ok(None);
        }
        let own = |(number, class): (usize, &Class)| Cluster {
            classes: vec![number],
            wanted: class.size,
            value: class.size,
        };
        let mut clusters: Vec<Cluster> = self.classes.iter().enumerate().map(own).collect();
        let groups = self.merge_lines(&mut clusters);
        let before = clusters.len();
        self.merge_sizes(&groups, &mut clusters);
        if groups.center.len() == self.cuts.len() && clusters.len() == before {
            return Ok(None);
        }
        let Some(positions) = self.place(&groups, &clusters)? else {
            return Ok(None);
        };
        let moved: Vec<f64> = groups.of_line.iter().map(|&g| positions[g]).collect();
        Ok((moved != self.cuts).then_some(moved))
    }

    /// The constraints of groups and clusters.
    fn system(&self, groups: &Groups, clusters: &[Cluster]) -> Differences {
        let size = |cluster: &Cluster| {
            let members = || cluster.classes.iter().map(|&c| &self.classes[c]);
            let group = |&(from, to): &(usize, usize)| (groups.of_line[from], groups.of_line[to]);
            let mut spans: Vec<(usize, usize)> = members()
                .flat_map(|c| c.spans.iter().map(group))
                .filter(|(from, to)| from != to)
                .collect();
            spans.sort_unstable();
            spans.dedup();
            if spans.len() < 2 {
                // One alone may have any size.
                spans.clear();
            }
            let least = members().map(|c| c.size).fold(f64::INFINITY, f64::min);
            let most = members().map(|c| c.size).fold(0.0, f64::max);
            let behind = members().all(|c| c.behind);
            let unit = if self.lattice.whole { 1.0 } else { 0.5 * least };
            SharedSize {
                value: cluster.value,
                wanted: cluster.wanted,
                range: (
                    (most - 2.0 * self.reach).floor().max(unit),
                    (least + 2.0 * self.reach).ceil(),
                ),
                weight: if behind { 1.0 } else { ELEMENT },
                spans,
            }
        };
        Differences::new(
            groups.lower.clone(),
            groups.upper.clone(),
            &groups.gap,
            clusters.iter().map(size).collect(),
            self.lattice.whole,
            self.lattice.slack(),
        )
    }

    /// Finds sizes for the clusters that leave a solution; whether there are any.
    pub(super) fn settle(&self, groups: &Groups, clusters: &mut [Cluster]) -> bool {
        let mut system = self.system(groups, clusters);
        if system.solve().is_none() {
            // Once more, from what the merged lines make of the sizes.
            system = self.system(groups, clusters);
            for size in &mut system.sizes {
                let mut values: Vec<f64> = (size.spans.iter())
                    .map(|&(from, to)| groups.center[to] - groups.center[from])
                    .collect();
                values.sort_by(f64::total_cmp);
                if let Some(&middle) = values.get(values.len() / 2) {
                    size.value = middle.max(size.range.0).min(size.range.1);
                }
            }
            if system.solve().is_none() {
                return false;
            }
        }
        for (cluster, size) in clusters.iter_mut().zip(&system.sizes) {
            cluster.value = size.value;
        }
        true
    }

    /// Solves the quadratic program with the sizes of the clusters as they are; `None` where it has no solution.
    fn place(
        &self,
        groups: &Groups,
        clusters: &[Cluster],
    ) -> Result<Option<Vec<f64>>, RegularizeError> {
        let system = self.system(groups, clusters);
        let n = groups.center.len();
        let mut program = QuadraticProgram::new(n);
        for k in 0..n {
            program.pull(k, groups.center[k], groups.weight[k]);
            program.lower[k] = groups.lower[k];
            program.upper[k] = groups.upper[k];
        }
        for (k, &gap) in groups.gap.iter().enumerate() {
            let row = Row::new([(k, 1.0), (k + 1, -1.0)], -gap);
            program.inequalities.push(row);
        }
        for size in &system.sizes {
            for &(from, to) in &size.spans {
                let row = Row::new([(to, 1.0), (from, -1.0)], size.value);
                program.equalities.push(row);
            }
        }
        let found = solve_qp(&program, QpOptions::default())?;
        if let Some(best) = found.best {
            let positions = match self.lattice.whole {
                true => round_together(&best),
                false => best,
            };
            if system.holds(&positions) {
                return Ok(Some(positions));
            }
        }
        // The solver stalled: any solution will do.
        Ok(system.least_solution().ok())
    }
}

/// Rounds all numbers at one threshold, which keeps every whole bound on their differences. The
/// threshold is laid where no fraction is near, lest the solver's last digit decides.
pub(super) fn round_together(values: &[f64]) -> Vec<f64> {
    let mut fractions: Vec<f64> = values.iter().map(|v| v - v.floor()).collect();
    fractions.extend([0.25, 0.75]);
    fractions.retain(|f| (0.25..=0.75).contains(f));
    fractions.sort_by(f64::total_cmp);
    let widest = fractions
        .windows(2)
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let threshold = widest.map_or(0.5, |pair| 0.5 * (pair[0] + pair[1]));
    values
        .iter()
        .map(|v| (v + 1.0 - threshold).floor())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_where_no_fraction_is_near() {
        // The widest gap of the fractions is from .34 to .75, though that from .25 to .30 begins lower.
        assert_eq!(round_together(&[2.30, 7.32, 1.34]), [2.0, 7.0, 1.0]);
        // From .25 to .62: all of these are above.
        assert_eq!(round_together(&[2.62, 7.66, 1.70]), [3.0, 8.0, 2.0]);
        // From .30 to .68, between them.
        assert_eq!(round_together(&[0.30, 5.68]), [0.0, 6.0]);
        assert_eq!(
            round_together(&[4.0, 4.9, -0.1, -1.0]),
            [4.0, 5.0, 0.0, -1.0]
        );
    }
}
