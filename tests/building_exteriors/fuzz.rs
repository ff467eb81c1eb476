//! Houses of random boxes, roofs, chimneys and towers: every one closed, in one piece, with the volume of the integral
//! over its plan. `EDIFICE_FUZZ_HOUSES=10000` makes so many of them.

use crate::cases::cases;
use edifice::methods::building_exteriors::house::model::expected_volume;
use edifice::methods::building_exteriors::house::{Joining, model};
use edifice::rng::stream;
use edifice::shape::{Building, Ridge, Roof, RoofStyle, Special};
use edifice_generators_building_exteriors::wild;
use rand::RngExt;
use rayon::prelude::*;

/// A wild house with any roof on any box.
fn house(index: u64) -> Building {
    let mut rng = stream(29, "tests/fuzz", index);
    let mut building = wild(7, index);
    let styles = [
        RoofStyle::Flat,
        RoofStyle::Gable,
        RoofStyle::Hip,
        RoofStyle::Shed,
        RoofStyle::Cone,
    ];
    for b in &mut building.boxes {
        let pitch = rng.random_range(0.0..60.0);
        b.roof = Roof {
            style: styles[rng.random_range(0..styles.len())],
            pitch,
            ridge: if rng.random() { Ridge::X } else { Ridge::Y },
        };
    }
    for special in [Special::Chimney, Special::Tower] {
        if rng.random_bool(0.3) {
            building.special.push(special);
        }
    }
    building
}

/// The fault of the house of this number; `None` for a sound one.
fn fault(index: u64) -> Option<String> {
    let building = house(index);
    let joining = [Joining::Boxes, Joining::Merged][(index % 2) as usize];
    let made = match model(&building, joining) {
        Ok(made) => made,
        Err(e) => return Some(format!("house {index}: {e}")),
    };
    let expected = expected_volume(&building, joining, made.openings);
    if made.report.shells != 1 {
        return Some(format!("house {index}: {} shells", made.report.shells));
    }
    let error = (made.report.volume - expected).abs() / expected;
    (error >= 1e-9).then(|| format!("house {index}: volume off by {error:e}"))
}

#[test]
fn random_houses_are_closed_and_have_the_volume_of_the_integral() {
    let count = std::env::var("EDIFICE_FUZZ_HOUSES").ok();
    let count = count.map_or(cases(cases(1000)), |c| {
        c.parse().expect("a number of houses")
    });
    let faults: Vec<String> = (0..count as u64)
        .into_par_iter()
        .filter_map(fault)
        .collect();
    assert!(
        faults.is_empty(),
        "{} of {count}: {:?}",
        faults.len(),
        &faults[..faults.len().min(5)]
    );
}
