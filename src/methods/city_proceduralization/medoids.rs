//! Representatives of types: medoids under the mismatched volume.

use rayon::prelude::*;

use super::components::CELLS;
use super::types::Use;

/// Rounds of medoids.
const ROUNDS: usize = 3;
/// Representatives that a component is compared with, nearest in features first.
const CANDIDATES: usize = 12;
/// Members that are tried as medoid, nearest to the mean first.
const TRIED: usize = 12;
/// Where templates are thinned out, so many times as many are begun with, and so many are left of each round.
const BEGUN: f64 = 2.0;
const LEFT: f64 = 0.75;
/// Where corners count, those of all templates together are worth this share of all volume.
const WORTH: f64 = 0.03;

/// Distinct components.
pub(super) struct Table<'a> {
    /// Features, row after row, and how many a row has.
    pub(super) rows: Vec<f64>,
    pub(super) d: usize,
    /// Volumes.
    pub(super) weights: Vec<f64>,
    pub(super) heights: Vec<&'a [f32]>,
    /// Corners of the meshes.
    pub(super) corners: Vec<f64>,
}

/// What a template costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cost {
    /// The same as any other.
    Each,
    /// So much as it has corners.
    Corners,
}

/// The use of a type for a component, and what it and the next best type mismatch.
#[derive(Clone, Copy)]
struct Fit {
    used: Use,
    mismatch: f64,
    next: f64,
}

impl Table<'_> {
    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.d..(i + 1) * self.d]
    }

    /// How many types to begin with for `k` in the end.
    pub(super) fn begun(&self, k: usize, cost: Cost) -> usize {
        match cost {
            Cost::Each => k,
            Cost::Corners => ((k as f64 * BEGUN) as usize).min(self.weights.len()),
        }
    }

    /// Rounds of: a medoid for each type; the best medoid, and quarter turn, for each component; and the types that gain
    /// the least volume for their cost left out, until `k` are left. Medoids and uses.
    pub(super) fn medoids(
        &self,
        uses: Vec<Use>,
        count: usize,
        k: usize,
        cost: Cost,
    ) -> (Vec<usize>, Vec<Use>) {
        let mut uses = uses;
        let mut medoids = self.choose(&uses, count, &[], cost);
        let mut round = 0;
        while medoids.len() > k || round < ROUNDS {
            let fits = self.assign(&medoids, &uses);
            uses = fits.iter().map(|f| f.used).collect();
            if medoids.len() > k {
                let left = ((medoids.len() as f64 * LEFT) as usize).max(k);
                self.thin(&mut medoids, &mut uses, &fits, left, cost);
                continue;
            }
            medoids = self.choose(&uses, medoids.len(), &medoids, cost);
            round += 1;
        }
        let fits = self.assign(&medoids, &uses);
        (medoids, fits.iter().map(|f| f.used).collect())
    }

    /// Leaves out types until `left` are left: those whose components lose the least volume, going over to the next best
    /// type, for what the template costs. Uses of types that are left out are of the first one, until they are assigned.
    fn thin(
        &self,
        medoids: &mut Vec<usize>,
        uses: &mut [Use],
        fits: &[Fit],
        left: usize,
        cost: Cost,
    ) {
        let mut loss = vec![0.0; medoids.len()];
        for (f, w) in fits.iter().zip(&self.weights) {
            loss[f.used.kind] += w * (f.next - f.mismatch);
        }
        let price = |kind: usize| match cost {
            Cost::Each => 1.0,
            Cost::Corners => self.corners[medoids[kind]] + 1.0,
        };
        let gain = |kind: &usize| loss[*kind] / price(*kind);
        let mut order: Vec<usize> = (0..medoids.len()).collect();
        order.sort_by(|a, b| gain(b).total_cmp(&gain(a)).then(a.cmp(b)));
        order.truncate(left);
        order.sort_unstable();
        let mut number = vec![0; medoids.len()];
        order
            .iter()
            .enumerate()
            .for_each(|(new, &old)| number[old] = new);
        uses.iter_mut().for_each(|u| u.kind = number[u.kind]);
        *medoids = order.iter().map(|&kind| medoids[kind]).collect();
    }

    /// The member of each type with the least mismatched volume to the others, of those nearest to the mean; where corners
    /// count, the volume that they are worth is added.
    fn choose(&self, uses: &[Use], count: usize, before: &[usize], cost: Cost) -> Vec<usize> {
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (i, u) in uses.iter().enumerate() {
            members[u.kind].push(i);
        }
        let volume: f64 = self.weights.iter().sum();
        let corners = self.corners.iter().sum::<f64>() / self.corners.len().max(1) as f64;
        let worth = match cost {
            Cost::Each => 0.0,
            Cost::Corners => WORTH * volume / (count as f64 * corners.max(1.0)),
        };
        let medoid = |(kind, list): (usize, &Vec<usize>)| {
            let total: f64 = list.iter().map(|&i| self.weights[i]).sum();
            let mean = |k: usize| {
                list.iter()
                    .map(|&i| self.weights[i] * self.row(i)[k])
                    .sum::<f64>()
                    / total
            };
            let mean: Vec<f64> = (0..self.d).map(mean).collect();
            let mut near = list.clone();
            let far = |i: usize| square(self.row(i), &mean);
            near.sort_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
            near.truncate(TRIED);
            near.extend(before.get(kind));
            let cost = |m: usize| -> f64 {
                let mismatch = |&i: &usize| {
                    let turned = uses[i].quarter;
                    self.weights[i] * mismatch(self.heights[m], self.heights[i], turned)
                };
                list.iter().map(mismatch).sum::<f64>() + worth * self.corners[m]
            };
            let costs = near.iter().map(|&m| (cost(m), m));
            let best = costs.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            best.map_or(0, |b| b.1)
        };
        members.par_iter().enumerate().map(medoid).collect()
    }

    /// The best of the present type and the types whose medoids are nearest in features.
    fn assign(&self, medoids: &[usize], uses: &[Use]) -> Vec<Fit> {
        let nearest = Nearest::new(self, medoids);
        let best = |i: usize| {
            let mut best = Fit {
                used: uses[i],
                mismatch: f64::INFINITY,
                next: f64::INFINITY,
            };
            let near = nearest.of(self.row(i));
            let present = uses[i].kind;
            let also = (!near.contains(&present)).then_some(present);
            for kind in near.iter().copied().chain(also) {
                let own = (0..4).map(|quarter| {
                    let cost = mismatch(self.heights[medoids[kind]], self.heights[i], quarter);
                    (cost, quarter)
                });
                let own = own.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                let (cost, quarter) = own.unwrap_or((f64::INFINITY, 0));
                if cost < best.mismatch {
                    best.next = best.mismatch;
                    best.mismatch = cost;
                    best.used = Use { kind, quarter };
                } else {
                    best.next = best.next.min(cost);
                }
            }
            // A single type has no other: all would be lost.
            best.next = best.next.min(1.0);
            best
        };
        (0..uses.len()).into_par_iter().map(best).collect()
    }
}

