//! The numbers that the paper printed, `datasets/facade_grammar/published.csv`.

use edifice_base::{Error, Result};
use edifice_frame::Context;

/// The automatic methods of the paper's Tables 2 to 4, in their order.
pub(crate) const AUTOMATIC: [&str; 4] = ["procedural_logic", "bayesian", "symmetry", "adp"];

/// The printed numbers.
pub(crate) struct Published(Vec<[String; 7]>);

impl Published {
    /// Reads them.
    pub(crate) fn read(ctx: &mut Context) -> Result<Self> {
        let path = ctx.shipped("facade_grammar/published.csv")?;
        let mut reader = csv::Reader::from_path(&path).map_err(|e| Error::content(&path, e))?;
        let rows: std::result::Result<_, _> = reader.deserialize().collect();
        Ok(Self(rows.map_err(|e| Error::content(&path, e))?))
    }

    /// A number as printed; a dash when the paper has none.
    pub(crate) fn text(&self, key: [&str; 5]) -> String {
        self.find(key).unwrap_or("–").to_string()
    }

    /// A number of the paper.
    ///
    /// # Errors
    /// [`Error::Method`] when the paper has none of this name.
    pub(crate) fn number(&self, key: [&str; 5]) -> Result<f64> {
        let value = self.find(key).and_then(|text| text.parse().ok());
        value.ok_or_else(|| Error::method(format!("the paper prints no number for {key:?}")))
    }

    /// By artefact, method, instance, metric and statistic.
    fn find(&self, key: [&str; 5]) -> Option<&str> {
        let row = self.0.iter().find(|row| row[..5] == key)?;
        Some(&row[5])
    }
}
