//! Protection of important regions (Sec. 4.7): which repeated regions a walk keeps whole until they
//! stand alone.

use rand::{Rng, RngExt};

use super::regions::Region;
use super::symmetry::Repeated;

/// The repeated regions of a layout, and those that the present walk protects.
#[derive(Debug)]
pub(crate) struct Protection {
    repeated: Vec<Repeated>,
    /// Draws per walk, at most.
    draws: usize,
    /// Scores of the repeated regions, summed up to each.
    scores: Vec<f64>,
    /// Whether the occurrences of a repeated region are disjoint from each other, once it was asked.
    apart: Vec<Option<bool>>,
    /// The regions that this walk protects.
    kept: Vec<usize>,
    /// Their occurrences, which no line may cross.
    occurrences: Vec<Region>,
}

impl Protection {
    /// Protects nothing yet, and draws at most so many regions for a walk.
    pub fn new(repeated: Vec<Repeated>, draws: usize) -> Self {
        let mut total = 0.0;
        let sums = repeated.iter().map(|r| {
            total += r.score();
            total
        });
        Self {
            draws,
            scores: sums.collect(),
            apart: vec![None; repeated.len()],
            repeated,
            kept: Vec::new(),
            occurrences: Vec::new(),
        }
    }

    /// Draws the regions for a walk: repeated regions in random order with probability proportional to
    /// `f(a, o)`, each kept when none of its occurrences overlaps one kept before.
    pub fn draw<R: Rng>(&mut self, rng: &mut R) {
        self.lift();
        let Some(total) = self.scores.last() else {
            return;
        };
        for _ in 0..rng.random_range(0..=self.draws) {
            let at = rng.random::<f64>() * total;
            let drawn = self.scores.partition_point(|sum| *sum <= at);
            let Some(group) = self.repeated.get(drawn) else {
                continue;
            };
            let occurrences = &group.occurrences;
            let apart = *self.apart[drawn].get_or_insert_with(|| disjoint(occurrences));
            if !apart || self.kept.contains(&drawn) {
                continue;
            }
            let crosses = |a: &Region| self.occurrences.iter().any(|b| overlap(*a, *b));
            if !occurrences.iter().any(crosses) {
                self.kept.push(drawn);
                self.occurrences.extend(occurrences);
            }
        }
    }

    /// Protects nothing for the rest of the walk.
    pub fn lift(&mut self) {
        self.kept.clear();
        self.occurrences.clear();
    }

    /// Whether nothing is protected.
    pub fn is_lifted(&self) -> bool {
        self.occurrences.is_empty()
    }

    /// The protected occurrences inside a region; one that is the region itself stands alone and is
    /// protected no more.
    pub fn inside(&self, region: Region) -> impl Iterator<Item = Region> + '_ {
        let all = self.occurrences.iter().copied();
        all.filter(move |p| contains(region, *p) && *p != region)
    }
}

/// Whether the first region contains the second.
pub(crate) fn contains(outer: Region, inner: Region) -> bool {
    outer.sheet == inner.sheet
        && outer.x0 <= inner.x0
        && inner.x1 <= outer.x1
        && outer.y0 <= inner.y0
        && inner.y1 <= outer.y1
}

/// Whether no two regions overlap.
fn disjoint(regions: &[Region]) -> bool {
    let later = |i: usize| &regions[i + 1..];
    let mut places = regions.iter().enumerate();
    places.all(|(i, a)| !later(i).iter().any(|b| overlap(*a, *b)))
}

/// Whether two regions share a cell.
fn overlap(a: Region, b: Region) -> bool {
    a.sheet == b.sheet && a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;
    use crate::rng::Stream;

    fn region(x0: u16, x1: u16) -> Region {
        Region {
            sheet: 0,
            x0,
            x1,
            y0: 0,
            y1: 1,
        }
    }

    fn repeated(id: u32, terminals: u32, occurrences: &[(u16, u16)]) -> Repeated {
        Repeated {
            id,
            terminals,
            occurrences: occurrences.iter().map(|&(a, b)| region(a, b)).collect(),
        }
    }

    #[test]
    fn protected_regions_never_overlap() {
        // The second lies in the first, the third touches both, the fourth overlaps itself.
        let groups = vec![
            repeated(1, 4, &[(0, 4), (10, 14)]),
            repeated(2, 2, &[(0, 2), (2, 4), (10, 12), (12, 14)]),
            repeated(3, 3, &[(4, 7), (7, 10)]),
            repeated(4, 9, &[(14, 23), (18, 27)]),
        ];
        let mut protection = Protection::new(groups, 8);
        let mut rng = Stream::seed_from_u64(1);
        let (mut nothing, mut both) = (false, false);
        for _ in 0..200 {
            protection.draw(&mut rng);
            assert!(disjoint(&protection.occurrences));
            assert!(protection.occurrences.iter().all(|r| r.x1 <= 14));
            nothing |= protection.is_lifted();
            both |= protection.kept.contains(&0) && protection.kept.contains(&2);
        }
        assert!(nothing && both);
    }
}
