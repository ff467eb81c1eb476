//! The attributes that are known from a partial house.

use crate::attributes::{AttributeError, AttributeRow, COLUMNS, GROUPS, attributes};
use crate::mass::target::PARTS;
use edifice_model::{Cell, Table};
use edifice_shape::Building;

/// First column of the facades and of the styles.
const FACADES: usize = 27;
const STYLES: usize = 39;

/// The attributes that a partial house tells; all others are `None`. With `keep`, those of the named groups, as they
/// are measured. Without, all of a house that names its unobserved parts, but for those of these parts; of one that names
/// none, as drawn by hand, what cannot change when more of the house appears:
/// - sizes of a garage or porch that is there,
/// - the three facade attributes of each side that has pieces,
/// - styles that are there (not that others are absent).
///
/// # Errors
/// [`AttributeError`] for more than three floors.
pub fn observed(partial: &Building, keep: &[String]) -> Result<AttributeRow, AttributeError> {
    let mut row = attributes(partial)?;
    if !keep.is_empty() {
        for group in GROUPS.iter().filter(|g| !keep.iter().any(|k| k == g.name)) {
            row[group.first..group.first + group.len].fill(None);
        }
        return Ok(row);
    }
    if !partial.unobserved.is_empty() {
        return Ok(row);
    }
    for (c, value) in row.iter_mut().enumerate() {
        let is_size = PARTS
            .iter()
            .any(|(_, first, _)| (first + 2..first + 5).contains(&c));
        let present = value.is_some_and(|v| v > 0.0);
        let tells = match c {
            c if c < FACADES => is_size && present,
            c if c < STYLES => true,
            _ => value.is_some_and(|v| v > 0.5),
        };
        if !tells {
            *value = None;
        }
    }
    Ok(row)
}

/// The 49 columns of each row of a table; missing cells and columns are 0.
pub fn wanted_rows(table: &Table) -> Vec<[f64; 49]> {
    let value = |row: usize, name: &str| {
        let cell = table.column(name).map(|c| c.cell(row));
        cell.ok().and_then(Cell::number).unwrap_or(0.0)
    };
    let row = |r: usize| std::array::from_fn(|c| value(r, COLUMNS[c]));
    (0..table.rows()).map(row).collect()
}
