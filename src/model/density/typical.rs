//! A density whose values count only as far as they are less probable than what is typical.

use serde::{Deserialize, Serialize};

use super::LogDensity;

/// A density p and a level: [`LogDensity::relative`] is `min(0, log p(x) - level)`, so that all x with at
/// least the typical density are equally good.
///
/// At a sharp maximum, [`LogDensity::relative`] of the density itself punishes all values but the modal one; here only
/// values rarer than most of the data lose. Learning is n densities and a sort, O(n log n).
///
/// # Examples
/// ```
/// use edifice_model::density::{LogDensity, ScalarMixture, Typical};
/// let standard = ScalarMixture::new(vec![1.0], vec![0.0], vec![1.0])?;
/// let rows = [[-1.0], [0.0], [0.5], [1.0]];
/// // The least quarter of the log densities is that of the rows at -1 and 1.
/// let typical = Typical::new(standard, rows.iter().map(|row| (&row[..], 1.0)), 0.25);
/// assert_eq!((typical.relative(&[0.2]), typical.relative(&[-0.9])), (0.0, 0.0));
/// assert!((typical.relative(&[2.0]) + 1.5).abs() < 1e-12); // -2² / 2 + 1² / 2
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Typical<D> {
    density: D,
    level: f64,
}

impl<D: LogDensity> Typical<D> {
    /// The level is the quantile `share` of the log densities of the rows, each a list of values and a
    /// weight; at 1 it is their maximum. Without rows it is the density's maximum.
    pub fn new<'a>(
        density: D,
        rows: impl IntoIterator<Item = (&'a [f64], f64)>,
        share: f64,
    ) -> Self {
        let rows = rows.into_iter();
        let mut logs: Vec<(f64, f64)> =
            rows.map(|(row, w)| (density.log_density(row), w)).collect();
        logs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = logs.iter().map(|l| l.1).sum();
        let mut below = 0.0;
        let at = logs.iter().find(|l| {
            below += l.1;
            below > share * total
        });
        let level = at.or(logs.last()).map_or(density.log_max(), |l| l.0);
        Self { density, level }
    }

    /// True if the level is finite.
    pub fn is_whole(&self) -> bool {
        self.level.is_finite()
    }
}

impl<D: LogDensity> LogDensity for Typical<D> {
    fn dimension(&self) -> usize {
        self.density.dimension()
    }
    fn log_density(&self, x: &[f64]) -> f64 {
        self.density.log_density(x)
    }
    fn log_max(&self) -> f64 {
        self.density.log_max()
    }
    fn relative(&self, x: &[f64]) -> f64 {
        (self.density.log_density(x) - self.level).min(0.0)
    }
}
