//! The choice of the lines along one axis that become one.

use super::axis::Axis;
use super::groups::{Cluster, Groups};

impl Axis<'_> {
    /// Merges lines that can meet. Leaders, those with most edge within reach, stay where they are as far
    /// as possible; of the lines beside them, the nearest join first.
    pub(super) fn merge_lines(&self, clusters: &mut [Cluster]) -> Groups {
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

    /// True if nothing is lost between the lines that follow a leader.
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
            let mut lower = ranges
                .iter()
                .fold(cuts[end - 1] - self.reach, |l, r| l.max(r[0]));
            let mut upper = ranges
                .iter()
                .fold(cuts[first] + self.reach, |u, r| u.min(r[1]));
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
}
