//! Quilting: patches of a city, laid side by side so that its streets go on from one to the next.
//!
//! As image quilting (Efros and Freeman 2001), with blocks in place of pixels: squares of a lattice that is turned as the city's walls are
//! are filled one after the other. For each, patches are drawn at random places of the city and turned so that walls and
//! groups go on in the direction of those that stand around; of those whose plan agrees best with what stands, each is moved to where it agrees
//! best, and the one is taken after which the new city has most nearly as many buildings, blocks and built square metres as the old, as
//! attached, as large, as high and as far apart (`amount`), of ground that was seldom copied before. A group of near buildings is taken whole or not at all, but cut between
//! buildings at the edge of the shape. Then squares between those of
//! the lattice, and smaller ones, fill what stayed empty, until the ground is built on as in the old city.

use rand::RngExt;

use super::amount::Amount;
use super::exemplar::Exemplar;
use super::footprint::CELL;
use super::lattice::{Square, lattice, points};
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
/// by so much of what the shape has of the square at least,
const GAIN: f64 = 0.04;
/// where so much of it is free.
const ROOM: f64 = 0.1;
/// Widths of the rim that are tried.
const RIMS: i32 = 5;
/// Places at which the density of the old city is measured.
const MEASURED: usize = 4000;

/// A copy of a building: which, where, and its turn in degrees.
#[derive(Clone, Copy)]
pub(super) struct Copy {
    pub(super) source: usize,
    pub(super) at: [f64; 2],
    pub(super) turn: f64,
}

/// The distance in metres from a shape's edge within which nothing is counted: half the side of a building, as of a square, the mean
/// over built ground; less of it where that would leave less than half of the shape.
fn rim(city: &Exemplar, shape: &Shape) -> f64 {
    let areas = || city.buildings.iter().map(|b| b.footprint.points() as f64);
    let side = CELL * areas().map(|a| a * a.sqrt()).sum::<f64>() / areas().sum::<f64>();
    let squares = lattice(city, shape, city.side, [0.0; 2]);
    let ground = |rim: f64| {
        let within = |square: &Square| within(shape, rim, *square, city.axis);
        squares.iter().map(within).sum::<f64>()
    };
    let all = ground(0.0);
    let rims = (1..RIMS).map(|k| side * 0.5_f64.powi(k));
    rims.chain([0.0])
        .find(|rim| 2.0 * ground(*rim) >= all)
        .unwrap_or(0.0)
}

/// True if a point lies in the shape and at least so many metres from its edge, along the axes.
fn is_within(shape: &Shape, rim: f64, [x, y]: [f64; 2]) -> bool {
    let around = [[x - rim, y], [x + rim, y], [x, y - rim], [x, y + rim]];
    shape.contains([x, y]) && around.iter().all(|p| shape.contains(*p))
}

/// The share of a square, turned by so many degrees, that lies in the shape and at least so many metres from its edge.
fn within(shape: &Shape, rim: f64, square: Square, degrees: f64) -> f64 {
    let points = points(square, square.side, degrees);
    let within = points.iter().filter(|p| is_within(shape, rim, **p));
    within.count() as f64 / points.len() as f64
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
    /// Of a square of the first side in the old city.
    density: Amount,
    /// Nearer to the edge of the shape, in metres, fewer buildings can stand, since none is cut: nothing is counted there ([`rim`]).
    rim: f64,
    /// Of the new city so far, within the rim,
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
                let own = city.groups[group].buildings.iter().copied();
                density = density.plus(&Amount::of(city, own));
            }
        }
        Self {
            city,
            shape,
            ground: Occupancy::new(),
            copies: Vec::new(),
            laid: Vec::new(),
            copied: vec![0; city.groups.len()],
            density: density.times(1.0 / MEASURED as f64),
            rim: rim(city, shape),
            amount: Amount::default(),
            squares: 0.0,
        }
    }

    /// The share of a square of the lattice that is the ground of the new city.
    fn ground_of(&self, square: Square) -> f64 {
        within(self.shape, self.rim, square, self.city.axis)
    }

    /// True if as much ground is built on as in the old city.
    fn is_dense(&self) -> bool {
        self.amount.area >= self.density.area * self.squares
    }

    /// The unlikeness of an amount on so many squares to the old city.
    fn unlike(&self, amount: &Amount, squares: f64) -> f64 {
        amount.unlike(&self.density.times(squares))
    }

    /// The amount of the new city with groups laid beside it.
    fn with(&self, groups: &[(usize, Vec<Copy>)]) -> Amount {
        let copies = groups.iter().flat_map(|(_, copies)| copies);
        self.amount.plus(&self.counted(copies))
    }

    /// The patch of a square of the lattice: one that agrees with what stands, and keeps the density of the old city.
    fn first(&self, square: Square, rng: &mut Stream) -> Option<Patch> {
        let squares = self.squares + self.ground_of(square);
        let cost = |patch: &Patch| {
            let fitting = self.fitting(square, patch);
            let with = self.with(&fitting);
            let unlike = self.unlike(&with, squares) - self.unlike(&self.amount, self.squares);
            let repeated = self.repeated(square, &fitting);
            Some(patch.mismatch + STEER * unlike * squares + REPEAT * repeated)
        };
        self.search(square).best(true, cost, rng)
    }

    /// The patch of a square that is partly filled: one that agrees with what stands and covers most; `None` where little is won.
    fn later(&self, square: Square, rng: &mut Stream) -> Option<Patch> {
        let mut points = points(square, square.side, self.city.axis);
        let all = points.len() as f64;
        points.retain(|p| self.shape.contains(*p));
        let inside = points.len() as f64;
        let free = points.iter().filter(|p| self.ground.free(**p)).count();
        if (free as f64) < ROOM * inside {
            return None;
        }
        let ground = square.side * square.side * inside / all;
        let cost = |patch: &Patch| {
            let fitting = self.fitting(square, patch);
            // Whole buildings also at the edge.
            let copies = fitting.iter().flat_map(|(_, copies)| copies);
            let won = Amount::of(self.city, copies.map(|c| c.source)).area;
            let with = self.with(&fitting);
            let unlike = self.unlike(&with, self.squares) - self.unlike(&self.amount, self.squares);
            let cost = patch.mismatch - won / ground
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

    /// The amount of copies whose middles lie within the rim.
    fn counted<'c>(&self, copies: impl Iterator<Item = &'c Copy>) -> Amount {
        let counted = copies.filter(|c| {
            let [x, y] = rotated(self.city.buildings[c.source].middle, c.turn);
            is_within(self.shape, self.rim, [c.at[0] + x, c.at[1] + y])
        });
        Amount::of(self.city, counted.map(|c| c.source))
    }

    /// The share of a square that is covered by groups that were copied before, for each time.
    fn repeated(&self, square: Square, fitting: &[(usize, Vec<Copy>)]) -> f64 {
        let area = |(group, _): &(usize, _)| {
            f64::from(self.copied[*group]) * self.city.groups[*group].area
        };
        fitting.iter().map(area).sum::<f64>() / (square.side * square.side)
    }

    fn lay(&mut self, square: Square, patch: Patch) {
        let fitting = self.fitting(square, &patch);
        self.amount = self.with(&fitting);
        for (group, copies) in fitting {
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
