//! Tables and models of tables.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use edifice_base::{Error, Result, csv};
use edifice_io::building_csv::{self, TextTable};
use edifice_io::{json, read_bytes};
use edifice_model::tables::Dataset;
use edifice_model::tables::schema::{FORMAT, RELATED_VERSION, Schema, SchemaError, VERSION};
use edifice_model::tables::table_model::TableModel;
use edifice_model::{Cell, Column, ModelError, Table};
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

/// The rows of a table that a schema keeps.
pub(crate) struct Kept {
    /// The rows.
    pub data: Dataset,
    /// Their places in the table, from 0.
    pub rows: Vec<usize>,
}

impl Kept {
    /// An error of a model, with the row of the table at `path` instead of the one among those kept.
    pub(crate) fn at<'a>(&'a self, path: &'a Path) -> impl Fn(ModelError) -> Error + 'a {
        |error| Error::content(path, error.among(&self.rows))
    }
}

impl TableInput {
    /// Reads the table; the schema is returned besides.
    pub(crate) fn read(&self) -> Result<(Kept, Schema)> {
        let text = read_table(&self.table)?;
        let at = |e| Error::content(&self.table, e);
        let schema = match &self.schema {
            Some(path) => read_schema(path)?,
            None => Schema::guess(&text.header, &text.rows).map_err(at)?,
        };
        Ok((kept(&schema, &text).map_err(at)?, schema))
    }

    /// As [`Self::read`], with the exact relations between columns in the schema, which are said: those of `known`, or else those
    /// that the schema states, or else those that are found. The columns that they determine are left out of the rows.
    pub(crate) fn read_related(&self, known: Option<&Schema>) -> Result<(Kept, Schema)> {
        let (mut kept, mut schema) = self.read()?;
        match known {
            Some(known) => schema.relations.clone_from(&known.relations),
            None => schema = schema.related(&kept.data),
        }
        for relation in schema.relations.iter().flatten() {
            print::message(&format!("exact relation: {}", relation.said()));
        }
        let relations = schema.relations().map_err(kept.at(&self.table))?;
        let reduced = relations.reduce_dataset(&kept.data);
        kept.data = reduced.map_err(kept.at(&self.table))?;
        Ok((kept, schema))
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

/// The rows of a table by a schema.
fn kept(schema: &Schema, text: &TextTable) -> std::result::Result<Kept, SchemaError> {
    Ok(Kept {
        data: schema.read(&text.header, &text.rows)?,
        rows: schema.kept(&text.header, &text.rows)?,
    })
}

/// The rows of a table that was read, by a model's schema; `path` names it in errors. Of the schema's columns the table may lack
/// some, but not all: they are missing, which is said.
pub(crate) fn rows(model: &TableModel, text: &TextTable, path: &Path) -> Result<Kept> {
    let mut schema = model.schema.clone();
    let mut lacking = Vec::new();
    for group in &mut schema.groups {
        let (there, not) = std::mem::take(&mut group.columns)
            .into_iter()
            .partition(|column| text.column(column).is_some());
        group.columns = there;
        lacking.extend::<Vec<String>>(not);
    }
    schema.groups.retain(|group| !group.columns.is_empty());
    if schema.groups.is_empty() {
        let message = format!(
            "the table has none of the model's columns: {}",
            lacking.join(", ")
        );
        return Err(Error::content(path, message));
    }
    say_hidden(&lacking);
    kept(&schema, text).map_err(|e| Error::content(path, e))
}

/// Says which columns of a model a table lacks.
pub(crate) fn say_hidden(names: &[impl AsRef<str>]) {
    if !names.is_empty() {
        let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
        print::message(&format!("hidden: {}", names.join(", ")));
    }
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

/// A table as lines of CSV, the header first; categories by name, missing cells empty.
pub(crate) fn csv_lines(table: &Table) -> Vec<String> {
    let names = table.columns().iter().map(|c| csv::cell(c.name()));
    let mut lines = vec![names.collect::<Vec<_>>().join(",")];
    for row in 0..table.rows() {
        let cells = table.columns().iter().map(|column| text_of(column, row));
        let cells = cells.map(|text| csv::cell(&text).into_owned());
        lines.push(cells.collect::<Vec<_>>().join(","));
    }
    lines
}

/// The text of a cell, empty where it is missing.
pub(crate) fn text_of(column: &Column, row: usize) -> Cow<'_, str> {
    match column.cell(row) {
        Cell::Missing => "".into(),
        Cell::Real(value) => value.to_string().into(),
        Cell::Code(code) => {
            let names = column.categories().unwrap_or_default();
            names.get(code).map_or("", String::as_str).into()
        }
    }
}
