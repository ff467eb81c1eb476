//! The houses that donate: boxes, roofs, windows.

use rayon::prelude::*;

use crate::attributes::{AttributeError, AttributeRow, COLUMNS, attributes};
use edifice_shape::Building;

/// Houses with their attributes.
#[derive(Debug, Clone)]
pub struct Database {
    /// The houses of the database.
    pub buildings: Vec<Building>,
    /// The 49 attributes of each house.
    pub rows: Vec<AttributeRow>,
    /// Standard deviation of each column; 1 where it does not vary.
    pub deviations: [f64; 49],
}

/// Why houses cannot serve as a database.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DatabaseError {
    /// The database has no houses.
    #[error("the database has no houses")]
    Empty,
    /// One of them has no attributes.
    #[error(transparent)]
    Attributes(#[from] AttributeError),
}

impl Database {
    /// Measures the houses.
    ///
    /// # Errors
    /// [`DatabaseError`] without houses, or for one with more than three floors.
    pub fn new(buildings: Vec<Building>) -> Result<Self, DatabaseError> {
        if buildings.is_empty() {
            return Err(DatabaseError::Empty);
        }
        let rows: Vec<_> = buildings.par_iter().map(attributes).collect();
        let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
        let deviations = std::array::from_fn(|c| deviation(&rows, c));
        debug_assert_eq!(COLUMNS.len(), 49);
        Ok(Self {
            buildings,
            rows,
            deviations,
        })
    }
}

/// Standard deviation of the known values of a column (divided by n); 1 where it does not vary.
fn deviation(rows: &[AttributeRow], column: usize) -> f64 {
    let known: Vec<f64> = rows.iter().filter_map(|row| row[column]).collect();
    let n = known.len().max(1) as f64;
    let mean = known.iter().sum::<f64>() / n;
    let deviation = (known.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt();
    if deviation > 1e-9 { deviation } else { 1.0 }
}
