//! Sampled rows of attributes that no house can have, repaired (Sec. 7: samples conflict a little).

use super::contradiction::least_boundary;
use super::target::{FLOOR_SHARE, PARTS, floors, part};
use crate::attributes::COLUMNS;

/// Columns of a row.
const N: usize = COLUMNS.len();
/// A part smaller or lower than this is absent (m).
const ABSENT: [f64; 2] = [0.8, 1.2];
/// Least height of a floor and of a part (m).
pub(super) const LEAST_FLOOR: f64 = 2.1;
const LEAST_PART: f64 = 1.8;
/// Alignment nearer than this to none or all is none or all.
const NEARLY: f64 = 0.12;
/// Room between parts that overlapped (m).
const APART: f64 = 0.05;

/// A sampled value that was moved.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Change {
    /// Name of the column.
    pub column: &'static str,
    /// The sampled value.
    pub from: f64,
    /// The value in its place.
    pub to: f64,
}

/// Moves sampled values as little as needed for a house to have them; given ones stay. What remains impossible is
/// missed, and the report of the house says by how much.
pub fn repair(row: &mut [f64; N], given: &[bool; N], deviations: &[f64; N]) -> Vec<Change> {
    let before = *row;
    let mut set = |row: &mut [f64; N], c: usize, value: f64| {
        if !given[c] && value.is_finite() {
            row[c] = value;
        }
    };
    for c in 27..39 {
        let most = if c < 31 { 0.6 } else { 1.0 };
        let mut value = row[c].clamp(0.0, most);
        // A few pairs of pieces have few ratios: what is nearly all or none is all or none.
        if c >= 35 && value < NEARLY {
            value = 0.0;
        } else if c >= 35 && value > 1.0 - NEARLY {
            value = 1.0;
        }
        set(row, c, value);
    }
    // Floors.
    let mut shares = [row[6], row[7], row[8]].map(|v| if v > FLOOR_SHARE { v } else { 0.0 });
    if shares[1] == 0.0 {
        shares[2] = 0.0;
    }
    shares[1] = shares[1].min(shares[0]);
    shares[2] = shares[2].min(shares[1]);
    let sum: f64 = shares.iter().sum();
    for (k, share) in shares.into_iter().enumerate() {
        set(
            row,
            6 + k,
            if sum > 0.0 {
                share / sum
            } else {
                f64::from(u8::from(k == 0))
            },
        );
    }
    let floors = floors(row) as f64;
    if floors == 1.0 {
        // Elements are aligned with those of the floor below.
        (35..39).for_each(|c| set(row, c, 0.0));
    }
    for (c, least) in [(0, 4.0), (1, 4.0), (2, LEAST_FLOOR * floors)] {
        let value = row[c].max(least);
        set(row, c, value);
    }
    let storey = row[2] / floors;
    for (k, (_, c, _)) in PARTS.into_iter().enumerate() {
        if row[c + 2].min(row[c + 3]) < ABSENT[0] || row[c + 4] < ABSENT[1] {
            (c..c + 6).for_each(|c| set(row, c, 0.0));
            continue;
        }
        for axis in 0..2 {
            let size = row[c + 2 + axis].min(0.9 * row[axis]);
            set(row, c + 2 + axis, size);
            let half = row[c + 2 + axis] / 2.0 / row[axis];
            let mut at = row[c + axis].clamp(half.min(0.5), (1.0 - half).max(0.5));
            if axis == 1 && k == 1 {
                at = at.min(0.49).max(half);
            }
            if axis == 1 && k == 2 {
                at = at.max(0.5).min(1.0 - half);
            }
            set(row, c + axis, at);
        }
        // In a house of lower storeys a part is no higher than they allow.
        let most = (1.4 * storey).min(row[2]);
        let height = row[c + 4].clamp(LEAST_PART.min(most), most);
        set(row, c + 4, height);
        let visible = row[c + 5].clamp(0.03, 0.97);
        set(row, c + 5, visible);
    }
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        separate(row, PARTS[a].1, PARTS[b].1, &mut set);
    }
    share_out(row, given, deviations, &mut set);
    let value = row[3].clamp(0.2, 1.0);
    set(row, 3, value);
    let value = row[4].max(least_boundary(row));
    set(row, 4, value);
    let value = row[3] / row[6];
    set(row, 5, value);
    changes(&before, row)
}

