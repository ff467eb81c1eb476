//! Observed houses from tables of texts: columns of attributes, of presence and of floors; an empty cell is missing.

use super::attributes::{COLUMNS, GROUPS};
use super::coding::{FLOORS, Observation, THERE};

/// Why a table does not tell of houses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObservationError {
    /// No column is an attribute.
    #[error("no column is an attribute of houses, for example `bbox.w`")]
    NoColumn,
    /// A cell that says nothing of its column.
    #[error("row {row}, column `{column}`: {text:?} is not {expected}")]
    Cell {
        /// Row, the first is 1.
        row: usize,
        /// The column.
        column: String,
        /// The text that stands there.
        text: String,
        /// The kind of value that should stand there.
        expected: &'static str,
    },
    /// A group of attributes that there is not.
    #[error("there is no attribute `{0}`")]
    Group(String),
}

/// Largest number that a cell may hold: no attribute of a house comes near it.
const LARGEST: f64 = 1e4;

/// True if a table with this header tells of houses: it has a column of attributes.
pub fn tells_of_houses(header: &[String]) -> bool {
    header.iter().any(|h| COLUMNS.contains(&h.as_str()))
}

/// A cell of an attribute: a number, or yes or no; `None` when it is empty.
///
/// # Errors
/// What was expected.
pub fn cell(text: &str) -> Result<Option<f64>, &'static str> {
    match text.trim() {
        "" => Ok(None),
        "yes" | "true" => Ok(Some(1.0)),
        "no" | "false" => Ok(Some(0.0)),
        text => match text.parse::<f64>() {
            Ok(v) if v.abs() <= LARGEST => Ok(Some(v)),
            Ok(_) => Err("a number of a house: at most 10,000"),
            Err(_) => Err("a number"),
        },
    }
}

/// The houses of a table, one a row; columns that are no attributes are not read.
///
/// # Errors
/// [`ObservationError`] names row and column.
pub fn observations(
    header: &[String],
    rows: &[Vec<String>],
) -> Result<Vec<Observation>, ObservationError> {
    if !tells_of_houses(header) {
        return Err(ObservationError::NoColumn);
    }
    let place = |name: &str| header.iter().position(|h| h == name);
    let columns: Vec<Option<usize>> = COLUMNS.iter().map(|c| place(c)).collect();
    let there = THERE.map(place);
    let floors = place(FLOORS);
    let mut houses = Vec::with_capacity(rows.len());
    for (r, row) in rows.iter().enumerate() {
        let wrong = |at: usize, expected| ObservationError::Cell {
            row: r + 1,
            column: header[at].clone(),
            text: row[at].clone(),
            expected,
        };
        let number = |at: Option<usize>| match at {
            Some(at) => cell(&row[at]).map_err(|expected| wrong(at, expected)),
            None => Ok(None),
        };
        let values = columns.iter().map(|at| number(*at));
        let mut house = Observation::from(values.collect::<Result<Vec<_>, _>>()?);
        for (own, at) in house.there.iter_mut().zip(there) {
            *own = number(at)?.map(|v| v > 0.5).or(*own);
        }
        if let (Some(at), Some(count)) = (floors, number(floors)?) {
            if ![1.0, 2.0, 3.0].contains(&count) {
                return Err(wrong(at, "1, 2 or 3 floors"));
            }
            house.floors = Some(count as usize);
        }
        houses.push(house);
    }
    Ok(houses)
}

/// Forgets what does not belong to the named groups of attributes.
///
/// # Errors
/// [`ObservationError::Group`].
pub fn only(houses: &mut [Observation], groups: &[String]) -> Result<(), ObservationError> {
    if let Some(name) = groups
        .iter()
        .find(|n| GROUPS.iter().all(|g| g.name != n.as_str()))
    {
        return Err(ObservationError::Group(name.clone()));
    }
    let keeps = |name: &str| groups.iter().any(|g| g == name);
    for house in houses {
        for group in GROUPS.iter().filter(|g| !keeps(g.name)) {
            house.row[group.first..group.first + group.len].fill(None);
        }
        if !keeps("garage") {
            house.there[0] = None;
        }
        if !keeps("porch") {
            house.there[1..].fill(None);
        }
        if !keeps("arf") {
            house.floors = None;
        }
    }
    Ok(())
}
