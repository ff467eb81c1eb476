//! Data: named columns, real or categorical, with missing values allowed anywhere.

use super::error::ModelError;

pub use super::column::{Cell, Column};
pub(crate) use super::column::{MISSING, Values};

/// A table of named columns with the same number of rows, the data of every model that has columns.
///
/// A missing value is one that was not observed: models sum or integrate it out, `p(x_seen) = ∫ p(x) dx_missing`, as if it were
/// missing at random (Rubin 1976); that is not what zero or a category of its own says. Columns are found by name, O(columns);
/// adding one is O(rows), of categories by name O(rows x categories).
///
/// # Examples
/// ```
/// use edifice_model::{Cell, Table};
/// let houses = Table::new()
///     .real("width", [Some(12.0), None, Some(9.5)])?
///     .binary("chimney", [Some(true), Some(false), None])?
///     .categorical("roof", &["flat", "gable", "hip"], [Some("hip"), Some("flat"), None])?;
/// assert_eq!(houses.rows(), 3);
/// let roof = houses.column("roof")?;
/// assert_eq!((roof.cell(0), roof.cell(2)), (Cell::Code(2), Cell::Missing));
/// // Evidence: of the second and the first house, no more than the chimney is known.
/// let asked = houses.select(&[1, 0]).only(&["chimney"])?;
/// assert_eq!(asked.column("chimney")?.cell(1), Cell::Code(1));
/// assert_eq!(asked.column("width")?.cell(1), Cell::Missing);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Table {
    rows: usize,
    columns: Vec<Column>,
}

impl Table {
    /// A table without columns.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a column of real numbers.
    ///
    /// # Errors
    /// [`ModelError::NotFinite`], [`ModelError::Rows`], [`ModelError::Duplicate`].
    pub fn real(
        self,
        name: &str,
        values: impl IntoIterator<Item = Option<f64>>,
    ) -> Result<Self, ModelError> {
        let mut column = Vec::new();
        for (row, value) in values.into_iter().enumerate() {
            column.push(match value {
                None => f64::NAN,
                Some(x) if x.is_finite() => x,
                Some(value) => {
                    return Err(ModelError::NotFinite {
                        column: name.to_owned(),
                        row,
                        value,
                    });
                }
            });
        }
        self.push(name, Values::Real(column))
    }

    /// Adds a column of yes/no values (categories `no` and `yes`).
    ///
    /// # Errors
    /// [`ModelError::Rows`], [`ModelError::Duplicate`].
    pub fn binary(
        self,
        name: &str,
        values: impl IntoIterator<Item = Option<bool>>,
    ) -> Result<Self, ModelError> {
        let codes = values.into_iter().map(|v| v.map_or(MISSING, u32::from));
        let values = Values::Codes {
            categories: vec!["no".to_owned(), "yes".to_owned()],
            codes: codes.collect(),
        };
        self.push(name, values)
    }