/// The columns in which two rows differ.
pub fn changes(before: &[f64; N], after: &[f64; N]) -> Vec<Change> {
    let moved = (0..N).filter(|&c| (after[c] - before[c]).abs() > 1e-12);
    moved
        .map(|c| Change {
            column: COLUMNS[c],
            from: before[c],
            to: after[c],
        })
        .collect()
}

/// Moves coverage, share of the ground floor and floor area ratio so that the third is the first over the second,
/// by the least sum of squares in standard deviations (one step of Newton's method; what is left goes to the last).
fn share_out(
    row: &mut [f64; N],
    given: &[bool; N],
    deviations: &[f64; N],
    set: &mut impl FnMut(&mut [f64; N], usize, f64),
) {
    let gap = row[5] * row[6] - row[3];
    let storeys = row[7] + row[8];
    let slopes = [(3, -1.0), (5, row[6]), (6, row[5])];
    let weight = |c: usize| match given[c] || (c == 6 && (storeys <= 0.0 || given[7] || given[8])) {
        true => 0.0,
        false => deviations[c].powi(2),
    };
    let total: f64 = slopes.iter().map(|(c, s)| weight(*c) * s * s).sum();
    if total <= 0.0 {
        return;
    }
    let before = row[6];
    for (c, slope) in slopes {
        let value = row[c] - gap * weight(c) * slope / total;
        set(row, c, value);
    }
    let scale = (1.0 - row[6]) / (1.0 - before);
    if weight(6) > 0.0 && scale.is_finite() && scale > 0.0 {
        for c in [7, 8] {
            let value = row[c] * scale;
            set(row, c, value);
        }
    }
}

/// Moves the second of two overlapping parts along the axis on which it has the shorter way, where it has room.
fn separate(
    row: &mut [f64; N],
    a: usize,
    b: usize,
    set: &mut impl FnMut(&mut [f64; N], usize, f64),
) {
    let (Some(p), Some(q)) = (part(row, a), part(row, b)) else {
        return;
    };
    let mut ways: Vec<(usize, f64)> = Vec::new();
    for (axis, (p, q)) in [(p.x, q.x), (p.y, q.y)].into_iter().enumerate() {
        if p[1].min(q[1]) - p[0].max(q[0]) <= 0.0 {
            return;
        }
        for shift in [p[1] - q[0] + APART, p[0] - q[1] - APART] {
            let fits = q[0] + shift >= 0.0 && q[1] + shift <= row[axis];
            if fits {
                ways.push((axis, shift));
            }
        }
    }
    let shortest = ways
        .into_iter()
        .min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    if let Some((axis, shift)) = shortest {
        let value = row[b + axis] + shift / row[axis];
        set(row, b + axis, value);
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use edifice_base::rng::stream;

    /// Any finite row is repaired to a finite one, and what was given stays: also heights that no storey has.
    #[test]
    fn any_finite_row_is_repaired() {
        let mut rng = stream(1, "repair", 0);
        for case in 0..20_000 {
            let scale = [0.0, 1e-9, 0.3, 1.0, 3.0, 20.0, 1e6][case % 7];
            let mut row: [f64; N] = std::array::from_fn(|_| scale * rng.random_range(-0.2..1.0));
            let given: [bool; N] = std::array::from_fn(|_| rng.random_bool(0.2));
            let before = row;
            repair(&mut row, &given, &[0.1; N]);
            for c in 0..N {
                let kept = !given[c] || row[c] == before[c];
                assert!(kept && row[c].is_finite(), "{} in {before:?}", COLUMNS[c]);
            }
        }
    }
}
