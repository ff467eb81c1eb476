//! Placements along Hilbert's curve, so that those that follow each other stand near each other.

use super::Steps;
use crate::grammar::instance::Placement;

/// Halvings of the square.
const LEVELS: u32 = 20;

/// Sorts placements along Hilbert's curve over their plan; those of one cell by all their numbers, then by identifiers.
pub(super) fn along_curve(placed: &mut [Placement], steps: &Steps) {
    let low = |k: usize| placed.iter().map(|p| p.at[k]).fold(f64::INFINITY, f64::min);
    let (x, y) = (low(0), low(1));
    let cell = |p: &Placement| {
        let scale = steps.length as f64;
        let [u, v] = [p.at[0] - x, p.at[1] - y].map(|v| (v * scale).round() as u64);
        hilbert(u, v)
    };
    placed.sort_by_cached_key(|p| {
        let numbers: Vec<i64> =
            p.at.iter()
                .chain(&p.size)
                .chain([&p.turn])
                .map(|&v| ordered(v))
                .collect();
        (cell(p), numbers, p.symbol.clone(), p.id.clone())
    });
}

/// Whole numbers in the order of numbers.
fn ordered(v: f64) -> i64 {
    let bits = v.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// The distance along the curve of a cell of a square of 2^20 cells a side, in which larger coordinates wrap.
fn hilbert(x: u64, y: u64) -> u64 {
    let side = 1_u64 << LEVELS;
    let (mut x, mut y) = (x % side, y % side);
    let mut far = 0;
    let mut half = side / 2;
    while half > 0 {
        let (right, up) = (u64::from(x & half > 0), u64::from(y & half > 0));
        far += half * half * ((3 * right) ^ up);
        if up == 0 {
            if right == 1 {
                x = side - 1 - x;
                y = side - 1 - y;
            }
            std::mem::swap(&mut x, &mut y);
        }
        half /= 2;
    }
    far
}
