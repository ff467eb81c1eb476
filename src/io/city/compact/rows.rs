//! Buildings beside buildings: neighbours mostly touch, or stand in line.
//!
//! Where a building stands is told in the frame of the one before it, (u, v), and as the difference from one of four places beside it:
//! before or behind it along its width, or along its depth, so near that the two touch; or from its own place. In whole steps a
//! frame is turned by quarters, which are exact, and by three shears with rounded shifts (Blair 1990's and Paeth's rotation), which
//! are undone without a loss. Sines come from their series in plain operations: the same bits on every machine.

use super::integers::bits_of;

/// Places beside a building, and its own.
pub(super) const PLACES: usize = 5;

/// A building in steps: where its middle is, how it is turned, its width and depth.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Footprint {
    pub(super) at: [i64; 2],
    pub(super) turn: i64,
    pub(super) size: [i64; 2],
}

/// A turn in whole steps, as quarters and shears.
struct Turn {
    quarters: i64,
    /// Shifts of x by y, and of y by x.
    shears: [f64; 2],
}

impl Turn {
    /// The turn by `turn` steps, `full` of them in a circle.
    fn of(turn: i64, full: i64) -> Self {
        let turn = turn.rem_euclid(full);
        let quarter = full / 4;
        let quarters = (turn + quarter / 2) / quarter;
        let rest = (turn - quarters * quarter) as f64 / full as f64 * std::f64::consts::TAU;
        let (sin, cos) = series(rest);
        Self {
            quarters: quarters % 4,
            shears: [-sin / (1.0 + cos), sin],
        }
    }

    /// From the frame to the plan.
    fn apply(&self, [x, y]: [i64; 2]) -> [i64; 2] {
        let [mut x, mut y] = match self.quarters {
            0 => [x, y],
            1 => [y.wrapping_neg(), x],
            2 => [x.wrapping_neg(), y.wrapping_neg()],
            _ => [y, x.wrapping_neg()],
        };
        let [p, q] = self.shears;
        x = x.wrapping_add(shift(p, y));
        y = y.wrapping_add(shift(q, x));
        x = x.wrapping_add(shift(p, y));
        [x, y]
    }

    /// From the plan to the frame: what [`Turn::apply`] undoes.
    fn undo(&self, [mut x, mut y]: [i64; 2]) -> [i64; 2] {
        let [p, q] = self.shears;
        x = x.wrapping_sub(shift(p, y));
        y = y.wrapping_sub(shift(q, x));
        x = x.wrapping_sub(shift(p, y));
        match self.quarters {
            0 => [x, y],
            1 => [y, x.wrapping_neg()],
            2 => [x.wrapping_neg(), y.wrapping_neg()],
            _ => [y.wrapping_neg(), x],
        }
    }
}

fn shift(share: f64, v: i64) -> i64 {
    (share * v as f64).round() as i64
}

/// Sine and cosine from -45 to 45 degrees, by their series.
fn series(x: f64) -> (f64, f64) {
    let square = x * x;
    let (mut sin, mut cos) = (1.0, 1.0);
    for k in [6.0, 5.0, 4.0, 3.0, 2.0, 1.0] {
        sin = 1.0 - square / (2.0 * k * (2.0 * k + 1.0)) * sin;
        cos = 1.0 - square / ((2.0 * k - 1.0) * (2.0 * k)) * cos;
    }
    (x * sin, cos)
}

impl Footprint {
    /// The place `place` beside this one in its frame, for a neighbour; `full`: steps of a circle.
    fn beside(&self, place: usize, neighbour: &Footprint, full: i64) -> [i64; 2] {
        let quarters = (neighbour.turn - self.turn).rem_euclid(full) + full / 8;
        let mut size = neighbour.size;
        if quarters / (full / 4) % 2 == 1 {
            size.swap(0, 1);
        }
        let far = [0, 1].map(|k| self.size[k].wrapping_add(size[k]) / 2);
        match place {
            0 => [far[0], 0],
            1 => [far[0].wrapping_neg(), 0],
            2 => [0, far[1]],
            3 => [0, far[1].wrapping_neg()],
            _ => [0, 0],
        }
    }

    /// The place beside this one that a neighbour is nearest to, and how far it is from there.
    pub(super) fn told(&self, neighbour: &Footprint, full: i64) -> (usize, [i64; 2]) {
        let away = [0, 1].map(|k| neighbour.at[k].wrapping_sub(self.at[k]));
        let own = Turn::of(self.turn, full).undo(away);
        let from = |place: usize| {
            let beside = self.beside(place, neighbour, full);
            (place, [0, 1].map(|k| own[k].wrapping_sub(beside[k])))
        };
        let places = (0..PLACES).map(from);
        // Its own place is told only where it is much better.
        let cost = |&(place, rest): &(usize, [i64; 2])| (bits(rest) + place / 4, sum(rest), place);
        places.min_by_key(cost).unwrap_or((PLACES - 1, own))
    }

    /// The middle of the neighbour of which [`Footprint::told`] told this; its own place is not looked at.
    pub(super) fn found(
        &self,
        neighbour: &Footprint,
        place: usize,
        rest: [i64; 2],
        full: i64,
    ) -> [i64; 2] {
        let beside = self.beside(place, neighbour, full);
        let own = [0, 1].map(|k| rest[k].wrapping_add(beside[k]));
        let away = Turn::of(self.turn, full).apply(own);
        [0, 1].map(|k| self.at[k].wrapping_add(away[k]))
    }
}

/// Bits of two numbers.
pub(super) fn bits(rest: [i64; 2]) -> usize {
    rest.iter().map(|v| bits_of(v.unsigned_abs())).sum()
}

fn sum(rest: [i64; 2]) -> u64 {
    rest[0]
        .unsigned_abs()
        .saturating_add(rest[1].unsigned_abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_undone_without_a_loss() {
        for turn in 0..720 {
            for v in [[0, 0], [1, -1], [123, -4567], [-1 << 39, 1 << 38]] {
                let turn = Turn::of(turn, 720);
                assert_eq!(turn.undo(turn.apply(v)), v);
                assert_eq!(turn.apply(turn.undo(v)), v);
            }
        }
    }

    #[test]
    fn a_turn_turns() {
        for turn in 0..720 {
            let angle = f64::from(turn) / 2.0_f64;
            let (sin, cos) = angle.to_radians().sin_cos();
            let [x, y] = Turn::of(i64::from(turn), 720).apply([1000, 500]);
            assert!((x as f64 - (1000.0 * cos - 500.0 * sin)).abs() < 2.0);
            assert!((y as f64 - (1000.0 * sin + 500.0 * cos)).abs() < 2.0);
        }
    }

    #[test]
    fn a_building_that_touches_another_is_told_in_few_bits() {
        for turn in (0..720).step_by(7) {
            let one = Footprint {
                at: [5000, -300],
                turn,
                size: [120, 80],
            };
            let mut other = Footprint {
                turn: (turn + 180) % 720,
                size: [60, 100],
                ..one
            };
            other.at = one.found(&other, 0, [1, -2], 720);
            assert_eq!(one.told(&other, 720), (0, [1, -2]));
            let blank = Footprint {
                at: [0; 2],
                ..other
            };
            assert_eq!(one.found(&blank, 0, [1, -2], 720), other.at);
        }
    }
}
