//! From attribute rows to the tables and groups of the model layer.

use super::attributes::{AttributeRow, GROUPS, Level};
use crate::model::hierarchy::Group;
use crate::model::{ModelError, Table};

/// A table and its attributes.
#[derive(Debug, Clone)]
pub struct Dataset {
    /// One house a row.
    pub table: Table,
    /// Which columns belong together.
    pub groups: Vec<Group>,
}

impl Dataset {
    /// The houses of the given rows.
    pub fn select(&self, rows: &[usize]) -> Self {
        Self {
            table: self.table.select(rows),
            groups: self.groups.clone(),
        }
    }

    /// All attributes but one.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] when a group names a column that the table lacks.
    pub fn without(&self, attribute: &str) -> Result<Self, ModelError> {
        let mut groups = self.groups.clone();
        groups.retain(|g| g.name != attribute);
        let columns = groups.iter().flat_map(|g| &g.columns);
        let columns: Vec<&str> = columns.map(String::as_str).collect();
        Ok(Self {
            table: self.table.only(&columns)?,
            groups,
        })
    }
}

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
