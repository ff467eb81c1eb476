//! From attribute rows to the tables and groups of the model layer.

use super::attributes::{AttributeRow, GROUPS, Level};
use edifice_model::hierarchy::Group;
use edifice_model::tables::Dataset;
use edifice_model::{Cell, ModelError, Table};

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

/// The dataset without columns of which nothing is known, and without attributes that have no other.
///
/// # Errors
/// [`ModelError::Empty`] when nothing is known at all.
pub fn known(data: Dataset) -> Result<Dataset, ModelError> {
    let tells = |name: &str| -> Result<bool, ModelError> {
        let column = data.table.column(name)?;
        Ok((0..data.table.rows()).any(|row| column.cell(row) != Cell::Missing))
    };
    let (mut groups, mut names) = (Vec::new(), Vec::new());
    for group in &data.groups {
        let mut own: Vec<&str> = Vec::new();
        for column in &group.columns {
            if tells(column)? {
                own.push(column);
            }
        }
        if !own.is_empty() {
            groups.push(Group::new(&group.name, &own));
            names.extend(own);
        }
    }
    if groups.is_empty() {
        return Err(ModelError::Empty { what: "columns" });
    }
    Ok(Dataset {
        table: data.table.in_order(&names)?,
        groups,
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
