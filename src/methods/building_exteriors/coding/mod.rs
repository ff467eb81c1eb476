//! Codings of attributes as variables of the model, so that its draws are houses.
//!
//! The paper ([`Coding::Published`]) gives every attribute a Gaussian: a house without a garage has a garage of six zeros,
//! `far` and the share of the ground floor are drawn although they follow from others, and shares of floors may be
//! negative. [`Coding::Presence`], the default, instead
//!
//! - makes presence discrete: `garage.there`, `porch.front.there`, `porch.back.there` (yes or no) and `floors` (1, 2, 3)
//!   are variables of the model; the numbers of an absent part, and the share of a floor that is not there, are missing;
//! - reads plans and storeys by kinds that are exact (`shape`): boxes, cut corners and recesses, full floors;
//! - computes what follows: `arf.0 = 1 - arf.1 - arf.2`, `far = bcr / arf.0`, `bdry`, `bbox.h`;
//! - puts drawn garages and porches where they fit the drawn plan (`parts`);
//! - moves each drawn row to the nearest that a house can have (`mass::repair`): shares fall upwards, parts lie inside the
//!   bounding box and beside each other, `bdry >= 2 (bbox.w + bbox.d) / sqrt(bcr bbox.w bbox.d)`, ratios lie in `[0, 1]`.
//!
//! Given values are never moved. A row of attributes and its coded row tell the same of a house, but for a part whose
//! presence alone is known: [`Observation`].
//!
//! # Deviations and readings
//! - Densities are those of coded rows, so that they compare draws of one model, not models of both codings.
//! - Columns without a known value in the data are left out of the model; its draws lack them.

mod decode;
mod observation;
mod parts;
mod shape;

pub use decode::{decoded, settled};
pub use observation::Observation;

use self::shape::{FULL, PLAN, PLANS, RECESS, RECESSED, STOREY, UPPER};
use super::attributes::{self, AttributeRow, COLUMNS, GROUPS, Level};
use super::mass::target::PARTS;
use edifice_model::hierarchy::Group;
use edifice_model::tables::Dataset;
use edifice_model::{ModelError, Table};

/// Columns of presence, in the order of garage, front and back porch.
pub const THERE: [&str; 3] = ["garage.there", "porch.front.there", "porch.back.there"];
/// Column of the number of floors.
pub const FLOORS: &str = "floors";
/// Categories of [`FLOORS`].
const COUNTS: [&str; 3] = ["1", "2", "3"];
/// Groups of discrete columns that the paper does not have.
const PRESENCE: &str = "presence";
const FULL_FLOORS: &str = "full";

/// First column of the styles.
const STYLES: usize = 39;
const FAR: usize = 5;

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

/// Names of the variables that a group of attributes becomes.
fn variables(group: &attributes::Group) -> Vec<&'static str> {
    match group.name {
        "bbox" => vec![COLUMNS[0], COLUMNS[1], STOREY[0], STOREY[1]],
        "bdry" => vec![RECESS],
        "arf" => UPPER.to_vec(),
        _ => group.columns().to_vec(),
    }
}

impl Observation {
    /// The category of the number of floors.
    fn count(&self) -> Option<&'static str> {
        self.floors
            .and_then(|f| COUNTS.get(f.checked_sub(1)?).copied())
    }

    /// The value of a variable; flags are 0 or 1.
    fn value(&self, name: &str) -> Option<f64> {
        if let Some(value) = self.shape(name) {
            return value;
        }
        match COLUMNS.iter().position(|c| *c == name) {
            Some(c) if c < STYLES => self.coded(c),
            Some(c) => self.row[c],
            None => None,
        }
    }

    /// The number of a coded real column.
    fn coded(&self, c: usize) -> Option<f64> {
        let part = PARTS.iter().position(|(_, p, _)| (*p..p + 6).contains(&c));
        let counts = match (c, part) {
            (FAR, _) | (6, _) => false,
            (7 | 8, _) => self.floors.is_some_and(|f| f > c - 6),
            (_, Some(k)) => self.there[k] == Some(true),
            _ => true,
        };
        self.row[c].filter(|_| counts)
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
        for name in variables(group) {
            let cells: Vec<Option<f64>> = houses.iter().map(|h| h.value(name)).collect();
            if cells.iter().all(Option::is_none) {
                continue;
            }
            table = match group.level {
                Level::Element => {
                    table.binary(name, cells.into_iter().map(|v| v.map(|v| v > 0.5)))?
                }
                Level::Mass | Level::Facade => table.real(name, cells)?,
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
    if houses.iter().any(|h| h.floors.is_some()) {
        table = table.categorical(FLOORS, &COUNTS, houses.iter().map(Observation::count))?;
        groups.push(Group::new(FLOORS, &[FLOORS]));
    }
    // Where all plans have recesses, and no floor is full, the recesses and the shares tell it.
    if houses
        .iter()
        .filter_map(Observation::plan)
        .any(|kind| kind != RECESSED)
    {
        let plans = houses.iter().map(|h| h.plan().map(|k| PLANS[k]));
        table = table.categorical(PLAN, &PLANS, plans)?;
        groups.push(Group::new(PLAN, &[PLAN]));
    }
    let mut own: Vec<&str> = Vec::new();
    for (k, name) in FULL.into_iter().enumerate() {
        if houses.iter().any(|h| h.full(k) == Some(true)) {
            table = table.binary(name, houses.iter().map(|h| h.full(k)))?;
            own.push(name);
        }
    }
    if !own.is_empty() {
        groups.push(Group::new(FULL_FLOORS, &own));
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
    houses.iter_mut().for_each(|h| h.floors = h.counted());
    let mut table = Table::new();
    let knows = |name: &str| columns.iter().any(|c| c == name);
    for name in columns {
        let flag = COLUMNS
            .iter()
            .position(|c| c == name)
            .is_some_and(|c| c >= STYLES);
        let cells = houses.iter().map(|h| h.value(name));
        let discrete = [FLOORS, PLAN].contains(&name.as_str())
            || THERE.contains(&name.as_str())
            || FULL.contains(&name.as_str());
        table = match (discrete, flag) {
            (true, _) => continue,
            (false, false) => table.real(name, cells)?,
            (false, true) => table.binary(name, cells.map(|v| v.map(|v| v > 0.5)))?,
        };
    }
    for (k, name) in THERE.iter().enumerate().filter(|(_, n)| knows(n)) {
        table = table.binary(name, houses.iter().map(|h| h.there[k]))?;
    }
    if knows(FLOORS) {
        table = table.categorical(FLOORS, &COUNTS, houses.iter().map(Observation::count))?;
    }
    if knows(PLAN) {
        let plans = houses.iter().map(|h| h.plan().map(|k| PLANS[k]));
        table = table.categorical(PLAN, &PLANS, plans)?;
    }
    for (k, name) in FULL.iter().enumerate().filter(|(_, n)| knows(n)) {
        table = table.binary(name, houses.iter().map(|h| h.full(k)))?;
    }
    Ok(table)
}

/// The attributes of each row of a table; a column that it lacks is missing.
pub fn attribute_rows(table: &Table) -> Vec<AttributeRow> {
    let columns: Vec<_> = COLUMNS.iter().map(|n| table.column(n).ok()).collect();
    let value = |row: usize, c: usize| columns[c]?.cell(row).number();
    let row = |r: usize| (0..COLUMNS.len()).map(|c| value(r, c)).collect();
    (0..table.rows()).map(row).collect()
}
