//! Quilting: patches of a city, laid side by side so that its streets go on from one to the next.
//!
//! As image quilting (Efros and Freeman 2001), with blocks in place of pixels: squares of a lattice that is turned as the city's walls are
//! are filled one after the other. For each, patches are drawn at random places of the city and turned so that walls and
//! groups go on in the direction of those that stand around; of those whose plan agrees best with what stands, each is moved to where it agrees
//! best, and the one is taken after which the new city has most nearly as many buildings, attached ones, blocks and built square metres
//! as the old, of ground that was seldom copied before. A group of near buildings is taken whole or not at all, but cut between
//! buildings at the edge of the shape. Then squares between those of
//! the lattice, and smaller ones, fill what stayed empty, until the ground is built on as in the old city.

use rand::RngExt;

use super::exemplar::Exemplar;
use super::footprint::CELL;
use super::lattice::{Square, inside, lattice, points};
use super::occupancy::{Occupancy, Standing};
use super::patches::{Laid, Patch, Search};
use super::shape::{Shape, rotated};
use edifice_base::rng::{self, Stream};
use edifice_base::{Progress, Watch, Watched};

/// Weight of the density of the new city beside the disagreement with what stands.
const STEER: f64 = 1.0;
/// Weight of the share of a square that groups cover that stand in the new city already, for each time.
const REPEAT: f64 = 1.0;
/// Squares that are filled later, as shares of the first,
const LATER: [f64; 3] = [1.0, 0.7, 0.5];
/// by so much of the square at least,
const GAIN: f64 = 0.04;
/// where so much of it is free.
const ROOM: f64 = 0.1;
/// Places at which the density of the old city is measured.
const MEASURED: usize = 400;

/// A copy of a building: which, where, and its turn in degrees.
#[derive(Clone, Copy)]
pub(super) struct Copy {
    pub(super) source: usize,
    pub(super) at: [f64; 2],
    pub(super) turn: f64,
}

/// Blocks, buildings, attached ones among them, the sum of their gaps, and square metres of plan.
#[derive(Debug, Clone, Copy, Default)]
struct Amount([f64; 5]);

/// Index of the square metres in an [`Amount`].
const AREA: usize = 4;

/// The amount of some buildings of a city.
fn amount(city: &Exemplar, buildings: impl Iterator<Item = usize>) -> [f64; 5] {
    let mut blocks: Vec<usize> = Vec::new();
    let [mut all, mut attached, mut points] = [0, 0, 0];
    let mut gaps = 0.0;
    for b in buildings {
        let source = &city.buildings[b];
        all += 1;
        points += source.footprint.points();
        if let Some(own) = source.neighbourhood {
            blocks.push(own.block);
            attached += usize::from(own.attached);
            gaps += own.gap;
        }
    }
    blocks.sort_unstable();
    blocks.dedup();
    let [blocks, all, attached] = [blocks.len(), all, attached].map(|n| n as f64);
    [blocks, all, attached, gaps, points as f64 * CELL * CELL]
}

/// The share of a shape's points that are farther from its edge than half the side of a building, the mean over built ground: buildings
/// are not cut, so that nearer to the edge fewer can stand.
fn room(city: &Exemplar, shape: &Shape) -> f64 {
    let areas = || city.buildings.iter().map(|b| b.footprint.points() as f64);
    let side = CELL * areas().map(|a| a * a.sqrt()).sum::<f64>() / areas().sum::<f64>();
    let [mut all, mut far] = [0usize; 2];
    for square in lattice(city, shape, city.side, [0.0; 2]) {
        for [x, y] in points(square, square.side, city.axis) {
            let reach = side / 2.0;
            let around = [
                [x - reach, y],
                [x + reach, y],
                [x, y - reach],
                [x, y + reach],
            ];
            if shape.contains([x, y]) {
                all += 1;
                far += usize::from(around.iter().all(|p| shape.contains(*p)));
            }
        }
    }
    // A shape too narrow for any building has none; it is filled as far as that goes.
    far.max(1) as f64 / all.max(1) as f64
}

