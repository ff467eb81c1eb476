//! Rows that a house can have: the lower bound on every house's distance, and samples truncated to possible rows.

use std::convert::Infallible;
use std::path::Path;

use crate::cases::cases;
use edifice::io::building_json;
use edifice::methods::building_exteriors::attributes::attributes;
use edifice::methods::building_exteriors::design::{possible_rows, wanted_rows};
use edifice::methods::building_exteriors::house::{Database, Options, generate};
use edifice::methods::building_exteriors::mass::{SearchLimits, least_z};
use edifice::methods::building_exteriors::model_file::ModelFile;
use edifice::rng::stream;
use rand::RngExt;
use rand_distr::StandardNormal;
use rayon::prelude::*;

fn shipped() -> (Database, ModelFile) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/building_exteriors");
    let houses = building_json::read(&folder.join("houses.buildings.jsonl")).unwrap();
    (Database::new(houses).unwrap(), model("made"))
}

fn model(name: &str) -> ModelFile {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/building_exteriors");
    let path = folder.join(format!("{name}.houses.json"));
    ModelFile::from_json(&std::fs::read_to_string(&path).unwrap()).unwrap()
}

fn whole(row: &[Option<f64>]) -> [f64; 49] {
    std::array::from_fn(|c| row[c].unwrap())
}

/// Attacks the bound: what is measured on a house has to be possible, and no house that was built is nearer to the row
/// that was wanted than the bound says, however wild the row.
#[test]
fn no_house_is_nearer_than_the_bound() {
    let (database, _) = shipped();
    for row in &database.rows {
        assert_eq!(least_z(&whole(row), &database.deviations), 0.0);
    }
    let options = Options {
        search: SearchLimits {
            rounds: 1,
            ..SearchLimits::default()
        },
        ..Options::default()
    };
    // Cases are independent: all threads.
    let case = |case: usize| -> bool {
        let mut rng = stream(1, "tests/bound", case as u64);
        let mut wanted = whole(&database.rows[case]);
        let scale = [0.05, 0.3, 1.0][case % 3];
        for (value, deviation) in wanted.iter_mut().zip(&database.deviations).take(39) {
            *value += scale * deviation * rng.sample::<f64, _>(StandardNormal);
        }
        let free = [false; 49];
        let Ok(made) = generate("h", &wanted, &free, &database, &options, &mut rng) else {
            return false;
        };
        let bound = least_z(&wanted, &database.deviations);
        assert!(
            bound <= made.report.max_z + 1e-9,
            "case {case}: bound {bound}, a house has {}",
            made.report.max_z
        );
        let reached = whole(&attributes(&made.building).unwrap());
        assert_eq!(least_z(&reached, &database.deviations), 0.0, "case {case}");
        bound > 0.25
    };
    let count = cases(cases(200));
    let positive = (0..count).into_par_iter().filter(|k| case(*k)).count();
    assert!(
        10 * positive > count,
        "{positive} of {count} bounds say something"
    );
}

#[test]
fn the_bound_grows_with_a_value_that_leaves_the_possible() {
    let (database, _) = shipped();
    let house = database.rows.iter().find(|r| r[15].unwrap() > 0.0).unwrap();
    let mut row = whole(house);
    let mut last = 0.0;
    for k in 1..20 {
        // The centre of a porch moves out of the house.
        row[15] = 1.0 + 0.1 * f64::from(k);
        let bound = least_z(&row, &database.deviations);
        assert!(bound > last, "{bound} after {last}");
        last = bound;
    }
    for value in [f64::MAX, 1e300, -1e300, 0.0] {
        let bound = least_z(&[value; 49], &database.deviations);
        assert!((0.0..=64.0).contains(&bound), "{value}: {bound}");
    }
}

/// The model with which users start has no contradictions: at most one in twenty of its plain samples is further than 0.05 standard
/// deviations from every house. Of the published form of the made houses' model, nearly all are.
#[test]
fn plain_samples_of_the_default_model_are_possible() {
    let (database, published) = shipped();
    let impossible = |file: &ModelFile| {
        let mut rng = stream(5, "tests/plain", 0);
        let rows = wanted_rows(&file.sample(2000, &mut rng).unwrap().table);
        let far = |row: &&[f64; 49]| least_z(row, &database.deviations) > 0.05;
        (rows.iter().filter(far).count(), rows.len())
    };
    let (far, drawn) = impossible(&model("real"));
    assert_eq!(drawn, 2000);
    println!("{far} of {drawn}");
    assert!(20 * far <= drawn, "{far} of {drawn}");
    let (far, drawn) = impossible(&published);
    assert!(2 * far > drawn, "{far} of {drawn}: the bound says nothing");
}

#[test]
fn samples_are_truncated_to_possible_rows() {
    let (database, file) = shipped();
    let free = [false; 49];
    let drawn = |count: usize| {
        let mut rng = stream(3, "tests/possible", 0);
        possible_rows(
            count,
            &free,
            &database.deviations,
            |_| 0.0,
            || file.sample(count, &mut rng).map(|d| d.table),
        )
        .unwrap()
    };
    let possible = drawn(300);
    assert_eq!((possible.rows.len(), possible.impossible), (300, 0));
    assert!(possible.drawn > 300);
    assert_eq!(possible, drawn(300));
    for row in &possible.rows {
        let bound = least_z(row, &database.deviations);
        assert!(bound <= 0.25, "{bound}");
    }
    // A model of impossible rows only: what is nearest to possible comes, and is called what it is.
    let mut rng = stream(4, "tests/possible", 0);
    let table = file.sample(40, &mut rng).unwrap().table;
    let rows = wanted_rows(&table);
    let far: Vec<usize> = (0..rows.len())
        .filter(|&r| least_z(&rows[r], &database.deviations) > 0.3)
        .collect();
    assert!(!far.is_empty());
    let none = possible_rows(
        3,
        &free,
        &database.deviations,
        |_| 0.0,
        || Ok::<_, Infallible>(table.select(&far[..1])),
    );
    let none = none.unwrap();
    assert_eq!((none.rows.len(), none.impossible), (3, 3));
}
