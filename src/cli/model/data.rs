//! Tables and models of tables.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result, csv};
use edifice_io::building_csv::{self, TextTable};
use edifice_io::{json, read_bytes};
use edifice_model::tables::Dataset;
use edifice_model::tables::schema::{FORMAT, RELATED_VERSION, Schema, VERSION};
use edifice_model::tables::table_model::TableModel;
use edifice_model::{Cell, Column, Table};
use serde_json::Value;

use crate::print::{self, Json};

/// A table, and how to read it.
#[derive(clap::Args)]
pub(crate) struct TableInput {
    /// The table (`*.csv`, `*.csv.gz`), a header line first.
    pub table: PathBuf,
    /// Which columns are which attributes (`*.schema.json`); guessed without.
    #[arg(long)]
    pub schema: Option<PathBuf>,
}

impl TableInput {
    /// Reads the table; the schema is returned besides.
    pub(crate) fn read(&self) -> Result<(Dataset, Schema)> {
        let text = read_table(&self.table)?;
        let at = |e| Error::content(&self.table, e);
        let schema = match &self.schema {
            Some(path) => read_schema(path)?,
            None => Schema::guess(&text.header, &text.rows).map_err(at)?,
        };
        let data = schema.read(&text.header, &text.rows).map_err(at)?;
        Ok((data, schema))
    }

    /// As [`Self::read`], with the exact relations between columns in the schema, which are said: those of `known`, or else those
    /// that the schema states, or else those that are found. The columns that they determine are left out of the rows.
    pub(crate) fn read_related(&self, known: Option<&Schema>) -> Result<(Dataset, Schema)> {
        let (data, mut schema) = self.read()?;
        match known {
            Some(known) => schema.relations.clone_from(&known.relations),
            None => schema = schema.related(&data),
        }
        for relation in schema.relations.iter().flatten() {
            print::message(&format!("exact relation: {}", relation.said()));
        }
        let at = |e| Error::content(&self.table, e);
        let relations = schema.relations().map_err(at)?;
        let reduced = relations.reduce_dataset(&data).map_err(at)?;
        Ok((reduced, schema))
    }

    /// The guessed schema, of the columns that can be in one, with the relations found, and why other columns are left out, which is said.
    pub(crate) fn guess(&self) -> Result<(Schema, Vec<String>)> {
        let text = read_table(&self.table)?;
        let (mut schema, left_out) = Schema::guess_some(&text.header, &text.rows);
        if let Ok(data) = schema.read(&text.header, &text.rows) {
            schema = schema.related(&data);
        }
        let left_out: Vec<String> = left_out.iter().map(ToString::to_string).collect();
        for reason in &left_out {
            print::message(&format!("left out: {reason}"));
        }
        Ok((schema, left_out))
    }
}

/// Reads a table, and says how it was read where that was not as plain CSV.
pub(crate) fn read_table(path: &Path) -> Result<TextTable> {
    let table = building_csv::read(path)?;
    for note in &table.notes {
        print::message(&format!("{}: {note}", path.display()));
    }
    Ok(table)
}

/// Reads a schema.
pub(crate) fn read_schema(path: &Path) -> Result<Schema> {
    let bytes = read_bytes(path)?;
    json::check_versions(&bytes, path, FORMAT, VERSION..=RELATED_VERSION)?;
    json::parse_json(&bytes, path)
}

/// Reads a model of a table.
pub(crate) fn read_model(path: &Path) -> Result<TableModel> {
    let bytes = read_bytes(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|e| Error::content(path, e))?;
    TableModel::from_json(text).map_err(|e| Error::content(path, e))
}

/// Reads a table by a model's schema. Of the schema's columns the table may lack some: they are missing.
pub(crate) fn read_rows(model: &TableModel, path: &Path) -> Result<Dataset> {
    rows(model, &read_table(path)?, path)
}

/// The rows of a table that was read, by a model's schema; `path` names it in errors.
pub(crate) fn rows(model: &TableModel, text: &TextTable, path: &Path) -> Result<Dataset> {
    let mut schema = model.schema.clone();
    for group in &mut schema.groups {
        group.columns.retain(|column| text.header.contains(column));
    }
    schema.groups.retain(|group| !group.columns.is_empty());
    let data = schema.read(&text.header, &text.rows);
    data.map_err(|e| Error::content(path, e))
}

/// Prints a table as CSV, or as one line of JSON: numbers, categories by name, missing cells null.
pub(crate) fn print_table(table: &Table, json: Json) -> Result<()> {
    match json.is_asked() {
        true => json.end(&json_of(table)),
        false => print::line(&csv_lines(table).join("\n")),
    }
}

/// A table as `columns`, their names, and `rows`.
pub(crate) fn json_of(table: &Table) -> Value {
    let names: Vec<&str> = table.columns().iter().map(|c| c.name()).collect();
    let cell = |column: &Column, row: usize| match column.cell(row) {
        Cell::Missing => Value::Null,
        Cell::Real(value) => value.into(),
        Cell::Code(code) => {
            let names = column.categories().unwrap_or_default();
            names
                .get(code)
                .map_or(Value::Null, |name| name.as_str().into())
        }
    };
    let row = |row| {
        table
            .columns()
            .iter()
            .map(|c| cell(c, row))
            .collect::<Vec<Value>>()
    };
    let rows: Vec<Vec<Value>> = (0..table.rows()).map(row).collect();
    serde_json::json!({ "columns": names, "rows": rows })
}

/// Completed rows for programs, gathered.
#[derive(Default)]
pub(crate) struct Completed {
    columns: Value,
    rows: Vec<Value>,
    of: Vec<usize>,
}

impl Completed {
    /// Adds rows; `of` says which row of the table, from 0, each of them completes.
    pub(crate) fn add(&mut self, drawn: &Table, of: impl Fn(usize) -> usize) {
        let mut value = json_of(drawn);
        self.columns = value["columns"].take();
        if let Value::Array(rows) = value["rows"].take() {
            self.of.extend((0..rows.len()).map(of));
            self.rows.extend(rows);
        }
    }

    /// Prints the line, if it was asked for.
    pub(crate) fn end(self, json: Json) -> Result<()> {
        json.end(&serde_json::json!({ "columns": self.columns, "rows": self.rows, "of": self.of }))
    }
}

/// A table as lines of CSV, the header first; categories by name, missing cells empty.
pub(crate) fn csv_lines(table: &Table) -> Vec<String> {
    let names = table.columns().iter().map(|c| csv::cell(c.name()));
    let mut lines = vec![names.collect::<Vec<_>>().join(",")];
    for row in 0..table.rows() {
        let cells = table.columns().iter().map(|column| match column.cell(row) {
            Cell::Missing => String::new(),
            Cell::Real(value) => value.to_string(),
            Cell::Code(code) => {
                let names = column.categories().unwrap_or_default();
                csv::cell(names.get(code).map_or("", String::as_str)).into_owned()
            }
        });
        lines.push(cells.collect::<Vec<_>>().join(","));
    }
    lines
}
