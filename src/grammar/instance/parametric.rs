//! Rules with parameters.
//!
//! `B(w, d, h1, ..., hn) -> ⊕ E_l T_l`: an instance of B states its width w, its depth d and the heights h1, ..., hn of its levels,
//! in metres. A successor's lengths along x are shares of w and those along y shares of d. It stands at a level: 0 is the base, k the
//! height h1 + ... + hk, and between two levels the height grows evenly; its height is a share of that of the level that it
//! stands on: at level 1 with a height of 1, it reaches from h1 to h1 + h2. A successor that is turned by t has, of its width s, s times the length of (w cos t, d sin t), and of its
//! depth, s times that of (w sin t, d cos t).
//!
//! Lengths that a rule computes are rounded to the centimetre, so that a derived city becomes the grammar that it was derived
//! from.

use super::{InstanceRule, Placement};

/// Steps of a metre of what rules compute.
const STEPS: f64 = 100.0;

impl InstanceRule {
    /// A rule without parameters.
    pub fn new(symbol: impl Into<String>, weight: f64, successors: Vec<Placement>) -> Self {
        Self {
            symbol: symbol.into(),
            weight,
            levels: 0,
            row: false,
            scale: [1.0; 3],
            successors,
        }
    }

    /// Number of numbers that an instance states: 0 without parameters.
    pub fn parameters(&self) -> usize {
        match self.levels {
            0 => 0,
            levels => levels + 2,
        }
    }

    /// The place of a successor in an instance with these numbers, in metres, before [`InstanceRule::scale`]; for a rule
    /// without parameters, the successor itself. Numbers that are missing are 0.
    pub fn part(&self, index: usize, numbers: &[f64]) -> Placement {
        let successor = &self.successors[index];
        if self.levels == 0 {
            return successor.clone();
        }
        let number = |k: usize| numbers.get(k).copied().unwrap_or(0.0);
        let height = |level: f64| -> f64 {
            let share = |k: usize| (level - k as f64).clamp(0.0, 1.0);
            (0..self.levels).map(|k| share(k) * number(k + 2)).sum()
        };
        let round = |v: f64| (v * STEPS).round() / STEPS + 0.0;
        let least = |v: f64| round(v).max(1.0 / STEPS);
        let level = successor.at[2];
        let tall = successor.size[2] * number(level.max(0.0) as usize + 2);
        let [along, across] = along_and_across(successor.turn, number(0), number(1));
        let mut out = successor.clone();
        out.at = [
            round(successor.at[0] * number(0)),
            round(successor.at[1] * number(1)),
            round(height(level)),
        ];
        out.size = [
            least(successor.size[0] * along),
            least(successor.size[1] * across),
            least(tall),
        ];
        out
    }

    /// True if all factors are 1.
    pub fn is_unscaled(&self) -> bool {
        self.scale == [1.0; 3]
    }

    /// A part, in metres, by the factors of the rule.
    pub fn scaled(&self, part: &Placement) -> Placement {
        let [x, y, z] = self.scale;
        let [along, across] = along_and_across(part.turn, x, y);
        let mut out = part.clone();
        out.at = [part.at[0] * x, part.at[1] * y, part.at[2] * z];
        out.size = [
            part.size[0] * along,
            part.size[1] * across,
            part.size[2] * z,
        ];
        out
    }
}

/// Lengths w along x and d along y, measured along the width and the depth of what is turned by degrees.
pub(super) fn along_and_across(turn: f64, w: f64, d: f64) -> [f64; 2] {
    let (sin, cos) = turn.to_radians().sin_cos();
    [(w * cos).hypot(d * sin), (w * sin).hypot(d * cos)]
}
