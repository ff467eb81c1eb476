//! From a table to standardised rows, by name, and back.

use super::super::error::ModelError;
use super::super::standardize::{Constant, moments};
use super::super::table::{MISSING, Table, Values};

/// Columns that belong together: all real (one vector-valued attribute C_g, of as many coordinates as columns), or all
/// categorical (a binary vector, or a single categorical attribute: each column is an E_k of its own).
///
/// The paper's mass, facade and element attributes are one group each (Fan and Wonka 2016, Sec. 4.2 and 5.2). Columns that no
/// group names are not in the model; units may differ from column to column.
///
/// # Examples
/// ```
/// use edifice_model::{ModelError, Table, hierarchy::{Group, Settings, learn}};
/// let houses = Table::new()
///     .real("width", (0..20).map(|i| Some(f64::from(i % 7))))?
///     .binary("garage", (0..20).map(|i| Some(i % 2 == 1)))?;
/// let mixed = [Group::new("house", &["width", "garage"])];
/// let refused = learn(&houses, &mixed, &Settings::default(), 1);
/// assert!(matches!(refused, Err(ModelError::Kind { column, .. }) if column == "garage"));
/// # Ok::<(), ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// The attribute's name.
    pub name: String,
    /// Names of its columns.
    pub columns: Vec<String>,
}

impl Group {
    /// A group from names.
    pub fn new(name: &str, columns: &[&str]) -> Self {
        Self {
            name: name.to_owned(),
            columns: columns.iter().map(|c| (*c).to_owned()).collect(),
        }
    }
}

/// A real column of the model.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct RealColumn {
    pub name: String,
    /// Mean of the training values.
    pub mean: f64,
    /// Standard deviation of the training values.
    pub scale: f64,
}

/// A categorical column of the model.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) struct CodeColumn {
    pub name: String,
    pub group: String,
    pub categories: Vec<String>,
}

/// Columns of a model, in the model's order.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Schema {
    /// Names of the real groups.
    pub groups: Vec<String>,
    /// First real column of each real group, and the total at the end.
    pub offsets: Vec<usize>,
    pub reals: Vec<RealColumn>,
    pub codes: Vec<CodeColumn>,
}

impl Schema {
    /// Reads names, categories, means and scales from training data.
    pub(crate) fn learn(
        data: &Table,
        groups: &[Group],
        constant: Constant,
    ) -> Result<Self, ModelError> {
        let mut schema = Self {
            groups: Vec::new(),
            offsets: vec![0],
            reals: Vec::new(),
            codes: Vec::new(),
        };
        if data.rows() == 0 {
            return Err(ModelError::Empty { what: "rows" });
        }
        if groups.is_empty() {
            return Err(ModelError::Empty { what: "groups" });
        }
        for (i, group) in groups.iter().enumerate() {
            if groups[..i].iter().any(|g| g.name == group.name) {
                return Err(ModelError::Duplicate {
                    name: group.name.clone(),
                });
            }
            schema.add(data, group, constant)?;
        }
        Ok(schema)
    }

    fn add(&mut self, data: &Table, group: &Group, constant: Constant) -> Result<(), ModelError> {
        let Some(first) = group.columns.first() else {
            return Err(ModelError::Empty { what: "columns" });
        };
        let real = matches!(data.column(first)?.values, Values::Real(_));
        for name in &group.columns {
            let column = data.column(name)?;
            let taken = self.reals.iter().any(|c| &c.name == name)
                || self.codes.iter().any(|c| &c.name == name);
            if taken {
                return Err(ModelError::Duplicate { name: name.clone() });
            }
            match &column.values {
                Values::Real(values) if real => {
                    let (mean, scale) = moments(name, values, constant)?;
                    self.reals.push(RealColumn {
                        name: name.clone(),
                        mean,
                        scale,
                    });
                }
                Values::Codes { categories, codes } if !real => {
                    check_codes(name, categories, codes, constant)?;
                    self.codes.push(CodeColumn {
                        name: name.clone(),
                        group: group.name.clone(),
                        categories: categories.clone(),
                    });
                }
                _ => {
                    return Err(ModelError::Kind {
                        column: name.clone(),
                        got: column.kind(),
                        expected: if real { "real" } else { "categorical" },
                    });
                }
            }
        }
        if real {
            self.groups.push(group.name.clone());
            self.offsets.push(self.reals.len());
        }
        Ok(())
    }

    /// Real columns of real group `g`.
    pub(crate) fn columns(&self, g: usize) -> std::ops::Range<usize> {
        self.offsets[g]..self.offsets[g + 1]
    }

    /// Numbers of categories.
    pub(crate) fn sizes(&self) -> Vec<usize> {
        self.codes.iter().map(|c| c.categories.len()).collect()
    }

