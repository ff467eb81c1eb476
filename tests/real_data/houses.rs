//! Real houses through the shipped schemas. Needs the data folder (`EDIFICE_DATA`).

use std::path::Path;

use edifice::io::{building_csv, json, read_bytes};
use edifice::model::hierarchy::{Constant, Settings, learn};
use edifice::model::tables::Dataset;
use edifice::model::tables::schema::Schema;
use edifice_base::unwatched;

fn read(schema: &str, table: &str) -> Option<Dataset> {
    let table = format!("houses/{table}");
    let folder = crate::common::real_data(&table)?;
    let schema = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors")
        .join(schema);
    let schema: Schema = json::parse_json(&read_bytes(&schema).unwrap(), &schema).unwrap();
    let text = building_csv::read(&folder.join(table)).unwrap();
    Some(schema.read(&text.header, &text.rows).unwrap())
}

/// Learns from the first houses, missing values and all, and asks for densities of all.
fn learns(data: &Dataset) {
    let few = data.select(&(0..150).collect::<Vec<_>>());
    let settings = Settings {
        styles: 2..=2,
        most_states: 2,
        restarts: 1,
        constant: Constant::Keep,
        ..Settings::default()
    };
    let learned = learn(&few.table, &few.groups, &settings, 1, &unwatched).unwrap();
    let logs = learned.model.log_likelihood(&data.table).unwrap();
    assert!(logs.iter().all(|l| l.is_finite()));
}

#[test]
fn h2k_has_4874_detached_houses() {
    if let Some(data) = read("h2k.schema.json", "h2k/single_detached_clean.csv.gz") {
        assert_eq!(data.table.rows(), 4874);
        learns(&data);
    }
}

#[test]
fn ames_has_2425_single_family_houses() {
    if let Some(data) = read("ames.schema.json", "ames_raw.csv.gz") {
        assert_eq!(data.table.rows(), 2425);
        learns(&data);
    }
}
