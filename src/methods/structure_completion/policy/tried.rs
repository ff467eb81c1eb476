//! The findings of earlier actions of a candidate: most actions fail, and many of them ask again.
//!
//! Elements are only added, so a place that was taken once stays taken. A place that depends on other items (by the
//! opposite neighbour's spacing, by snapping) is the same as long as none is added.

use super::growing::Growing;

/// Spacing of an extension.
#[derive(Debug, Clone, Copy)]
pub(super) enum SeedSpacing {
    /// That of the opposite neighbour.
    Opposite(f64),
    /// The observed one of this number.
    Observed(usize, f64),
    /// Any other spacing.
    Other(f64),
}

impl SeedSpacing {
    pub(super) fn length(self) -> f64 {
        match self {
            SeedSpacing::Opposite(length)
            | SeedSpacing::Observed(_, length)
            | SeedSpacing::Other(length) => length,
        }
    }

    /// Its bit among the spacings that are remembered.
    fn bit(self) -> Option<u64> {
        match self {
            SeedSpacing::Opposite(_) => Some(1 << 63),
            SeedSpacing::Observed(number, _) if number < 63 => Some(1 << number),
            SeedSpacing::Observed(..) | SeedSpacing::Other(_) => None,
        }
    }
}

/// The findings about one item as a seed, by direction (twice the axis, and one more forward).
#[derive(Debug, Clone, Copy)]
struct Known {
    /// Observed spacings at which the place for an element like the seed is taken.
    lasting: [u64; 4],
    /// Number of items for which the rest holds.
    items: usize,
    /// Spacings at which that place is taken, without and with snapping.
    passing: [[u64; 4]; 2],
    /// The opposite neighbour's spacing, where it was asked for.
    opposite: [Option<Option<f64>>; 4],
}

const NOTHING: Known = Known {
    lasting: [0; 4],
    items: 0,
    passing: [[0; 4]; 2],
    opposite: [None; 4],
};

/// The findings about all items.
#[derive(Debug, Default)]
pub(super) struct Tried(Vec<Known>);

fn side((axis, forward): (usize, bool)) -> usize {
    2 * axis + usize::from(forward)
}

impl Tried {
    fn of(&mut self, seed: usize, growing: &Growing) -> &mut Known {
        let items = growing.items.len();
        if self.0.len() < items {
            self.0.resize(items, NOTHING);
        }
        let known = &mut self.0[seed];
        if known.items != items {
            *known = Known {
                lasting: known.lasting,
                items,
                ..NOTHING
            };
        }
        known
    }

    /// The opposite neighbour's spacing ([`Growing::opposite`]).
    pub(super) fn opposite(
        &mut self,
        growing: &Growing,
        seed: usize,
        direction: (usize, bool),
    ) -> Option<f64> {
        let (axis, forward) = direction;
        *self.of(seed, growing).opposite[side(direction)]
            .get_or_insert_with(|| growing.opposite(&growing.items[seed], axis, forward))
    }

    /// True if the place for an element like the seed is known to be taken.
    pub(super) fn is_taken(
        &mut self,
        growing: &Growing,
        seed: usize,
        direction: (usize, bool),
        step: SeedSpacing,
        snap: bool,
    ) -> bool {
        let known = self.of(seed, growing);
        let side = side(direction);
        let taken = match step {
            SeedSpacing::Observed(..) if !snap => known.lasting[side],
            _ => known.passing[usize::from(snap)][side],
        };
        step.bit().is_some_and(|bit| taken & bit != 0)
    }

    /// Remembers that the place for an element like the seed is taken.
    pub(super) fn take(
        &mut self,
        growing: &Growing,
        seed: usize,
        direction: (usize, bool),
        step: SeedSpacing,
        snap: bool,
    ) {
        let known = self.of(seed, growing);
        let side = side(direction);
        let taken = match step {
            SeedSpacing::Observed(..) if !snap => &mut known.lasting[side],
            _ => &mut known.passing[usize::from(snap)][side],
        };
        *taken |= step.bit().unwrap_or(0);
    }
}
