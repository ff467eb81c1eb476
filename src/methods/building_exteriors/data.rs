//! From attribute rows to the tables and groups of the model layer.

use super::attributes::{AttributeRow, GROUPS, Level};
use edifice_model::hierarchy::Group;
use edifice_model::tables::Dataset;
use edifice_model::{ModelError, Table};

/// The 49 attributes of many buildings with the paper's 13 groups.
///
/// # Errors
/// As [`table`].
pub fn dataset(rows: &[AttributeRow]) -> Result<Dataset, ModelError> {
    Ok(Dataset {
        table: table(rows)?,
        groups: groups(),
    })
}

/// The 49 attributes of many buildings as a table: continuous groups as real columns, elements as
/// yes/no columns, missing kept missing.
///
/// # Errors
/// [`ModelError::NotFinite`] for a NaN or an infinity.
pub fn table(rows: &[AttributeRow]) -> Result<Table, ModelError> {
    let mut table = Table::new();
    for group in &GROUPS {
        for (k, name) in group.columns().iter().enumerate() {
            let values = rows
                .iter()
                .map(|row| row.get(group.first + k).copied().flatten());
            table = match group.level {
                Level::Element => table.binary(name, values.map(|v| v.map(|v| v > 0.5)))?,
                Level::Mass | Level::Facade => table.real(name, values)?,
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
