//! The ground of the new city: what buildings cover, what stays open, and what has been decided.

use super::footprint::{CELL, Footprint, OPEN_CELL};
use super::raster::Raster;
use super::shape::{Shape, rotated};

/// Share of the inner points of a group that may lie on others.
const OVERLAP: f64 = 0.004;
/// Share of a group that may lie on the open ground of others, and of its open ground that others may cover.
const INTRUSION: f64 = 0.12;
/// Share of the rim of a building that may lie outside the shape.
const OUTSIDE: f64 = 0.004;
/// Side of the cells that have been decided, in metres.
const DECIDED_CELL: f64 = 4.0;

/// The knowledge of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ground {
    /// A building stands there.
    Built,
    /// The open ground of a building, or ground that a patch left open.
    Open,
    /// Nothing has been put there yet.
    Undecided,
}

/// Ground that buildings stand on.
#[derive(Debug)]
pub(super) struct Occupancy {
    built: Raster,
    open: Raster,
    decided: Raster,
}

/// A footprint, where it would stand.
#[derive(Clone, Copy)]
pub(super) struct Standing<'a> {
    pub(super) footprint: &'a Footprint,
    pub(super) at: [f64; 2],
    pub(super) turn: f64,
}

impl Standing<'_> {
    fn placed<'a>(&'a self, points: &'a [[f64; 2]]) -> impl Iterator<Item = [f64; 2]> + 'a {
        let (sin, cos) = self.turn.to_radians().sin_cos();
        let at = self.at;
        points
            .iter()
            .map(move |[x, y]| [at[0] + x * cos - y * sin, at[1] + x * sin + y * cos])
    }

    /// True if it lies inside the shape.
    pub(super) fn inside(&self, shape: &Shape) -> bool {
        let edge = self.footprint.edge();
        let most = (OUTSIDE * edge.len() as f64) as usize;
        let outside = self.placed(edge).filter(|p| !shape.contains(*p));
        outside.take(most + 1).count() <= most
    }
}

impl Occupancy {
    /// Ground on which nothing stands.
    pub(super) fn new() -> Self {
        Self {
            built: Raster::new(CELL),
            open: Raster::new(OPEN_CELL),
            decided: Raster::new(DECIDED_CELL),
        }
    }

    /// The knowledge of a point.
    pub(super) fn ground(&self, p: [f64; 2]) -> Ground {
        if self.built.at(p) > 0 {
            Ground::Built
        } else if self.open.at(p) > 0 || self.decided.at(p) > 0 {
            Ground::Open
        } else {
            Ground::Undecided
        }
    }

    /// True if nothing stands at a point, and it is not the open ground of a building.
    pub(super) fn free(&self, p: [f64; 2]) -> bool {
        self.built.at(p) == 0 && self.open.at(p) == 0
    }

    /// True if the buildings of a group fit together: on nothing that stands, beyond the open ground of others, and nothing on theirs.
    pub(super) fn fits(&self, group: &[Standing]) -> bool {
        let inner: usize = group.iter().map(|s| s.footprint.inner.len()).sum();
        let open: usize = group.iter().map(|s| s.footprint.open.len()).sum();
        let at_most = |share: f64, of: usize, hits: &mut dyn Iterator<Item = [f64; 2]>| {
            let most = (share * of as f64) as usize;
            hits.take(most + 1).count() <= most
        };
        let covered = || group.iter().flat_map(|s| s.placed(&s.footprint.inner));
        let around = || group.iter().flat_map(|s| s.placed(&s.footprint.open));
        inner > 0
            && at_most(
                OVERLAP,
                inner,
                &mut covered().filter(|p| self.built.at(*p) > 0),
            )
            && at_most(
                INTRUSION,
                inner,
                &mut covered().filter(|p| self.open.at(*p) > 0),
            )
            && at_most(
                INTRUSION,
                open,
                &mut around().filter(|p| self.built.at(*p) > 0),
            )
    }

    /// Puts a building down.
    pub(super) fn take(&mut self, standing: &Standing) {
        let print = standing.footprint;
        for p in standing
            .placed(&print.inner)
            .chain(standing.placed(&print.rim))
        {
            *self.built.at_mut(p) = 1;
        }
        for p in standing.placed(&print.open) {
            *self.open.at_mut(p) = 1;
        }
    }

    /// A square of so many metres is decided: what no building covers there is meant to be open.
    pub(super) fn decide(&mut self, middle: [f64; 2], side: f64, degrees: f64) {
        // Half cells, so that a turned square has no holes.
        let step = DECIDED_CELL / 2.0;
        let half = (side / 2.0 / step) as i64;
        for i in -half..half {
            for j in -half..half {
                let [x, y] = rotated([i, j].map(|v| (v as f64 + 0.5) * step), degrees);
                *self.decided.at_mut([middle[0] + x, middle[1] + y]) = 1;
            }
        }
    }
}
