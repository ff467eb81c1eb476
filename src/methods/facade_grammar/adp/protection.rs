//! Protection of important regions (Sec. 4.7): which repeated regions a walk keeps whole until they
//! stand alone.

use std::ops::Range;

use rand::{Rng, RngExt};
use rand_distr::{Distribution, Exp1};

use super::symmetry::Repeated;
use crate::regions::Region;

/// The repeated regions of a layout, and those that the present walk protects.
#[derive(Debug)]
pub(crate) struct Protection {
    repeated: Vec<Repeated>,
    /// Scores of the repeated regions, summed up to each.
    scores: Vec<f64>,
    /// For each repeated region, true if its occurrences are disjoint from each other; `None` until it was asked.
    apart: Vec<Option<bool>>,
    /// The regions that were drawn.
    kept: Vec<usize>,
    /// Their occurrences, which no line may cross.
    occurrences: Vec<Region>,
    /// True if the present walk goes on without protection.
    lifted: bool,
}

impl Protection {
    /// The protection of a layout with these repeated regions, of which none is protected yet.
    pub(crate) fn new(repeated: Vec<Repeated>) -> Self {
        let mut total = 0.0;
        let sums = repeated.iter().map(|r| {
            total += r.score();
            total
        });
        Self {
            scores: sums.collect(),
            apart: vec![None; repeated.len()],
            repeated,
            kept: Vec::new(),
            occurrences: Vec::new(),
            lifted: false,
        }
    }

    /// Draws regions with probability proportional to `f(a, o)`, up to `draws` times; each is kept when
    /// none of its occurrences overlaps another or one kept before.
    pub(crate) fn draw<R: Rng>(&mut self, draws: usize, rng: &mut R) {
        self.restart();
        let Some(total) = self.total() else {
            return;
        };
        for _ in 0..rng.random_range(0..=draws) {
            let at = rng.random::<f64>() * total;
            self.keep(self.scores.partition_point(|sum| *sum <= at));
        }
    }

    /// The sum of all scores; `None` where no region has one.
    pub(crate) fn total(&self) -> Option<f64> {
        self.scores.last().copied().filter(|total| *total > 0.0)
    }

    /// Scores of the repeated regions, summed up to each: what [`Protection::draw`] draws by.
    pub(crate) fn scores(&self) -> &[f64] {
        &self.scores
    }

    /// Keeps a region that was drawn, when none of its occurrences overlaps another or one kept before.
    pub(crate) fn keep(&mut self, drawn: usize) {
        let Some(group) = self.repeated.get(drawn) else {
            return;
        };
        let occurrences = &group.occurrences;
        let apart = *self.apart[drawn].get_or_insert_with(|| disjoint(occurrences));
        if !apart || self.kept.contains(&drawn) {
            return;
        }
        let crosses = |a: &Region| self.occurrences.iter().any(|b| overlap(*a, *b));
        if !occurrences.iter().any(crosses) {
            self.kept.push(drawn);
            self.occurrences.extend(occurrences);
        }
    }

    /// Samples regions without replacement until the protected set is maximal: no other would fit between those kept. `layouts` gives the columns and rows of each layout.
    pub(crate) fn draw_all<R: Rng>(&mut self, layouts: &[(usize, usize)], rng: &mut R) {
        self.restart();
        // The order of draws without replacement: least exponential variates of these rates first.
        let mut order: Vec<(f64, usize)> = Vec::with_capacity(self.repeated.len());
        for (group, repeated) in self.repeated.iter().enumerate() {
            if repeated.score() > 0.0 {
                let variate: f64 = Exp1.sample(rng);
                order.push((variate / repeated.score(), group));
            }
        }
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut room = Room::new(layouts);
        for (_, group) in order {
            if room.take(&self.repeated[group].occurrences) {
                self.kept.push(group);
                self.occurrences.extend(&self.repeated[group].occurrences);
            }
        }
    }

    /// Protects what was drawn last again.
    pub(crate) fn restore(&mut self) {
        self.lifted = false;
    }

    /// Protects nothing for the rest of the walk.
    pub(crate) fn lift(&mut self) {
        self.lifted = true;
    }

    /// Protects nothing that was drawn before.
    pub(crate) fn restart(&mut self) {
        self.restore();
        self.kept.clear();
        self.occurrences.clear();
    }

    /// True if nothing is protected for the rest of the walk.
    pub(crate) fn is_lifted(&self) -> bool {
        self.lifted || self.occurrences.is_empty()
    }

    /// The protected occurrences inside a region; one that is the region itself stands alone and is
    /// protected no more.
    pub(crate) fn inside(&self, region: Region) -> impl Iterator<Item = Region> + '_ {
        let all = self.occurrences.iter().copied();
        all.filter(move |p| contains(region, *p) && *p != region)
    }
}

