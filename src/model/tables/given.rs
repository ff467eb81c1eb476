//! Evidence in words: `garage=none`, `bbox.w=12`, `wwr=0.2,0.2,0.1,0.1`, `roof.hip=yes`.

use super::categories::Meanings;
use crate::hierarchy::Group;
use crate::{ModelError, Table};

/// The defects of a piece of evidence.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GivenError {
    /// Not of the form `name=value`.
    #[error("{text:?}: expected NAME=VALUE")]
    Form {
        /// The text found.
        text: String,
    },
    /// Neither a column nor an attribute of the model.
    #[error("the model has no column or attribute `{name}`")]
    Unknown {
        /// The name found.
        name: String,
    },
    /// A vector of the wrong length.
    #[error("`{name}` has {expected} numbers, {got} are given")]
    Length {
        /// The attribute.
        name: String,
        /// Its columns.
        expected: usize,
        /// Values given.
        got: usize,
    },
    /// Not a number where one is needed.
    #[error("`{name}`: {text:?} is not a finite number")]
    NotANumber {
        /// The column.
        name: String,
        /// The text found.
        text: String,
    },
    /// Not a category of the column.
    #[error("`{name}`: {text:?} is none of {}", .categories.join(", "))]
    Category {
        /// The column.
        name: String,
        /// The text found.
        text: String,
        /// The categories of the column.
        categories: Vec<String>,
    },
    /// The model layer refuses the evidence.
    #[error(transparent)]
    Model(#[from] ModelError),
}

/// A table of one row with the given values and nothing else. `ATTRIBUTE=none` sets all numbers of
/// an attribute to zero, as for a house without garage. `columns` has the columns of the model, whose kinds
/// alone are read.
///
/// # Errors
/// [`GivenError`] names the text that is wrong.
pub fn evidence(groups: &[Group], columns: &Table, given: &[String]) -> Result<Table, GivenError> {
    let mut table = Table::new();
    for text in given {
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| GivenError::Form { text: text.clone() })?;
        if let Ok(column) = columns.column(name) {
            table = add(table, name, column.categories(), value)?;
            continue;
        }
        let Some(group) = groups.iter().find(|g| g.name == name) else {
            return Err(GivenError::Unknown { name: name.into() });
        };
        let values: Vec<&str> = match value {
            "none" => vec!["none"; group.columns.len()],
            value => value.split(',').collect(),
        };
        if values.len() != group.columns.len() {
            return Err(GivenError::Length {
                name: name.into(),
                expected: group.columns.len(),
                got: values.len(),
            });
        }
        for (column, value) in group.columns.iter().zip(values) {
            let categories = columns.column(column)?.categories();
            table = add(table, column, categories, value)?;
        }
    }
    Ok(table)
}

fn add(
    table: Table,
    name: &str,
    categories: Option<&[String]>,
    text: &str,
) -> Result<Table, GivenError> {
    let Some(categories) = categories else {
        let number = match text {
            "none" => Some(0.0),
            text => text.parse().ok().filter(|v: &f64| v.is_finite()),
        };
        let number = number.ok_or_else(|| GivenError::NotANumber {
            name: name.into(),
            text: text.into(),
        })?;
        return Ok(table.real(name, [Some(number)])?);
    };
    let code = match text {
        "none" if categories == ["no", "yes"] => Some(0),
        text => Meanings::new(categories).code(text),
    };
    let code = code.ok_or_else(|| GivenError::Category {
        name: name.into(),
        text: text.into(),
        categories: categories.to_vec(),
    })?;
    let names: Vec<&str> = categories.iter().map(String::as_str).collect();
    Ok(table.codes(name, &names, [Some(code)])?)
}
