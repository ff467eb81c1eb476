//! Which sizes become equal: clusters of nearly equal sizes, as large as constraints allow.

use super::axis::Run;
use super::differences::{Difference, Differences, exactly};

/// Most sizes that are tried for one cluster.
const MAX_TRIES: usize = 65;

/// Most sizes that are tried for a part of a cluster.
const MAX_PARTIAL_TRIES: usize = 9;

/// Sizes that became one.
pub struct Cluster {
    /// Groups of lines at both ends of each member.
    pub members: Vec<(usize, usize)>,
    /// The size that all members get.
    pub size: i64,
}

impl Cluster {
    /// The constraints that give every member the size.
    pub fn constraints(&self) -> impl Iterator<Item = Difference> + '_ {
        let member = |&(from, to): &(usize, usize)| exactly(from, to, self.size);
        self.members.iter().flat_map(member)
    }
}

/// A size that occurs: the runs that have it.
#[derive(Clone)]
struct Size {
    value: f64,
    weight: f64,
    members: Vec<(usize, usize)>,
}

impl Size {
    fn constraints(&self, size: i64) -> impl Iterator<Item = Difference> + '_ {
        self.members
            .iter()
            .flat_map(move |&(from, to)| exactly(from, to, size))
    }
}

/// Clusters sizes of one label, elements first, heavy ones first, and gives each cluster one size, by
/// constraints added to `system`. `of_line` and `center` are the group of each cut line and where the
/// groups lie; all lengths are in quanta.
pub fn choose_sizes(
    of_line: &[usize],
    center: &[f64],
    runs: &[Run],
    tolerance: f64,
    system: &mut Differences,
) -> Vec<Cluster> {
    let mut sizes: Vec<(bool, u16, Size)> = Vec::new();
    for run in runs {
        let ends = (of_line[run.from], of_line[run.to]);
        let known = |(behind, label, size): &&mut (bool, u16, Size)| {
            (*behind, *label) == (run.behind, run.label) && size.members[0] == ends
        };
        if ends.0 == ends.1 {
            continue;
        }
        match sizes.iter_mut().find(known) {
            Some((_, _, size)) => size.weight += run.weight,
            None => {
                let value = center[ends.1] - center[ends.0];
                let size = Size {
                    value,
                    weight: run.weight,
                    members: vec![ends],
                };
                sizes.push((run.behind, run.label, size));
            }
        }
    }
    sizes.sort_by(|a, b| {
        (a.0, a.1)
            .cmp(&(b.0, b.1))
            .then(a.2.value.total_cmp(&b.2.value))
    });
    let kinds = sizes.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
    let mut candidates: Vec<(bool, f64, Vec<Size>)> = Vec::new();
    for kind in kinds {
        let list = kind.iter().map(|(_, _, size)| size.clone()).collect();
        for cluster in agglomerate(list, tolerance) {
            let weight = cluster.iter().map(|s| s.weight).sum();
            candidates.push((kind[0].0, weight, cluster));
        }
    }
    candidates.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let mut chosen = Vec::new();
    for (_, _, cluster) in candidates {
        settle(cluster, tolerance, system, &mut chosen);
    }
    chosen
}

/// Clusters sorted sizes: the two neighbours that make the tightest cluster are joined, as long as
/// the cluster lies within twice the tolerance: a size has two ends that may move.
fn agglomerate(sizes: Vec<Size>, tolerance: f64) -> Vec<Vec<Size>> {
    let mut clusters: Vec<Vec<Size>> = sizes.into_iter().map(|s| vec![s]).collect();
    let low = |c: &[Size]| c[0].value;
    let high = |c: &[Size]| c[c.len() - 1].value;
    loop {
        let spread = |k: &usize| high(&clusters[k + 1]) - low(&clusters[*k]);
        let pairs = 0..clusters.len().saturating_sub(1);
        let tightest = pairs.min_by(|a, b| spread(a).total_cmp(&spread(b)));
        match tightest {
            Some(k) if spread(&k) <= 2.0 * tolerance => {
                let mut next = clusters.remove(k + 1);
                clusters[k].append(&mut next);
            }
            _ => return clusters,
        }
    }
}

/// Gives a cluster one size. Where no size fits all, the one that fits most is given to those whom it
/// fits, and the rest is a cluster of its own.
fn settle(cluster: Vec<Size>, tolerance: f64, system: &mut Differences, out: &mut Vec<Cluster>) {
    let mut rest = cluster;
    while rest.iter().map(|s| s.members.len()).sum::<usize>() > 1 {
        let target = weighted_median(&rest);
        let sizes = tries(target, tolerance);
        let all = |size: i64| {
            rest.iter()
                .flat_map(move |s| s.constraints(size))
                .collect::<Vec<_>>()
        };
        if let Some(size) = sizes.iter().copied().find(|&size| system.add(&all(size))) {
            let members = rest.iter().flat_map(|s| s.members.clone()).collect();
            out.push(Cluster { members, size });
            return;
        }
        let mut best: Option<(f64, i64, Vec<bool>, Differences)> = None;
        for size in sizes.into_iter().take(MAX_PARTIAL_TRIES) {
            let mut trial = system.clone();
            let mut fits = vec![false; rest.len()];
            // Those that are nearest to the size first: they need to move least.
            let mut order: Vec<usize> = (0..rest.len()).collect();
            let distance = |k: usize| (rest[k].value - size as f64).abs();
            order.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
            let mut weight = 0.0;
            for k in order {
                let constraints: Vec<Difference> = rest[k].constraints(size).collect();
                fits[k] = trial.add(&constraints);
                weight += if fits[k] { rest[k].weight } else { 0.0 };
            }
            if best.as_ref().is_none_or(|(most, ..)| weight > *most) {
                best = Some((weight, size, fits, trial));
            }
        }
        let Some((_, size, fits, trial)) = best else {
            return;
        };
        let mut fit = fits.into_iter();
        let (together, others): (Vec<Size>, Vec<Size>) =
            rest.into_iter().partition(|_| fit.next().unwrap_or(false));
        let members: Vec<(usize, usize)> = together.into_iter().flat_map(|s| s.members).collect();
        // One alone needs no constraint; none means that nothing here can be helped.
        match members.len() {
            0 => return,
            1 => {}
            _ => {
                *system = trial;
                out.push(Cluster { members, size });
            }
        }
        rest = others;
    }
}

fn weighted_median(sizes: &[Size]) -> f64 {
    let half: f64 = sizes.iter().map(|s| s.weight).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    for size in sizes {
        sum += size.weight;
        if sum >= half {
            return size.value;
        }
    }
    0.0
}

/// Whole sizes to try, nearest to the target first, within the tolerance.
fn tries(target: f64, tolerance: f64) -> Vec<i64> {
    let middle = target.round() as i64;
    let reach = tolerance.floor() as i64;
    let step = (2 * reach / MAX_TRIES as i64).max(1);
    let mut sizes: Vec<i64> = (-reach / step..=reach / step)
        .map(|k| middle + k * step)
        .collect();
    sizes.retain(|&s| s > 0);
    sizes.sort_by(|a, b| {
        (*a as f64 - target)
            .abs()
            .total_cmp(&(*b as f64 - target).abs())
    });
    sizes
}
