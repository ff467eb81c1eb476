//! Protection of important regions (Sec. 4.7): which repeated regions a walk keeps whole until they
//! stand alone.

use rand::{Rng, RngExt};

use super::regions::Region;
use super::symmetry::Repeated;

/// Draws of protected regions per walk, at most.
const DRAWS: usize = 30;

/// The repeated regions of a layout, and those that the present walk protects.
#[derive(Debug)]
pub(crate) struct Protection {
    repeated: Vec<Repeated>,
    /// Scores of the repeated regions, summed up to each; empty when nothing is ever protected.
    scores: Vec<f64>,
    /// Whether the occurrences of a repeated region are disjoint from each other, once it was asked.
    apart: Vec<Option<bool>>,
    /// The regions that this walk protects.
    kept: Vec<usize>,
    /// Their occurrences, which no line may cross.
    occurrences: Vec<Region>,
}

impl Protection {
    /// Protects nothing yet, and never anything unless `wanted`.
    pub fn new(repeated: Vec<Repeated>, wanted: bool) -> Self {
        let mut total = 0.0;
        let sums = repeated.iter().filter(|_| wanted).map(|r| {
            total += r.score();
            total
        });
        Self {
            scores: sums.collect(),
            apart: vec![None; repeated.len()],
            repeated,
            kept: Vec::new(),
            occurrences: Vec::new(),
        }
    }

    /// Draws the regions for a walk: repeated regions in random order with probability proportional to
    /// `f(a, o)`, each kept when none of its occurrences overlaps one kept before without one containing
    /// the other.
    pub fn draw<R: Rng>(&mut self, rng: &mut R) {
        self.lift();
        let Some(total) = self.scores.last() else {
            return;
        };
        for _ in 0..rng.random_range(0..=DRAWS) {
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

/// Whether two regions share a cell and neither contains the other.
fn overlap(a: Region, b: Region) -> bool {
    let shared = a.sheet == b.sheet && a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
    shared && !contains(a, b) && !contains(b, a)
}
