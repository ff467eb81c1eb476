//! The shipped database is what its generator makes, and the generator keeps its promises.

use std::path::PathBuf;

use edifice::io::{building_csv, building_json};
use edifice::methods::building_exteriors::attributes::{GROUPS, Level, attributes};
use edifice::methods::building_exteriors::house::model::expected_volume;
use edifice::methods::building_exteriors::house::{Joining, model};
use edifice::methods::building_exteriors::mass::is_sound;
use edifice::model::hierarchy::Priors;
use edifice_generators_building_exteriors::{
    DEPENDENCIES, Family, House, KINDS, SHIPPED, SHIPPED_SEED, STYLES, houses,
};

use crate::cases::cases;

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

/// A city model of this level of detail shows towers: where no small part stands above all others, there is none.
#[test]
fn towers_of_delft_are_those_that_its_model_shows() {
    let table = building_csv::read(&folder().join("real.houses.csv")).unwrap();
    let column = table.header.iter().position(|h| h == "special.tower");
    let column = column.unwrap();
    let rows = table.rows.iter().filter(|r| r[0] == "delft");
    let cells: Vec<&str> = rows.map(|r| r[column].as_str()).collect();
    let delft = building_json::read(&folder().join("delft.buildings.jsonl")).unwrap();
    assert_eq!(cells.len(), delft.len());
    for (cell, house) in cells.into_iter().zip(&delft) {
        let boxes = &house.boxes;
        let is_above = |i: usize| {
            let others = (0..boxes.len()).filter(|&j| j != i);
            boxes.len() > 1
                && others
                    .into_iter()
                    .all(|j| boxes[i].height > boxes[j].height + 1.0)
        };
        let is_small = |i: usize| boxes[i].width.max(boxes[i].depth) <= 4.5;
        let has = (0..boxes.len()).any(|i| is_small(i) && is_above(i));
        assert_eq!(cell, if has { "" } else { "no" }, "{}", house.name);
    }
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
        // The front porch stands beside the garage, never on it; in mirrored plans on its other side.
        let ends = |c: usize| {
            let (at, half) = (values[c] * values[0], values[c + 2] / 2.0);
            (at - half, at + half)
        };
        if values[11] > 0.0 && values[17] > 0.0 {
            let (garage, porch) = (ends(9), ends(15));
            assert!(porch.0 > garage.1 || porch.1 < garage.0, "{name}");
        }
    }
}

#[test]
fn plans_are_of_ten_families_and_garages_stand_in_front_beside_and_behind() {
    let made = houses(SHIPPED_SEED, SHIPPED);
    for family in Family::ALL {
        let count = made.iter().filter(|h| h.family == family).count();
        assert!(count > 0, "{family:?}");
    }
    let common = Family::ALL.into_iter().filter(|family| {
        let own = made.iter().filter(|h| h.family == *family);
        own.count() >= SHIPPED / 20
    });
    assert!(common.count() >= 8);
    let mut places = std::collections::BTreeSet::new();
    for house in &made {
        let row = attributes(&house.building).unwrap();
        let (x, y) = (row[9].unwrap(), row[10].unwrap());
        if x > 0.0 {
            places.insert(((3.0 * y) as usize, x > 0.5));
        }
    }
    // Thirds of the depth from the front, and left and right.
    for third in 0..3 {
        assert!(places.contains(&(third, false)), "{places:?}");
    }
    assert!(places.contains(&(1, true)), "{places:?}");
}

#[test]
fn no_window_is_hidden_and_every_house_is_closed() {
    use rayon::prelude::*;
    let made = houses(SHIPPED_SEED, cases(SHIPPED));
    made.par_iter().for_each(|house| {
        let name = &house.building.name;
        let made = model(&house.building, Joining::Boxes).unwrap();
        assert!(made.unplaced.is_empty(), "{name}: {:?}", made.unplaced);
        assert_eq!(made.report.shells, 1, "{name}");
        let expected = expected_volume(&house.building, Joining::Boxes, made.openings);
        let error = (made.report.volume - expected).abs() / expected;
        assert!(error < 1e-9, "{name}: volume off by {error:e}");
        assert!(is_sound(&house.building), "{name}");
    });
}

/// Kind of `group` of a house.
fn kind(house: &House, group: &str) -> usize {
    let at = KINDS.iter().position(|k| *k == group).unwrap();
    house.kinds[at]
}

