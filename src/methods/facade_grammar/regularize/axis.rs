//! Regularization along one axis; the program is stated in the parent module.

use super::RegularizeError;
use super::differences::{Difference, Differences};
use super::sizes::{Cluster, choose_sizes};
use crate::optim::qp::{QpOptions, QpOutcome, QuadraticProgram, Row, solve as solve_qp};

/// Parts of the tolerance that are told apart when the input is not in whole numbers.
const FINENESS: f64 = 256.0;

/// A stretch of one area along a strip, between cut lines `from` and `to`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// Background and odd shapes are served after elements.
    pub behind: bool,
    /// Label number; only runs of one label become equal.
    pub label: u16,
    /// Cut line at its start.
    pub from: usize,
    /// Cut line at its end.
    pub to: usize,
    /// Thickness of the strips with this run, summed.
    pub weight: f64,
}

/// The areas of all cells, strip by strip.
#[derive(Clone, Copy)]
pub struct Strips<'a> {
    /// Area of each cell.
    pub cells: &'a [u32],
    /// Whether each cell may vanish although its area does not continue beside it.
    pub yields: &'a [bool],
    /// Cells in a strip.
    pub length: usize,
    /// Label number of each area.
    pub labels: &'a [u16],
}

impl<'a> Strips<'a> {
    /// The strips.
    pub fn rows(self) -> impl Iterator<Item = &'a [u32]> {
        self.cells.chunks_exact(self.length)
    }

    /// Whether the cells between lines `first` and `last` can vanish: in each strip they continue what
    /// lies before, then what lies behind; a `narrow` stretch between the two may vanish when all of it
    /// yields and no two areas of one label come to touch.
    fn can_vanish(self, first: usize, last: usize, narrow: impl Fn(usize, usize) -> bool) -> bool {
        let yields = self.yields.chunks_exact(self.length);
        self.rows().zip(yields).all(|(row, yields)| {
            let before = first.checked_sub(1).map(|k| row[k]);
            let behind = row.get(last).copied();
            let from = (first..last)
                .find(|&k| Some(row[k]) != before)
                .unwrap_or(last);
            let to = (from..last)
                .rev()
                .find(|&k| Some(row[k]) != behind)
                .map_or(from, |k| k + 1);
            let label = |area: u32| self.labels[area as usize];
            let touch = |(a, b): (u32, u32)| a != b && label(a) == label(b);
            from == to
                || narrow(from, to)
                    && yields[from..to].iter().all(|&y| y)
                    && !before.zip(behind).is_some_and(touch)
        })
    }
}

/// New positions of all cut lines, in order; merged ones are equal.
pub fn solve(
    cuts: &[f64],
    weights: &[f64],
    runs: &[Run],
    strips: Strips,
    tolerance: f64,
) -> Result<Vec<f64>, RegularizeError> {
    let quantum = quantum(cuts, tolerance);
    let groups = merge_lines(cuts, weights, strips, tolerance, quantum);
    let Some(mut system) = groups.system() else {
        // No room to move at all: the tolerance is below the quantum.
        return Ok(cuts.to_vec());
    };
    let mut clusters = choose_sizes(
        &groups.of_line,
        &groups.center,
        runs,
        tolerance / quantum,
        &mut system,
    );

    // Sizes: as the program would have them, rounded, where that stays feasible.
    let (_, sizes) = groups.program(&clusters, true)?;
    for (k, size) in sizes.into_iter().enumerate() {
        let tried = size.round() as i64;
        let old = std::mem::replace(&mut clusters[k].size, tried);
        if tried != old {
            match groups.system_with(&clusters) {
                Some(better) => system = better,
                None => clusters[k].size = old,
            }
        }
    }
    let (positions, _) = groups.program(&clusters, false)?;
    let rounded = round_together(&positions);
    let whole = match system.holds(&rounded, &groups.lower) {
        true => rounded,
        false => system.values().to_vec(),
    };
    // The total size is kept to the bit.
    let end = groups.of_line[cuts.len() - 1];
    let position = |&group: &usize| match group == end {
        true => cuts[cuts.len() - 1],
        false => whole[group] as f64 * quantum,
    };
    let moved = groups.of_line.iter().map(position).collect();
    Ok(moved)
}

/// The unit of positions: one if the input is in whole numbers, else a fraction of the tolerance that
/// divides the total size.
fn quantum(cuts: &[f64], tolerance: f64) -> f64 {
    let total = cuts[cuts.len() - 1];
    if cuts.iter().all(|c| (c - c.round()).abs() <= 1e-9 * total) {
        1.0
    } else {
        total / (total * FINENESS / tolerance).round().clamp(1.0, 1e12)
    }
}

/// Cut lines, merged into groups that share a position; everything in quanta.
struct Groups {
    /// Group of each line.
    of_line: Vec<usize>,
    /// Where the lines of each group want to be, on average, and how much.
    center: Vec<f64>,
    weight: Vec<f64>,
    lower: Vec<i64>,
    upper: Vec<i64>,
    /// Least distance of each group to the next.
    gap: Vec<i64>,
}

