//! Bricks and plaster.

use super::Sample;
use super::noise::{cell, ramp, smooth};

/// Length and height of a brick with its joints in metres: the standard brick of 215 by 65 mm and joints of 10 mm.
const BRICK: [f64; 2] = [0.225, 0.075];
/// Bricks of a course, and courses, in one repeat.
const COUNT: [usize; 2] = [6, 18];
/// Width and height of one repeat in metres.
pub(super) const SIZE: f64 = BRICK[0] * COUNT[0] as f64;
/// Half the width of a joint in metres, and how far it lies back.
const JOINT: f64 = 0.005;
const RAKE: f64 = 0.006;

/// Stretcher bond: every second course is moved by half a brick.
pub(super) fn brick([x, y]: [f64; 2]) -> Sample {
    let up = y * COUNT[1] as f64;
    let course = (up as usize).min(COUNT[1] - 1);
    let along = (x * COUNT[0] as f64 + 0.5 * (course % 2) as f64) % COUNT[0] as f64;
    let number = along as usize;
    let inside = |v: f64, size: f64| v.min(1.0 - v) * size;
    let edge = inside(along - number as f64, BRICK[0]).min(inside(up - course as f64, BRICK[1]));
    let solid = ramp(JOINT - 0.0015, JOINT + 0.0015, edge);
    // Burnt more or less, a few of them dark.
    let burnt = cell(number, course, 1);
    let dark = if cell(number, course, 2) < 0.09 {
        0.8
    } else {
        1.0
    };
    let grain =
        0.9 + 0.1 * smooth([x, y], [128, 128], 3) + 0.08 * (smooth([x, y], [48, 48], 4) - 0.5);
    let share = (0.74 + 0.22 * burnt) * dark * grain;
    let hue = 0.1 * (cell(number, course, 5) - 0.5);
    Sample {
        share: [share * (1.0 + hue), share, share * (1.0 - hue)],
        joint: 1.0 - solid,
        height: RAKE * ramp(JOINT - 0.003, JOINT + 0.004, edge),
    }
}

/// Render with a fine grain and faint clouds.
pub(super) fn plaster(place: [f64; 2]) -> Sample {
    let clouds = smooth(place, [4, 4], 11);
    let middle = smooth(place, [24, 24], 12);
    let fine = smooth(place, [64, 64], 13);
    Sample {
        share: [0.86 + 0.05 * clouds + 0.04 * middle + 0.05 * fine; 3],
        joint: 0.0,
        height: 0.002 * fine + 0.003 * middle,
    }
}