/// A new city as it grows.
struct Quilt<'a> {
    city: &'a Exemplar,
    shape: &'a Shape,
    ground: Occupancy,
    copies: Vec<Copy>,
    laid: Vec<Laid>,
    /// The number of copies of each group.
    copied: Vec<u32>,
    /// Of a square of the first side, in the old city.
    density: Amount,
    /// Of the new city so far,
    amount: Amount,
    /// on so many squares.
    squares: f64,
    /// The share of the shape's ground where whole buildings may stand.
    room: f64,
}

/// The buildings of a new city inside the shape; when it is stopped, those laid so far.
pub(super) fn quilt(city: &Exemplar, shape: &Shape, seed: u64, watch: &Watch) -> Vec<Copy> {
    let watched = Watched::new(watch);
    let mut rng = rng::stream(seed, "city synthesis", 0);
    let mut quilt = Quilt::new(city, shape, &mut rng);
    let squares = lattice(city, shape, city.side, [0.0; 2]);
    for (done, &square) in squares.iter().enumerate() {
        if !watched.goes_on(Progress::of("patches", done as u64, squares.len() as u64)) {
            return quilt.copies;
        }
        if let Some(patch) = quilt.first(square, &mut rng) {
            quilt.lay(square, patch);
        }
        quilt.squares += quilt.ground_of(square);
        quilt.ground.decide(square.middle, square.side, city.axis);
    }
    for share in LATER {
        for offset in [[0.5, 0.5], [0.0, 0.5], [0.5, 0.0], [0.0, 0.0]] {
            let squares = lattice(city, shape, share * city.side, offset);
            for (done, &square) in squares.iter().enumerate() {
                let progress = Progress::of(
                    "smaller patches between them",
                    done as u64,
                    squares.len() as u64,
                );
                if quilt.is_dense() || !watched.goes_on(progress) {
                    return quilt.copies;
                }
                if let Some(patch) = quilt.later(square, &mut rng) {
                    quilt.lay(square, patch);
                }
            }
        }
    }
    quilt.copies
}

impl<'a> Quilt<'a> {
    fn new(city: &'a Exemplar, shape: &'a Shape, rng: &mut Stream) -> Self {
        let mut density = Amount::default();
        for _ in 0..MEASURED {
            let place = city.place(std::array::from_fn(|_| rng.random()));
            for group in city.within(place, city.side, city.axis) {
                density.add(amount(city, city.groups[group].buildings.iter().copied()));
            }
        }
        Self {
            city,
            shape,
            ground: Occupancy::new(),
            copies: Vec::new(),
            laid: Vec::new(),
            copied: vec![0; city.groups.len()],
            density: Amount(density.0.map(|v| v / MEASURED as f64)),
            amount: Amount::default(),
            squares: 0.0,
            room: room(city, shape),
        }
    }

    /// The share of a square of the lattice that is the ground of the new city.
    fn ground_of(&self, square: Square) -> f64 {
        self.room * inside(self.shape, square, self.city.axis)
    }

    /// True if as much ground is built on as in the old city.
    fn is_dense(&self) -> bool {
        self.amount.0[AREA] >= self.density.0[AREA] * self.squares
    }

    /// The unlikeness of an amount on so many squares to the old city: the sum of the absolute logarithms of the ratios of area,
    /// buildings, attached ones and metres of gap a building, and buildings a block.
    fn unlike(&self, amount: Amount, squares: f64) -> f64 {
        let [blocks, buildings, attached, gaps, area] = amount.0;
        let [old_blocks, old_buildings, old_attached, old_gaps, old_area] = self.density.0;
        let ratio = |new: f64, old: f64| ((new + 1.0) / (old * squares + 1.0)).ln();
        let grown = ratio(buildings, old_buildings);
        ratio(area, old_area).abs()
            + grown.abs()
            + (ratio(attached, old_attached) - grown).abs()
            + (ratio(gaps, old_gaps) - grown).abs()
            + (grown - ratio(blocks, old_blocks)).abs()
    }

    /// The patch of a square of the lattice: one that agrees with what stands, and keeps the density of the old city.
    fn first(&self, square: Square, rng: &mut Stream) -> Option<Patch> {
        let squares = self.squares + self.ground_of(square);
        let cost = |patch: &Patch| {
            let mut amount = self.amount;
            let fitting = self.fitting(square, patch);
            for group in &fitting {
                amount.add(self.kept(group));
            }
            let unlike = self.unlike(amount, squares) - self.unlike(self.amount, self.squares);
            let repeated = self.repeated(square, &fitting);
            Some(patch.mismatch + STEER * unlike * squares + REPEAT * repeated)
        };
        self.search(square).best(true, cost, rng)
    }