/// Medoids by their first feature, so that those nearest to a point are found without all distances.
struct Nearest<'a> {
    table: &'a Table<'a>,
    /// First feature, type, component; increasing.
    sorted: Vec<(f64, usize, usize)>,
}

impl<'a> Nearest<'a> {
    fn new(table: &'a Table<'a>, medoids: &[usize]) -> Self {
        let first = |&m: &usize| table.row(m).first().copied().unwrap_or(0.0);
        let medoids = medoids.iter().enumerate();
        let mut sorted: Vec<_> = medoids.map(|(kind, m)| (first(m), kind, *m)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Self { table, sorted }
    }

    /// The types nearest to a point, [`CANDIDATES`] at most, the nearest first, of equals the lower.
    fn of(&self, point: &[f64]) -> Vec<usize> {
        let first = point.first().copied().unwrap_or(0.0);
        let mut high = self.sorted.partition_point(|s| s.0 < first);
        let mut low = high;
        let mut found: Vec<(f64, usize)> = Vec::with_capacity(CANDIDATES + 1);
        let away =
            |at: Option<&(f64, usize, usize)>| at.map_or(f64::INFINITY, |s| (s.0 - first).powi(2));
        loop {
            let below = away(low.checked_sub(1).and_then(|l| self.sorted.get(l)));
            let above = away(self.sorted.get(high));
            let farthest = match found.len() < CANDIDATES {
                true => f64::INFINITY,
                false => found[CANDIDATES - 1].0,
            };
            let least = below.min(above);
            // What is farther along one axis is farther.
            if least.is_infinite() || least > farthest {
                return found.into_iter().map(|f| f.1).collect();
            }
            let (_, kind, medoid) = if below <= above {
                low -= 1;
                self.sorted[low]
            } else {
                high += 1;
                self.sorted[high - 1]
            };
            let entry = (square(point, self.table.row(medoid)), kind);
            let before = |f: &(f64, usize)| f.0.total_cmp(&entry.0).then(f.1.cmp(&entry.1)).is_lt();
            let at = found.partition_point(before);
            found.insert(at, entry);
            found.truncate(CANDIDATES);
        }
    }
}

/// Mean difference of two height maps, the first one turned by quarters counterclockwise: the mismatched
/// share of the box.
pub fn mismatch(template: &[f32], component: &[f32], quarter: u8) -> f64 {
    let last = CELLS - 1;
    let mut sum = 0.0f32;
    for y in 0..CELLS {
        for x in 0..CELLS {
            // Where the cell comes from.
            let (u, v) = match quarter {
                0 => (x, y),
                1 => (y, last - x),
                2 => (last - x, last - y),
                _ => (last - y, x),
            };
            sum += (template[v * CELLS + u] - component[y * CELLS + x]).abs();
        }
    }
    f64::from(sum) / (CELLS * CELLS) as f64
}

pub(super) fn square(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}
