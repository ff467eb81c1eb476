//! Databases, tables and models of houses.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::{AttributeRow, attributes};
use edifice_building_exteriors::coding::{Observation, coded};
use edifice_building_exteriors::data::{dataset, known};
use edifice_building_exteriors::model_file::ModelFile;
use edifice_building_exteriors::observations::{observations, only, tells_of_houses};
use edifice_editing::building_exteriors::{MADE, made_model};
use edifice_io::{building_csv, building_json, json, read_bytes};
use edifice_model::tables::Dataset;
use edifice_model::tables::schema::{FORMAT, Schema, VERSION};

/// The source of houses.
#[derive(clap::Args)]
pub(super) struct Input {
    /// Database (`*.buildings.jsonl`), one building (`*.building.json`), or CSV (`*.csv`); each also as `.gz`. A CSV
    /// whose columns are attributes, as `building attributes` prints them, needs no schema; empty cells are missing.
    pub input: PathBuf,
    /// Which columns of a CSV are which attributes (`*.schema.json`).
    #[arg(long)]
    pub schema: Option<PathBuf>,
    /// Attributes to read, for example `bbox,bcr,arf,roof`; all others are taken for missing. All by default.
    #[arg(long, value_delimiter = ',')]
    pub groups: Vec<String>,
}

impl Input {
    /// True of a CSV, whose cells may hold any number.
    pub(super) fn is_table(&self) -> bool {
        let name = self.input.to_string_lossy();
        name.ends_with(".csv") || name.ends_with(".csv.gz")
    }

    /// The houses with all attributes of the paper, or with those of the schema.
    pub(super) fn read(&self) -> Result<Dataset> {
        match &self.schema {
            Some(schema) => self.by_schema(schema),
            None => {
                let houses = self.observed()?;
                let rows: Vec<AttributeRow> = houses.into_iter().map(|h| h.row).collect();
                dataset(&rows).map_err(|e| Error::content(&self.input, e))
            }
        }
    }

    /// The same without columns of which nothing is known. A schema names the columns that are wanted: of one that has
    /// no value the learner complains by its name.
    pub(super) fn known(&self) -> Result<Dataset> {
        if self.schema.is_some() {
            return self.read();
        }
        known(self.read()?).map_err(|e| Error::content(&self.input, e))
    }

    /// The houses as a coded model reads them; those read by a schema are as they are.
    pub(super) fn coded(&self) -> Result<Dataset> {
        match &self.schema {
            Some(schema) => self.by_schema(schema),
            None => coded(&self.observed()?).map_err(|e| Error::content(&self.input, e)),
        }
    }

    fn by_schema(&self, path: &Path) -> Result<Dataset> {
        if !self.groups.is_empty() {
            let problem = "the schema says which attributes there are";
            return Err(Error::option("--groups", problem));
        }
        let bytes = read_bytes(path)?;
        json::check_header(&bytes, path, FORMAT, VERSION)?;
        let schema: Schema = json::parse_json(&bytes, path)?;
        let text = building_csv::read(&self.input)?;
        let read = schema.read(&text.header, &text.rows);
        read.map_err(|e| Error::content(&self.input, e))
    }

    /// The observation of each house: its known attributes.
    fn observed(&self) -> Result<Vec<Observation>> {
        let at = |e: String| Error::content(&self.input, e);
        let mut houses = if self.is_table() {
            let text = building_csv::read(&self.input)?;
            if !tells_of_houses(&text.header) {
                let problem = "the table has no columns of attributes, and needs a schema";
                return Err(Error::option("--schema", problem));
            }
            observations(&text.header, &text.rows).map_err(|e| at(e.to_string()))?
        } else {
            let houses = building_json::read(&self.input)?;
            let rows = houses.iter().map(|b| Ok(attributes(b)?.into()));
            let rows: std::result::Result<
                Vec<_>,
                edifice_building_exteriors::attributes::AttributeError,
            > = rows.collect();
            rows.map_err(|e| at(e.to_string()))?
        };
        if !self.groups.is_empty() {
            only(&mut houses, &self.groups)
                .map_err(|e| Error::option("--groups", e.to_string()))?;
        }
        Ok(houses)
    }
}

/// Reads a learned model; `made` is that of the made houses, which ships.
pub(super) fn model(path: &Path) -> Result<ModelFile> {
    if path.as_os_str() == MADE {
        return made_model().cloned();
    }
    let bytes = read_bytes(path)?;
    let text = String::from_utf8(bytes).map_err(|e| Error::content(path, e))?;
    ModelFile::from_json(&text).map_err(|e| Error::content(path, e))
}
