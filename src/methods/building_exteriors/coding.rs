//! Codings of attributes as variables of the model, so that its draws are houses.
//!
//! The paper ([`Coding::Published`]) gives every attribute a Gaussian: a house without a garage has a garage of six zeros,
//! `far` and the share of the ground floor are drawn although they follow from others, and shares of floors may be
//! negative. [`Coding::Presence`], the default, instead
//!
//! - makes presence discrete: `garage.there`, `porch.front.there`, `porch.back.there` (yes or no) and `floors` (1, 2, 3)
//!   are variables of the model; the numbers of an absent part, and the share of a floor that is not there, are missing;
//! - makes the shape of the plan discrete: `plan.rectangle` (it fills its bounding box) and `plan.recess` (its boundary is
//!   longer than that of the bounding box, by a recess of at least 0.6 m); of 320 houses of Delft 41 % are rectangles and
//!   91 % have no recess, so that a Gaussian around either would cut corners of centimetres;
//! - takes the height of a storey, `storey`, for that of the house: `bbox.h = floors storey`;
//! - computes what follows: `arf.0 = 1 - arf.1 - arf.2`, `far = bcr / arf.0`, `bcr = 1` for a rectangle, and
//!   `bdry = 2 (bbox.w + bbox.d) / sqrt(bcr bbox.w bbox.d)` without a recess;
//! - moves each drawn row to the nearest that a house can have ([`repair`]): shares fall upwards, parts lie inside the
//!   bounding box and beside each other, `bdry >= 2 (bbox.w + bbox.d) / sqrt(bcr bbox.w bbox.d)`, ratios lie in `[0, 1]`.
//!
//! Given values are never moved. A row of attributes and its coded row tell the same of a house, but for a part whose
//! presence alone is known: [`Observation`].
//!
//! # Deviations and readings
//! - Densities are those of coded rows, so that they compare draws of one model, not models of both codings.
//! - A given height without known floors is read as that of the floors, 2.9 m each, nearest to it.
//! - Columns without a known value in the data are left out of the model; its draws lack them.

use super::attributes::{AttributeRow, COLUMNS, GROUPS, Level};
use super::mass::repair::repair;
use super::mass::target::{FLOOR_SHARE, PARTS};
use edifice_model::hierarchy::Group;
use edifice_model::tables::Dataset;
use edifice_model::{Cell, ModelError, Table};

/// Columns of presence, in the order of garage, front and back porch.
pub const THERE: [&str; 3] = ["garage.there", "porch.front.there", "porch.back.there"];
/// Column of the number of floors.
pub const FLOORS: &str = "floors";
/// Categories of [`FLOORS`].
const COUNTS: [&str; 3] = ["1", "2", "3"];
/// Columns of the shape of the plan, and of the height of a storey (m).
const SHAPES: [&str; 2] = ["plan.rectangle", "plan.recess"];
const STOREY: &str = "storey";
/// Groups of the discrete columns that the paper does not have.
const PRESENCE: &str = "presence";
const SHAPE: &str = "shape";

/// First column of the facades, and of the styles.
const FACADES: usize = 27;
const STYLES: usize = 39;
const FAR: usize = 5;
const HEIGHT: usize = 2;
const COVERED: usize = 3;
const BOUNDARY: usize = 4;
const SHARES: [usize; 3] = [6, 7, 8];
/// Largest extent of a drawn house (m).
const LARGEST: f64 = 60.0;
/// Coverage from which a plan is a rectangle, and what its boundary exceeds that of its bounding box by if it has a recess
/// (m); least area cut off a plan that is none (square metres), and least excess of one with a recess (m).
const FULL: f64 = 0.995;
const EXCESS: f64 = 0.6;
const CUT: f64 = 1.5;
const RECESS: f64 = 2.4;
/// Heights of storeys of draws, and the usual one (m).
const STOREYS: [f64; 2] = [2.4, 4.0];
const USUAL_STOREY: f64 = 2.9;
/// Least share of an upper floor that is there.
const LEAST_SHARE: f64 = 0.03;

