//! The last step: buildings without which the new city is more like the one it is made from are taken out again.
//!
//! What grows where little room is left is small, and it stands alone where its neighbours found no room. Of each of four measures (width,
//! depth, height, distance to the nearest building), W is the Wasserstein distance between new and old city, over the standard
//! deviation in the old one. As long as the sum of W² falls, the building is taken out without which it falls most.

use rayon::prelude::*;

use super::super::localization::{Landmark, Nearest};

/// Measures of a building.
const MEASURES: usize = 4;
/// Distributions are compared at so many quantiles.
const QUANTILES: usize = 64;
/// Neighbours that are kept of a building; when all are gone, they are searched for anew.
const NEIGHBOURS: usize = 8;
/// No more than this share of the buildings is taken out.
const MOST: f64 = 0.3;

/// One measure of the old city.
struct Measure {
    /// Quantiles, increasing: bin b is what is above `edges[b - 1]` and at most `edges[b]`.
    edges: Vec<f64>,
    /// Share at or below each edge but the last.
    below: Vec<f64>,
    /// Differences of edges over the standard deviation.
    widths: Vec<f64>,
}

impl Measure {
    /// Of the old city's `values`; the bins reach to the `others`, those of the new city.
    fn new(mut values: Vec<f64>, others: impl Iterator<Item = f64>) -> Self {
        values.retain(|v| v.is_finite());
        values.sort_by(f64::total_cmp);
        let n = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
        let spread = variance.sqrt().max(1e-9);
        let at = |q: usize| values.get((q * values.len()).div_ceil(QUANTILES).max(1) - 1);
        let mut edges: Vec<f64> = (0..=QUANTILES).filter_map(at).copied().collect();
        let ends = others
            .filter(|v| v.is_finite())
            .fold(None, |e: Option<[f64; 2]>, v| {
                let [low, high] = e.unwrap_or([v; 2]);
                Some([low.min(v), high.max(v)])
            });
        edges.extend(ends.into_iter().flatten());
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        let share = |e: &f64| values.partition_point(|v| v <= e) as f64 / n;
        let inner = &edges[..edges.len().saturating_sub(1)];
        Self {
            below: inner.iter().map(share).collect(),
            widths: edges.windows(2).map(|e| (e[1] - e[0]) / spread).collect(),
            edges,
        }
    }

    fn bin(&self, value: f64) -> usize {
        let inner = self.below.len();
        self.edges[..inner].partition_point(|&e| e < value)
    }

    /// W of a new city of `counts` in the bins, less one in bins `out`, plus one in bins `back`.
    fn distance(&self, counts: &[i64], out: &[usize], back: &[usize]) -> f64 {
        let mut total = counts.iter().sum::<i64>() - out.len() as i64 + back.len() as i64;
        total = total.max(1);
        let mut sum = 0;
        let mut distance = 0.0;
        for (b, (below, width)) in self.below.iter().zip(&self.widths).enumerate() {
            let of = |list: &[usize]| list.iter().filter(|&&x| x == b).count() as i64;
            sum += counts[b] - of(out) + of(back);
            distance += (sum as f64 / total as f64 - below).abs() * width;
        }
        distance
    }
}

/// The new city while buildings are taken out.
struct Trimmed<'a> {
    old: [Measure; MEASURES],
    new: &'a [Landmark],
    stands: Vec<bool>,
    /// The buildings near each, the nearest first.
    near: Vec<Vec<usize>>,
    /// The building nearest to each, and how far it is.
    nearest: Vec<(usize, f64)>,
    /// Buildings to which each is the nearest.
    nearest_of: Vec<Vec<usize>>,
    counts: [Vec<i64>; MEASURES],
}

