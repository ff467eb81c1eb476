//! Pantiles and shingles of sloped roofs. Courses run along the eaves, each over the upper end of the one below.

use std::f64::consts::TAU;

use super::Sample;
use super::noise::{cell, ramp, smooth};

/// Width and height of one repeat in metres.
pub(super) const SIZE: f64 = 1.8;
/// Pantiles of a row, and rows: 225 by 300 mm.
const TILES: [usize; 2] = [8, 6];
/// Tabs of a course, and courses: 300 by 150 mm.
const TABS: [usize; 2] = [6, 12];

/// Row and column of a place, and where in it: across from 0 to 1, up from its lower edge in metres.
fn piece([x, y]: [f64; 2], count: [usize; 2], moved: f64) -> ([usize; 2], [f64; 2]) {
    let up = y * count[1] as f64;
    let row = (up as usize).min(count[1] - 1);
    let along = (x * count[0] as f64 + moved * (row % 2) as f64) % count[0] as f64;
    let column = along as usize;
    let metres = (up - row as f64) * SIZE / count[1] as f64;
    ([column, row], [along - column as f64, metres])
}

/// Clay pantiles: a wave across, a step at the lower edge of each row.
pub(super) fn tiles(place: [f64; 2]) -> Sample {
    let ([column, row], [across, up]) = piece(place, TILES, 0.0);
    let gauge = SIZE / TILES[1] as f64;
    let wave = 0.5 + 0.5 * (TAU * across).sin();
    let tone = 0.78 + 0.22 * cell(column, row, 21);
    let grain = 0.94 + 0.06 * smooth(place, [96, 96], 22);
    // The upper end lies in the shadow of the next row, and troughs in that of the waves beside them.
    let shadow = 1.0 - 0.62 * ramp(gauge - 0.035, gauge - 0.008, up);
    let trough = 0.7 + 0.3 * ramp(0.0, 0.6, wave);
    Sample {
        share: [tone * grain * shadow * trough; 3],
        joint: 0.0,
        height: 0.035 * wave + 0.022 * (1.0 - up / gauge),
    }
}

/// Asphalt shingles: tabs with slots between them, of several tones.
pub(super) fn shingles(place: [f64; 2]) -> Sample {
    let ([column, row], [across, up]) = piece(place, TABS, 0.5);
    let course = SIZE / TABS[1] as f64;
    let width = SIZE / TABS[0] as f64;
    let tone = 0.66 + 0.34 * cell(column, row, 34);
    let granules = 0.8 + 0.2 * smooth(place, [128, 128], 32);
    let slot = ramp(0.002, 0.006, across.min(1.0 - across) * width);
    let shadow = 1.0 - 0.55 * ramp(course - 0.022, course - 0.004, up);
    Sample {
        share: [tone * granules * shadow * (0.45 + 0.55 * slot); 3],
        joint: 0.0,
        height: 0.009 * (1.0 - up / course) + 0.003 * slot,
    }
}
