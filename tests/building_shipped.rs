//! The shipped database is what its generator makes, and the generator keeps its promises.

use std::path::PathBuf;

use edifice::experiments::building_exteriors::houses::{
    DEPENDENCIES, SHIPPED, SHIPPED_SEED, STYLES, houses,
};
use edifice::io::building_json;
use edifice::methods::building_exteriors::attributes::attributes;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("datasets/building_exteriors")
}

/// Set `EDIFICE_WRITE_SHIPPED=1` to write the files anew after a change of the generator.
#[test]
fn shipped_houses_and_truth_are_the_generators() {
    let made = houses(SHIPPED_SEED, SHIPPED);
    let buildings: Vec<_> = made.iter().map(|h| h.building.clone()).collect();
    let truth = serde_json::json!({
        "styles": made.iter().map(|h| h.style).collect::<Vec<_>>(),
        "dependencies": DEPENDENCIES,
    });
    let truth = format!("{truth}\n");
    let database = folder().join("houses.buildings.jsonl");
    let truth_file = folder().join("truth.json");
    if std::env::var_os("EDIFICE_WRITE_SHIPPED").is_some() {
        building_json::write_lines(&buildings, &database).unwrap();
        edifice::io::write_atomic(&truth_file, truth.as_bytes()).unwrap();
    }
    assert_eq!(building_json::read(&database).unwrap(), buildings);
    assert_eq!(std::fs::read_to_string(&truth_file).unwrap(), truth);
}

#[test]
fn houses_do_not_depend_on_how_many_are_made() {
    let (few, many) = (houses(3, 5), houses(3, 20));
    for (a, b) in few.iter().zip(&many) {
        assert_eq!((&a.building, a.style), (&b.building, b.style));
    }
}

#[test]
fn all_styles_occur_and_every_house_has_plausible_attributes() {
    let made = houses(11, 300);
    for style in 0..STYLES {
        assert!(made.iter().filter(|h| h.style == style).count() > 15);
    }
    for house in &made {
        let row = attributes(&house.building).unwrap();
        let values: Vec<f64> = row.iter().map(|v| v.unwrap()).collect();
        let name = &house.building.name;
        assert!(values.iter().all(|v| v.is_finite()), "{name}");
        // Coverage, shares, ratios and exposures.
        for c in (3..4).chain(6..9).chain(27..49) {
            assert!(
                (0.0..=1.0 + 1e-9).contains(&values[c]),
                "{name}, column {c}"
            );
        }
        let shares: f64 = values[6..9].iter().sum();
        assert!((shares - 1.0).abs() < 1e-12, "{name}");
        assert!(
            (values[5] * values[6] - values[3]).abs() < 1e-9,
            "{name}: far = bcr / arf.0"
        );
        // The front porch stands beside the garage, never on it.
        let garage_right = values[9] * values[0] + values[11] / 2.0;
        let porch_left = values[15] * values[0] - values[17] / 2.0;
        if values[11] > 0.0 && values[17] > 0.0 {
            assert!(porch_left > garage_right, "{name}");
        }
    }
}
