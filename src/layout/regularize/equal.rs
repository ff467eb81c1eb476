//! The choice of the sizes along one axis that become equal.

use super::axis::Axis;
use super::classes::Class;
use super::groups::{Cluster, Groups};

/// Most sizes that may turn out not to fit before no more are tried, for time on large layouts.
const MAX_REFUSALS: usize = 60;

impl Axis<'_> {
    /// Makes nearly equal sizes of one label equal. Leaders, those with most others within reach, keep
    /// their size as far as possible.
    pub(super) fn merge_sizes(&self, groups: &Groups, clusters: &mut Vec<Cluster>) {
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
}