/// A coding of attributes as variables of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coding {
    /// As they are: the paper's model.
    #[default]
    Published,
    /// Presence discrete, derived numbers computed.
    Presence,
}

/// The known attributes and parts of a house.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// Its 49 attributes.
    pub row: AttributeRow,
    /// Presence of a garage, a front and a back porch; `None` where it is unknown.
    pub there: [Option<bool>; 3],
    /// Number of floors, 1 to 3.
    pub floors: Option<usize>,
    /// The plan is a rectangle, and has a recess; `None` where it is unknown.
    pub shape: [Option<bool>; 2],
}

/// Length of the boundary of a bounding box over that of a square as large as the plan (Appendix A.1: `bdry`).
fn least_boundary(width: f64, depth: f64, covered: f64) -> f64 {
    2.0 * (width + depth) / (covered * width * depth).sqrt()
}

/// Rectangle and recess of a plan, as far as its attributes tell.
fn shape(row: &AttributeRow) -> [Option<bool>; 2] {
    let rectangle = row[COVERED].map(|covered| covered > FULL);
    let recess = match (row[0], row[1], row[COVERED], row[BOUNDARY]) {
        (Some(w), Some(d), Some(covered), Some(boundary)) => {
            let excess = boundary - least_boundary(w, d, covered);
            Some(excess * (covered * w * d).max(0.0).sqrt() > EXCESS)
        }
        _ => None,
    };
    [rectangle, recess]
}

impl From<AttributeRow> for Observation {
    /// A part is there when its width and depth are above zero, a floor when its share is above 0.02.
    fn from(row: AttributeRow) -> Self {
        let there = PARTS.map(|(_, c, _)| match (row[c + 2], row[c + 3]) {
            (Some(w), Some(d)) => Some(w > 0.0 && d > 0.0),
            (Some(v), None) | (None, Some(v)) => Some(v > 0.0),
            (None, None) => None,
        });
        let has = |c: usize| row[c].map(|v| v > FLOOR_SHARE);
        let floors = match (row[6], has(7), has(8)) {
            (Some(ground), _, _) if ground > 1.0 - FLOOR_SHARE => Some(1),
            (_, Some(false), _) => Some(1),
            (_, Some(true), Some(false)) => Some(2),
            (_, _, Some(true)) => Some(3),
            _ => None,
        };
        let shape = shape(&row);
        Self {
            row,
            there,
            floors,
            shape,
        }
    }
}

impl Observation {
    /// The number of a coded real column.
    fn coded(&self, c: usize) -> Option<f64> {
        let part = PARTS.iter().position(|(_, p, _)| (*p..p + 6).contains(&c));
        let counts = match (c, part) {
            (FAR, _) | (6, _) => false,
            (HEIGHT, _) => self.floors.is_some(),
            (COVERED, _) => self.shape[0] != Some(true),
            (BOUNDARY, _) => self.shape[1] != Some(false),
            (7 | 8, _) => self.floors.is_some_and(|f| f > c - 6),
            (_, Some(k)) => self.there[k] == Some(true),
            _ => true,
        };
        let value = self.row[c].filter(|_| counts);
        match (c, self.floors) {
            (HEIGHT, Some(floors)) => value.map(|h| h / floors as f64),
            _ => value,
        }
    }
}

