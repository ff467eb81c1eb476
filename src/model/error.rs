//! The errors of data, of models, and of questions put to a model.

/// One variant per way to be wrong; each names the variable, and the row where there is one.
///
/// Its text is a sentence for users, in which the first row is row 1. The fields count rows from 0 in the table that was given; a
/// caller that looked at one row on its own says which it was ([`ModelError::in_row`]).
///
/// # Examples
/// ```
/// use edifice_model::{ModelError, Table};
/// let error = Table::new().real("width", [Some(9.5), Some(f64::INFINITY)]).unwrap_err();
/// assert_eq!(error.to_string(), "column `width`, row 2: inf is not finite (declare it missing instead)");
/// assert!(matches!(error.in_row(7), ModelError::NotFinite { row: 7, .. }));
/// ```
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// No rows, or no columns, where some are needed.
    #[error("no {what} to work with")]
    Empty {
        /// The things of which there are none: `rows`, `columns`, `groups`, ...
        what: &'static str,
    },
    /// A watch ended the call before there was a result.
    #[error("ended before there was a result")]
    Interrupted,
    /// Two columns, variables or groups share a name.
    #[error("`{name}` is declared twice")]
    Duplicate {
        /// The shared name.
        name: String,
    },
    /// A name that is not declared.
    #[error("there is no variable `{name}`")]
    Unknown {
        /// The name asked for.
        name: String,
    },
    /// A column has another number of rows than the table.
    #[error("column `{column}` has {got} rows, the table has {expected}")]
    Rows {
        /// The column.
        column: String,
        /// Its rows.
        got: usize,
        /// Rows of the table.
        expected: usize,
    },
    /// A value that is neither finite nor declared missing.
    #[error("column `{column}`, row {}: {value} is not finite (declare it missing instead)", .row + 1)]
    NotFinite {
        /// The column.
        column: String,
        /// Row, from 0.
        row: usize,
        /// The value.
        value: f64,
    },
    /// A column whose observed values are all equal, so that it has no scale.
    #[error("column `{column}` is constant (every observed value is {value})")]
    Constant {
        /// The column.
        column: String,
        /// The value.
        value: String,
    },
    /// A column without any observed value.
    #[error("column `{column}` has no observed value")]
    AllMissing {
        /// The column.
        column: String,
    },
    /// A value that must be given is missing.
    #[error("column `{column}`, row {}: a value is needed here", .row + 1)]
    Missing {
        /// The column.
        column: String,
        /// Row, from 0.
        row: usize,
    },
    /// A category that the variable does not have.
    #[error("column `{column}`, row {}: category `{category}` was not seen in training", .row + 1)]
    UnseenCategory {
        /// The column.
        column: String,
        /// Row, from 0.
        row: usize,
        /// The category.
        category: String,
    },
    /// A column of another kind than the model needs.
    #[error("column `{column}` is {got}, {expected} is needed")]
    Kind {
        /// The column.
        column: String,
        /// Its kind.
        got: &'static str,
        /// The kind needed.
        expected: &'static str,
    },
    /// Evidence of probability zero.
    #[error("{}the evidence has probability zero (first contradiction at `{variable}`)", place(*.row))]
    Contradiction {
        /// Row, from 0; `None` for evidence that is no row of a table.
        row: Option<usize>,
        /// The variable at which the probability became zero.
        variable: String,
    },
    /// A fit without a prior that the data cannot determine.
    #[error(
        "{rows} rows cannot determine the {parameters} parameters of `{variable}`: use a prior"
    )]
    TooFewRows {
        /// Rows at hand.
        rows: usize,
        /// Free parameters asked for.
        parameters: usize,
        /// The variable or model.
        variable: String,
    },
    /// Parents that form a cycle.
    #[error("the model is cyclic: `{variable}` is among its own ancestors")]
    Cycle {
        /// A variable on the cycle.
        variable: String,
    },
    /// A parameter or a setting out of its range.
    #[error("`{name}`: {problem}")]
    Parameter {
        /// The parameter, setting or variable.
        name: String,
        /// The defect of the variable, as a phrase.
        problem: String,
    },
    /// A covariance that is not positive definite.
    #[error("the covariance of `{variable}` is singular: give it a prior")]
    Singular {
        /// The variable.
        variable: String,
    },
    /// Exact inference would need tables that are too large.
    #[error(
        "exact inference needs a table of {width} variables and {cells:.1e} cells to eliminate `{variable}`, which is too large: \
         ask for fewer variables or approximately"
    )]
    TooWide {
        /// The variable whose elimination needs the largest table.
        variable: String,
        /// Number of variables of that table.
        width: usize,
        /// Its number of cells.
        cells: f64,
    },
    /// Text that does not hold a model.
    #[error("corrupt model, {place}: {problem}")]
    Corrupt {
        /// Line and column, or the field.
        place: String,
        /// The defect at that place, as a phrase.
        problem: String,
    },
}

impl ModelError {
    /// A parameter or setting out of range.
    pub fn parameter(name: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Parameter {
            name: name.into(),
            problem: problem.into(),
        }
    }

    /// The same with `row` for the row: for a row that was looked at on its own. Errors without a row stay as they are, and so
    /// does [`ModelError::Rows`], which counts rows.
    pub fn in_row(self, row: usize) -> Self {
        match self {
            Self::NotFinite { column, value, .. } => Self::NotFinite { column, row, value },
            Self::Missing { column, .. } => Self::Missing { column, row },
            Self::UnseenCategory {
                column, category, ..
            } => Self::UnseenCategory {
                column,
                row,
                category,
            },
            Self::Contradiction { variable, .. } => Self::Contradiction {
                row: Some(row),
                variable,
            },
            other => other,
        }
    }

    /// The row, from 0, of an error that has one.
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::NotFinite { row, .. }
            | Self::Missing { row, .. }
            | Self::UnseenCategory { row, .. } => Some(*row),
            Self::Contradiction { row, .. } => *row,
            _ => None,
        }
    }

    /// The same for a table that has the given rows of another, with the row of that one. Errors without a row, or with one that
    /// is not there, stay as they are.
    pub fn among(self, rows: &[usize]) -> Self {
        match self.row().and_then(|row| rows.get(row)) {
            Some(&row) => self.in_row(row),
            None => self,
        }
    }

    /// The same for evidence that a caller put into a row, where users gave none: a contradiction has no row then.
    pub fn in_no_row(self) -> Self {
        match self {
            Self::Contradiction { variable, .. } => Self::Contradiction {
                row: None,
                variable,
            },
            other => other,
        }
    }

    /// Text that does not hold a model.
    pub fn corrupt(place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Corrupt {
            place: place.into(),
            problem: problem.into(),
        }
    }
}

/// The row in words, before a sentence.
fn place(row: Option<usize>) -> String {
    row.map_or_else(String::new, |row| format!("row {}: ", row + 1))
}
