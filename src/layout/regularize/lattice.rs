//! The grid of numbers that the coordinates of a layout lie on.

/// Coordinates that differ by less, as a part of the longer side, are equal.
pub(super) const SAME: f64 = 1e-7;

/// Most steps along the longer side of a layout that lies on a lattice.
const MAX_STEPS: usize = 50_000;

/// Units of a layout without a lattice along its longer side.
const FINE: f64 = 1_048_576.0;

/// The unit that positions are counted in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lattice {
    /// Longer side.
    longer: f64,
    /// Units along it.
    steps: f64,
    /// True if all coordinates are whole numbers of units.
    pub whole: bool,
}

impl Lattice {
    /// The coarsest lattice that all coordinates lie on. It scales with them.
    pub(super) fn of(xs: &[f64], ys: &[f64]) -> Self {
        let last = |cuts: &[f64]| cuts[cuts.len() - 1];
        let longer = last(xs).max(last(ys));
        let on = |steps: usize| {
            let steps = steps as f64;
            let near = |&c: &f64| {
                let at = c / longer * steps;
                (at - at.round()).abs() <= SAME * steps
            };
            xs.iter().chain(ys).all(near)
        };
        match (1..=MAX_STEPS).find(|&steps| on(steps)) {
            Some(steps) => Self {
                longer,
                steps: steps as f64,
                whole: true,
            },
            None => Self {
                longer,
                steps: FINE,
                whole: false,
            },
        }
    }

    /// A length in units.
    pub(super) fn units(&self, length: f64) -> f64 {
        length / self.longer * self.steps
    }

    /// Coordinates in units.
    pub(super) fn positions(&self, cuts: &[f64]) -> Vec<f64> {
        let at = cuts.iter().map(|&c| self.units(c));
        match self.whole {
            true => at.map(f64::round).collect(),
            false => at.collect(),
        }
    }

    /// A position as a coordinate.
    pub(super) fn coordinate(&self, position: f64) -> f64 {
        position * self.longer / self.steps
    }

    /// Units below which positions are equal.
    pub(super) fn slack(&self) -> f64 {
        match self.whole {
            true => 0.0,
            false => 0.01 * SAME * FINE,
        }
    }

    /// Units below which sizes are equal.
    pub(super) fn same(&self) -> f64 {
        match self.whole {
            true => 0.5,
            false => 2.0 * SAME * FINE,
        }
    }
}
