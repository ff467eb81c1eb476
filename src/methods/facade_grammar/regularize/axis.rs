//! Regularization along one axis: which lines and sizes become equal, and where the lines go.

use super::RegularizeError;
use super::classes::Class;
use super::differences::{Differences, SharedSize};
use super::lattice::Lattice;
use super::strips::Strips;
use crate::optim::qp::{QpOptions, QpOutcome, QuadraticProgram, Row, solve as solve_qp};

/// How much dearer it is to change the size of an element than one of the background.
const ELEMENT: f64 = 8.0;

/// Most sizes that may turn out not to fit before no more are tried, for time on large layouts.
const MAX_REFUSALS: usize = 60;

/// One axis of a layout; lengths are in units of the lattice.
pub struct Axis<'a> {
    /// Positions of the cut lines.
    pub cuts: Vec<f64>,
    /// Length of edge on each line.
    pub weights: Vec<f64>,
    /// What lies between the lines.
    pub strips: Strips<'a>,
    /// Sizes that are equal.
    pub classes: Vec<Class>,
    /// Longest way that a line may move.
    pub reach: f64,
    /// Where each line may be.
    pub ranges: Vec<[f64; 2]>,
    /// The lattice.
    pub lattice: Lattice,
}

/// Cut lines, merged into groups that share a position.
struct Groups {
    /// Group of each line.
    of_line: Vec<usize>,
    /// Where the lines of each group want to be, on average, and how much.
    center: Vec<f64>,
    weight: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Least distance of each group to the next.
    gap: Vec<f64>,
}

/// Classes of sizes that have become one.
#[derive(Debug, Clone)]
struct Cluster {
    /// Their numbers.
    classes: Vec<usize>,
    /// Size that they should have.
    wanted: f64,
    /// Size that they have.
    value: f64,
}

impl Cluster {
    /// The class that it began with.
    fn lead(&self) -> usize {
        self.classes[0]
    }
}

