//! Databases, tables and models of houses.

use std::path::{Path, PathBuf};

use edifice::io::{building_csv, building_json, json, read_bytes};
use edifice::methods::building_exteriors::attributes::attributes;
use edifice::methods::building_exteriors::data::{Dataset, dataset};
use edifice::methods::building_exteriors::model_file::ModelFile;
use edifice::methods::building_exteriors::schema::{FORMAT, Schema, VERSION};
use edifice::model::{Cell, Table};
use edifice::{Error, Result};

/// Where houses come from.
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

/// A table as lines of CSV, the header first; categories by name, missing cells empty.
pub fn csv_lines(table: &Table) -> Vec<String> {
    let quoted = |text: &str| {
        if text.contains([',', '"', '\n']) {
            format!("\"{}\"", text.replace('"', "\"\""))
        } else {
            text.to_owned()
        }
    };
    let names = table.columns().iter().map(|c| quoted(c.name()));
    let mut lines = vec![names.collect::<Vec<_>>().join(",")];
    for row in 0..table.rows() {
        let cells = table.columns().iter().map(|column| match column.cell(row) {
            Cell::Missing => String::new(),
            Cell::Real(value) => value.to_string(),
            Cell::Code(code) => {
                let names = column.categories().unwrap_or_default();
                quoted(names.get(code).map_or("", String::as_str))
            }
        });
        lines.push(cells.collect::<Vec<_>>().join(","));
    }
    lines
}
