//! Tidy CSV: one observation a row.

use std::path::Path;

use edifice_base::{Error, Result};

/// One observation.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    /// Slug of the paper.
    pub experiment: String,
    /// Data set.
    pub dataset: String,
    /// Method, with its configuration.
    pub method: String,
    /// The input of the run: facade, split, rank, ...
    pub instance: String,
    /// Seed; empty for what has none (deterministic methods, means over seeds).
    pub seed: Option<u64>,
    /// The measured quantity.
    pub metric: String,
    /// The number.
    pub value: f64,
    /// Its unit; empty for pure numbers.
    pub unit: String,
}

/// An observation that is not a number.
#[derive(Debug, thiserror::Error)]
#[error("{dataset}, {method}, {instance}: {metric} is {value}")]
struct NotFinite {
    dataset: String,
    method: String,
    instance: String,
    metric: String,
    value: f64,
}

/// The rows as CSV with a header.
///
/// # Errors
/// [`Error::Method`] when a value is not finite.
pub fn csv_bytes(rows: &[Row]) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header = "experiment,dataset,method,instance,seed,metric,value,unit".split(',');
    writer.write_record(header).map_err(Error::method)?;
    for row in rows {
        if !row.value.is_finite() {
            return Err(Error::method(NotFinite {
                dataset: row.dataset.clone(),
                method: row.method.clone(),
                instance: row.instance.clone(),
                metric: row.metric.clone(),
                value: row.value,
            }));
        }
        let seed = row.seed.map_or_else(String::new, |seed| seed.to_string());
        // Sums of tenths carry rounding dust; nothing here is measured to more than nine digits.
        let value = format!("{}", (row.value * 1e9).round() / 1e9);
        writer
            .write_record([
                &row.experiment,
                &row.dataset,
                &row.method,
                &row.instance,
                &seed,
                &row.metric,
                &value,
                &row.unit,
            ])
            .map_err(Error::method)?;
    }
    writer.into_inner().map_err(Error::method)
}

/// Writes the rows to a CSV file.
///
/// # Errors
/// As [`csv_bytes`], and [`Error::Io`] when the file cannot be written.
pub fn write_rows(path: &Path, rows: &[Row]) -> Result<()> {
    edifice_base::file::write_atomic(path, &csv_bytes(rows)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_names_and_rejects_nan() {
        let mut row = Row {
            experiment: "p".into(),
            instance: "a, b".into(),
            seed: Some(3),
            metric: "cost".into(),
            value: 0.1 + 0.2,
            ..Row::default()
        };
        let text = String::from_utf8(csv_bytes(std::slice::from_ref(&row)).unwrap()).unwrap();
        assert_eq!(text.lines().nth(1).unwrap(), "p,,,\"a, b\",3,cost,0.3,");
        row.value = f64::NAN;
        assert!(
            csv_bytes(&[row])
                .unwrap_err()
                .to_string()
                .contains("cost is NaN")
        );
    }
}
