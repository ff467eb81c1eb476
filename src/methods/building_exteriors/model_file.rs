//! A learned model with its attributes, as JSON text: `*.houses.json`.

use rand::Rng;
use serde::{Deserialize, Serialize};

use super::attributes::{AttributeRow, GROUPS};
use super::coding::{Coding, attribute_rows, coded_evidence, settled};
use super::data;
use edifice_model::hierarchy::{Draws, Group, Hierarchy};
use edifice_model::{ModelError, Table};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/building_model";
/// Version of the paper's model, whose attributes are variables as they are.
pub const VERSION: u64 = 1;
/// Version of a model whose rows are coded ([`super::coding`]).
pub const CODED_VERSION: u64 = 2;

/// A model and the attributes it was learned from.
#[derive(Debug, Clone)]
pub struct ModelFile {
    /// The variables, in the order of the data.
    pub groups: Vec<Group>,
    /// The coding of attributes as variables.
    pub coding: Coding,
    /// The model.
    pub model: Hierarchy,
}

#[derive(Serialize, Deserialize)]
struct Stored {
    format: String,
    version: u64,
    #[serde(default, skip_serializing_if = "is_published")]
    coding: Coding,
    groups: Vec<StoredGroup>,
    model: serde_json::Value,
}

fn is_published(coding: &Coding) -> bool {
    *coding == Coding::Published
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

    /// The attributes that evidence may name: of a coded model those of the paper of which it has a column.
    pub fn attributes(&self) -> Vec<Group> {
        match self.coding {
            Coding::Published => self.groups.clone(),
            Coding::Presence => {
                let known = GROUPS.iter().filter(|g| {
                    let own = |c: &str| g.columns().contains(&c);
                    let derived = match g.name {
                        "far" => self.has("bcr"),
                        "bdry" => self.has("plan"),
                        "arf" => self.has("floors"),
                        _ => false,
                    };
                    derived || self.groups.iter().flat_map(|g| &g.columns).any(|c| own(c))
                });
                known.map(|g| Group::new(g.name, g.columns())).collect()
            }
        }
    }

    /// A table of the columns of [`Self::attributes`] without rows: their kinds.
    ///
    /// # Errors
    /// As [`Hierarchy::columns`].
    pub fn columns(&self) -> Result<Table, ModelError> {
        match self.coding {
            Coding::Published => self.model.columns(),
            Coding::Presence => {
                let attributes = self.attributes();
                let names = attributes.iter().flat_map(|g| &g.columns);
                data::table(&[])?.in_order(&names.map(String::as_str).collect::<Vec<_>>())
            }
        }
    }

    fn has(&self, column: &str) -> bool {
        self.groups
            .iter()
            .flat_map(|g| &g.columns)
            .any(|c| c == column)
    }

    /// Number of styles.
    pub fn styles(&self) -> usize {
        self.model.styles()
    }

    /// Draws houses; see [`Hierarchy::sample`]. Tables of a coded model have attributes in their columns, those that
    /// it knows or that follow.
    ///
    /// # Errors
    /// As [`Hierarchy::sample`].
    pub fn sample<R: Rng>(&self, count: usize, rng: &mut R) -> Result<Draws, ModelError> {
        self.decoded(self.model.sample(count, rng)?, &[])
    }

    /// Draws houses of one style; see [`Hierarchy::sample_style`].
    ///
    /// # Errors
    /// As [`Hierarchy::sample_style`].
    pub fn sample_style<R: Rng>(
        &self,
        style: usize,
        count: usize,
        rng: &mut R,
    ) -> Result<Draws, ModelError> {
        self.decoded(self.model.sample_style(style, count, rng)?, &[])
    }

    /// Completes every row of `given`; see [`Hierarchy::complete`].
    ///
    /// # Errors
    /// As [`Hierarchy::complete`].
    pub fn complete<R: Rng>(
        &self,
        given: &Table,
        count: usize,
        rng: &mut R,
    ) -> Result<Draws, ModelError> {
        let (evidence, rows) = self.evidence(given)?;
        let draws = self.model.complete(&evidence, count, rng)?;
        let rows = rows
            .iter()
            .flat_map(|row| std::iter::repeat_n(row.clone(), count));
        self.decoded(draws, &rows.collect::<Vec<_>>())
    }

    /// The rows with what is missing drawn given the rest; columns that the model does not know stay missing.
    ///
    /// # Errors
    /// As [`Self::complete`].
    pub fn filled<R: Rng>(
        &self,
        mut rows: Vec<AttributeRow>,
        rng: &mut R,
    ) -> Result<Vec<AttributeRow>, ModelError> {
        let holes = |row: &AttributeRow| row.iter().any(Option::is_none);
        for row in rows.iter_mut().filter(|row| holes(row)) {
            let drawn = match row.iter().all(Option::is_none) {
                true => self.sample(1, rng)?,
                false => self.complete(&data::table(std::slice::from_ref(row))?, 1, rng)?,
            };
            for own in attribute_rows(&drawn.table) {
                for (value, drawn) in row.iter_mut().zip(own) {
                    *value = value.or(drawn);
                }
            }
        }
        Ok(rows)
    }

    /// The most probable completions of one row that differ; see [`Hierarchy::most_probable`].
    ///
    /// # Errors
    /// As [`Hierarchy::most_probable`].
    pub fn most_probable<R: Rng>(
        &self,
        given: &Table,
        count: usize,
        pool: usize,
        apart: f64,
        rng: &mut R,
    ) -> Result<Draws, ModelError> {
        let (evidence, rows) = self.evidence(given)?;
        let draws = (self.model).most_probable(&evidence, count, pool, apart, None, rng)?;
        self.decoded(draws, &rows)
    }

    /// Evidence as the model reads it, and its rows of attributes.
    fn evidence(&self, given: &Table) -> Result<(Table, Vec<AttributeRow>), ModelError> {
        if self.coding == Coding::Published || given.columns().is_empty() {
            return Ok((given.clone(), Vec::new()));
        }
        let rows = attribute_rows(given);
        let columns: Vec<String> = self.groups.iter().flat_map(|g| g.columns.clone()).collect();
        Ok((coded_evidence(&rows, &columns)?, rows))
    }

    fn decoded(&self, draws: Draws, given: &[AttributeRow]) -> Result<Draws, ModelError> {
        match self.coding {
            Coding::Published => Ok(draws),
            Coding::Presence => Ok(Draws {
                table: settled(&draws.table, given)?,
                ..draws
            }),
        }
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
            version: match self.coding {
                Coding::Published => VERSION,
                Coding::Presence => CODED_VERSION,
            },
            coding: self.coding,
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
        let expected = match stored.coding {
            Coding::Published => VERSION,
            Coding::Presence => CODED_VERSION,
        };
        if stored.version != expected {
            return Err(corrupt("version", &format!("expected {expected}")));
        }
        let groups = stored.groups.into_iter().map(|g| Group {
            name: g.name,
            columns: g.columns,
        });
        Ok(Self {
            coding: stored.coding,
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
