//! A learned hierarchical model of any table, with the schema by which it reads tables: `*.table-model.json`.

use rand::Rng;
use rand_distr::Distribution;
use rand_distr::weighted::WeightedIndex;
use serde::{Deserialize, Serialize};

use super::encoding::Encoding;
use super::relations::Bound;
use super::schema::Schema;
use crate::hierarchy::Hierarchy;
use crate::{ModelError, Table};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/table_model";
/// Version of files without an encoding.
pub const VERSION: u64 = 1;
/// Version of files with one.
pub const ENCODED_VERSION: u64 = 2;
/// Version of files whose schema states relations.
pub const RELATED_VERSION: u64 = 3;
/// Candidates of a completion that a relation binds ([`Bound`]).
const CANDIDATES: usize = 64;

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
    /// The table as the model reads it, without columns that others determine.
    ///
    /// # Errors
    /// As [`Relations::reduce`](super::relations::Relations::reduce) and [`Encoding::encode`].
    pub fn encode(&self, table: &Table) -> Result<Table, ModelError> {
        self.encode_reduced(&self.schema.relations()?.reduce(table)?)
    }

    fn encode_reduced(&self, reduced: &Table) -> Result<Table, ModelError> {
        match &self.encoding {
            None => Ok(reduced.clone()),
            Some(encoding) => encoding.encode(reduced),
        }
    }

    /// `log p(row)` of every row, nats, in the columns' own units, at an atom a probability; missing values and columns that
    /// `table` lacks are integrated out. Columns that others determine have no density of their own.
    ///
    /// # Errors
    /// As [`Hierarchy::log_likelihood`] and [`Self::encode`]: a row that breaks a relation has probability zero.
    pub fn log_likelihood(&self, table: &Table) -> Result<Vec<f64>, ModelError> {
        self.log_reduced(&self.schema.relations()?.reduce(table)?)
    }

    fn log_reduced(&self, reduced: &Table) -> Result<Vec<f64>, ModelError> {
        let mut logs = self.model.log_likelihood(&self.encode_reduced(reduced)?)?;
        if let Some(encoding) = &self.encoding {
            for (log, slope) in logs.iter_mut().zip(encoding.log_slopes(reduced)) {
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

    /// A table of the columns without rows, in the order of the schema: their kinds and categories.
    ///
    /// # Errors
    /// As [`Hierarchy::columns`]; [`ModelError::Unknown`] for a column of the schema that the model lacks.
    pub fn columns(&self) -> Result<Table, ModelError> {
        self.decode(&self.model.columns()?)
    }

    /// Draws `count` rows.
    ///
    /// # Errors
    /// As [`Hierarchy::sample`].
    pub fn sample<R: Rng>(&self, count: usize, rng: &mut R) -> Result<Table, ModelError> {
        self.decode(&self.model.sample(count, rng)?.table)
    }

    /// Completes every row of `given` `count` times; numbers that are given stay, to the bit. A known column that others determine binds them: those that are
    /// missing are drawn so that the relation holds exactly, by importance from 64 candidates a draw where several are.
    ///
    /// # Errors
    /// As [`Hierarchy::complete`] and [`Self::encode`]; [`ModelError::Parameter`] for relations that share all their
    /// missing columns.
    pub fn complete<R: Rng>(
        &self,
        given: &Table,
        count: usize,
        rng: &mut R,
    ) -> Result<Table, ModelError> {
        let relations = self.schema.relations()?;
        let reduced = relations.reduce(given)?;
        let rows = 0..given.rows();
        let bound = rows.map(|row| relations.bound(given, &reduced, row));
        let bound = bound.collect::<Result<Vec<_>, ModelError>>()?;
        if bound.iter().all(Vec::is_empty) {
            let draws = (self.model).complete(&self.encode_reduced(&reduced)?, count, rng)?;
            return Ok(self.decode(&draws.table)?.overlaid(given, count));
        }
        let mut all: Option<Table> = None;
        for (row, bound) in bound.iter().enumerate() {
            let draws = self.complete_bound(&reduced.select(&[row]), bound, count, rng);
            let draws = self.restored(draws.map_err(|e| e.in_row(row))?)?;
            let draws = draws.overlaid(&given.select(&[row]), count);
            match &mut all {
                Some(all) => all.append(&draws),
                None => all = Some(draws),
            }
        }
        all.ok_or(ModelError::Empty { what: "rows" })
    }

    /// Draws of one reduced row that keep the bound relations.
    fn complete_bound<R: Rng>(
        &self,
        row: &Table,
        bound: &[Bound],
        count: usize,
        rng: &mut R,
    ) -> Result<Table, ModelError> {
        let encoded = self.encode_reduced(row)?;
        let drawn = self
            .model
            .complete(&encoded, count * CANDIDATES, rng)?
            .table;
        let drawn = self.decode_numbers(&drawn)?;
        let mut logs = vec![0.0; drawn.rows()];
        let mut known = Table::new();
        for one in bound {
            let solved = one.solved(&drawn)?;
            for (log, cell) in logs.iter_mut().zip(&solved) {
                *log += cell.map_or(f64::NEG_INFINITY, |(_, slope)| slope);
            }
            known = known.real(one.pivot(), solved.iter().map(|cell| cell.map(|(x, _)| x)))?;
        }
        let solved = drawn.overlaid(&known, 1);
        let names = solved.columns().iter().map(|c| c.name());
        let pivots: Vec<&str> = bound.iter().map(Bound::pivot).collect();
        let others: Vec<&str> = names.filter(|name| !pivots.contains(name)).collect();
        let whole = self.log_reduced(&solved)?;
        let rest = self.log_reduced(&solved.only(&others)?)?;
        for (log, (whole, rest)) in logs.iter_mut().zip(whole.iter().zip(&rest)) {
            *log += whole - rest;
        }
        let mut chosen = Vec::with_capacity(count);
        for (draw, logs) in logs.chunks(CANDIDATES).enumerate() {
            let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let weights = logs.iter().map(|log| (log - most).exp());
            let weighted = WeightedIndex::new(weights).map_err(|_| ModelError::Contradiction {
                row: None,
                variable: pivots.join(", "),
            })?;
            chosen.push(draw * CANDIDATES + weighted.sample(rng));
        }
        Ok(solved.select(&chosen))
    }

    /// The columns in the order of the schema.
    fn decode(&self, encoded: &Table) -> Result<Table, ModelError> {
        self.restored(self.decode_numbers(encoded)?)
    }

    /// The columns of encoded rows but for those that others determine.
    fn decode_numbers(&self, encoded: &Table) -> Result<Table, ModelError> {
        match &self.encoding {
            None => Ok(encoded.clone()),
            Some(encoding) => encoding.decode(encoded),
        }
    }

    /// All columns, in the order of the schema.
    fn restored(&self, reduced: Table) -> Result<Table, ModelError> {
        let groups = self.schema.groups.iter();
        let columns: Vec<&str> = groups
            .flat_map(|g| g.columns.iter().map(String::as_str))
            .collect();
        self.schema
            .relations()?
            .restore(reduced)?
            .in_order(&columns)
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
            version: version(&self.schema, self.encoding.as_ref()),
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
        let expected = version(&stored.schema, stored.encoding.as_ref());
        if stored.version != expected {
            return Err(corrupt("version", &format!("expected {expected}")));
        }
        if let Some(encoding) = &stored.encoding {
            encoding.check()?;
        }
        stored.schema.relations()?;
        Ok(Self {
            schema: stored.schema,
            encoding: stored.encoding,
            model: Hierarchy::from_json(&stored.model.to_string())?,
        })
    }
}

fn version(schema: &Schema, encoding: Option<&Encoding>) -> u64 {
    match (&schema.relations, encoding) {
        (Some(_), _) => RELATED_VERSION,
        (None, Some(_)) => ENCODED_VERSION,
        (None, None) => VERSION,
    }
}

fn corrupt(place: &str, problem: &dyn std::fmt::Display) -> ModelError {
    ModelError::corrupt(place, problem.to_string())
}