impl Axis<'_> {
    /// New positions of all cut lines, in order, merged ones equal; `None` when no lines and no sizes
    /// become equal that were not.
    pub fn solve(&self) -> Result<Option<Vec<f64>>, RegularizeError> {
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

    /// Merges lines that can meet. Leaders, those with most edge within reach, stay where they are as far
    /// as possible; of the lines beside them, the nearest join first.
    fn merge_lines(&self, clusters: &mut [Cluster]) -> Groups {
        let cuts = &self.cuts;
        let end = cuts.len() - 1;
        let near = |a: usize, b: usize| (cuts[a] - cuts[b]).abs() <= self.reach + 1e-6;
        let mut leads = vec![None; cuts.len()];
        let mut open: Vec<usize> = (0..=end).collect();
        while !open.is_empty() {
            let score = |&leader: &usize| {
                let from = cuts.partition_point(|&c| c < cuts[leader] - self.reach - 1e-6);
                let window = (from..=end).take_while(|&k| near(k, leader));
                let around = window.filter(|&k| leads[k].is_none());
                let sums = around.fold((0.0, 0.0), |(sum, far), k| {
                    let distance = (cuts[leader] - cuts[k]).abs();
                    (sum + self.weights[k], far + self.weights[k] * distance)
                });
                // The ends of the layout stay where they are.
                (leader == 0 || leader == end, sums)
            };
            let better = |a: &&usize, b: &&usize| {
                let ((end_a, (sum_a, far_a)), (end_b, (sum_b, far_b))) = (score(a), score(b));
                (end_b.cmp(&end_a))
                    .then(sum_b.total_cmp(&sum_a))
                    .then(far_a.total_cmp(&far_b))
                    .then(a.cmp(b))
            };
            let Some(&leader) = open.iter().min_by(better) else {
                break;
            };
            leads[leader] = Some(leader);
            for side in [-1isize, 1] {
                let mut at = leader;
                while let Some(next) = at.checked_add_signed(side).filter(|&k| k <= end) {
                    if leads[next].is_some() || !near(next, leader) {
                        break;
                    }
                    leads[next] = Some(leader);
                    if !self.may_meet(leader, &leads) {
                        leads[next] = None;
                        break;
                    }
                    at = next;
                }
            }
            open.retain(|&k| leads[k].is_none());
        }
        let followers = |&k: &usize| leads[k].is_some_and(|leader| leader != k);
        let mut wanted: Vec<usize> = (0..=end).filter(followers).collect();
        // Away from the leader, so that each line that is refused refuses those beyond it.
        wanted.sort_by_key(|&k| leads[k].map(|leader| (leader, leader.abs_diff(k))));
        let wanted: Vec<(usize, usize)> = (wanted.into_iter())
            .filter_map(|k| leads[k].map(|leader| (k, leader)))
            .collect();
        let mut taken = vec![None; cuts.len()];
        self.follow(&wanted, &mut taken, clusters);
        self.groups(&taken)
    }

    /// Lets lines follow their leaders, all at once if possible: ends of equal sizes can only meet
    /// together.
    fn follow(
        &self,
        wanted: &[(usize, usize)],
        taken: &mut Vec<Option<usize>>,
        clusters: &mut [Cluster],
    ) {
        let mut trial = taken.clone();
        for &(line, leader) in wanted {
            let toward = if line < leader { line + 1 } else { line - 1 };
            if toward == leader || trial[toward] == Some(leader) {
                (trial[line], trial[leader]) = (Some(leader), Some(leader));
            }
        }
        if trial == *taken {
            return;
        }
        if self.settle(&self.groups(&trial), clusters) {
            *taken = trial;
        } else if wanted.len() > 1 {
            let (first, second) = wanted.split_at(wanted.len() / 2);
            self.follow(first, taken, clusters);
            self.follow(second, taken, clusters);
        }
    }

    /// Whether nothing is lost between the lines that follow a leader.
    fn may_meet(&self, leader: usize, leads: &[Option<usize>]) -> bool {
        let cuts = &self.cuts;
        let narrow = |from: usize, to: usize| cuts[to] - cuts[from] <= self.reach + 1e-6;
        let mut mine = (0..cuts.len()).filter(|&k| leads[k] == Some(leader));
        let first = mine.next().unwrap_or(leader);
        let last = mine.next_back().unwrap_or(first);
        self.strips.can_vanish(first, last, narrow)
    }

    /// Groups of lines that follow one leader; others stand alone.
    fn groups(&self, leads: &[Option<usize>]) -> Groups {
        let (cuts, weights) = (&self.cuts, &self.weights);
        let lead = |k: usize| leads[k].unwrap_or(k);
        let mut groups = Groups {
            of_line: vec![0; cuts.len()],
            center: Vec::new(),
            weight: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
            gap: Vec::new(),
        };
        let mut first = 0;
        for end in 1..=cuts.len() {
            if end < cuts.len() && lead(end) == lead(first) {
                continue;
            }
            let weight: f64 = weights[first..end].iter().sum();
            let ranges = &self.ranges[first..end];
            let mut lower = ranges.iter().fold(cuts[end - 1] - self.reach, |l, r| l.max(r[0]));
            let mut upper = ranges.iter().fold(cuts[first] + self.reach, |u, r| u.min(r[1]));
            if first == 0 || end == cuts.len() {
                let fixed = if first == 0 { cuts[0] } else { cuts[end - 1] };
                (lower, upper) = (fixed, fixed);
            }
            if self.lattice.whole {
                // A hair's breadth of rounding must not cost a whole unit.
                (lower, upper) = ((lower - 1e-6).ceil(), (upper + 1e-6).floor());
            }
            groups.of_line[first..end].fill(groups.center.len());
            groups.center.push(cuts[lead(first)]);
            groups.weight.push(weight.max(1e-3));
            groups.lower.push(lower);
            groups.upper.push(upper);
            if end < cuts.len() {
                groups.gap.push(self.gap(cuts[end] - cuts[end - 1]));
            }
            first = end;
        }
        groups
    }

    /// Least distance that remains of one between lines: half, and out of reach if it was.
    fn gap(&self, distance: f64) -> f64 {
        let apart = self.reach.floor() + if self.lattice.whole { 1.0 } else { 0.01 };
        let least = match distance > self.reach + 1e-6 {
            true => (0.5 * distance).max(apart.min(distance)),
            false => 0.5 * distance,
        };
        match self.lattice.whole {
            true => least.floor().max(1.0),
            false => least,
        }
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
    fn settle(&self, groups: &Groups, clusters: &mut [Cluster]) -> bool {
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

    /// Makes nearly equal sizes of one label equal. Leaders, those with most others within reach, keep
    /// their size as far as possible.
    fn merge_sizes(&self, groups: &Groups, clusters: &mut Vec<Cluster>) {
        // Sizes that lines alone decide are what the lines have become.
        for cluster in clusters.iter_mut() {
            let class = &self.classes[cluster.classes[0]];
            let (from, to) = class.spans[0];
            let ends = (groups.of_line[from], groups.of_line[to]);
            if class.spans.len() == 1 {
                cluster.value = groups.center[ends.1] - groups.center[ends.0];
                if self.lattice.whole {
                    cluster.value = cluster.value.round();
                }
                cluster.wanted = cluster.value;
            }
        }
        let mut kinds: Vec<(bool, u16)> =
            self.classes.iter().map(|c| (c.behind, c.label)).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let mut refusals = 0;
        for kind in kinds {
            self.merge_kind(kind, groups, clusters, &mut refusals);
        }
    }

    fn merge_kind(
        &self,
        kind: (bool, u16),
        groups: &Groups,
        clusters: &mut Vec<Cluster>,
        refusals: &mut usize,
    ) {
        let stays = |class: &Class| {
            let (from, to) = class.spans[0];
            groups.of_line[from] != groups.of_line[to]
        };
        let of_kind = |c: &&Cluster| {
            let class = &self.classes[c.classes[0]];
            (class.behind, class.label) == kind && stays(class)
        };
        let mut open: Vec<usize> = clusters.iter().filter(of_kind).map(Cluster::lead).collect();
        while !open.is_empty() {
            let mut values = vec![0.0; self.classes.len()];
            for cluster in clusters.iter() {
                values[cluster.lead()] = cluster.value;
            }
            let near = |a: usize, b: usize| {
                // A size has two ends.
                let within = |x: f64, y: f64| (x - y).abs() <= 2.0 * self.reach + 1e-6;
                let across = self.classes[a].across.zip(self.classes[b].across);
                within(values[a], values[b]) && across.is_none_or(|(x, y)| within(x, y))
            };
            let others = |leader: usize| {
                let open = open.iter().copied();
                open.filter(move |&other| other != leader && near(leader, other))
            };
            // What is near nothing stays as it is.
            let scored = open.iter().filter_map(|&leader| {
                others(leader).next()?;
                let own = (self.classes[leader].weight, 0.0);
                let sums = others(leader).fold(own, |(sum, far), other| {
                    let weight = self.classes[other].weight;
                    (
                        sum + weight,
                        far + weight * (values[leader] - values[other]).abs(),
                    )
                });
                Some((leader, sums))
            });
            let better = |a: &(usize, (f64, f64)), b: &(usize, (f64, f64))| {
                let ((sum_a, far_a), (sum_b, far_b)) = (a.1, b.1);
                sum_b
                    .total_cmp(&sum_a)
                    .then(far_a.total_cmp(&far_b))
                    .then(values[a.0].total_cmp(&values[b.0]))
                    .then(a.0.cmp(&b.0))
            };
            let Some((leader, _)) = scored.min_by(better) else {
                return;
            };
            let mut around: Vec<usize> = others(leader).collect();
            around.sort_by(|&a, &b| {
                let distance = |c: usize| (values[c] - values[leader]).abs();
                distance(a)
                    .total_cmp(&distance(b))
                    .then(self.classes[b].weight.total_cmp(&self.classes[a].weight))
            });
            let joined = self.join(leader, &around, groups, clusters, refusals);
            open.retain(|c| *c != leader && !joined.contains(c));
        }
    }

    /// Joins to a leader as many as can be, all at once if possible. Returns those that joined.
    fn join(
        &self,
        leader: usize,
        others: &[usize],
        groups: &Groups,
        clusters: &mut Vec<Cluster>,
        refusals: &mut usize,
    ) -> Vec<usize> {
        if others.is_empty() || *refusals == MAX_REFUSALS {
            return Vec::new();
        }
        let (gone, mut trial): (Vec<Cluster>, Vec<Cluster>) =
            (clusters.iter().cloned()).partition(|c| others.contains(&c.lead()));
        if let Some(first) = trial.iter_mut().find(|c| c.lead() == leader) {
            first.classes.extend(gone.iter().flat_map(|c| &c.classes));
            first.value = first.wanted;
        }
        if self.settle(groups, &mut trial) {
            *clusters = trial;
            return others.to_vec();
        }
        *refusals += 1;
        if others.len() == 1 {
            return Vec::new();
        }
        let (near, far) = others.split_at(others.len().div_ceil(2));
        let mut joined = self.join(leader, near, groups, clusters, refusals);
        joined.extend(self.join(leader, far, groups, clusters, refusals));
        joined
    }

    /// Solves the quadratic program with the sizes of the clusters as they are; `None` where it has no solution.
    fn place(&self, groups: &Groups, clusters: &[Cluster]) -> Result<Option<Vec<f64>>, RegularizeError> {
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
        let solved = matches!(
            found.outcome,
            QpOutcome::Converged | QpOutcome::AlmostConverged
        );
        if solved && found.x.iter().all(|v| v.is_finite()) {
            let positions = match self.lattice.whole {
                true => round_together(&found.x),
                false => found.x,
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
pub fn round_together(values: &[f64]) -> Vec<f64> {
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
