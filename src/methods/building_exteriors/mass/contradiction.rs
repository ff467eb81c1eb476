//! Given attributes that no house can have together, each with the columns and the bound.

use super::target::{PARTS, part};
use crate::attributes::COLUMNS;

/// Columns of a row.
const N: usize = COLUMNS.len();
/// Slack of comparisons (m, or shares).
const SLACK: f64 = 0.005;

/// Largest size of a house (m), and what rounding may leave of a zero.
const LARGEST: f64 = 200.0;
const ROUNDING: f64 = 1e-9;

/// Two attributes that no house can have together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Contradiction {
    /// A size or share that is not positive or not finite.
    #[error("{column} is {value}, expected a number {expected}")]
    Range {
        /// Name of the column.
        column: &'static str,
        /// Its value.
        value: f64,
        /// The range that is asked of it, in words.
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
        /// The coverage, column `bcr`.
        bcr: f64,
    },
    /// The floor area ratio does not follow from coverage and share of the ground floor.
    #[error("far = {value} is not bcr / arf.0 = {expected:.4}")]
    FloorArea {
        /// The floor area ratio.
        value: f64,
        /// The value that follows from the other two.
        expected: f64,
    },
    /// Shares of the floors that do not sum to one or grow upwards.
    #[error("{upper} = {value} is more than {lower} = {below}: boxes stand on the ground")]
    Floors {
        /// Name of the upper share.
        upper: &'static str,
        /// Its value.
        value: f64,
        /// Name of the share below.
        lower: &'static str,
        /// Its value.
        below: f64,
    },
    /// A part is higher than the house.
    #[error("{column} = {value} is more than bbox.h = {height}")]
    TooHigh {
        /// Name of the column.
        column: &'static str,
        /// Its value.
        value: f64,
        /// The height of the house.
        height: f64,
    },
}

/// Finds a contradiction among values that are all given.
///
/// # Errors
/// The first [`Contradiction`], which names the columns.
pub fn check(row: &[f64; N]) -> Result<(), Contradiction> {
    check_given(row, &[true; N])
}

/// Finds a contradiction among the values that are given: a condition counts when all its columns are.
///
/// # Errors
/// The first [`Contradiction`], which names the columns.
pub fn check_given(row: &[f64; N], given: &[bool; N]) -> Result<(), Contradiction> {
    let all = |columns: &[usize]| columns.iter().all(|c| given[*c]);
    let range = |c: usize, ok: bool, expected| {
        let (column, value) = (COLUMNS[c], row[c]);
        match !given[c] || (ok && value.is_finite()) {
            true => Ok(()),
            false => Err(Contradiction::Range {
                column,
                value,
                expected,
            }),
        }
    };
    for (c, value) in row.iter().enumerate().take(3) {
        range(
            c,
            *value > 0.0 && *value <= LARGEST,
            "above zero, at most 200 m",
        )?;
    }
    range(
        3,
        row[3] > 0.0 && row[3] <= 1.0 + 1e-9,
        "above 0, at most 1 (coverage)",
    )?;
    for (c, value) in row.iter().enumerate().skip(4) {
        range(
            c,
            *value >= -ROUNDING && *value <= LARGEST,
            "not below zero, at most 200",
        )?;
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
        !all(&[6, 7, 8]) || (row[6] + row[7] + row[8] - 1.0).abs() < SLACK,
        "such that the shares of the floors sum to 1",
    )?;
    for c in [7, 8] {
        if all(&[c, c - 1]) && row[c] > row[c - 1] + SLACK {
            return Err(Contradiction::Floors {
                upper: COLUMNS[c],
                value: row[c],
                lower: COLUMNS[c - 1],
                below: row[c - 1],
            });
        }
    }
    parts(row, given)?;
    let bound = least_boundary(row);
    if all(&[0, 1, 3, 4]) && row[4] < bound - SLACK {
        return Err(Contradiction::Boundary {
            value: row[4],
            bound,
            bcr: row[3],
        });
    }
    let expected = row[3] / row[6];
    if all(&[3, 5, 6]) && (row[5] - expected).abs() > 2.0 * SLACK {
        return Err(Contradiction::FloorArea {
            value: row[5],
            expected,
        });
    }
    Ok(())
}

fn parts(row: &[f64; N], given: &[bool; N]) -> Result<(), Contradiction> {
    let known = PARTS.map(|(name, c, _)| (name, c, part(row, c)));
    for (_, c, own) in &known {
        let Some(own) = own else { continue };
        for (axis, [low, high]) in [own.x, own.y].into_iter().enumerate() {
            let known = given[axis] && given[c + axis] && given[c + 2 + axis];
            if known && (low < -SLACK || high > row[axis] + SLACK) {
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
        if given[c + 4] && given[2] && row[c + 4] > row[2] + SLACK {
            return Err(Contradiction::TooHigh {
                column: COLUMNS[c + 4],
                value: row[c + 4],
                height: row[2],
            });
        }
    }
    let placed = |c: usize| [0, 1, c, c + 1, c + 2, c + 3].iter().all(|c| given[*c]);
    for (i, (first, c, a)) in known.iter().enumerate() {
        for (second, d, b) in &known[i + 1..] {
            let (Some(a), Some(b)) = (a, b) else { continue };
            if !placed(*c) || !placed(*d) {
                continue;
            }
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
pub(super) fn least_boundary(row: &[f64; N]) -> f64 {
    2.0 * (row[0] + row[1]) / (row[3] * row[0] * row[1]).sqrt()
}
