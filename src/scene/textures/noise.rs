//! Numbers that look random and are the same each time, and smooth fields of them that repeat.

/// A number from 0 to 1 for a place of a grid: the finalizer of SplitMix64 (Steele, Lea and Flood 2014, Fig. 17).
pub(super) fn cell(x: usize, y: usize, field: u64) -> f64 {
    let mut z = (x as u64) << 32 ^ (y as u64) << 8 ^ field;
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as f64 / u64::MAX as f64
}

/// A smooth field from 0 to 1 over the unit square that repeats: numbers on a grid of so many columns and rows, and
/// between them what they blend to.
pub(super) fn smooth([x, y]: [f64; 2], [columns, rows]: [usize; 2], field: u64) -> f64 {
    let split = |v: f64, n: usize| {
        let at = v.rem_euclid(1.0) * n as f64;
        let low = (at as usize).min(n - 1);
        (low, (low + 1) % n, ramp(0.0, 1.0, at - low as f64))
    };
    let (x0, x1, s) = split(x, columns);
    let (y0, y1, t) = split(y, rows);
    let blend = |a: f64, b: f64, s: f64| a + (b - a) * s;
    let row = |y: usize| blend(cell(x0, y, field), cell(x1, y, field), s);
    blend(row(y0), row(y1), t)
}

/// From 0 below `low` to 1 above `high`, smooth between them.
pub(super) fn ramp(low: f64, high: f64, v: f64) -> f64 {
    let t = ((v - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
