//! The numbers that the paper printed, `datasets/structure_completion/published.csv`.

use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_io::read_bytes;

/// The printed numbers.
pub(crate) struct Published(Vec<Record>);

#[derive(serde::Deserialize)]
struct Record {
    artefact: String,
    method: String,
    instance: String,
    metric: String,
    value: f64,
}

impl Published {
    /// Reads the file that ships.
    pub(crate) fn read(ctx: &mut Context) -> Result<Self> {
        let path = ctx.shipped("structure_completion/published.csv")?;
        let bytes = read_bytes(&path)?;
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        let records: std::result::Result<Vec<Record>, _> = reader.deserialize().collect();
        Ok(Self(records.map_err(|e| Error::content(&path, e))?))
    }

    /// A value of the paper's own method or of no method.
    pub(crate) fn value(&self, artefact: &str, instance: &str, metric: &str) -> Option<f64> {
        let same = |r: &&Record| {
            r.artefact == artefact
                && r.instance == instance
                && r.metric == metric
                && (r.method == "ours" || r.method.is_empty())
        };
        self.0.iter().find(same).map(|r| r.value)
    }

    /// The value as text with its unit, or a dash where none is printed.
    pub(crate) fn text(&self, artefact: &str, instance: &str, metric: &str) -> String {
        let unit = if metric == "seconds" { " s" } else { "" };
        match self.value(artefact, instance, metric) {
            Some(value) => format!("{value}{unit}"),
            None => "–".into(),
        }
    }
}