    /// The index at which the indicators of each categorical column start in a row of real columns and indicators, and
    /// its length at the end.
    pub(crate) fn indicators(&self) -> Vec<usize> {
        let mut starts = vec![self.reals.len()];
        for (i, size) in self.sizes().into_iter().enumerate() {
            starts.push(starts[i] + size);
        }
        starts
    }

    /// Standardised rows of `data`, columns found by name; a column that is absent is missing.
    pub(crate) fn encode(&self, data: &Table) -> Result<Rows, ModelError> {
        let (rows, d, c) = (data.rows(), self.reals.len(), self.codes.len());
        let mut reals = vec![f64::NAN; rows * d];
        for (j, column) in self.reals.iter().enumerate() {
            let Ok(found) = data.column(&column.name) else {
                continue;
            };
            let Values::Real(values) = &found.values else {
                return Err(ModelError::Kind {
                    column: column.name.clone(),
                    got: found.kind(),
                    expected: "real",
                });
            };
            for (i, v) in values.iter().enumerate() {
                reals[i * d + j] = (v - column.mean) / column.scale;
            }
        }
        let mut codes = vec![MISSING; rows * c];
        for (j, column) in self.codes.iter().enumerate() {
            let Ok(found) = data.column(&column.name) else {
                continue;
            };
            let Values::Codes {
                categories,
                codes: values,
            } = &found.values
            else {
                return Err(ModelError::Kind {
                    column: column.name.clone(),
                    got: found.kind(),
                    expected: "categorical",
                });
            };
            let map: Vec<Option<u32>> = categories
                .iter()
                .map(|n| {
                    column
                        .categories
                        .iter()
                        .position(|c| c == n)
                        .map(|i| i as u32)
                })
                .collect();
            for (i, &v) in values.iter().enumerate().filter(|(_, v)| **v != MISSING) {
                codes[i * c + j] = map[v as usize].ok_or_else(|| ModelError::UnseenCategory {
                    column: column.name.clone(),
                    row: i,
                    category: categories[v as usize].clone(),
                })?;
            }
        }
        Ok(Rows {
            rows,
            d,
            c,
            reals,
            codes,
        })
    }

    /// A table of complete rows from standardised values.
    pub(crate) fn decode(&self, rows: &Rows) -> Result<Table, ModelError> {
        let mut table = Table::new();
        for (j, column) in self.reals.iter().enumerate() {
            let values = (0..rows.rows).map(|i| {
                let v = rows.reals[i * rows.d + j] * column.scale + column.mean;
                v.is_finite().then_some(v)
            });
            table = table.real(&column.name, values)?;
        }
        for (j, column) in self.codes.iter().enumerate() {
            let values = Values::Codes {
                categories: column.categories.clone(),
                codes: (0..rows.rows).map(|i| rows.codes[i * rows.c + j]).collect(),
            };
            table = table.push(&column.name, values)?;
        }
        Ok(table)
    }
}

/// Standardised rows; NaN and [`MISSING`] mark missing values.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    pub rows: usize,
    /// Real columns.
    pub d: usize,
    /// Categorical columns.
    pub c: usize,
    pub reals: Vec<f64>,
    pub codes: Vec<u32>,
}

impl Rows {
    pub(crate) fn real(&self, row: usize) -> &[f64] {
        &self.reals[row * self.d..(row + 1) * self.d]
    }

    pub(crate) fn code(&self, row: usize) -> &[u32] {
        &self.codes[row * self.c..(row + 1) * self.c]
    }

    /// Number of values that a row lacks.
    pub(crate) fn missing(&self, row: usize) -> usize {
        let reals = self.real(row).iter().filter(|v| v.is_nan()).count();
        reals + self.code(row).iter().filter(|v| **v == MISSING).count()
    }

    /// The chosen rows, in the given order.
    pub(crate) fn select(&self, chosen: &[usize]) -> Self {
        Self {
            rows: chosen.len(),
            reals: chosen.iter().flat_map(|&i| self.real(i)).copied().collect(),
            codes: chosen.iter().flat_map(|&i| self.code(i)).copied().collect(),
            d: self.d,
            c: self.c,
        }
    }
}

fn check_codes(
    name: &str,
    categories: &[String],
    codes: &[u32],
    constant: Constant,
) -> Result<(), ModelError> {
    let mut observed = codes.iter().filter(|c| **c != MISSING);
    let Some(&first) = observed.next() else {
        return Err(ModelError::AllMissing {
            column: name.to_owned(),
        });
    };
    if constant == Constant::Refuse && observed.all(|&c| c == first) {
        return Err(ModelError::Constant {
            column: name.to_owned(),
            value: categories[first as usize].clone(),
        });
    }
    Ok(())
}
