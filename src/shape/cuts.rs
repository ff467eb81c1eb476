//! Sorted cut coordinates along one axis, with nearly equal values taken as one.

/// Distinct coordinates along one axis, increasing; values within a tolerance are one cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Cuts {
    /// The lowest value of each cut.
    values: Vec<f64>,
}

impl Cuts {
    /// Collects `values` (finite). A value at most `tolerance` above a cut's lowest value belongs
    /// to that cut.
    pub fn new(values: impl IntoIterator<Item = f64>, tolerance: f64) -> Self {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_unstable_by(f64::total_cmp);
        let mut last = f64::NEG_INFINITY;
        values.retain(|&value| {
            let new = value - last > tolerance;
            if new {
                last = value;
            }
            new
        });
        Self { values }
    }

    /// The coordinates, increasing.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Index of the cut that `value` belongs to: the last one not above it.
    pub fn index(&self, value: f64) -> usize {
        self.values.partition_point(|&cut| cut <= value).max(1) - 1
    }
}
