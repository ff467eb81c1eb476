//! Alignment of a resized layout along one axis: equal terminals first, then aligned edges.
//!
//! ```text
//! minimise    sum_k w_k (v_k - x_k)^2           x_k: derived cut lines, w_k: length of edge on them
//! subject to  v_0 = 0, v_n = W, |v_k - x_k| <= reach
//!             v_r - v_l >= (x_r - x_l) / 2      every region (l, r) keeps half its size
//!             v_r - v_l = s_c                   every element (l, r) of kind c has its size s_c
//!             v_i = v_j                         lines merged so far
//! ```
//! solved anew after merges of neighbouring lines, nearest first: more and more pairs at once while that has a
//! solution, fewer when it has none, and a pair that has none alone stays apart. In every strip the regions stay in order, so that the layout stays a
//! tiling; lines of different floors may pass each other. If kinds have no solution even without a
//! merge, they are admitted one by one, those with most edge first, and the others keep the sizes
//! that the derivation gave them.

use std::collections::{BTreeMap, BTreeSet};

use super::error::RegularizeError;
use super::strips::Run;
use edifice_optim::qp::{QpOptions, QuadraticProgram, Row, solve as solve_qp};

/// Share of its derived size that every region keeps.
const LEAST_SHARE: f64 = 0.5;

/// New positions of all cut lines; merged ones are equal.
pub(super) fn solve(
    cuts: &[f64],
    weights: &[f64],
    runs: &[Run],
    reach: f64,
    tolerance: f64,
) -> Result<Vec<f64>, RegularizeError> {
    let mut lines = Lines {
        cuts,
        weights,
        runs,
        reach,
        group: (0..cuts.len()).collect(),
        kinds: kinds(runs),
    };
    let mut positions = match lines.place()? {
        Some(positions) => positions,
        None => lines.admit()?,
    };
    // Pairs of groups (by their first lines) that cannot merge.
    let mut apart = BTreeSet::new();
    // Pairs merged at once.
    let mut batch = 1;
    loop {
        let mut firsts: Vec<usize> = (0..cuts.len()).filter(|&k| lines.group[k] == k).collect();
        firsts.sort_by(|&a, &b| positions[a].total_cmp(&positions[b]).then(a.cmp(&b)));
        let pairs = firsts.windows(2).map(|pair| (pair[0], pair[1]));
        let distance = |(a, b): (usize, usize)| positions[b] - positions[a];
        let near = pairs.filter(|&pair| distance(pair) <= tolerance && !apart.contains(&pair));
        let mut near: Vec<(usize, usize)> = near.collect();
        if near.is_empty() {
            return Ok(positions);
        }
        near.sort_by(|&p, &q| distance(p).total_cmp(&distance(q)));
        let before = lines.group.clone();
        let merged = lines.merge(&near, batch);
        match lines.place()? {
            Some(placed) => {
                positions = placed;
                batch = 2 * merged;
            }
            None => {
                lines.group = before;
                if merged == 1 {
                    let (a, b) = near[0];
                    apart.extend([(a, b), (b, a)]);
                }
                batch = (merged / 2).max(1);
            }
        }
    }
}

/// The elements of each kind that occurs more than once, by the lines at both ends; the kind with
/// most edge comes first.
fn kinds(runs: &[Run]) -> Vec<Vec<(usize, usize)>> {
    let mut kinds: BTreeMap<u16, (f64, Vec<(usize, usize)>)> = BTreeMap::new();
    for run in runs.iter().filter(|run| !run.behind) {
        let kind = kinds.entry(run.label).or_default();
        kind.0 += run.weight;
        kind.1.push((run.from, run.to));
    }
    let mut kinds: Vec<_> = kinds
        .into_values()
        .filter(|kind| kind.1.len() > 1)
        .collect();
    kinds.sort_by(|a, b| b.0.total_cmp(&a.0));
    kinds.into_iter().map(|kind| kind.1).collect()
}

/// The derived cut lines, and what binds them.
struct Lines<'a> {
    cuts: &'a [f64],
    weights: &'a [f64],
    runs: &'a [Run],
    reach: f64,
    /// First line of the group that each line belongs to; the lines of a group are one.
    group: Vec<usize>,
    kinds: Vec<Vec<(usize, usize)>>,
}

impl Lines<'_> {
    /// Merges the first pairs of groups, at most `most`, of which no two share a group; returns how many.
    fn merge(&mut self, pairs: &[(usize, usize)], most: usize) -> usize {
        let mut touched = BTreeSet::new();
        let mut count = 0;
        for &(a, b) in pairs {
            if count == most {
                break;
            }
            if touched.contains(&a) || touched.contains(&b) {
                continue;
            }
            touched.extend([a, b]);
            count += 1;
            let (first, second) = (a.min(b), a.max(b));
            for group in self.group.iter_mut().filter(|group| **group == second) {
                *group = first;
            }
        }
        count
    }

    /// Keeps the kinds that can have one size together, in order, and places the lines.
    fn admit(&mut self) -> Result<Vec<f64>, RegularizeError> {
        let mut positions = self.cuts.to_vec();
        for kind in std::mem::take(&mut self.kinds) {
            self.kinds.push(kind);
            match self.place()? {
                Some(placed) => positions = placed,
                None => drop(self.kinds.pop()),
            }
        }
        Ok(positions)
    }

    /// Solves the program; `None` when it has no solution.
    fn place(&self) -> Result<Option<Vec<f64>>, RegularizeError> {
        let (cuts, n) = (self.cuts, self.cuts.len());
        let mut program = QuadraticProgram::new(n + self.kinds.len());
        for (k, &cut) in cuts.iter().enumerate() {
            program.pull(k, cut, self.weights[k].max(1e-3));
            program.lower[k] = cut - self.reach;
            program.upper[k] = cut + self.reach;
            if self.group[k] != k {
                let same = Row::new([(k, 1.0), (self.group[k], -1.0)], 0.0);
                program.equalities.push(same);
            }
        }
        for k in [0, n - 1] {
            (program.lower[k], program.upper[k]) = (cuts[k], cuts[k]);
        }
        let spans: BTreeSet<(usize, usize)> = self.runs.iter().map(|r| (r.from, r.to)).collect();
        for (from, to) in spans {
            if self.group[from] == self.group[to] {
                return Ok(None);
            }
            let least = LEAST_SHARE * (cuts[to] - cuts[from]);
            let keeps = Row::new([(from, 1.0), (to, -1.0)], -least);
            program.inequalities.push(keeps);
        }
        for (c, kind) in self.kinds.iter().enumerate() {
            for &(from, to) in kind {
                let size = [(to, 1.0), (from, -1.0), (n + c, -1.0)];
                program.equalities.push(Row::new(size, 0.0));
            }
        }
        let found = solve_qp(&program, QpOptions::default())?;
        let Some(best) = found.best else {
            return Ok(None);
        };
        // Lines of a group are equal, and the sides stay, to the bit.
        let position = |&first: &usize| match first {
            0 => cuts[0],
            first if self.group[n - 1] == first => cuts[n - 1],
            first => best[first],
        };
        Ok(Some(self.group.iter().map(position).collect()))
    }
}
