//! From attribute rows to the tables and groups of the model layer.

use super::attributes::{AttributeRow, COLUMNS, GROUPS, Level};
use crate::model::hierarchy::Group;
use crate::model::{ModelError, Table};

/// The 49 attributes of many buildings as a table: continuous groups as real columns, elements as
/// yes/no columns, missing kept missing.
///
/// # Errors
/// [`ModelError::NotFinite`] for a NaN or an infinity.
pub fn table(rows: &[AttributeRow]) -> Result<Table, ModelError> {
    let mut table = Table::new();
    for group in &GROUPS {
        for c in group.first..group.first + group.len {
            let values = rows.iter().map(|row| row.get(c).copied().flatten());
            table = match group.level {
                Level::Element => table.binary(COLUMNS[c], values.map(|v| v.map(|v| v > 0.5)))?,
                Level::Mass | Level::Facade => table.real(COLUMNS[c], values)?,
            };
        }
    }
    Ok(table)
}

/// The 13 attributes of the paper as groups of columns: seven of the mass model and three of the
/// facades, each with a hidden variable of its own, and three binary vectors.
pub fn groups() -> Vec<Group> {
    let groups = GROUPS.iter();
    groups.map(|g| Group::new(g.name, g.columns())).collect()
}
