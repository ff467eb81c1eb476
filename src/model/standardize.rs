//! Location and scale of columns, for models that work on mean 0 and deviation 1.

use super::error::ModelError;

/// The treatment of a column whose observed values are all equal.
///
/// Such a column has deviation 0, so that it cannot be brought to deviation 1: `(x - mean) / deviation` is not defined.
/// It arises in [`hierarchy::Settings::constant`](super::hierarchy::Settings::constant).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Constant {
    /// [`ModelError::Constant`].
    #[default]
    Refuse,
    /// Keep it, with unit scale: for training sets of very few rows.
    Keep,
}

/// Mean and standard deviation of the observed values; NaN is a missing value.
pub(crate) fn moments(
    name: &str,
    values: &[f64],
    constant: Constant,
) -> Result<(f64, f64), ModelError> {
    let observed = || values.iter().copied().filter(|v| !v.is_nan());
    let n = observed().count() as f64;
    if n == 0.0 {
        return Err(ModelError::AllMissing {
            column: name.to_owned(),
        });
    }
    let mean = observed().map(|v| v / n).sum::<f64>();
    let spread = observed().map(|v| (v - mean).abs()).fold(0.0, f64::max);
    let variance = observed()
        .map(|v| ((v - mean) / spread).powi(2) / n)
        .sum::<f64>();
    // Rounding in the mean of a constant column leaves a spread of a few units in the last place.
    if spread <= 1e-12 * mean.abs() || spread < f64::MIN_POSITIVE {
        return match constant {
            Constant::Refuse => Err(ModelError::Constant {
                column: name.to_owned(),
                value: observed().next().unwrap_or(mean).to_string(),
            }),
            Constant::Keep => Ok((mean, 1.0)),
        };
    }
    Ok((mean, spread * variance.sqrt()))
}
