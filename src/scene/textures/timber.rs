//! Timber: cladding, floors and paint. Boards and their grain run to the right.

use super::Sample;
use super::noise::{cell, ramp, smooth};

/// Boards in one repeat of cladding and its size in metres: boards of 180 mm.
const LAPS: usize = 8;
pub(super) const CLADDING: f64 = 0.18 * LAPS as f64;
/// Boards in one repeat of a floor and its size in metres: boards of 140 mm.
const PLANKS: usize = 10;
pub(super) const BOARDS: f64 = 0.14 * PLANKS as f64;

/// The board at a place, and the place in it in metres from its lower edge.
fn board(y: f64, count: usize, size: f64) -> (usize, f64) {
    let up = y * count as f64;
    let number = (up as usize).min(count - 1);
    (number, (up - number as f64) * size / count as f64)
}

/// Grain: long streaks, moved from board to board.
fn grain([x, y]: [f64; 2], number: usize, fields: u64) -> f64 {
    let x = x + cell(number, 0, fields);
    0.65 * smooth([x, y], [4, 128], fields + 1) + 0.35 * smooth([x, y], [16, 256], fields + 2)
}

/// Overlapping boards: the lower edge of each stands before the one below and throws a shadow on it.
pub(super) fn cladding(place: [f64; 2]) -> Sample {
    let (number, up) = board(place[1], LAPS, CLADDING);
    let exposed = CLADDING / LAPS as f64;
    let tone = 0.93 + 0.07 * cell(number, 0, 41);
    let shadow = 1.0 - 0.55 * ramp(exposed - 0.024, exposed - 0.006, up);
    Sample {
        share: [tone * shadow * (0.9 + 0.1 * grain(place, number, 42)); 3],
        joint: 0.0,
        height: 0.02 * (1.0 - up / exposed),
    }
}

/// Boards of a floor with gaps between them.
pub(super) fn boards(place: [f64; 2]) -> Sample {
    let (number, up) = board(place[1], PLANKS, BOARDS);
    let edge = up.min(BOARDS / PLANKS as f64 - up);
    let tone = 0.74 + 0.2 * cell(number, 0, 51);
    let solid = ramp(0.001, 0.006, edge);
    Sample {
        share: [tone * (0.76 + 0.24 * grain(place, number, 52)) * (0.25 + 0.75 * solid); 3],
        joint: 0.0,
        height: 0.006 * solid,
    }
}

/// Painted timber.
pub(super) fn paint(place: [f64; 2]) -> Sample {
    Sample {
        share: [0.94 + 0.06 * grain(place, 0, 61); 3],
        joint: 0.0,
        height: 0.0,
    }
}