/// Many houses as the model reads them; groups and columns without any known value are left out.
///
/// # Errors
/// [`ModelError::NotFinite`]; [`ModelError::Empty`] without any known value.
pub fn coded(houses: &[Observation]) -> Result<Dataset, ModelError> {
    let mut table = Table::new();
    let mut groups = Vec::new();
    for group in &GROUPS {
        let mut own: Vec<&str> = Vec::new();
        for (k, name) in group.columns().iter().enumerate() {
            let c = group.first + k;
            let is_flag = group.level == Level::Element;
            let cells: Vec<Option<f64>> = match is_flag {
                true => houses.iter().map(|h| h.row[c]).collect(),
                false => houses.iter().map(|h| h.coded(c)).collect(),
            };
            if cells.iter().all(Option::is_none) {
                continue;
            }
            let name = &if c == HEIGHT { STOREY } else { name };
            table = match is_flag {
                true => table.binary(name, cells.into_iter().map(|v| v.map(|v| v > 0.5)))?,
                false => table.real(name, cells)?,
            };
            own.push(name);
        }
        if !own.is_empty() {
            groups.push(Group::new(group.name, &own));
        }
    }
    let mut own: Vec<&str> = Vec::new();
    for (k, name) in THERE.iter().enumerate() {
        if houses.iter().any(|h| h.there[k].is_some()) {
            table = table.binary(name, houses.iter().map(|h| h.there[k]))?;
            own.push(name);
        }
    }
    if !own.is_empty() {
        groups.push(Group::new(PRESENCE, &own));
    }
    let mut own: Vec<&str> = Vec::new();
    for (k, name) in SHAPES.iter().enumerate() {
        if houses.iter().any(|h| h.shape[k].is_some()) {
            table = table.binary(name, houses.iter().map(|h| h.shape[k]))?;
            own.push(name);
        }
    }
    if !own.is_empty() {
        groups.push(Group::new(SHAPE, &own));
    }
    if houses.iter().any(|h| h.floors.is_some()) {
        let counts = houses
            .iter()
            .map(|h| h.floors.and_then(|f| COUNTS.get(f.checked_sub(1)?)));
        table = table.categorical(FLOORS, &COUNTS, counts.map(|c| c.copied()))?;
        groups.push(Group::new(FLOORS, &[FLOORS]));
    }
    if groups.is_empty() {
        return Err(ModelError::Empty { what: "columns" });
    }
    Ok(Dataset { table, groups })
}

/// Evidence as the model with these columns reads it.
///
/// # Errors
/// [`ModelError::NotFinite`].
pub fn coded_evidence(given: &[AttributeRow], columns: &[String]) -> Result<Table, ModelError> {
    let mut houses: Vec<Observation> = given.iter().cloned().map(Observation::from).collect();
    let mut table = Table::new();
    let knows = |name: &str| columns.iter().any(|c| c == name);
    if knows(STOREY) {
        for house in &mut houses {
            let storeys = house.row[HEIGHT].map(|h| (h / USUAL_STOREY).round().clamp(1.0, 3.0));
            house.floors = house.floors.or(storeys.map(|s| s as usize));
        }
        table = table.real(STOREY, houses.iter().map(|h| h.coded(HEIGHT)))?;
    }
    for (k, name) in SHAPES.iter().enumerate().filter(|(_, n)| knows(n)) {
        table = table.binary(name, houses.iter().map(|h| h.shape[k]))?;
    }
    for (c, name) in COLUMNS.iter().enumerate().filter(|(_, n)| knows(n)) {
        table = match c < STYLES {
            true => table.real(name, houses.iter().map(|h| h.coded(c)))?,
            false => table.binary(name, houses.iter().map(|h| h.row[c].map(|v| v > 0.5)))?,
        };
    }
    for (k, name) in THERE.iter().enumerate().filter(|(_, n)| knows(n)) {
        table = table.binary(name, houses.iter().map(|h| h.there[k]))?;
    }
    if knows(FLOORS) {
        let counts = houses
            .iter()
            .map(|h| h.floors.and_then(|f| COUNTS.get(f.checked_sub(1)?)));
        table = table.categorical(FLOORS, &COUNTS, counts.map(|c| c.copied()))?;
    }
    Ok(table)
}

