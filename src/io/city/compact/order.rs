//! Placements along Hilbert's curve, so that those that follow each other stand near each other.

use super::Steps;
use edifice_grammar::instance::Placement;

/// Halvings of the square.
const LEVELS: u32 = 20;

/// Sorts placements along Hilbert's curve over their plan; those of one cell by all their numbers, then by symbols and
/// identifiers. Numbers are compared as they are written, in steps.
pub(super) fn along_curve(placed: &mut [Placement], steps: &Steps) {
    let whole = |v: f64, steps: i64| (v * steps as f64).round() as i64;
    let plan = |p: &Placement| [0, 1].map(|k| whole(p.at[k], steps.length));
    let low = |k: usize| placed.iter().map(|p| plan(p)[k]).min().unwrap_or(0);
    let (x, y) = (low(0), low(1));
    placed.sort_by_cached_key(|p| {
        let [u, v] = plan(p);
        let lengths = p.at.iter().chain(&p.size);
        let mut numbers: Vec<i64> = lengths.map(|&v| whole(v, steps.length)).collect();
        numbers.push(whole(p.turn, steps.turn));
        let cell = hilbert(u.abs_diff(x), v.abs_diff(y));
        (cell, numbers, p.symbol.clone(), p.id.clone())
    });
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