#[test]
fn plans_and_walls_have_the_numbers_that_were_drawn() {
    for house in houses(5, 500) {
        let name = &house.building.name;
        let row = attributes(&house.building).unwrap();
        let value = |c: usize| row[c].unwrap();
        // Coverage: mean by kind and width, noise of 0.005 within 2.5 deviations, millimetres.
        let mean = [0.86, 0.80, 0.74][kind(&house, "bcr")] - 0.009 * (value(0) - 14.0);
        assert!((value(3) - mean).abs() < 0.0135, "{name}: bcr");
        // Boundary, with the coverage as measured.
        let mean = [5.06, 5.36][kind(&house, "bdry")] + 0.03 * (value(0) - 14.0);
        let bdry = mean - 3.0 * (value(3) - 0.8);
        assert!((value(4) - bdry).abs() < 0.055, "{name}: bdry");
        let aligned = match (kind(&house, "arf"), kind(&house, "alignment")) {
            (0, _) | (_, 2) => [0.0; 4],
            (_, 1) => [1.0, 1.0, 0.0, 0.0],
            _ => [1.0; 4],
        };
        assert_eq!([35, 36, 37, 38].map(value), aligned, "{name}: alignment");
    }
}

/// Parents of every continuous attribute in the generator, in an order of drawing.
const PARENTS: [(&str, &[&str]); 10] = [
    ("bbox", &[]),
    ("bcr", &["bbox"]),
    ("bdry", &["bbox", "bcr"]),
    ("arf", &["bcr"]),
    ("far", &["bcr", "arf"]),
    ("garage", &["bbox"]),
    ("porch", &["bbox", "garage"]),
    ("wwr", &[]),
    ("symmetry", &[]),
    ("alignment", &[]),
];

#[test]
fn with_kinds_known_the_nine_dependencies_have_evidence_and_no_other_has() {
    let made = houses(1, 2000 * cases(2));
    let rows: Vec<Vec<f64>> = made
        .iter()
        .map(|h| {
            let row = attributes(&h.building).unwrap();
            row.iter().map(|v| v.unwrap()).collect()
        })
        .collect();
    let moments: Vec<(f64, f64)> = (0..39)
        .map(|c| {
            let mean = rows.iter().map(|r| r[c]).sum::<f64>() / rows.len() as f64;
            let squares: f64 = rows.iter().map(|r| (r[c] - mean).powi(2)).sum();
            (mean, (squares / rows.len() as f64).sqrt())
        })
        .collect();
    // Equal values of a hidden variable: the kind; for what is measured on several floors, also
    // their number; the floor area ratio follows the shares of the floors.
    let part = |h: &House, g: &str| match g {
        "far" => kind(h, "arf"),
        "symmetry" | "alignment" => 10 * kind(h, g) + [0, 1, 1, 2][kind(h, "arf")],
        g => kind(h, g),
    };
    let columns = |g: &str| {
        let group = GROUPS.iter().find(|k| k.name == g).unwrap();
        group.first..group.first + group.len
    };
    let prior = Priors::default().linear;
    let evidence = |g: &str, parents: &[&str]| -> f64 {
        let regressors: Vec<usize> = parents.iter().flat_map(|p| columns(p)).collect();
        let all: Vec<usize> = regressors.iter().copied().chain(columns(g)).collect();
        let q = all.len() + 1;
        let parts: std::collections::BTreeSet<usize> = made.iter().map(|h| part(h, g)).collect();
        let of_part = |k: usize| {
            let mut scatter = vec![0.0; q * q];
            for (row, _) in rows.iter().zip(&made).filter(|(_, h)| part(h, g) == k) {
                let standard = |&c: &usize| (row[c] - moments[c].0) / moments[c].1;
                let u: Vec<f64> = std::iter::once(1.0)
                    .chain(all.iter().map(standard))
                    .collect();
                for i in 0..q {
                    for j in 0..=i {
                        scatter[i * q + j] += u[i] * u[j];
                    }
                }
            }
            let p = 1 + regressors.len();
            prior.evidence(&scatter, p, q - p).unwrap()
        };
        parts.into_iter().map(of_part).sum()
    };
    let is_listed =
        |a: &str, b: &str| DEPENDENCIES.contains(&(a, b)) || DEPENDENCIES.contains(&(b, a));
    for (at, (group, parents)) in PARENTS.iter().enumerate() {
        let base = evidence(group, parents);
        for (other, _) in &PARENTS[..at] {
            if parents.contains(other) {
                let rest: Vec<&str> = parents.iter().copied().filter(|p| p != other).collect();
                assert!(is_listed(other, group) && base > evidence(group, &rest) + 50.0);
            } else {
                let more: Vec<&str> = parents.iter().copied().chain([*other]).collect();
                let gain = evidence(group, &more) - base;
                assert!(
                    !is_listed(other, group) && gain < 0.0,
                    "{other} -> {group}: {gain}"
                );
            }
        }
    }
    let continuous = GROUPS.iter().filter(|g| g.level != Level::Element);
    assert_eq!(continuous.count(), PARENTS.len());
}
