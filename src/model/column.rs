//! Columns: their cells one by one, and all at once.

/// Code of a missing category.
pub(crate) const MISSING: u32 = u32::MAX;

/// One cell of a [`Table`](super::Table), by [`Column::cell`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// Not observed.
    Missing,
    /// A finite number, in the column's own unit.
    Real(f64),
    /// Index into the column's categories.
    Code(usize),
}

impl Cell {
    /// The number of a real cell, the index of a categorical one (0 or 1 of a binary one), `None` where it is missing.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Missing => None,
            Self::Real(value) => Some(value),
            Self::Code(code) => Some(code as f64),
        }
    }
}

/// Values of a column.
#[derive(Clone, Debug)]
pub(crate) enum Values {
    /// Finite numbers; NaN marks a missing one.
    Real(Vec<f64>),
    /// Indices into `categories`, or [`MISSING`].
    Codes {
        categories: Vec<String>,
        codes: Vec<u32>,
    },
}

/// A named column of n cells: real numbers in a unit of its own, or categories. Made by [`Table`](super::Table)'s methods, whose example reads
/// some; 8 bytes a real cell, 4 a category.
#[derive(Clone, Debug)]
pub struct Column {
    pub(crate) name: String,
    pub(crate) values: Values,
}

impl Column {
    /// The index that [`Column::codes`] has for a missing cell.
    pub const MISSING: u32 = MISSING;

    /// The column's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Categories of a categorical column (`no`, `yes` for a binary one), `None` for a real one.
    pub fn categories(&self) -> Option<&[String]> {
        match &self.values {
            Values::Real(_) => None,
            Values::Codes { categories, .. } => Some(categories),
        }
    }

    /// All cells of a real column, in its own unit, NaN where a cell is missing; `None` for a categorical one.
    ///
    /// # Examples
    /// ```
    /// use edifice_model::{Column, Table};
    /// let houses = Table::new()
    ///     .real("width", [Some(12.0), None])?
    ///     .categorical("roof", &["flat", "hip"], [None, Some("hip")])?;
    /// let width = houses.column("width")?.numbers().unwrap_or_default();
    /// assert!(width[0] == 12.0 && width[1].is_nan());
    /// assert_eq!(houses.column("roof")?.codes(), Some(&[Column::MISSING, 1][..]));
    /// # Ok::<(), edifice_model::ModelError>(())
    /// ```
    pub fn numbers(&self) -> Option<&[f64]> {
        match &self.values {
            Values::Real(values) => Some(values),
            Values::Codes { .. } => None,
        }
    }

    /// All cells of a categorical column as indices into its categories, [`Column::MISSING`] where a cell is missing; `None` for
    /// a real one.
    pub fn codes(&self) -> Option<&[u32]> {
        match &self.values {
            Values::Real(_) => None,
            Values::Codes { codes, .. } => Some(codes),
        }
    }

    /// The cell at `row`; [`Cell::Missing`] past the end.
    pub fn cell(&self, row: usize) -> Cell {
        match &self.values {
            Values::Real(v) => match v.get(row) {
                Some(x) if x.is_finite() => Cell::Real(*x),
                _ => Cell::Missing,
            },
            Values::Codes { codes, .. } => match codes.get(row) {
                Some(&c) if c != MISSING => Cell::Code(c as usize),
                _ => Cell::Missing,
            },
        }
    }

    pub(crate) fn kind(&self) -> &'static str {
        match self.values {
            Values::Real(_) => "real",
            Values::Codes { .. } => "categorical",
        }
    }

    pub(crate) fn len(&self) -> usize {
        match &self.values {
            Values::Real(v) => v.len(),
            Values::Codes { codes, .. } => codes.len(),
        }
    }
}
