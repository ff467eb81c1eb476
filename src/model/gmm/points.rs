//! Weighted points, checked at the door.

use super::super::error::ModelError;

/// Rows of d values, with weights.
///
/// N x d values, row-major, borrowed and checked once, O(N d). A weight w counts a row w times, and need not be whole. NaN
/// is a missing value in [`Points::with_missing`] and an error in [`Points::new`].
///
/// # Examples
/// ```
/// use edifice_model::ModelError;
/// use edifice_model::gmm::Points;
/// let values = [1.0, 2.0, 3.0, f64::NAN, 5.0, 6.0];
/// let points = Points::with_missing(2, &values)?.weighted(&[1.0, 2.0, 0.5])?;
/// assert_eq!((points.len(), points.dimension(), points.total()), (3, 2, 3.5));
/// assert_eq!(points.observed(), 2.0 + 2.0 + 1.0);
/// assert!(matches!(Points::new(2, &values), Err(ModelError::NotFinite { row: 1, .. })));
/// # Ok::<(), ModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Points<'a> {
    d: usize,
    values: &'a [f64],
    weights: Option<&'a [f64]>,
    /// True if any value is missing.
    incomplete: bool,
}

impl<'a> Points<'a> {
    /// Rows of `d` values, one after the other.
    ///
    /// # Errors
    /// [`ModelError::Empty`], [`ModelError::Rows`] for a broken last row, [`ModelError::NotFinite`].
    pub fn new(d: usize, values: &'a [f64]) -> Result<Self, ModelError> {
        Self::checked(d, values, f64::is_finite)
    }

    /// Rows of `d` values, one after the other; NaN is a missing value.
    ///
    /// # Errors
    /// As [`Points::new`].
    pub fn with_missing(d: usize, values: &'a [f64]) -> Result<Self, ModelError> {
        let points = Self::checked(d, values, |v| v.is_finite() || v.is_nan())?;
        Ok(Self {
            incomplete: values.iter().any(|v| v.is_nan()),
            ..points
        })
    }

    fn checked(
        d: usize,
        values: &'a [f64],
        allowed: impl Fn(f64) -> bool,
    ) -> Result<Self, ModelError> {
        if d == 0 || values.is_empty() {
            return Err(ModelError::Empty { what: "points" });
        }
        if !values.len().is_multiple_of(d) {
            return Err(ModelError::Rows {
                column: (values.len() % d).to_string(),
                got: values.len() / d,
                expected: values.len() / d + 1,
            });
        }
        if let Some(i) = values.iter().position(|v| !allowed(*v)) {
            return Err(ModelError::NotFinite {
                column: (i % d).to_string(),
                row: i / d,
                value: values[i],
            });
        }
        Ok(Self {
            d,
            values,
            weights: None,
            incomplete: false,
        })
    }

    /// The same rows, row i counted `weights[i]` times.
    ///
    /// # Errors
    /// [`ModelError::Rows`], [`ModelError::Parameter`] for a weight that is negative or not
    /// finite, or when all are zero.
    pub fn weighted(self, weights: &'a [f64]) -> Result<Self, ModelError> {
        if weights.len() != self.len() {
            return Err(ModelError::Rows {
                column: "weights".to_owned(),
                got: weights.len(),
                expected: self.len(),
            });
        }
        if let Some(i) = weights.iter().position(|w| !(w.is_finite() && *w >= 0.0)) {
            let problem = format!("row {}: {} is no weight", i + 1, weights[i]);
            return Err(ModelError::parameter("weights", problem));
        }
        if weights.iter().sum::<f64>() <= 0.0 {
            return Err(ModelError::parameter("weights", "all are zero"));
        }
        Ok(Self {
            weights: Some(weights),
            ..self
        })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.values.len() / self.d
    }

    /// Always false: points are checked when they are made.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// d.
    pub fn dimension(&self) -> usize {
        self.d
    }

    /// The rows in order.
    pub fn rows(&self) -> impl Iterator<Item = &'a [f64]> {
        self.values.chunks(self.d)
    }

    pub(crate) fn row(&self, i: usize) -> &'a [f64] {
        &self.values[i * self.d..(i + 1) * self.d]
    }

    pub(crate) fn weight(&self, i: usize) -> f64 {
        self.weights.map_or(1.0, |w| w[i])
    }

    /// True if row `i` lacks a value.
    pub(crate) fn lacks(&self, i: usize) -> bool {
        self.incomplete && self.row(i).iter().any(|v| v.is_nan())
    }

    /// Number of values that are not missing, weighted.
    pub fn observed(&self) -> f64 {
        if !self.incomplete {
            return self.total() * self.d as f64;
        }
        let seen = |i: usize| self.row(i).iter().filter(|v| !v.is_nan()).count() as f64;
        (0..self.len()).map(|i| self.weight(i) * seen(i)).sum()
    }

    /// Sum of weights.
    pub fn total(&self) -> f64 {
        self.weights.map_or(self.len() as f64, |w| w.iter().sum())
    }
}
