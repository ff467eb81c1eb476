//! A learned hierarchical model of any table, with the schema by which it reads tables: `*.table-model.json`.

use rand::Rng;
use serde::{Deserialize, Serialize};

use super::encoding::Encoding;
use super::schema::Schema;
use crate::hierarchy::Hierarchy;
use crate::{ModelError, Table};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/table_model";
/// Version of files without an encoding.
pub const VERSION: u64 = 1;
/// Version of files with one.
pub const ENCODED_VERSION: u64 = 2;

/// A model and how to read tables for it.
#[derive(Debug, Clone)]
pub struct TableModel {
    /// The schema by which tables are read.
    pub schema: Schema,
    /// The form in which their real columns enter the model; `None` if they enter as they are.
    pub encoding: Option<Encoding>,
    /// The model, of encoded tables.
    pub model: Hierarchy,
}

/// Result of [`TableModel::log_parts`], row by row, nats.
#[derive(Debug, Clone, PartialEq)]
pub struct LogParts {
    /// `log P(c)`, of categories and atoms.
    pub log_probability_mass: Vec<f64>,
    /// `log p(x | c)`, of all other numbers, in the columns' own units.
    pub log_density: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
struct Stored {
    format: String,
    version: u64,
    schema: Schema,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    encoding: Option<Encoding>,
    model: serde_json::Value,
}

impl TableModel {
    /// The table as the model reads it.
    ///
    /// # Errors
    /// As [`Encoding::encode`].
    pub fn encode(&self, table: &Table) -> Result<Table, ModelError> {
        match &self.encoding {
            None => Ok(table.clone()),
            Some(encoding) => encoding.encode(table),
        }
    }

    /// `log p(row)` of every row, nats, in the columns' own units, at an atom a probability; missing values and columns that
    /// `table` lacks are integrated out.
    ///
    /// # Errors
    /// As [`Hierarchy::log_likelihood`] and [`Encoding::encode`].
    pub fn log_likelihood(&self, table: &Table) -> Result<Vec<f64>, ModelError> {
        let mut logs = self.model.log_likelihood(&self.encode(table)?)?;
        if let Some(encoding) = &self.encoding {
            for (log, slope) in logs.iter_mut().zip(encoding.log_slopes(table)) {
                *log += slope;
            }
        }
        Ok(logs)
    }

    /// The two parts of [`Self::log_likelihood`] of every row, nats, which add up to it.
    ///
    /// With c a row's categories and atoms, and x its other numbers, `log p(row) = log P(c) + log p(x | c)`: a probability mass, and a
    /// density, which changes with the columns' units. A row without numbers besides atoms has a log density of 0, a table
    /// without categories and atoms a log probability mass of 0; only numbers of one kind are to be compared.
    ///
    /// # Errors
    /// As [`Self::log_likelihood`].
    pub fn log_parts(&self, table: &Table) -> Result<LogParts, ModelError> {
        let encoded = self.encode(table)?;
        let discrete = encoded.columns().iter();
        let discrete: Vec<&str> = (discrete.filter(|c| c.categories().is_some()))
            .map(|c| c.name())
            .collect();
        let log_probability_mass = match discrete.is_empty() {
            true => vec![0.0; table.rows()],
            false => self.model.log_likelihood(&encoded.only(&discrete)?)?,
        };
        let all = self.log_likelihood(table)?;
        let rest = all.iter().zip(&log_probability_mass);
        Ok(LogParts {
            log_density: rest.map(|(all, mass)| all - mass).collect(),
            log_probability_mass,
        })
    }

    /// Draws `count` rows.
    ///
    /// # Errors
    /// As [`Hierarchy::sample`].
    pub fn sample<R: Rng>(&self, count: usize, rng: &mut R) -> Result<Table, ModelError> {
        self.decode(&self.model.sample(count, rng)?.table)
    }

    /// Completes every row of `given` `count` times.
    ///
    /// # Errors
    /// As [`Hierarchy::complete`] and [`Encoding::encode`].
    pub fn complete<R: Rng>(
        &self,
        given: &Table,
        count: usize,
        rng: &mut R,
    ) -> Result<Table, ModelError> {
        let draws = self.model.complete(&self.encode(given)?, count, rng)?;
        self.decode(&draws.table)
    }

    /// The columns in the order of the schema.
    fn decode(&self, encoded: &Table) -> Result<Table, ModelError> {
        let groups = self.schema.groups.iter();
        let columns: Vec<&str> = groups
            .flat_map(|g| g.columns.iter().map(String::as_str))
            .collect();
        match &self.encoding {
            None => encoded.in_order(&columns),
            Some(encoding) => encoding.decode(encoded)?.in_order(&columns),
        }
    }

    /// The text of the file.
    ///
    /// # Errors
    /// As [`Hierarchy::to_json`].
    pub fn to_json(&self) -> Result<String, ModelError> {
        let text = self.model.to_json()?;
        let model = serde_json::from_str(&text).map_err(|e| corrupt("model", &e))?;
        let stored = Stored {
            format: FORMAT.into(),
            version: match self.encoding {
                None => VERSION,
                Some(_) => ENCODED_VERSION,
            },
            schema: self.schema.clone(),
            encoding: self.encoding.clone(),
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
        let expected = match stored.encoding {
            None => VERSION,
            Some(_) => ENCODED_VERSION,
        };
        if stored.version != expected {
            return Err(corrupt("version", &format!("expected {expected}")));
        }
        if let Some(encoding) = &stored.encoding {
            encoding.check()?;
        }
        Ok(Self {
            schema: stored.schema,
            encoding: stored.encoding,
            model: Hierarchy::from_json(&stored.model.to_string())?,
        })
    }
}

fn corrupt(place: &str, problem: &dyn std::fmt::Display) -> ModelError {
    ModelError::corrupt(place, problem.to_string())
}
