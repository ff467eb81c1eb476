//! The three sets of houses.

use std::sync::Arc;

use serde::Deserialize;

use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::attributes;
use edifice_building_exteriors::data::dataset;
use edifice_frame::Context;
use edifice_io::{building_csv, building_json, json, read_bytes};
use edifice_model::hierarchy::{Learned, Settings, learn};
use edifice_model::tables::Dataset;
use edifice_model::tables::compare::split;
use edifice_model::tables::schema::{FORMAT, Schema, VERSION};
use edifice_model::{Cell, Table};
use edifice_shape::Building;
use edifice_sweep::Shared;

/// The generator's own knowledge of the houses, which learning does not see.
#[derive(Deserialize)]
pub(crate) struct Truth {
    /// Hidden style of each house.
    pub styles: Vec<usize>,
    /// Dependencies between attributes.
    pub dependencies: Vec<(String, String)>,
}

/// The made houses, a line each, by their name below `datasets/`.
pub(crate) const HOUSES: &str = "building_exteriors/houses.buildings.jsonl";

/// The shipped database.
pub(crate) struct Shipped {
    pub buildings: Vec<Building>,
    pub data: Dataset,
    pub truth: Truth,
}

/// Reads the shipped database and, for judging only, its truth.
pub(crate) fn shipped(ctx: &mut Context) -> Result<Shipped> {
    let path = ctx.shipped(HOUSES)?;
    let buildings = building_json::read(&path)?;
    let path = ctx.shipped("building_exteriors/truth.json")?;
    let truth: Truth = json::parse_json(&read_bytes(&path)?, &path)?;
    let data = measure(&buildings)?;
    Ok(Shipped {
        buildings,
        data,
        truth,
    })
}

/// The model of the first houses of the shipped database. Several artefacts ask for that of the same ones: a run learns it once.
///
/// # Errors
/// [`Error::Method`], those of learning.
pub(crate) fn learned(first: &Dataset, settings: &Settings, seed: u64) -> Result<Arc<Learned>> {
    static MODELS: Shared<Learned> = Shared::new();
    let key = format!("{} {seed} {settings:?}", first.table.rows());
    MODELS.get(key, || {
        learn(&first.table, &first.groups, settings, seed).map_err(Error::method)
    })
}

/// The attributes of buildings.
pub(crate) fn measure(buildings: &[Building]) -> Result<Dataset> {
    let rows = buildings.iter().map(attributes);
    let rows = rows.collect::<std::result::Result<Vec<_>, _>>();
    dataset(&rows.map_err(Error::method)?).map_err(Error::method)
}

/// Real sets: name, schema in `datasets/building_exteriors`, table in the data folder.
const REAL: [(&str, &str, &str); 2] = [
    (
        "h2k",
        "building_exteriors/h2k.schema.json",
        "houses/h2k/single_detached_clean.csv.gz",
    ),
    (
        "ames",
        "building_exteriors/ames.schema.json",
        "houses/ames_raw.csv.gz",
    ),
];

/// The real sets that are there: of each, up to `most` houses without missing values (a mixture
/// over concatenated vectors has no place for these, and all models see the same houses).
pub(crate) fn real(ctx: &mut Context, most: usize) -> Result<Vec<(&'static str, Dataset)>> {
    let mut sets = Vec::new();
    for (name, schema, table) in REAL {
        let schema = ctx.shipped(schema)?;
        let Some(path) = ctx.real(table)? else {
            continue;
        };
        let bytes = read_bytes(&schema)?;
        json::check_header(&bytes, &schema, FORMAT, VERSION)?;
        let schema: Schema = json::parse_json(&bytes, &schema)?;
        let text = building_csv::read(&path)?;
        let all = schema
            .read(&text.header, &text.rows)
            .map_err(|e| Error::content(&path, e))?;
        let complete = complete_rows(&all.table);
        let seed = ctx.seed();
        let (chosen, _) = split(complete.len(), 1.0, seed, 999);
        let chosen: Vec<usize> = chosen.iter().take(most).map(|&i| complete[i]).collect();
        ctx.note(format!(
            "`{name}`: {} of {} houses, drawn from the {} without missing values; {} attributes.",
            chosen.len(),
            all.table.rows(),
            complete.len(),
            all.table.columns().len()
        ));
        sets.push((name, all.select(&chosen)));
    }
    if sets.len() < REAL.len() {
        ctx.note("Real sets that are not there are left out: give their folder with `--data`.");
    }
    Ok(sets)
}

fn complete_rows(table: &Table) -> Vec<usize> {
    let known = |row: usize| table.columns().iter().all(|c| c.cell(row) != Cell::Missing);
    (0..table.rows()).filter(|&row| known(row)).collect()
}

/// The real value in a named column; NaN never leaves: `None` for a missing or categorical cell.
pub(crate) fn number(table: &Table, column: &str, row: usize) -> Option<f64> {
    match table.column(column).ok()?.cell(row) {
        Cell::Real(value) => Some(value),
        _ => None,
    }
}

/// Index of the largest value; 0 of none.
pub(crate) fn argmax(values: &[f64]) -> usize {
    let best = values.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    best.map_or(0, |(i, _)| i)
}
