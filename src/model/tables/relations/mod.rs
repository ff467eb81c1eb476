//! Exact relations between columns: copies, sums and products.
//!
//! ```text
//! y = x                        copy of a category
//! y = c + Σ a_j x_j            sum: also another unit, a duplicated number, a total
//! y = c Π x_j^(a_j)            product, all values positive: a ratio such as area / width
//! ```
//! A column y that others determine has no density of its own: a Gaussian on the plane that the rows lie in grows without bound, and draws
//! leave the plane. So y leaves the model. What is left has a density over the remaining columns; y is computed again in
//! every draw, and a row that breaks a relation is impossible. A missing cell that a relation determines is filled.
//!
//! [`find()`] finds the relations of a table, [`Relations`] applies them; the schema states them.

mod apply;
mod bound;
mod find;

use serde::{Deserialize, Serialize};

pub use apply::Relations;
pub(super) use bound::Bound;
pub use find::find;

/// Share of the size of its terms by which a relation may be off in a row: rounding of the numbers as they are stored.
pub const TOLERANCE: f64 = 1e-9;

/// The form of a relation, and the columns that determine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "form")]
pub enum Form {
    /// The same category as in column `of`.
    Copy {
        /// The column.
        of: String,
    },
    /// `constant + Σ coefficient × value`.
    Sum {
        /// In the units of the determined column.
        constant: f64,
        /// Column and coefficient.
        terms: Vec<(String, f64)>,
    },
    /// `factor × Π value^exponent`, of positive values.
    Product {
        /// Positive.
        factor: f64,
        /// Column and exponent.
        terms: Vec<(String, f64)>,
    },
}

/// A column that others determine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Relation {
    /// The determined column.
    pub column: String,
    /// The form of the relation, with the columns that determine it.
    #[serde(flatten)]
    pub form: Form,
}

impl Relation {
    /// Columns and coefficients or exponents; empty of a copy.
    pub(super) fn terms(&self) -> &[(String, f64)] {
        match &self.form {
            Form::Copy { .. } => &[],
            Form::Sum { terms, .. } | Form::Product { terms, .. } => terms,
        }
    }

    /// The determined number; `None` where a term is missing, or not positive in a product.
    pub(super) fn value(&self, x: impl Fn(&str) -> Option<f64>) -> Option<f64> {
        match &self.form {
            Form::Copy { .. } => None,
            Form::Sum { constant, terms } => {
                let mut sum = *constant;
                for (name, a) in terms {
                    sum += a * x(name)?;
                }
                Some(sum)
            }
            Form::Product { factor, terms } => {
                let mut product = *factor;
                for (name, a) in terms {
                    let x = x(name).filter(|x| *x > 0.0)?;
                    product *= match *a {
                        1.0 => x,
                        -1.0 => 1.0 / x,
                        a => x.powf(a),
                    };
                }
                Some(product)
            }
        }
    }

    /// The number of term `at` that makes the column `y`, all other terms known; `None` where there is none.
    pub(super) fn solved(&self, at: usize, y: f64, x: impl Fn(&str) -> Option<f64>) -> Option<f64> {
        let (name, a) = &self.terms()[at];
        match &self.form {
            Form::Copy { .. } => None,
            Form::Sum { .. } => {
                let others = self.value(|other| if other == name { Some(0.0) } else { x(other) });
                Some((y - others?) / a)
            }
            Form::Product { .. } => {
                let others = self.value(|other| if other == name { Some(1.0) } else { x(other) });
                let ratio = y / others?;
                (ratio > 0.0).then(|| ratio.powf(1.0 / a))
            }
        }
    }

    /// True where the known number `y` is what the terms make, up to rounding; true where a term is missing.
    fn holds(&self, y: f64, x: impl Fn(&str) -> Option<f64>) -> bool {
        let terms = self.terms().iter();
        if terms.clone().any(|(name, _)| x(name).is_none()) {
            return true;
        }
        let Some(value) = self.value(&x) else {
            return false;
        };
        let size = match &self.form {
            Form::Sum { constant, .. } => {
                let sizes = terms.map(|(name, a)| a.abs() * x(name).map_or(0.0, f64::abs));
                constant.abs() + sizes.sum::<f64>()
            }
            _ => value.abs(),
        };
        (y - value).abs() <= TOLERANCE * size.max(y.abs())
    }

    /// The relation in words.
    pub fn said(&self) -> String {
        let list = |sign: &str, terms: &[(String, f64)]| {
            let all = terms.iter().map(|(name, a)| match *a {
                1.0 => name.clone(),
                a if sign == "^" => format!("{name}^{a}"),
                a => format!("{a} {name}"),
            });
            all.collect::<Vec<_>>()
        };
        let right = match &self.form {
            Form::Copy { of } => of.clone(),
            Form::Sum { constant, terms } => {
                let mut parts = list("*", terms);
                if *constant != 0.0 {
                    parts.push(constant.to_string());
                }
                parts.join(" + ")
            }
            Form::Product { factor, terms } => {
                let mut parts = list("^", terms);
                if *factor != 1.0 {
                    parts.insert(0, factor.to_string());
                }
                parts.join(" * ")
            }
        };
        format!("{} = {right}", self.column)
    }
}
