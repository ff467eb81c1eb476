//! Given attributes that no house can have together, each with the columns and the bound.

use super::target::{FLOOR_SHARE, PARTS, part};
use crate::attributes::COLUMNS;

/// Columns of a row.
const N: usize = COLUMNS.len();
/// Slack of comparisons (m, or shares).
const SLACK: f64 = 0.005;

/// Largest and least share of a floor, from the ground floor up: boxes stand on the ground, so that no floor is larger than
/// the one below it.
const SHARES: [([f64; 2], &str); 3] = [
    (
        [1.0 / 3.0, 1.0],
        "from 1/3 to 1 (the ground floor is the largest of at most three)",
    ),
    (
        [0.0, 0.5],
        "from 0 to 1/2 (no floor is larger than the one below it)",
    ),
    (
        [0.0, 1.0 / 3.0],
        "from 0 to 1/3 (no floor is larger than the one below it)",
    ),
];
/// Heights of storeys (m) beyond which a house has no rooms that one could live in.
pub(crate) const STOREY: [f64; 2] = [1.8, 8.0];
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
    /// Storeys that nobody could live in.
    #[error(
        "bbox.h = {value} makes storeys of {storey:.2} m on {floors} floors, expected {} to {} m",
        STOREY[0],
        STOREY[1]
    )]
    Storey {
        /// The height of the house, in metres.
        value: f64,
        /// The number of floors: the given one, else that of one to three that comes nearest.
        floors: usize,
        /// The height of a storey, in metres.
        storey: f64,
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

/// Finds a contradiction among the known values of a row, in the order of [`COLUMNS`]; missing ones contradict nothing.
///
/// # Errors
/// The first [`Contradiction`], which names the columns.
pub fn check_known(row: &[Option<f64>]) -> Result<(), Contradiction> {
    let known = |c: usize| row.get(c).copied().flatten();
    let given: [bool; N] = std::array::from_fn(|c| known(c).is_some());
    check_given(&std::array::from_fn(|c| known(c).unwrap_or(0.0)), &given)
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
    let (shares, known) = shares(row, given);
    range(
        6,
        !known || (shares.iter().sum::<f64>() - 1.0).abs() < SLACK && shares[2] > -SLACK,
        "such that the shares of the floors sum to 1",
    )?;
    for c in [7, 8] {
        let [below, own] = [shares[c - 7], shares[c - 6]];
        if (known || all(&[c, c - 1])) && own > below + SLACK {
            return Err(Contradiction::Floors {
                upper: COLUMNS[c],
                value: own,
                lower: COLUMNS[c - 1],
                below,
            });
        }
    }
    for (k, ([least, most], expected)) in SHARES.into_iter().enumerate() {
        let within = (least - SLACK..=most + SLACK).contains(&row[6 + k]);
        range(6 + k, within, expected)?;
    }
    if given[2] {
        let counted = 1 + shares[1..].iter().filter(|s| **s > FLOOR_SHARE).count();
        storey(row[2], known.then_some(counted))?;
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

/// Checks that a house of height `value` (m) has storeys that one could live in: on the known number of floors, else on any.
fn storey(value: f64, floors: Option<usize>) -> Result<(), Contradiction> {
    let likely = match value < STOREY[1] {
        true => 1,
        false => 3,
    };
    let floors = floors.unwrap_or(likely);
    let storey = value / floors as f64;
    match (STOREY[0]..=STOREY[1]).contains(&storey) {
        true => Ok(()),
        false => Err(Contradiction::Storey {
            value,
            floors,
            storey,
        }),
    }
}

/// The shares of the floors, of which the third follows from two that are given; true if all are known.
fn shares(row: &[f64; N], given: &[bool; N]) -> ([f64; 3], bool) {
    let mut shares = [row[6], row[7], row[8]];
    let missing: Vec<usize> = (0..3).filter(|k| !given[6 + k]).collect();
    if let [k] = missing[..] {
        shares[k] = 0.0;
        shares[k] = 1.0 - shares.iter().sum::<f64>();
    }
    (shares, missing.len() < 2)
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
