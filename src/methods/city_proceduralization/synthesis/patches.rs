//! The search for a patch: drawn at random, turned as what stands, moved to where it agrees best.

use rand::RngExt;
use rayon::prelude::*;

use super::exemplar::{Exemplar, direction};
use super::lattice::{Square, points};
use super::occupancy::{Ground, Occupancy};
use super::shape::rotated;
use edifice_base::rng::Stream;

/// Patches drawn for a square,
const DRAWN: usize = 400;
/// and so many of them tried that agree best with what stands.
const TRIED: usize = 24;
/// Buildings and open ground are compared so far around a square, in metres.
const AROUND: f64 = 48.0;
/// Steps by which a patch is moved to where it agrees best, in metres, as judged by every so many known points.
const STEPS: [(f64, usize); 4] = [(16.0, SPARSE), (8.0, SPARSE), (4.0, 2), (2.0, 1)];
/// Patches that are drawn are judged by every so many known points.
const SPARSE: usize = 7;

/// A patch: the place where it is taken, its turn in degrees, and its disagreement with what stands.
#[derive(Clone, Copy)]
pub(super) struct Patch {
    pub(super) from: [f64; 2],
    pub(super) turn: f64,
    pub(super) mismatch: f64,
}

/// A point about the middle of a square of which it is known whether a building stands there.
#[derive(Clone, Copy)]
struct Known {
    at: [f64; 2],
    built: bool,
}

/// A group of the new city: its middle, and the directions of its walls and of its length.
pub(super) struct Laid {
    pub(super) middle: [f64; 2],
    pub(super) walls: [f64; 2],
    pub(super) length: [f64; 2],
}

/// The search for the patch of a square beside what was laid.
pub(super) struct Search<'a> {
    pub(super) city: &'a Exemplar,
    pub(super) ground: &'a Occupancy,
    pub(super) laid: &'a [Laid],
    pub(super) square: Square,
}

impl Search<'_> {
    /// The cheapest of the patches that agree best with what stands. `whole`: what was decided to be open is to stay so.
    pub(super) fn best(
        &self,
        whole: bool,
        cost: impl Fn(&Patch) -> Option<f64> + Sync,
        rng: &mut Stream,
    ) -> Option<Patch> {
        let window = self.window(whole);
        let draws: Vec<[f64; 4]> = (0..DRAWN)
            .map(|_| std::array::from_fn(|_| rng.random()))
            .collect();
        let around = self.directions();
        let drawn = |draw: &[f64; 4]| self.drawn(&window, around, *draw);
        let mut patches: Vec<Patch> = draws.par_iter().map(drawn).collect();
        // The sort is stable: the same order for any number of threads.
        patches.sort_by(|a, b| a.mismatch.total_cmp(&b.mismatch));
        patches.truncate(TRIED);
        let tried: Vec<(Patch, Option<f64>)> = patches
            .par_iter()
            .map(|p| self.moved(&window, *p))
            .map(|p| (p, cost(&p)))
            .collect();
        let cheapest = tried.into_iter().filter_map(|(p, c)| Some((p, c?)));
        Some(cheapest.min_by(|a, b| a.1.total_cmp(&b.1))?.0)
    }

    /// The points around a square that are known.
    fn window(&self, whole: bool) -> Vec<Known> {
        let known = |p: [f64; 2]| match self.ground.ground(p) {
            Ground::Built => Some(true),
            Ground::Open => (whole || !self.ground.free(p)).then_some(false),
            Ground::Undecided => None,
        };
        let [x, y] = self.square.middle;
        let points = points(self.square, self.square.side + 2.0 * AROUND, self.city.axis);
        let about = |p: [f64; 2]| {
            let built = known(p)?;
            let at = [p[0] - x, p[1] - y];
            Some(Known { at, built })
        };
        points.into_iter().filter_map(about).collect()
    }

    /// The directions of the walls and of the length of the groups that stand around; zeros where none does.
    fn directions(&self) -> [[f64; 2]; 2] {
        let reach = self.square.side / 2.0 + AROUND;
        let near = self.laid.iter().filter(|l| {
            let [x, y] = [0, 1].map(|k| (l.middle[k] - self.square.middle[k]).abs());
            x.max(y) < reach
        });
        let (mut walls, mut length) = ([0.0; 2], [0.0; 2]);
        for group in near {
            walls = [0, 1].map(|k| walls[k] + group.walls[k]);
            length = [0, 1].map(|k| length[k] + group.length[k]);
        }
        [walls, length]
    }

    /// A patch from a random place, turned as the walls and the length of what stands around.
    fn drawn(&self, window: &[Known], [walls, length]: [[f64; 2]; 2], draw: [f64; 4]) -> Patch {
        let city = self.city;
        let from = city.place([draw[0], draw[1], draw[2]]);
        let mut turn = 0.0;
        if walls != [0.0; 2] {
            let (mut own, mut along) = ([0.0; 2], [0.0; 2]);
            for group in city.within(from, self.square.side + AROUND, city.axis) {
                own = [0, 1].map(|k| own[k] + city.groups[group].walls[k]);
                along = [0, 1].map(|k| along[k] + city.groups[group].length[k]);
            }
            turn = direction(walls, 4.0) - direction(own, 4.0);
            let across = (direction(length, 2.0) - direction(along, 2.0) - turn).rem_euclid(180.0);
            if (45.0..135.0).contains(&across) {
                turn += 90.0;
            }
            if draw[3] < 0.5 {
                turn += 180.0;
            }
        }
        let mismatch = self.mismatch(window, SPARSE, from, turn);
        Patch {
            from,
            turn,
            mismatch,
        }
    }

    /// The disagreement of a patch with every `step`th known point: the sum of differences over the points where buildings stand, or
    /// over a fifth of the points, if that is more.
    fn mismatch(&self, window: &[Known], step: usize, from: [f64; 2], turn: f64) -> f64 {
        let (mut sum, mut built, mut all) = (0.0, 0usize, 0usize);
        let (sin, cos) = (-turn).to_radians().sin_cos();
        for known in window.iter().step_by(step) {
            let [x, y] = known.at;
            let p = [from[0] + x * cos - y * sin, from[1] + x * sin + y * cos];
            sum += (self.city.built(p) - f64::from(u8::from(known.built))).abs();
            built += usize::from(known.built);
            all += 1;
        }
        sum / (built as f64).max(0.2 * all as f64).max(1.0)
    }

    /// The patch, moved downhill to where it disagrees least.
    fn moved(&self, window: &[Known], mut patch: Patch) -> Patch {
        if window.is_empty() {
            return patch;
        }
        for (step, sparse) in STEPS {
            patch.mismatch = self.mismatch(window, sparse, patch.from, patch.turn);
            loop {
                let around = [[step, 0.0], [-step, 0.0], [0.0, step], [0.0, -step]].map(|d| {
                    let [x, y] = rotated(d, self.city.axis);
                    let from = [patch.from[0] + x, patch.from[1] + y];
                    (from, self.mismatch(window, sparse, from, patch.turn))
                });
                let Some((from, mismatch)) = around.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))
                else {
                    break;
                };
                if mismatch >= patch.mismatch - 1e-9 {
                    break;
                }
                patch = Patch {
                    from,
                    mismatch,
                    ..patch
                };
            }
        }
        patch
    }
}