/// The cells that protected regions leave free.
struct Room {
    /// By layout: columns, and whether each cell is taken, row by row.
    layouts: Vec<(usize, Vec<bool>)>,
}

impl Room {
    fn new(layouts: &[(usize, usize)]) -> Self {
        let free = |&(columns, rows): &(usize, usize)| (columns, vec![false; columns * rows]);
        Self {
            layouts: layouts.iter().map(free).collect(),
        }
    }

    /// Takes the cells of all regions, or none when they overlap each other or what was taken before.
    fn take(&mut self, regions: &[Region]) -> bool {
        for (i, region) in regions.iter().enumerate() {
            if !self.is_free(*region) {
                regions[..i].iter().for_each(|r| self.set(*r, false));
                return false;
            }
            self.set(*region, true);
        }
        true
    }

    fn is_free(&self, r: Region) -> bool {
        let (columns, taken) = &self.layouts[usize::from(r.layout)];
        cells(r, *columns).all(|row| !taken[row].contains(&true))
    }

    fn set(&mut self, r: Region, value: bool) {
        let (columns, taken) = &mut self.layouts[usize::from(r.layout)];
        cells(r, *columns).for_each(|row| taken[row].fill(value));
    }
}

/// The cells of a region on a grid of so many columns, row by row.
fn cells(r: Region, columns: usize) -> impl Iterator<Item = Range<usize>> {
    let (from, to) = (usize::from(r.x0), usize::from(r.x1));
    (usize::from(r.y0)..usize::from(r.y1)).map(move |y| y * columns + from..y * columns + to)
}

/// True if the first region contains the second.
pub(crate) fn contains(outer: Region, inner: Region) -> bool {
    outer.layout == inner.layout
        && outer.x0 <= inner.x0
        && inner.x1 <= outer.x1
        && outer.y0 <= inner.y0
        && inner.y1 <= outer.y1
}

/// True if no two of the regions overlap.
fn disjoint(regions: &[Region]) -> bool {
    let later = |i: usize| &regions[i + 1..];
    let mut places = regions.iter().enumerate();
    places.all(|(i, a)| !later(i).iter().any(|b| overlap(*a, *b)))
}

/// True if the two regions have a cell in common.
fn overlap(a: Region, b: Region) -> bool {
    a.layout == b.layout && a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;
    use edifice_base::rng::Stream;

    fn region(x0: u16, x1: u16) -> Region {
        Region {
            layout: 0,
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
        let mut protection = Protection::new(groups);
        let mut rng = Stream::seed_from_u64(1);
        let (mut nothing, mut both) = (false, false);
        for _ in 0..200 {
            protection.draw(8, &mut rng);
            assert!(disjoint(&protection.occurrences));
            assert!(protection.occurrences.iter().all(|r| r.x1 <= 14));
            nothing |= protection.is_lifted();
            both |= protection.kept.contains(&0) && protection.kept.contains(&2);
        }
        assert!(nothing && both);
    }

    #[test]
    fn all_that_fit_are_drawn() {
        // The first three overlap one another, the fourth overlaps itself, the last is one terminal.
        let groups = vec![
            repeated(1, 4, &[(0, 4), (10, 14)]),
            repeated(2, 2, &[(0, 2), (2, 4), (10, 12), (12, 14)]),
            repeated(3, 4, &[(2, 6), (8, 12)]),
            repeated(4, 9, &[(14, 23), (18, 27)]),
            repeated(5, 1, &[(24, 25), (26, 27)]),
            repeated(6, 2, &[(14, 16), (16, 18)]),
        ];
        let mut protection = Protection::new(groups);
        let mut rng = Stream::seed_from_u64(1);
        let mut times = [0; 6];
        for _ in 0..300 {
            protection.draw_all(&[(27, 1)], &mut rng);
            assert!(disjoint(&protection.occurrences));
            assert_eq!(protection.kept.len(), 2);
            protection.kept.iter().for_each(|&group| times[group] += 1);
        }
        // Each of the first three has a score of 3.
        assert!(times[..3].iter().all(|times| (70..130).contains(times)));
        assert_eq!(times[3..], [0, 0, 300]);
    }

    #[test]
    fn a_lifted_protection_can_be_restored() {
        let mut protection = Protection::new(vec![repeated(1, 4, &[(0, 4), (10, 14)])]);
        protection.draw_all(&[(14, 1)], &mut Stream::seed_from_u64(1));
        assert_eq!(protection.inside(region(0, 14)).count(), 2);
        protection.lift();
        assert!(protection.is_lifted());
        protection.restore();
        assert_eq!(protection.inside(region(0, 5)).count(), 1);
    }
}
