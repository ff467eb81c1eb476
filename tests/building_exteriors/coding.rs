//! Coded models: nothing is lost, draws are possible, what is given stays to the bit.

use std::path::Path;

use edifice::io::building_json;
use edifice::methods::building_exteriors::attributes::{AttributeRow, COLUMNS, GROUPS, attributes};
use edifice::methods::building_exteriors::coding::{
    Coding, Observation, attribute_rows, coded, decoded,
};
use edifice::methods::building_exteriors::house::Database;
use edifice::methods::building_exteriors::mass::least_z;
use edifice::methods::building_exteriors::model_file::ModelFile;
use edifice::model::Table;
use edifice::model::em::Stopping;
use edifice::model::hierarchy::{Priors, fit};
use edifice::rng::stream;

fn shipped(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors")
        .join(name)
}

fn made() -> Database {
    Database::new(building_json::read(&shipped("houses.buildings.jsonl")).unwrap()).unwrap()
}

/// A coded model of the made houses, without a search for its structure.
fn small_model() -> ModelFile {
    let rows = made().rows.into_iter().map(Observation::from);
    let data = coded(&rows.collect::<Vec<_>>()).unwrap();
    let kinds = [2; 9];
    let (priors, stopping) = (Priors::default(), Stopping::default());
    let found = fit(&data.table, &data.groups, 3, &kinds, &priors, &stopping, 1).unwrap();
    ModelFile {
        groups: data.groups,
        coding: Coding::Presence,
        model: found.model,
    }
}

#[test]
fn rows_survive_coding() {
    let houses = made().rows;
    let observations: Vec<Observation> = houses.iter().cloned().map(Observation::from).collect();
    let data = coded(&observations).unwrap();
    assert!(data.table.column("far").is_err() && data.table.column("arf.0").is_err());
    let again = attribute_rows(&decoded(&data.table, &[]).unwrap());
    for (row, own) in houses.iter().zip(&again) {
        // Facades are moved to what their walls can have; masses stay but for the last digits.
        for c in 0..27 {
            let (a, b) = (row[c].unwrap(), own[c].unwrap());
            assert!(
                (a - b).abs() < 0.06 * (1.0 + a.abs()),
                "{}: {a} became {b}",
                COLUMNS[c]
            );
        }
    }
}

#[test]
fn a_missing_part_is_not_an_absent_one() {
    let village = building_json::read(&shipped("delft.buildings.jsonl")).unwrap();
    let rows: Vec<Observation> = village
        .iter()
        .map(|b| attributes(b).unwrap().into())
        .collect();
    let data = coded(&rows).unwrap();
    assert!(data.table.column("porch.front.there").is_err());
    assert!(data.table.column("wwr.front").is_err());
    assert!(data.table.column("garage.there").is_ok());
}

#[test]
fn draws_of_a_coded_model_are_possible() {
    let model = small_model();
    assert_eq!(model.coding, Coding::Presence);
    let deviations = made().deviations;
    let draws = model.sample(400, &mut stream(3, "coding", 0)).unwrap();
    let impossible = attribute_rows(&draws.table)
        .iter()
        .filter(|row| {
            let row = std::array::from_fn(|c| row[c].unwrap());
            least_z(&row, &deviations) > 0.05
        })
        .count();
    assert!(impossible <= 20, "{impossible} of 400 are impossible");
    let negative = attribute_rows(&draws.table)
        .iter()
        .flatten()
        .flatten()
        .any(|v| *v < 0.0);
    assert!(!negative);
}

/// Nothing is to be aligned on a wall without windows, and all of it is symmetric; a house that wants another share there would have to
/// get a window for it.
#[test]
fn sides_with_next_to_no_glass_are_blank_walls() {
    let text = std::fs::read_to_string(shipped("real.houses.json")).unwrap();
    let model = ModelFile::from_json(&text).unwrap();
    let draws = model.sample(400, &mut stream(6, "coding", 0)).unwrap();
    let mut blank = 0;
    for row in attribute_rows(&draws.table) {
        for side in 27..31 {
            let [glass, symmetry, alignment] = [side, side + 4, side + 8].map(|c| row[c].unwrap());
            assert!(glass == 0.0 || glass >= 0.01, "{glass}");
            blank += usize::from(glass == 0.0);
            assert!(glass > 0.0 || (symmetry, alignment) == (1.0, 0.0));
        }
    }
    assert!((40..800).contains(&blank), "{blank} blank sides of 1,600");
}

#[test]
fn columns_are_those_of_draws() {
    for file in ["made.houses.json", "real.houses.json"] {
        let text = std::fs::read_to_string(shipped(file)).unwrap();
        let model = ModelFile::from_json(&text).unwrap();
        let columns = model.columns().unwrap();
        assert_eq!(columns.rows(), 0);
        let drawn = model
            .sample(20, &mut stream(1, "columns", 0))
            .unwrap()
            .table;
        assert!(!drawn.columns().is_empty());
        for column in drawn.columns() {
            let asked = columns.column(column.name()).unwrap();
            assert_eq!(asked.categories(), column.categories());
        }
        let attributes = model.attributes();
        for name in attributes.iter().flat_map(|g| &g.columns) {
            columns.column(name).unwrap();
        }
    }
}

#[test]
fn what_is_given_stays_to_the_bit() {
    let model = small_model();
    for group in GROUPS
        .iter()
        .filter(|g| !["bbox", "bcr", "bdry", "far", "arf"].contains(&g.name))
    {
        let mut given = Table::new();
        for (k, name) in group.columns().iter().enumerate() {
            given = match group.first + k < 39 {
                true => given.real(name, [Some(0.0)]).unwrap(),
                false => given.binary(name, [Some(false)]).unwrap(),
            };
        }
        let draws = model
            .complete(&given, 5, &mut stream(4, "coding", 0))
            .unwrap();
        for row in attribute_rows(&draws.table) {
            for c in group.first..group.first + group.len {
                assert_eq!(row[c], Some(0.0), "{}", COLUMNS[c]);
            }
        }
    }
    let wide = Table::new()
        .real("bbox.w", [Some(14.123_456_789)])
        .unwrap()
        .real("garage.w", [Some(5.25)])
        .unwrap();
    let draws = model
        .complete(&wide, 20, &mut stream(5, "coding", 0))
        .unwrap();
    let rows: Vec<AttributeRow> = attribute_rows(&draws.table);
    for row in rows {
        assert_eq!((row[0], row[11]), (Some(14.123_456_789), Some(5.25)));
        // A garage of which the width is given is there.
        assert!(row[12].unwrap() > 0.0 && row[13].unwrap() > 0.0);
        assert!((row[5].unwrap() - row[3].unwrap() / row[6].unwrap()).abs() < 1e-9);
        assert!((row[6..9].iter().flatten().sum::<f64>() - 1.0).abs() < 1e-9);
    }
}
