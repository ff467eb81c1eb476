//! The city that patches are taken from.

use rustc_hash::{FxHashMap, FxHashSet};

use super::footprint::CELL;
use super::groups::{Group, groups};
use super::raster::Raster;
use super::shape::rotated;
use super::sources::Source;

/// Side of the cells in which patches are compared, in metres.
pub(super) const COMPARED: f64 = 4.0;
/// Side of the cells that tell town from open country, in metres.
const TOWN_CELL: f64 = 20.0;
/// Open ground between buildings belongs to the town as far as so many such cells from them;
const TOWN_STEPS: i64 = 5;
/// outside, the town ends so many cells from the last building.
const TOWN_EDGE: i64 = 3;
/// Patches are taken where at least this share of them is town, or this share of the most there is.
const TOWN: f64 = 0.9;
/// The side of a patch over the square root of the area of a group, mean over the ground that groups cover.
const SIDE: f64 = 3.0;
/// A patch is so wide, besides, that it holds so many buildings where they stand as densely as in the whole town.
const HELD: f64 = 20.0;
/// Patches are at least and at most so wide, in metres.
const SIDES: [f64; 2] = [60.0, 240.0];
/// Side of the cells by which groups are found, in metres.
const NEAR: f64 = 100.0;

/// A city, as patches are taken from it.
pub(super) struct Exemplar {
    pub(super) buildings: Vec<Source>,
    pub(super) groups: Vec<Group>,
    /// Square metres of plan in each cell of side [`COMPARED`].
    built: Raster,
    /// Middles of cells where a patch may be taken; they have sides of [`TOWN_CELL`].
    middles: Vec<[f64; 2]>,
    /// Side of a patch, in metres.
    pub(super) side: f64,
    /// Direction of the walls of the whole city, in degrees below 90.
    pub(super) axis: f64,
    near: FxHashMap<[i64; 2], Vec<usize>>,
}

impl Exemplar {
    /// Of buildings, and the pairs that stand near each other; `None` if none of them covers ground.
    pub(super) fn new(buildings: Vec<Source>, pairs: &[[usize; 2]]) -> Option<Self> {
        let groups = groups(&buildings, pairs);
        let covered: f64 = groups.iter().map(|b| b.area).sum();
        if groups.is_empty() {
            return None;
        }
        let mean = groups.iter().map(|b| b.area * b.area.sqrt()).sum::<f64>() / covered;
        let mut built = Raster::new(COMPARED);
        let mut town: FxHashSet<[i64; 2]> = FxHashSet::default();
        for b in &buildings {
            for p in b.footprint.covered() {
                let [x, y] = rotated(p, b.turn);
                let p = [b.at[0] + x, b.at[1] + y];
                let cell = built.at_mut(p);
                *cell = cell.saturating_add(1);
                town.insert(p.map(|v| (v / TOWN_CELL).floor() as i64));
            }
        }
        let town = closed(&town);
        let ground = town.len() as f64 * TOWN_CELL * TOWN_CELL;
        let held = (HELD * ground / buildings.len() as f64).sqrt();
        let side = (SIDE * mean).max(held).clamp(SIDES[0], SIDES[1]);
        let mut near: FxHashMap<[i64; 2], Vec<usize>> = FxHashMap::default();
        for (i, b) in groups.iter().enumerate() {
            let cell = b.middle.map(|v| (v / NEAR).floor() as i64);
            near.entry(cell).or_default().push(i);
        }
        let walls = [0, 1].map(|k| groups.iter().map(|b| b.walls[k]).sum());
        Some(Self {
            middles: middles(&town, side),
            axis: direction(walls, 4.0),
            side,
            built,
            near,
            buildings,
            groups,
        })
    }

    /// A place where a patch may be taken, uniformly over them, by three numbers uniform in 0..1.
    pub(super) fn place(&self, [which, x, y]: [f64; 3]) -> [f64; 2] {
        let i = ((which * self.middles.len() as f64) as usize).min(self.middles.len() - 1);
        let [u, v] = self.middles[i];
        [u + (x - 0.5) * TOWN_CELL, v + (y - 0.5) * TOWN_CELL]
    }