/// The attributes of each row of a table; a column that it lacks is missing.
pub fn attribute_rows(table: &Table) -> Vec<AttributeRow> {
    let columns: Vec<_> = COLUMNS.iter().map(|n| table.column(n).ok()).collect();
    let value = |row: usize, c: usize| match columns[c].map(|column| column.cell(row)) {
        Some(Cell::Real(v)) => Some(v),
        Some(Cell::Code(code)) => Some(code as f64),
        _ => None,
    };
    let row = |r: usize| (0..COLUMNS.len()).map(|c| value(r, c)).collect();
    (0..table.rows()).map(row).collect()
}

/// Drawn coded rows as attributes: what follows is computed, rows are moved to the nearest possible ones. `given` has the
/// evidence of each row, which stays to the bit; a shorter list repeats its last.
///
/// # Errors
/// [`ModelError::NotFinite`].
pub fn decoded(drawn: &Table, given: &[AttributeRow]) -> Result<Table, ModelError> {
    let none: AttributeRow = vec![None; COLUMNS.len()];
    let category = |name: &str, row: usize| match drawn.column(name).map(|c| c.cell(row)) {
        Ok(Cell::Code(code)) => Some(code),
        _ => None,
    };
    let mut rows = attribute_rows(drawn);
    for (i, row) in rows.iter_mut().enumerate() {
        let given = given.get(i).or(given.last()).unwrap_or(&none);
        let there = THERE.map(|name| category(name, i).map(|code| code == 1));
        let floors = category(FLOORS, i).map(|code| code + 1);
        let shape = SHAPES.map(|name| category(name, i).map(|code| code == 1));
        if let (Ok(Cell::Real(storey)), Some(floors)) =
            (drawn.column(STOREY).map(|c| c.cell(i)), floors)
        {
            let [low, high] = STOREYS;
            row[HEIGHT] = Some(storey.clamp(low, high) * floors as f64);
        }
        possible(row, there, floors, shape, given);
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
    shape: [Option<bool>; 2],
    given: &AttributeRow,
) {
    for (k, (_, c, _)) in PARTS.into_iter().enumerate() {
        if there[k] == Some(false) {
            row[c..c + 6].fill(Some(0.0));
        }
    }
    for (value, known) in row.iter_mut().zip(given) {
        *value = known.or(*value);
    }
    shares(row, floors, given);
    for c in 0..2 {
        if given[c].is_none() {
            row[c] = row[c].map(|v| v.clamp(4.0, LARGEST));
        }
    }
    plan(row, shape, given);
    if let (None, Some(covered), Some(ground)) = (given[FAR], row[3], row[6]) {
        row[FAR] = Some(covered.clamp(0.2, 1.0) / ground);
    }
    if row[..FACADES].iter().all(Option::is_some) {
        let mut whole: [f64; 49] = std::array::from_fn(|c| row[c].unwrap_or(0.0));
        let known: [bool; 49] = std::array::from_fn(|c| given[c].is_some());
        repair(&mut whole, &known, &[1.0; 49]);
        for (value, repaired) in row.iter_mut().zip(whole) {
            *value = value.map(|_| repaired);
        }
    }
}

/// Coverage and boundary of a plan of a shape.
fn plan(row: &mut AttributeRow, shape: [Option<bool>; 2], given: &AttributeRow) {
    let (Some(w), Some(d)) = (row[0], row[1]) else {
        return;
    };
    if given[COVERED].is_none() {
        row[COVERED] = match shape[0] {
            Some(true) => Some(1.0),
            Some(false) => row[COVERED].map(|v| v.min(1.0 - CUT / (w * d)).max(0.3)),
            None => row[COVERED],
        };
    }
    let (Some(covered), None) = (row[COVERED], given[BOUNDARY]) else {
        return;
    };
    let least = least_boundary(w, d, covered);
    let with_recess = least + RECESS / (covered * w * d).sqrt();
    row[BOUNDARY] = match shape {
        [Some(true), _] | [_, Some(false)] => Some(least),
        [_, Some(true)] => row[BOUNDARY].map(|v| v.max(with_recess)),
        [_, None] => row[BOUNDARY],
    };
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
            _ => first.clamp(second.max(LEAST_SHARE), (1.0 - second) / 2.0),
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