/// For each building of `new`, true if it stays, so that the city is like `old`.
pub(super) fn trim(old: &[Landmark], new: &[Landmark]) -> Vec<bool> {
    let all = vec![true; new.len()];
    if old.len() < 2 || new.len() < 2 {
        return all;
    }
    let mut city = Trimmed::new(old, new);
    let mut now = city.badness(None);
    for _ in 0..(MOST * new.len() as f64) as usize {
        let candidates = (0..new.len()).filter(|&i| city.stands[i]);
        let worth = candidates.map(|i| (city.badness(Some(i)), i));
        let best = worth.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        match best {
            Some((after, i)) if after < now => {
                now = after;
                city.take_out(i);
            }
            _ => break,
        }
    }
    city.stands
}

impl<'a> Trimmed<'a> {
    fn new(old: &[Landmark], new: &'a [Landmark]) -> Self {
        let first = |all: &[Landmark], near: &[Vec<usize>]| -> Vec<(usize, f64)> {
            let nearest = near.iter().enumerate();
            let pair = |(i, n): (usize, &Vec<usize>)| {
                let j = n.first().copied().unwrap_or(i);
                (j, distance(&all[i], &all[j]))
            };
            nearest.map(pair).collect()
        };
        let far = first(old, &neighbours(old, 1)).into_iter().map(|n| n.1);
        let near = neighbours(new, NEIGHBOURS);
        let nearest = first(new, &near);
        let sizes = |k: usize| {
            let of = |all: &[Landmark]| all.iter().map(|l| size(l)[k]).collect::<Vec<_>>();
            Measure::new(of(old), of(new).into_iter())
        };
        let far = Measure::new(far.collect(), nearest.iter().map(|n| n.1));
        let old = [sizes(0), sizes(1), sizes(2), far];
        let mut nearest_of = vec![Vec::new(); new.len()];
        for (i, n) in nearest.iter().enumerate() {
            nearest_of[n.0].push(i);
        }
        let mut counts: [Vec<i64>; MEASURES] =
            std::array::from_fn(|k| vec![0; old[k].below.len() + 1]);
        for (l, n) in new.iter().zip(&nearest) {
            for (k, value) in measures(l, n.1).into_iter().enumerate() {
                counts[k][old[k].bin(value)] += 1;
            }
        }
        Self {
            old,
            new,
            stands: vec![true; new.len()],
            near,
            nearest,
            nearest_of,
            counts,
        }
    }

    /// The sum of W², without building `out`.
    fn badness(&self, out: Option<usize>) -> f64 {
        let mut sum = 0.0;
        for k in 0..MEASURES {
            let (mut less, mut more) = (Vec::new(), Vec::new());
            if let Some(i) = out {
                let value = measures(&self.new[i], self.nearest[i].1)[k];
                less.push(self.old[k].bin(value));
                if k == MEASURES - 1 {
                    for &j in &self.nearest_of[i] {
                        less.push(self.old[k].bin(self.nearest[j].1));
                        let next = self.next_nearest(j, i);
                        more.push(self.old[k].bin(next.1));
                    }
                }
            }
            sum += self.old[k].distance(&self.counts[k], &less, &more).powi(2);
        }
        sum
    }

    fn take_out(&mut self, i: usize) {
        let count = |city: &mut Self, j: usize, by: i64| {
            for (k, value) in measures(&city.new[j], city.nearest[j].1)
                .into_iter()
                .enumerate()
            {
                city.counts[k][city.old[k].bin(value)] += by;
            }
        };
        count(self, i, -1);
        self.stands[i] = false;
        let before = self.nearest[i].0;
        self.nearest_of[before].retain(|&j| j != i);
        for j in std::mem::take(&mut self.nearest_of[i]) {
            count(self, j, -1);
            self.nearest[j] = self.next_nearest(j, i);
            self.nearest_of[self.nearest[j].0].push(j);
            count(self, j, 1);
        }
    }

