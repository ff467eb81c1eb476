//! Values of `rand`.

use std::cell::Cell;

/// Number of equal parts that a range is divided into, a prime.
pub(super) const DRAWS: usize = 5;

/// The value of every `rand` of an alternative: the middle of one of [`DRAWS`] equal parts of its range.
///
/// In the alternative for part k, the j-th `rand` takes part (j k + k) mod 5: any two of the first four
/// together take each part of one with a different part of the other, as a lattice rule has it.
#[derive(Default)]
pub(super) struct Draw {
    /// The part; `None` outside rules, where a range stands for its middle.
    part: Option<usize>,
    /// Number of values taken so far.
    taken: Cell<usize>,
}

impl Draw {
    pub(super) fn new(part: usize) -> Self {
        Self {
            part: Some(part),
            taken: Cell::new(0),
        }
    }

    pub(super) fn between(&self, low: f64, high: f64) -> f64 {
        let fraction = match self.part {
            None => 0.5,
            Some(part) => {
                let taken = self.taken.replace(self.taken.get() + 1);
                let part = part * (taken % (DRAWS - 1) + 1) % DRAWS;
                (part as f64 + 0.5) / DRAWS as f64
            }
        };
        low + fraction * (high - low)
    }
}