impl Groups {
    /// Groups of consecutive lines, given the first line of each.
    fn new(firsts: &[usize], cuts: &[f64], weights: &[f64], tolerance: f64, quantum: f64) -> Self {
        let ends = firsts[1..].iter().copied().chain([cuts.len()]);
        let mut groups = Self {
            of_line: vec![0; cuts.len()],
            center: Vec::new(),
            weight: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
            gap: Vec::new(),
        };
        for (number, (first, end)) in firsts.iter().copied().zip(ends).enumerate() {
            groups.of_line[first..end].fill(number);
            let weight: f64 = weights[first..end].iter().sum();
            let at = |k: usize| cuts[k] / quantum;
            let moment: f64 = (first..end).map(|k| weights[k] * at(k)).sum();
            let center = if weight > 0.0 {
                moment / weight
            } else {
                at(first)
            };
            // A hair's breadth of rounding must not cost a whole quantum.
            let reach = tolerance / quantum + 1e-9;
            let (mut lower, mut upper) = (at(end - 1) - reach, at(first) + reach);
            if first == 0 || end == cuts.len() {
                let fixed = if first == 0 { at(0) } else { at(end - 1) };
                (lower, upper) = (fixed.round(), fixed.round());
            }
            groups.center.push(center);
            groups.weight.push(weight.max(1e-3));
            groups.lower.push(lower.ceil() as i64);
            groups.upper.push(upper.floor() as i64);
            if end < cuts.len() {
                let distance = at(end) - at(end - 1);
                groups.gap.push(((distance / 2.0).floor() as i64).max(1));
            }
        }
        groups
    }

    /// The constraints of order and bounds; `None` when they leave no solution.
    fn system(&self) -> Option<Differences> {
        let mut system = Differences::new(self.lower.clone(), self.upper.clone())?;
        let order: Vec<Difference> = (self.gap.iter().enumerate())
            .map(|(k, &least)| Difference {
                from: k,
                to: k + 1,
                least,
            })
            .collect();
        system.add(&order).then_some(system)
    }

    fn system_with(&self, clusters: &[Cluster]) -> Option<Differences> {
        let mut system = self.system()?;
        let all: Vec<Difference> = clusters.iter().flat_map(Cluster::constraints).collect();
        system.add(&all).then_some(system)
    }

    /// Solves the quadratic program, with the sizes of the clusters free or as they are. Returns
    /// positions and sizes; where the solver stalls, the centres and the sizes as they are.
    fn program(
        &self,
        clusters: &[Cluster],
        free: bool,
    ) -> Result<(Vec<f64>, Vec<f64>), RegularizeError> {
        let n = self.center.len();
        let extra = if free { clusters.len() } else { 0 };
        let mut program = QuadraticProgram::new(n + extra);
        for k in 0..n {
            program.pull(k, self.center[k], self.weight[k]);
            program.lower[k] = self.lower[k] as f64;
            program.upper[k] = self.upper[k] as f64;
        }
        for (k, &gap) in self.gap.iter().enumerate() {
            let row = Row::new([(k, 1.0), (k + 1, -1.0)], -gap as f64);
            program.inequalities.push(row);
        }
        for (c, cluster) in clusters.iter().enumerate() {
            for &(from, to) in &cluster.members {
                let ends = [(to, 1.0), (from, -1.0)];
                program.equalities.push(if free {
                    Row::new(ends.into_iter().chain([(n + c, -1.0)]), 0.0)
                } else {
                    Row::new(ends, cluster.size as f64)
                });
            }
        }
        let mut x = solve_qp(&program, QpOptions::default())?;
        let solved = matches!(x.outcome, QpOutcome::Converged | QpOutcome::AlmostConverged);
        if solved && x.x.iter().all(|v| v.is_finite()) {
            let sizes = x.x.split_off(n);
            Ok((x.x, sizes))
        } else {
            let sizes = clusters.iter().map(|c| c.size as f64);
            Ok((self.center.clone(), sizes.take(extra).collect()))
        }
    }
}

/// Merges neighbouring lines, nearest first, that can meet without moving further than the tolerance.
fn merge_lines(
    cuts: &[f64],
    weights: &[f64],
    strips: Strips,
    tolerance: f64,
    quantum: f64,
) -> Groups {
    let mut firsts: Vec<usize> = (0..cuts.len()).collect();
    let build = |firsts: &[usize]| Groups::new(firsts, cuts, weights, tolerance, quantum);
    let last_of = |firsts: &[usize], g: usize| firsts.get(g + 1).map_or(cuts.len(), |&f| f) - 1;
    // Boundaries between groups (by their line) that cannot go.
    let mut fixed = vec![false; cuts.len()];
    loop {
        let spread = |g: usize| cuts[last_of(&firsts, g)] - cuts[firsts[g - 1]];
        let candidates = (1..firsts.len()).filter(|&g| !fixed[firsts[g]]);
        // The ends of the layout stay where they are; elsewhere both lines may move.
        let at_an_end = |g: usize| firsts[g - 1] == 0 || last_of(&firsts, g) + 1 == cuts.len();
        let reach = |g: usize| tolerance * if at_an_end(g) { 1.0 } else { 2.0 };
        let near = candidates.filter(|&g| spread(g) <= reach(g));
        let Some(g) = near.min_by(|&a, &b| spread(a).total_cmp(&spread(b))) else {
            return build(&firsts);
        };
        let line = firsts.remove(g);
        let (first, last) = (firsts[g - 1], last_of(&firsts, g - 1));
        let narrow = |from: usize, to: usize| cuts[to] - cuts[from] <= tolerance;
        if !strips.can_vanish(first, last, narrow) || build(&firsts).system().is_none() {
            firsts.insert(g, line);
            fixed[line] = true;
        }
    }
}

/// Rounds all numbers at one threshold, which keeps every whole bound on their differences. The
/// threshold is laid where no fraction is near, lest the solver's last digit decides.
fn round_together(values: &[f64]) -> Vec<i64> {
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
        .map(|v| (v + 1.0 - threshold).floor() as i64)
        .collect()
}
