//! Doors of a ground floor.

use super::boxes::Box4;

/// A door smaller than this share of the largest one's area is a speck: those to cellars and yards are small, too.
const SPECK: f64 = 0.1;

/// The largest door, last, and those that begin below its middle and are no specks beside it.
pub(super) fn on_the_ground(mut doors: Vec<Box4>) -> Vec<Box4> {
    doors.sort_by(|a, b| a.area().total_cmp(&b.area()));
    if let Some(&largest) = doors.last() {
        let middle = (largest.y[0] + largest.y[1]) / 2.0;
        doors.retain(|b| b.y[0] < middle && b.area() >= SPECK * largest.area());
    }
    doors
}