    /// The share of the ground that is built at a point, over a cell of side [`COMPARED`].
    pub(super) fn built(&self, p: [f64; 2]) -> f64 {
        f64::from(self.built.at(p)).min(BUILT) / BUILT
    }

    /// Groups whose middles lie in a square that is turned by so many degrees, in order.
    pub(super) fn within(&self, middle: [f64; 2], side: f64, degrees: f64) -> Vec<usize> {
        let reach = side * std::f64::consts::FRAC_1_SQRT_2;
        let cell = |v: f64| (v / NEAR).floor() as i64;
        let mut out = Vec::new();
        for x in cell(middle[0] - reach)..=cell(middle[0] + reach) {
            for y in cell(middle[1] - reach)..=cell(middle[1] + reach) {
                out.extend(self.near.get(&[x, y]).into_iter().flatten().copied());
            }
        }
        out.retain(|&i: &usize| {
            let b = self.groups[i].middle;
            let local = rotated([b[0] - middle[0], b[1] - middle[1]], -degrees);
            local.iter().all(|v| v.abs() <= side / 2.0)
        });
        out.sort_unstable();
        out
    }
}

/// Square metres in a cell of side [`COMPARED`].
const BUILT: f64 = COMPARED * COMPARED / (CELL * CELL);

/// The direction of a sum of exp(`fold` · iφ), in degrees below 360 / `fold`.
pub(super) fn direction([cos, sin]: [f64; 2], fold: f64) -> f64 {
    (sin.atan2(cos).to_degrees() / fold).rem_euclid(360.0 / fold)
}

/// Cells and those within a number of steps of a cell.
fn around(c: [i64; 2], steps: i64) -> impl Iterator<Item = [i64; 2]> {
    (-steps..=steps).flat_map(move |x| (-steps..=steps).map(move |y| [c[0] + x, c[1] + y]))
}

/// The town of cells with buildings: the cells near them, but those at the outside of it (a morphological closing).
fn closed(cells: &FxHashSet<[i64; 2]>) -> FxHashSet<[i64; 2]> {
    let near: FxHashSet<[i64; 2]> = cells.iter().flat_map(|c| around(*c, TOWN_STEPS)).collect();
    let inner = |c: &&[i64; 2]| around(**c, TOWN_STEPS - TOWN_EDGE).all(|n| near.contains(&n));
    near.iter().filter(inner).copied().collect()
}

/// Middles of the cells of town around which a square of so many metres is town.
fn middles(town: &FxHashSet<[i64; 2]>, side: f64) -> Vec<[f64; 2]> {
    let half = (side / 2.0 / TOWN_CELL) as i64;
    let share = |c: &[i64; 2]| {
        let inside = around(*c, half).filter(|n| town.contains(n)).count();
        inside as f64 / ((2 * half + 1) * (2 * half + 1)) as f64
    };
    let mut cells: Vec<[i64; 2]> = town.iter().copied().collect();
    cells.sort_unstable();
    let shares: Vec<f64> = cells.iter().map(share).collect();
    let most = shares.iter().copied().fold(0.0, f64::max);
    let kept = cells
        .iter()
        .zip(shares)
        .filter(|(_, s)| *s >= TOWN.min(TOWN * most));
    let middle = |c: &[i64; 2]| c.map(|v| (v as f64 + 0.5) * TOWN_CELL);
    kept.map(|(c, _)| middle(c)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_fill_the_cells_about_their_middles() {
        let city = Exemplar {
            buildings: Vec::new(),
            groups: Vec::new(),
            built: Raster::new(COMPARED),
            middles: vec![[100.0, -50.0], [300.0, 20.0]],
            side: 60.0,
            axis: 0.0,
            near: FxHashMap::default(),
        };
        let half = 0.5 * TOWN_CELL;
        assert_eq!(city.place([0.2, 0.5, 0.5]), [100.0, -50.0]);
        assert_eq!(city.place([0.2, 0.0, 0.0]), [100.0 - half, -50.0 - half]);
        assert_eq!(city.place([0.7, 1.0, 0.0]), [300.0 + half, 20.0 - half]);
        assert_eq!(city.place([1.0, 0.0, 1.0]), [300.0 - half, 20.0 + half]);
    }
}
