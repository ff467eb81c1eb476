//! From drawn variables back to attributes.

use super::super::attributes::{AttributeRow, COLUMNS};
use super::super::mass::repair::repair;
use super::super::mass::target::{FLOOR_SHARE, PARTS};
use super::parts;
use super::shape::{FULL, PLAN, RECESS, RECESSED, STOREY, Shape, UPPER};
use super::{FAR, FLOORS, STYLES, THERE, attribute_rows};
use edifice_model::{Cell, ModelError, Table};

/// First column of the facades.
const FACADES: usize = 27;
const SHARES: [usize; 3] = [6, 7, 8];
/// Largest extent of a drawn house (m).
const LARGEST: f64 = 60.0;
/// Window-to-wall ratio below which a side has no window: less than half a square metre on most sides.
const BLANK: f64 = 0.01;
/// Least share of an upper floor that is there.
const LEAST_SHARE: f64 = 0.03;

/// Drawn coded rows as attributes: what follows is computed, rows are moved to the nearest possible ones. `given` has the
/// evidence of each row, which stays to the bit; a shorter list repeats its last.
///
/// # Errors
/// [`ModelError::NotFinite`].
pub fn decoded(drawn: &Table, given: &[AttributeRow]) -> Result<Table, ModelError> {
    attribute_table(drawn, given, false)
}

/// As [`decoded`], with garages and porches put where they fit the plan.
///
/// # Errors
/// [`ModelError::NotFinite`].
pub fn settled(drawn: &Table, given: &[AttributeRow]) -> Result<Table, ModelError> {
    attribute_table(drawn, given, true)
}

fn attribute_table(
    drawn: &Table,
    given: &[AttributeRow],
    settles: bool,
) -> Result<Table, ModelError> {
    let none: AttributeRow = vec![None; COLUMNS.len()];
    let cell = |name: &str, row: usize| drawn.column(name).map(|c| c.cell(row));
    let category = |name: &str, row: usize| match cell(name, row) {
        Ok(Cell::Code(code)) => Some(code),
        _ => None,
    };
    let real = |name: &str, row: usize| match cell(name, row) {
        Ok(Cell::Real(value)) => Some(value),
        _ => None,
    };
    let mut rows = attribute_rows(drawn);
    for (i, row) in rows.iter_mut().enumerate() {
        let given = given.get(i).or(given.last()).unwrap_or(&none);
        let there = THERE.map(|name| category(name, i).map(|code| code == 1));
        let floors = category(FLOORS, i).map(|code| code + 1);
        let recess = real(RECESS, i);
        let shape = Shape {
            plan: category(PLAN, i).or(recess.map(|_| RECESSED)),
            recess,
            storey: STOREY.map(|name| real(name, i)),
            full: FULL.map(|name| category(name, i).map(|code| code == 1)),
            upper: UPPER.map(|name| real(name, i)),
        };
        possible(row, there, floors, &shape, given, settles);
    }
    let mut table = Table::new();
    for (c, name) in COLUMNS.iter().enumerate() {
        let cells = || rows.iter().map(|row| row[c]);
        if cells().any(|v| v.is_none()) {
            continue;
        }
        table = match c < STYLES {
            true => table.real(name, cells())?,
            false => table.binary(name, cells().map(|v| v.map(|v| v > 0.5)))?,
        };
    }
    Ok(table)
}

/// Completes a drawn row with what follows from it.
fn possible(
    row: &mut AttributeRow,
    there: [Option<bool>; 3],
    floors: Option<usize>,
    shape: &Shape,
    given: &AttributeRow,
    settles: bool,
) {
    for (k, (_, c, _)) in PARTS.into_iter().enumerate() {
        if there[k] == Some(false) {
            row[c..c + 6].fill(Some(0.0));
        }
    }
    for (value, known) in row.iter_mut().zip(given) {
        *value = known.or(*value);
    }
    for c in 0..2 {
        if given[c].is_none() {
            row[c] = row[c].map(|v| v.clamp(4.0, LARGEST));
        }
    }
    shape.mass(row, given, floors);
    if settles {
        parts::settle(row, given);
    }
    let ground = [0, 1, 3]
        .map(|c| row[c])
        .into_iter()
        .try_fold(1.0, |a, v| Some(a * v?));
    let most = match ground {
        Some(ground) if settles && parts::area(row) > 0.0 => 1.0 - parts::area(row) / ground,
        _ => 1.0,
    };
    if let Some([first, second]) = floors.and_then(|f| shape.shares(f, most)) {
        row[7] = given[7].or(Some(first));
        row[8] = given[8].or(Some(second));
    }
    shares(row, floors, given);
    if let (None, Some(covered), Some(ground)) = (given[FAR], row[3], row[6]) {
        row[FAR] = Some(covered.clamp(0.2, 1.0) / ground);
    }
    blank_sides(row, given);
    if row[..FACADES].iter().all(Option::is_some) {
        let mut whole: [f64; 49] = std::array::from_fn(|c| row[c].unwrap_or(0.0));
        let known: [bool; 49] = std::array::from_fn(|c| given[c].is_some());
        repair(&mut whole, &known, &[1.0; 49]);
        for (value, repaired) in row.iter_mut().zip(whole) {
            *value = value.map(|_| repaired);
        }
    }
}

/// Sides with next to no glass have no window, and are what a wall without any is: symmetric, with nothing to align.
fn blank_sides(row: &mut AttributeRow, given: &AttributeRow) {
    for side in FACADES..FACADES + 4 {
        let own = [side, side + 4, side + 8];
        if own.iter().all(|&c| given[c].is_none()) && row[side].is_some_and(|ratio| ratio < BLANK) {
            for (c, value) in own.into_iter().zip([0.0, 1.0, 0.0]) {
                row[c] = row[c].map(|_| value);
            }
        }
    }
}

/// The shares of the floors from those of the upper ones.
fn shares(row: &mut AttributeRow, floors: Option<usize>, given: &AttributeRow) {
    let Some(floors) = floors else { return };
    let own = |c: usize| given[c].or(row[c]).unwrap_or(0.0);
    let [_, mut first, mut second] = SHARES.map(own);
    if given[8].is_none() {
        second = match floors {
            3 => second.clamp(LEAST_SHARE, 1.0 / 3.0),
            _ => 0.0,
        };
    }
    if given[7].is_none() {
        first = match floors {
            1 => 0.0,
            _ => first.max(second.max(LEAST_SHARE)).min((1.0 - second) / 2.0),
        };
    }
    // A given share of the ground floor leaves the rest to the others; so does a given floor area ratio.
    let by_area = match (given[FAR], row[3]) {
        (Some(far), Some(covered)) if far > 0.0 => Some((covered / far).clamp(1.0 / 3.0, 1.0)),
        _ => None,
    };
    let ground = given[6].or(by_area.filter(|_| given[7].is_none() && given[8].is_none()));
    if let (Some(ground), None, None) = (ground, given[7], given[8]) {
        let rest = (1.0 - ground).max(0.0);
        let upper = first + second;
        (first, second) = match (rest > FLOOR_SHARE, upper > 0.0) {
            (true, true) => (first * rest / upper, second * rest / upper),
            (true, false) => (rest, 0.0),
            (false, _) => (rest, 0.0),
        };
    }
    row[6] = Some(given[6].unwrap_or(1.0 - first - second));
    row[7] = Some(first);
    row[8] = Some(second);
}
