//! A lower bound on the distance of any house from a row of attributes, from what holds of every house.

use super::repair::LEAST_FLOOR;
use super::target::PARTS;
use crate::attributes::COLUMNS;

/// Columns of a row, and its numbers; the flags of styles follow.
const N: usize = COLUMNS.len();
const NUMBERS: usize = 39;
/// First of the four alignments of facades.
const ALIGNMENT: usize = 35;
/// Rows further away than this many standard deviations are not told apart, and steps of the bisection.
const FAR: f64 = 64.0;
const STEPS: usize = 60;

/// A distance in standard deviations, by the largest of the 39 numbers, that no house with storeys of at least
/// 2.1 m stays below: the least slack with which each single condition can hold.
///
/// The conditions: shares, alignments and symmetries lie in [0, 1]; the shares of the floors sum to one, fall
/// upwards and are 0 above the highest floor, and a house of one floor has no alignment; the height has room for the
/// floors; `far = bcr / arf.0`; a garage or porch lies inside the bounding box, front porches before its middle, back
/// porches behind it, and is no higher than the house, or all its numbers are 0; the boundary is at least that of the
/// bounding box. Each is met on its own by the best choice within the slack, so that all of them together may ask
/// for more: a bound, not the distance. O(1), some thousand operations.
pub fn least_z(row: &[f64; N], deviations: &[f64; N]) -> f64 {
    let holds = |slack: f64| Slack::new(row, deviations, slack).holds();
    if holds(0.0) {
        return 0.0;
    }
    let (mut below, mut above) = (0.0, FAR);
    for _ in 0..STEPS {
        let middle = (below + above) / 2.0;
        match holds(middle) {
            true => above = middle,
            false => below = middle,
        }
    }
    below
}

/// Values that each number may take.
struct Slack {
    low: [f64; NUMBERS],
    high: [f64; NUMBERS],
}

impl Slack {
    fn new(row: &[f64; N], deviations: &[f64; N], slack: f64) -> Self {
        // Measured attributes are rounded in the last digits.
        let reach = |c: usize| slack * deviations[c] + 1e-9 * (1.0 + row[c].abs());
        Self {
            // No attribute is negative.
            low: std::array::from_fn(|c| (row[c] - reach(c)).max(0.0)),
            high: std::array::from_fn(|c| row[c] + reach(c)),
        }
    }

    fn may_be(&self, c: usize, value: f64) -> bool {
        self.low[c] <= value && value <= self.high[c]
    }

    fn holds(&self) -> bool {
        let shares = (27..NUMBERS).all(|c| self.high[c] >= 0.0 && self.low[c] <= 1.0);
        shares
            && (0..NUMBERS).all(|c| self.high[c] >= 0.0)
            && (1..=3).any(|floors| self.floors(floors))
            && (0..PARTS.len()).all(|k| self.part(k))
            && self.boundary()
    }

    fn floors(&self, floors: usize) -> bool {
        let (below, above) = ([6, 7, 8].split_at(floors).0, 6 + floors..9);
        let sum = |of: &[f64; NUMBERS]| below.iter().map(|c| of[*c]).sum::<f64>();
        let falls = below.windows(2).all(|c| self.low[c[1]] <= self.high[c[0]]);
        let aligned = floors > 1 || (ALIGNMENT..NUMBERS).all(|c| self.may_be(c, 0.0));
        // The ground floor has at least its share, and all of it without others.
        let ground = [
            self.low[6].max(1.0 / floors as f64 - 1e-9),
            self.high[6].min(1.0 + 1e-9),
        ];
        let covered = self.high[3].min(1.0 + 1e-9);
        ground[0] <= ground[1]
            && self.low[3] <= covered
            && self.low[3] / ground[1] <= self.high[5]
            && covered / ground[0] >= self.low[5]
            && sum(&self.low) <= 1.0
            && sum(&self.high) >= 1.0
            && above.into_iter().all(|c| self.may_be(c, 0.0))
            && falls
            && aligned
            && self.high[2] >= LEAST_FLOOR * floors as f64
    }

    fn part(&self, k: usize) -> bool {
        let c = PARTS[k].1;
        let absent = (c..c + 6).all(|c| self.may_be(c, 0.0));
        let inside = |axis: usize| {
            let half = self.low[c + 2 + axis] / 2.0 / self.high[axis];
            self.high[c + axis] >= half && self.low[c + axis] <= 1.0 - half
        };
        let side = match k {
            1 => self.low[c + 1] <= 0.5,
            2 => self.high[c + 1] >= 0.5,
            _ => true,
        };
        absent
            || (inside(0)
                && inside(1)
                && side
                && self.low[c + 4] <= self.high[2]
                && self.low[c + 5] <= 1.0)
    }

    /// `bdry >= 2 (w + d) / sqrt(bcr w d)`, least for the box nearest to a square.
    fn boundary(&self) -> bool {
        let ratio = 1.0_f64
            .max(self.low[0] / self.high[1])
            .min(self.high[0] / self.low[1]);
        let least = 2.0 * (ratio.sqrt() + ratio.sqrt().recip());
        self.high[4] * self.high[3].min(1.0 + 1e-9).sqrt() >= least
    }
}