    /// Adds a column of categories, each value one of `categories`.
    ///
    /// # Errors
    /// [`ModelError::UnseenCategory`], [`ModelError::Rows`], [`ModelError::Duplicate`] (also for
    /// a category listed twice).
    pub fn categorical<'v>(
        self,
        name: &str,
        categories: &[&str],
        values: impl IntoIterator<Item = Option<&'v str>>,
    ) -> Result<Self, ModelError> {
        let mut codes = Vec::new();
        for (row, value) in values.into_iter().enumerate() {
            codes.push(match value {
                None => None,
                Some(v) => match categories.iter().position(|c| *c == v) {
                    Some(i) => Some(i),
                    None => {
                        return Err(ModelError::UnseenCategory {
                            column: name.to_owned(),
                            row,
                            category: v.to_owned(),
                        });
                    }
                },
            });
        }
        self.codes(name, categories, codes)
    }

    /// Adds a column of category indices.
    ///
    /// # Errors
    /// [`ModelError::UnseenCategory`] for an index out of range, [`ModelError::Rows`],
    /// [`ModelError::Duplicate`].
    pub fn codes(
        self,
        name: &str,
        categories: &[&str],
        values: impl IntoIterator<Item = Option<usize>>,
    ) -> Result<Self, ModelError> {
        for (i, c) in categories.iter().enumerate() {
            if categories[..i].contains(c) {
                return Err(ModelError::Duplicate {
                    name: format!("{name}={c}"),
                });
            }
        }
        let mut codes = Vec::new();
        for (row, value) in values.into_iter().enumerate() {
            codes.push(match value {
                None => MISSING,
                Some(i) if i < categories.len() => i as u32,
                Some(i) => {
                    return Err(ModelError::UnseenCategory {
                        column: name.to_owned(),
                        row,
                        category: i.to_string(),
                    });
                }
            });
        }
        let categories = categories.iter().map(|c| (*c).to_owned()).collect();
        self.push(name, Values::Codes { categories, codes })
    }

    pub(crate) fn push(mut self, name: &str, values: Values) -> Result<Self, ModelError> {
        if self.columns.iter().any(|c| c.name == name) {
            return Err(ModelError::Duplicate {
                name: name.to_owned(),
            });
        }
        let column = Column {
            name: name.to_owned(),
            values,
        };
        if self.columns.is_empty() {
            self.rows = column.len();
        } else if column.len() != self.rows {
            return Err(ModelError::Rows {
                column: column.name.clone(),
                got: column.len(),
                expected: self.rows,
            });
        }
        self.columns.push(column);
        Ok(self)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// True if any cell is missing.
    pub fn has_missing(&self) -> bool {
        self.columns.iter().any(|column| match &column.values {
            Values::Real(values) => values.iter().any(|v| v.is_nan()),
            Values::Codes { codes, .. } => codes.contains(&MISSING),
        })
    }

    /// The columns, in order of declaration.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The column called `name`.
    ///
    /// # Errors
    /// [`ModelError::Unknown`].
    pub fn column(&self, name: &str) -> Result<&Column, ModelError> {
        self.columns
            .iter()
            .find(|c| c.name == name)
            .ok_or_else(|| ModelError::Unknown {
                name: name.to_owned(),
            })
    }

    /// The rows with the given indices, in that order; an index past the end gives a row of
    /// missing values.
    pub fn select(&self, rows: &[usize]) -> Self {
        let columns = self.columns.iter().map(|c| Column {
            name: c.name.clone(),
            values: match &c.values {
                Values::Real(v) => Values::Real(
                    rows.iter()
                        .map(|&r| v.get(r).copied().unwrap_or(f64::NAN))
                        .collect(),
                ),
                Values::Codes { categories, codes } => Values::Codes {
                    categories: categories.clone(),
                    codes: rows
                        .iter()
                        .map(|&r| codes.get(r).copied().unwrap_or(MISSING))
                        .collect(),
                },
            },
        });
        Self {
            rows: rows.len(),
            columns: columns.collect(),
        }
    }

    /// Adds the rows of a table with the same columns: names, kinds and categories are the caller's to keep equal.
    pub(crate) fn append(&mut self, other: &Self) {
        for (own, more) in self.columns.iter_mut().zip(&other.columns) {
            match (&mut own.values, &more.values) {
                (Values::Real(own), Values::Real(more)) => own.extend(more),
                (Values::Codes { codes: own, .. }, Values::Codes { codes: more, .. }) => {
                    own.extend(more);
                }
                _ => {}
            }
        }
        self.rows += other.rows;
    }

    /// The columns of these names, in this order.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] for a name without a column; [`ModelError::Duplicate`] for one that comes twice.
    pub fn in_order(&self, names: &[&str]) -> Result<Self, ModelError> {
        let mut table = Self {
            columns: Vec::with_capacity(names.len()),
            rows: self.rows,
        };
        for name in names {
            table = table.push(name, self.column(name)?.values.clone())?;
        }
        table.rows = self.rows;
        Ok(table)
    }

    /// The same table with the numbers that `known` has in real columns of the same name, to the bit; each row of
    /// `known` belongs to `times` rows of this table, one after the other. Categories stay: they are exact anyhow.
    pub(crate) fn overlaid(mut self, known: &Self, times: usize) -> Self {
        for column in &mut self.columns {
            let Ok(own) = known.column(&column.name) else {
                continue;
            };
            if let (Values::Real(to), Values::Real(from)) = (&mut column.values, &own.values) {
                let from = from.iter().flat_map(|v| std::iter::repeat_n(*v, times));
                let known = to.iter_mut().zip(from).filter(|(_, v)| v.is_finite());
                known.for_each(|(to, v)| *to = v);
            }
        }
        self
    }

    /// The same table where every column not called one of `names` is missing in every row: what
    /// is left is evidence to condition on.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] for a name without a column.
    pub fn only(&self, names: &[&str]) -> Result<Self, ModelError> {
        for name in names {
            self.column(name)?;
        }
        let mut table = self.clone();
        for column in &mut table.columns {
            if !names.contains(&column.name.as_str()) {
                match &mut column.values {
                    Values::Real(v) => v.fill(f64::NAN),
                    Values::Codes { codes, .. } => codes.fill(MISSING),
                }
            }
        }
        Ok(table)
    }
}
