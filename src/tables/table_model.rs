//! A learned hierarchical model of any table, with the schema by which it reads tables: `*.table-model.json`.

use serde::{Deserialize, Serialize};

use super::schema::Schema;
use crate::model::ModelError;
use crate::model::hierarchy::Hierarchy;

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/table_model";
/// The only version.
pub const VERSION: u64 = 1;

/// A model and how to read tables for it.
#[derive(Debug, Clone)]
pub struct TableModel {
    /// How tables are read.
    pub schema: Schema,
    /// The model.
    pub model: Hierarchy,
}

#[derive(Serialize, Deserialize)]
struct Stored {
    format: String,
    version: u64,
    schema: Schema,
    model: serde_json::Value,
}

impl TableModel {
    /// The text of the file.
    ///
    /// # Errors
    /// As [`Hierarchy::to_json`].
    pub fn to_json(&self) -> Result<String, ModelError> {
        let text = self.model.to_json()?;
        let model = serde_json::from_str(&text).map_err(|e| corrupt("model", &e))?;
        let stored = Stored {
            format: FORMAT.into(),
            version: VERSION,
            schema: self.schema.clone(),
            model,
        };
        serde_json::to_string_pretty(&stored).map_err(|e| corrupt("the file", &e))
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] with the place.
    pub fn from_json(text: &str) -> Result<Self, ModelError> {
        let stored: Stored = serde_json::from_str(text).map_err(|e| corrupt("the file", &e))?;
        if stored.format != FORMAT {
            return Err(corrupt("format", &format!("expected {FORMAT:?}")));
        }
        if stored.version != VERSION {
            return Err(corrupt("version", &format!("expected {VERSION}")));
        }
        Ok(Self {
            schema: stored.schema,
            model: Hierarchy::from_json(&stored.model.to_string())?,
        })
    }
}

fn corrupt(place: &str, problem: &dyn std::fmt::Display) -> ModelError {
    ModelError::corrupt(place, problem.to_string())
}