    /// The building nearest to `i` among those that stand, without `out`, and its distance; the farthest there is, if it is alone.
    fn next_nearest(&self, i: usize, out: usize) -> (usize, f64) {
        let free = |&j: &usize| j != out && j != i && self.stands[j];
        let pair = |j: usize| (j, distance(&self.new[i], &self.new[j]));
        if let Some(j) = self.near[i].iter().copied().find(free) {
            return pair(j);
        }
        let rest = (0..self.new.len()).filter(free).map(pair);
        rest.min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((i, f64::MAX))
    }
}

fn size(l: &Landmark) -> [f64; 3] {
    [l.seen.width, l.seen.depth, l.seen.height]
}

fn measures(l: &Landmark, nearest: f64) -> [f64; MEASURES] {
    let [w, d, h] = size(l);
    [w, d, h, nearest]
}

fn distance(a: &Landmark, b: &Landmark) -> f64 {
    (a.at[0] - b.at[0]).hypot(a.at[1] - b.at[1])
}

/// The `count` others nearest to each.
fn neighbours(all: &[Landmark], count: usize) -> Vec<Vec<usize>> {
    let index = Nearest::new(all);
    let of = |i: usize| {
        let mut near = index.nearest(all, i, count + 1);
        near.retain(|&j| j != i);
        near.truncate(count);
        near
    };
    (0..all.len()).into_par_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::super::localization::Seen;
    use super::*;

    fn building(x: f64, y: f64, width: f64) -> Landmark {
        let seen = Seen {
            width,
            depth: width / 2.0,
            height: 10.0 + width,
            solid: None,
        };
        Landmark { at: [x, y], seen }
    }

    /// A grid of buildings 30 m apart, of sizes from 10 to 20 m.
    fn grid(side: usize) -> Vec<Landmark> {
        let cell = |i: usize| {
            let [x, y] = [i % side, i / side].map(|v| 30.0 * v as f64 + (i * 7 % 5) as f64);
            building(x, y, 10.0 + (i * 37 % 101) as f64 / 10.0)
        };
        (0..side * side).map(cell).collect()
    }

    #[test]
    fn a_city_like_the_old_one_keeps_all_buildings() {
        assert!(trim(&grid(20), &grid(20)).iter().all(|&s| s));
        for n in 0..2 {
            assert_eq!(trim(&grid(3), &grid(3)[..n]), vec![true; n]);
        }
    }

    #[test]
    fn what_is_unlike_the_old_city_is_taken_out() {
        let old = grid(20);
        let mut new = grid(12);
        let wanted = new.len();
        // Huts between the others.
        new.extend((0..30).map(|i| building(15.0 + 30.0 * f64::from(i % 6), 15.0, 2.0)));
        let stays = trim(&old, &new);
        let huts = stays[wanted..].iter().filter(|&&s| s).count();
        let others = stays[..wanted].iter().filter(|&&s| s).count();
        assert!(huts <= 1 && others > wanted * 9 / 10, "{huts} {others}");
    }

    #[test]
    fn counts_and_neighbours_stay_right() {
        let (old, new) = (grid(15), grid(9));
        let mut city = Trimmed::new(&old, &new);
        for i in [40, 41, 39, 31, 49, 30, 32, 48, 50, 22, 58, 0, 80] {
            let foretold = city.badness(Some(i));
            city.take_out(i);
            assert_eq!(foretold, city.badness(None));
            let standing: Vec<usize> = (0..new.len()).filter(|&i| city.stands[i]).collect();
            let mut counts = city.counts.clone();
            counts.iter_mut().for_each(|c| c.fill(0));
            for &i in &standing {
                let far = standing.iter().filter(|&&j| j != i);
                let far = far.map(|&j| distance(&new[i], &new[j]));
                let far = far.fold(f64::INFINITY, f64::min);
                for (k, value) in measures(&new[i], far).into_iter().enumerate() {
                    counts[k][city.old[k].bin(value)] += 1;
                }
            }
            assert_eq!(city.counts, counts);
        }
    }
}
