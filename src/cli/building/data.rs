//! Databases, tables and models of houses.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::attributes;
use edifice_building_exteriors::data::dataset;
use edifice_building_exteriors::model_file::ModelFile;
use edifice_io::{building_csv, building_json, json, read_bytes};
use edifice_model::tables::Dataset;
use edifice_model::tables::schema::{FORMAT, Schema, VERSION};

/// The source of houses.
#[derive(clap::Args)]
pub struct Input {
    /// Database (`*.buildings.jsonl`), one building (`*.building.json`), or CSV (`*.csv`); each also as `.gz`.
    pub input: PathBuf,
    /// Which columns of a CSV are which attributes (`*.schema.json`).
    #[arg(long)]
    pub schema: Option<PathBuf>,
}

impl Input {
    /// Reads the houses.
    pub fn read(&self) -> Result<Dataset> {
        let name = self.input.to_string_lossy();
        if !(name.ends_with(".csv") || name.ends_with(".csv.gz")) {
            return buildings(&self.input);
        }
        let Some(schema) = &self.schema else {
            return Err(Error::option("--schema", "a CSV table needs a schema"));
        };
        let bytes = read_bytes(schema)?;
        json::check_header(&bytes, schema, FORMAT, VERSION)?;
        let schema: Schema = json::parse_json(&bytes, schema)?;
        let text = building_csv::read(&self.input)?;
        let read = schema.read(&text.header, &text.rows);
        read.map_err(|e| Error::content(&self.input, e))
    }
}

fn buildings(path: &Path) -> Result<Dataset> {
    let mut rows = Vec::new();
    for building in building_json::read(path)? {
        rows.push(attributes(&building).map_err(|e| Error::content(path, e))?);
    }
    dataset(&rows).map_err(|e| Error::content(path, e))
}

/// Reads a learned model.
pub fn model(path: &Path) -> Result<ModelFile> {
    let bytes = read_bytes(path)?;
    let text = String::from_utf8(bytes).map_err(|e| Error::content(path, e))?;
    ModelFile::from_json(&text).map_err(|e| Error::content(path, e))
}
