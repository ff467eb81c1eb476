//! Quilting: patches of a city, laid side by side so that its streets go on from one to the next.
//!
//! As image quilting (Efros and Freeman 2001), with blocks in place of pixels: squares of a lattice that is turned as the city's walls are
//! are filled one after the other. For each, patches are drawn at random places of the city and turned so that walls and
//! blocks go on in the direction of those that stand around; of those whose plan agrees best with what stands, each is moved to where it agrees
//! best, and the one is taken after which the new city has most nearly as many buildings, blocks and built square metres as the old.
//! A block is taken whole or not at all, but cut between buildings at the edge of the shape. Then squares between those of
//! the lattice, and smaller ones, fill what stayed empty, until the ground is built on as in the old city.

use rand::RngExt;

use super::exemplar::Exemplar;
use super::lattice::{Square, inside, lattice, points};
use super::occupancy::{Occupancy, Standing};
use super::patches::{Laid, Patch, Search};
use super::shape::{Shape, rotated};
use edifice_base::rng::{self, Stream};
use edifice_base::{Progress, Watch, Watched};

/// Weight of the density of the new city beside the disagreement with what stands.
const STEER: f64 = 1.0;
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

/// Blocks, buildings and square metres of plan.
#[derive(Debug, Clone, Copy, Default)]
struct Amount([f64; 3]);

/// A new city as it grows.
struct Quilt<'a> {
    city: &'a Exemplar,
    shape: &'a Shape,
    ground: Occupancy,
    copies: Vec<Copy>,
    laid: Vec<Laid>,
    /// Of a square of the first side, in the old city.
    density: Amount,
    /// Of the new city so far,
    amount: Amount,
    /// on so many squares.
    squares: f64,
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
        quilt.squares += inside(shape, square, city.axis);
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
            for block in city.within(place, city.side, city.axis) {
                let block = &city.blocks[block];
                density.add([1.0, block.buildings.len() as f64, block.area]);
            }
        }
        Self {
            city,
            shape,
            ground: Occupancy::new(),
            copies: Vec::new(),
            laid: Vec::new(),
            density: Amount(density.0.map(|v| v / MEASURED as f64)),
            amount: Amount::default(),
            squares: 0.0,
        }
    }

    /// True if as much ground is built on as in the old city.
    fn is_dense(&self) -> bool {
        self.amount.0[2] >= self.density.0[2] * self.squares
    }

    /// The unlikeness of an amount on so many squares to the old city: the sum of the absolute logarithms of the ratios of area,
    /// buildings, and buildings a block.
    fn unlike(&self, amount: Amount, squares: f64) -> f64 {
        let [blocks, buildings, area] = amount.0;
        let [old_blocks, old_buildings, old_area] = self.density.0;
        let ratio = |new: f64, old: f64| ((new + 1.0) / (old * squares + 1.0)).ln();
        let blocks = ratio(blocks, old_blocks);
        ratio(area, old_area).abs()
            + ratio(buildings, old_buildings).abs()
            + (ratio(buildings, old_buildings) - blocks).abs()
    }

    /// The patch of a square of the lattice: one that agrees with what stands, and keeps the density of the old city.
    fn first(&self, square: Square, rng: &mut Stream) -> Option<Patch> {
        let squares = self.squares + inside(self.shape, square, self.city.axis);
        let cost = |patch: &Patch| {
            let mut amount = self.amount;
            for block in self.fitting(square, patch) {
                amount.add(self.kept(&block));
            }
            let unlike = self.unlike(amount, squares) - self.unlike(self.amount, self.squares);
            Some(patch.mismatch + STEER * unlike * squares)
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
            for block in &fitting {
                amount.add(self.kept(block));
            }
            let won = amount.0[2] - self.amount.0[2];
            let unlike = self.unlike(amount, self.squares) - self.unlike(self.amount, self.squares);
            let cost =
                patch.mismatch - won / (square.side * square.side) + STEER * unlike * self.squares;
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

    /// The blocks of a patch that fit into the new city: block, and its copies inside the shape.
    fn fitting(&self, square: Square, patch: &Patch) -> Vec<(usize, Vec<Copy>)> {
        let city = self.city;
        let blocks = city.within(patch.from, square.side, city.axis - patch.turn);
        let copied = |block: usize| {
            let buildings = city.blocks[block].buildings.iter();
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
            self.ground.fits(&standing).then_some((block, inside))
        };
        blocks.into_iter().filter_map(copied).collect()
    }

    fn standing(&self, copy: &Copy) -> Standing<'a> {
        Standing {
            footprint: &self.city.buildings[copy.source].footprint,
            at: copy.at,
            turn: copy.turn,
        }
    }

    /// The part of a block that is kept inside the shape.
    fn kept(&self, (_, copies): &(usize, Vec<Copy>)) -> [f64; 3] {
        let points = |c: &Copy| self.city.buildings[c.source].footprint.points();
        let area: usize = copies.iter().map(points).sum();
        [1.0, copies.len() as f64, area as f64]
    }

    fn lay(&mut self, square: Square, patch: Patch) {
        for block in self.fitting(square, &patch) {
            self.amount.add(self.kept(&block));
            let (block, copies) = block;
            let block = &self.city.blocks[block];
            let [x, y] = rotated([0, 1].map(|k| block.middle[k] - patch.from[k]), patch.turn);
            self.laid.push(Laid {
                middle: [square.middle[0] + x, square.middle[1] + y],
                walls: rotated(block.walls, 4.0 * patch.turn),
                length: rotated(block.length, 2.0 * patch.turn),
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
    fn add(&mut self, more: [f64; 3]) {
        for (sum, v) in self.0.iter_mut().zip(more) {
            *sum += v;
        }
    }
}
