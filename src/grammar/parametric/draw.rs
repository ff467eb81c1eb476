//! New facades from a library.
//!
//! 1. A facade of the library is drawn, and another one with the same root and counts, if there is one. Between two
//!    such facades every edge is `(1 - t) a + t b` with one `t` from 0 to 1 for all: what is aligned, equal, mirrored or
//!    repeated in both stays so.
//! 2. It gets the upper strips (floors) of a further facade, from a strip on that both have (`recombine.rs`): ground
//!    floors, orders of floors and roofs come together anew.
//! 3. Along each axis the number of columns or floors is drawn from the smoothed numbers of the library's facades, and columns and floors
//!    are inserted or taken away until the facade has it, as far as it can be done without a seam (`bands.rs`).
//!
//! This is not the distribution of codes ([`Library::draw_code`]), which draws every size for itself
//! and is the one that bits speak of.

use rand::{Rng, RngExt};

use super::bands::{levels, with_band};
use super::error::LibraryError;
use super::library::{Library, Member};
use super::tree;
use edifice_shape::{Axis, Facade, LabelGrid, Rect, Region, decompose};

/// Share of the draws whose number of floors or columns is beside that of a facade.
const SMOOTHING: f64 = 0.3;

impl Library {
    /// Draws a new facade.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] when a member does not fit the rules, which a checked library has not.
    pub fn draw<R: Rng>(&self, rng: &mut R, name: &str) -> Result<Facade, LibraryError> {
        let members = self.members();
        let first = &members[rng.random_range(0..members.len())];
        let alike: Vec<&Member> = members
            .iter()
            .filter(|m| m.parse.root == first.parse.root && m.parse.counts == first.parse.counts)
            .collect();
        let second = alike[rng.random_range(0..alike.len())];
        let between = self.between(first, second, rng.random(), name)?;
        let whole = match self.recombined((first, &between), rng)? {
            Some(joined) => joined,
            None => between,
        };
        let wrong = |message: String| LibraryError::Invalid {
            place: name.to_owned(),
            message,
        };
        let mut grid = LabelGrid::from_facade(&whole, None)
            .map_err(|e| wrong(e.to_string()))?
            .merged();
        for axis in Axis::BOTH {
            let from = levels(&whole, axis);
            let other = &members[rng.random_range(0..members.len())];
            let to = neighbouring(levels(&self.facade(&other.parse, name)?, axis), rng);
            for _ in 0..from.abs_diff(to).min(4) {
                match with_band(&grid, axis, to > from, rng) {
                    Some(edited) => grid = edited,
                    None => break,
                }
            }
        }
        Ok(decompose(&grid).map_err(|e| wrong(e.to_string()))?.facade)
    }

    /// The facade between two members of the same root and counts.
    pub(super) fn between(
        &self,
        a: &Member,
        b: &Member,
        t: f64,
        name: &str,
    ) -> Result<Facade, LibraryError> {
        let edges = |member: &Member| {
            let mut edges = Vec::new();
            tree::unfold(
                &member.parse,
                self.rules().rules(),
                |label, [x, y], [w, h]| {
                    edges.push((label, [x, y, x + w, y + h].map(f64::from)));
                },
            )?;
            Ok::<_, LibraryError>(edges)
        };
        let (a, b) = (edges(a)?, edges(b)?);
        let cuts = [0, 1].map(|axis| {
            let pairs = a
                .iter()
                .zip(&b)
                .flat_map(|((_, a), (_, b))| [(a[axis], b[axis]), (a[axis + 2], b[axis + 2])]);
            mixed(pairs.collect(), t)
        });
        let place = |axis: usize, a: f64, b: f64| {
            let at = cuts[axis].iter().find(|cut| (cut.0, cut.1) == (a, b));
            at.map_or(0.0, |cut| cut.2) * self.step()
        };
        let regions = a.iter().zip(&b).map(|((label, a), (_, b))| {
            let edge = |k: usize| place(k % 2, a[k], b[k]);
            let label = self.rules().labels()[*label as usize].clone();
            let rect = Rect::new(edge(0), edge(1), edge(2) - edge(0), edge(3) - edge(1));
            Region { label, rect }
        });
        let regions = regions.collect();
        let [width, height] = [0, 1].map(|axis| {
            let last = cuts[axis].iter().map(|cut| cut.2).fold(0.0, f64::max);
            last * self.step()
        });
        Facade::new(name, self.unit(), width, height, regions).map_err(|source| {
            LibraryError::Layout {
                name: name.to_owned(),
                source,
            }
        })
    }
}

/// The number that a facade of the library has, or one beside it: a smoothed histogram, since a library of few
/// facades has not seen all numbers of floors and columns.
fn neighbouring<R: Rng>(seen: u32, rng: &mut R) -> u32 {
    match rng.random::<f64>() {
        t if t < 0.5 * SMOOTHING => seen.saturating_sub(1).max(1),
        t if t < SMOOTHING => seen + 1,
        _ => seen,
    }
}

/// The places between two: of pairs of coordinates, with a share `t` of the second. Steps from one place to the next that are
/// equal in both stay equal, and none vanishes.
fn mixed(mut pairs: Vec<(f64, f64)>, t: f64) -> Vec<(f64, f64, f64)> {
    let mix = |pair: &(f64, f64)| pair.0 + t * (pair.1 - pair.0);
    pairs.sort_by(|x, y| {
        mix(x)
            .total_cmp(&mix(y))
            .then(x.0.total_cmp(&y.0))
            .then(x.1.total_cmp(&y.1))
    });
    pairs.dedup();
    let mut places: Vec<(f64, f64, f64)> = Vec::with_capacity(pairs.len());
    for pair in pairs {
        let place = match places.last() {
            None => 0.0,
            Some(&(a, b, place)) => place + mix(&(pair.0 - a, pair.1 - b)).round().max(1.0),
        };
        places.push((pair.0, pair.1, place));
    }
    places
}
