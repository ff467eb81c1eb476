//! Rows of attributes that no house can have: named when given, repaired when sampled (Sec. 7: samples conflict a little).

use super::target::{FLOOR_SHARE, PARTS, floors, part};
use crate::methods::building_exteriors::attributes::COLUMNS;

/// Columns of a row.
const N: usize = COLUMNS.len();
/// A part smaller or lower than this is absent (m).
const ABSENT: [f64; 2] = [0.8, 1.2];
/// Least height of a floor and of a part (m).
const LEAST_FLOOR: f64 = 2.1;
const LEAST_PART: f64 = 1.8;
/// Alignment nearer than this to none or all is none or all.
const NEARLY: f64 = 0.12;
/// Room between parts that overlapped (m).
const APART: f64 = 0.05;
/// Slack of comparisons of given values (m, or shares).
const SLACK: f64 = 0.005;

/// Two attributes that no house can have together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Contradiction {
    /// A size or share that is not positive or not finite.
    #[error("{column} is {value}, expected a number {expected}")]
    Range {
        /// The column.
        column: &'static str,
        /// Its value.
        value: f64,
        /// What is asked of it.
        expected: &'static str,
    },
    /// A garage or porch reaches outside the bounding box.
    #[error(
        "{position} = {at} and {size} = {extent} reach from {low:.3} to {high:.3} m, outside 0 to {bound} m ({bounding})"
    )]
    Outside {
        /// Column of the position.
        position: &'static str,
        /// Its value.
        at: f64,
        /// Column of the size.
        size: &'static str,
        /// Its value.
        extent: f64,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
        /// Column of the bounding box.
        bounding: &'static str,
        /// Its value.
        bound: f64,
    },
    /// Garage and porch lie on top of each other.
    #[error("{first} and {second} overlap by {x:.3} m x {y:.3} m")]
    Overlap {
        /// One part.
        first: &'static str,
        /// The other.
        second: &'static str,
        /// Overlap along x.
        x: f64,
        /// Overlap along y.
        y: f64,
    },
    /// Less boundary than any plan with this bounding box and coverage has.
    #[error(
        "bdry = {value} is below its bound 2 (bbox.w + bbox.d) / sqrt(bcr bbox.w bbox.d) = {bound:.4} for bcr = {bcr}"
    )]
    Boundary {
        /// The boundary complexity.
        value: f64,
        /// Its bound.
        bound: f64,
        /// The coverage.
        bcr: f64,
    },
    /// The floor area ratio does not follow from coverage and share of the ground floor.
    #[error("far = {value} is not bcr / arf.0 = {expected:.4}")]
    FloorArea {
        /// The floor area ratio.
        value: f64,
        /// What it must be.
        expected: f64,
    },
    /// Shares of the floors that do not sum to one or grow upwards.
    #[error("{upper} = {value} is more than {lower} = {below}: boxes stand on the ground")]
    Floors {
        /// The upper share.
        upper: &'static str,
        /// Its value.
        value: f64,
        /// The share below.
        lower: &'static str,
        /// Its value.
        below: f64,
    },
    /// A part is higher than the house.
    #[error("{column} = {value} is more than bbox.h = {height}")]
    TooHigh {
        /// The column.
        column: &'static str,
        /// Its value.
        value: f64,
        /// The height of the house.
        height: f64,
    },
}

/// A sampled value that was moved.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Change {
    /// The column.
    pub column: &'static str,
    /// The sampled value.
    pub from: f64,
    /// The value in its place.
    pub to: f64,
}

/// Finds a contradiction among values that are all given.
///
/// # Errors
/// The first [`Contradiction`], which names the columns.
pub fn check(row: &[f64; N]) -> Result<(), Contradiction> {
    let range = |c: usize, ok: bool, expected| {
        let (column, value) = (COLUMNS[c], row[c]);
        match ok && value.is_finite() {
            true => Ok(()),
            false => Err(Contradiction::Range {
                column,
                value,
                expected,
            }),
        }
    };
    for (c, value) in row.iter().enumerate().take(3) {
        range(c, *value > 0.0, "above zero")?;
    }
    range(
        3,
        row[3] > 0.0 && row[3] <= 1.0 + 1e-9,
        "above 0, at most 1 (coverage)",
    )?;
    for (c, value) in row.iter().enumerate().skip(4) {
        range(c, *value >= 0.0, "not below zero")?;
    }
    for (c, value) in row.iter().enumerate().take(39).skip(27) {
        range(c, *value <= 1.0 + 1e-9, "at most 1")?;
    }
    for (c, value) in row.iter().enumerate().take(31).skip(27) {
        range(
            c,
            *value <= 0.9,
            "at most 0.9 (windows need walls around them)",
        )?;
    }
    range(
        6,
        (row[6] + row[7] + row[8] - 1.0).abs() < SLACK,
        "such that the shares of the floors sum to 1",
    )?;
    for c in [7, 8] {
        if row[c] > row[c - 1] + SLACK {
            return Err(Contradiction::Floors {
                upper: COLUMNS[c],
                value: row[c],
                lower: COLUMNS[c - 1],
                below: row[c - 1],
            });
        }
    }
    parts(row)?;
    let bound = least_boundary(row);
    if row[4] < bound - SLACK {
        return Err(Contradiction::Boundary {
            value: row[4],
            bound,
            bcr: row[3],
        });
    }
    let expected = row[3] / row[6];
    if (row[5] - expected).abs() > 2.0 * SLACK {
        return Err(Contradiction::FloorArea {
            value: row[5],
            expected,
        });
    }
    Ok(())
}

fn parts(row: &[f64; N]) -> Result<(), Contradiction> {
    let known = PARTS.map(|(name, c, _)| (name, c, part(row, c)));
    for (_, c, own) in &known {
        let Some(own) = own else { continue };
        for (axis, [low, high]) in [own.x, own.y].into_iter().enumerate() {
            if low < -SLACK || high > row[axis] + SLACK {
                return Err(Contradiction::Outside {
                    position: COLUMNS[c + axis],
                    at: row[c + axis],
                    size: COLUMNS[c + 2 + axis],
                    extent: row[c + 2 + axis],
                    low,
                    high,
                    bounding: COLUMNS[axis],
                    bound: row[axis],
                });
            }
        }
        if row[c + 4] > row[2] + SLACK {
            return Err(Contradiction::TooHigh {
                column: COLUMNS[c + 4],
                value: row[c + 4],
                height: row[2],
            });
        }
    }
    for (i, (first, _, a)) in known.iter().enumerate() {
        for (second, _, b) in &known[i + 1..] {
            let (Some(a), Some(b)) = (a, b) else { continue };
            let shared = |p: [f64; 2], q: [f64; 2]| p[1].min(q[1]) - p[0].max(q[0]);
            let (x, y) = (shared(a.x, b.x), shared(a.y, b.y));
            if x > SLACK && y > SLACK {
                return Err(Contradiction::Overlap {
                    first,
                    second,
                    x,
                    y,
                });
            }
        }
    }
    Ok(())
}

/// A plan has at least the boundary of its bounding box.
fn least_boundary(row: &[f64; N]) -> f64 {
    2.0 * (row[0] + row[1]) / (row[3] * row[0] * row[1]).sqrt()
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
        let height = row[c + 4].clamp(LEAST_PART, (1.4 * storey).min(row[2]));
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
    let moved = (0..N).filter(|&c| (row[c] - before[c]).abs() > 1e-12);
    moved
        .map(|c| Change {
            column: COLUMNS[c],
            from: before[c],
            to: row[c],
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