    /// The patch of a square that is partly filled: one that agrees with what stands and covers most; `None` where little is won.
    fn later(&self, square: Square, rng: &mut Stream) -> Option<Patch> {
        let points = points(square, square.side, self.city.axis);
        let free = points
            .iter()
            .filter(|p| self.ground.free(**p) && self.shape.contains(**p));
        if (free.count() as f64) < ROOM * points.len() as f64 {
            return None;
        }
        let cost = |patch: &Patch| {
            let fitting = self.fitting(square, patch);
            let mut amount = self.amount;
            for group in &fitting {
                amount.add(self.kept(group));
            }
            let won = amount.0[AREA] - self.amount.0[AREA];
            let unlike = self.unlike(amount, self.squares) - self.unlike(self.amount, self.squares);
            let cost = patch.mismatch - won / (square.side * square.side)
                + STEER * unlike * self.squares
                + REPEAT * self.repeated(square, &fitting);
            (!fitting.is_empty() && cost < -GAIN).then_some(cost)
        };
        self.search(square).best(false, cost, rng)
    }

    fn search(&self, square: Square) -> Search<'_> {
        Search {
            city: self.city,
            ground: &self.ground,
            laid: &self.laid,
            square,
        }
    }

    /// The groups of a patch that fit into the new city: group, and its copies inside the shape.
    fn fitting(&self, square: Square, patch: &Patch) -> Vec<(usize, Vec<Copy>)> {
        let city = self.city;
        let groups = city.within(patch.from, square.side, city.axis - patch.turn);
        let copied = |group: usize| {
            let buildings = city.groups[group].buildings.iter();
            let copies = buildings.map(|&source| {
                let b = &city.buildings[source];
                let [x, y] = rotated([0, 1].map(|k| b.at[k] - patch.from[k]), patch.turn);
                Copy {
                    source,
                    at: [square.middle[0] + x, square.middle[1] + y],
                    turn: b.turn + patch.turn,
                }
            });
            let inside: Vec<Copy> = copies
                .filter(|c| self.standing(c).inside(self.shape))
                .collect();
            let standing: Vec<Standing> = inside.iter().map(|c| self.standing(c)).collect();
            self.ground.fits(&standing).then_some((group, inside))
        };
        groups.into_iter().filter_map(copied).collect()
    }

    fn standing(&self, copy: &Copy) -> Standing<'a> {
        Standing {
            footprint: &self.city.buildings[copy.source].footprint,
            at: copy.at,
            turn: copy.turn,
        }
    }

    /// The part of a group that is kept inside the shape.
    fn kept(&self, (_, copies): &(usize, Vec<Copy>)) -> [f64; 5] {
        amount(self.city, copies.iter().map(|c| c.source))
    }

    /// The share of a square that is covered by groups that were copied before, for each time.
    fn repeated(&self, square: Square, fitting: &[(usize, Vec<Copy>)]) -> f64 {
        let area = |(group, _): &(usize, _)| {
            f64::from(self.copied[*group]) * self.city.groups[*group].area
        };
        fitting.iter().map(area).sum::<f64>() / (square.side * square.side)
    }

    fn lay(&mut self, square: Square, patch: Patch) {
        for group in self.fitting(square, &patch) {
            self.amount.add(self.kept(&group));
            let (group, copies) = group;
            self.copied[group] += 1;
            let group = &self.city.groups[group];
            let [x, y] = rotated([0, 1].map(|k| group.middle[k] - patch.from[k]), patch.turn);
            self.laid.push(Laid {
                middle: [square.middle[0] + x, square.middle[1] + y],
                walls: rotated(group.walls, 4.0 * patch.turn),
                length: rotated(group.length, 2.0 * patch.turn),
            });
            for copy in copies {
                let standing = self.standing(&copy);
                self.ground.take(&standing);
                self.copies.push(copy);
            }
        }
    }
}

impl Amount {
    fn add(&mut self, more: [f64; 5]) {
        for (sum, v) in self.0.iter_mut().zip(more) {
            *sum += v;
        }
    }
}
