//! A learned model with its attributes, as JSON text: `*.houses.json`.

use serde::{Deserialize, Serialize};

use edifice_model::ModelError;
use edifice_model::hierarchy::{Group, Hierarchy};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/building_model";
/// The only version.
pub const VERSION: u64 = 1;

/// A model and the attributes it was learned from.
#[derive(Debug, Clone)]
pub struct ModelFile {
    /// The attributes, in the order of the data.
    pub groups: Vec<Group>,
    /// The model.
    pub model: Hierarchy,
}

#[derive(Serialize, Deserialize)]
struct Stored {
    format: String,
    version: u64,
    groups: Vec<StoredGroup>,
    model: serde_json::Value,
}

#[derive(Serialize, Deserialize)]
struct StoredGroup {
    name: String,
    columns: Vec<String>,
}

impl ModelFile {
    /// Names of the attributes of categorical columns.
    pub fn discrete(&self) -> Vec<String> {
        let real = self.model.real_groups();
        let names = self.groups.iter().map(|g| g.name.clone());
        names.filter(|name| !real.contains(name)).collect()
    }

    /// The text of the file.
    ///
    /// # Errors
    /// As [`Hierarchy::to_json`].
    pub fn to_json(&self) -> Result<String, ModelError> {
        let groups = self.groups.iter().map(|g| StoredGroup {
            name: g.name.clone(),
            columns: g.columns.clone(),
        });
        let stored = Stored {
            format: FORMAT.into(),
            version: VERSION,
            groups: groups.collect(),
            model: serde_json::from_str(&self.model.to_json()?)
                .map_err(|e| corrupt("model", &e))?,
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
        let groups = stored.groups.into_iter().map(|g| Group {
            name: g.name,
            columns: g.columns,
        });
        Ok(Self {
            groups: groups.collect(),
            model: Hierarchy::from_json(&stored.model.to_string())?,
        })
    }
}

fn corrupt(place: &str, problem: &dyn std::fmt::Display) -> ModelError {
    ModelError::Corrupt {
        place: place.to_owned(),
        problem: problem.to_string(),
    }
}
