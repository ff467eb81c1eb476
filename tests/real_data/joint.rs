//! One grammar for several real facades never costs more than their own grammars together (needs `EDIFICE_DATA` or
//! `../shared/data`).

use edifice::grammar::{Costs, evaluate};
use edifice::io::read_label_grid;
use edifice::methods::facade_grammar::{Operations, Settings, infer};
use edifice::rng::stream;
use edifice::shape::{Facade, decompose, splittable};
use edifice::unwatched;
use rand::seq::SliceRandom;

const FOLDER: &str = "facades/ecp2011/labels";

fn read(numbers: &[u32]) -> Option<Vec<Facade>> {
    let data = crate::common::real_data(FOLDER)?;
    let read = |number: &u32| {
        let path = data.join(FOLDER).join(format!("monge_{number}.png"));
        let grid = read_label_grid(&path, &Default::default()).unwrap();
        decompose(&grid).unwrap().facade
    };
    Some(numbers.iter().map(read).collect())
}

fn cost(facades: &[Facade], settings: &Settings) -> f64 {
    let found = infer(facades, settings, &unwatched).unwrap();
    // No method marks its own work: this derives every facade and compares.
    let cost = evaluate(&found.grammar, facades, &Costs::default())
        .unwrap()
        .cost;
    if let Some(bound) = found.lower_bound {
        assert!(bound <= cost + 1e-6);
    }
    cost
}

fn joint_and_separate(facades: &[Facade], settings: &Settings) -> (f64, f64) {
    let alone = facades.iter().map(std::slice::from_ref);
    (
        cost(facades, settings),
        alone.map(|facade| cost(facade, settings)).sum(),
    )
}

#[test]
fn four_facades_of_monge_cost_no_more_together() {
    let Some(facades) = read(&[1, 10, 101, 102]) else {
        return;
    };
    let (joint, separate) = joint_and_separate(&facades, &Settings::default());
    println!("jointly {joint:.1}, separately {separate:.1}");
    assert!(
        joint <= separate + 1e-9,
        "jointly {joint}, separately {separate}"
    );
}

#[test]
fn random_sets_cost_no_more_together() {
    let Some(mut facades) = read(&(1..=21).collect::<Vec<_>>()) else {
        return;
    };
    facades.retain(|facade| splittable(facade).is_ok());
    for set in 0..8 {
        facades.shuffle(&mut stream(15, "joint sets", set));
        let drawn = &facades[..2 + set as usize % 4];
        // Little work, so that no grammar is proven optimal and the search walks.
        let settings = Settings {
            iterations: [8, 80][set as usize / 4],
            operations: Operations {
                repeat_aba: set % 2 == 1,
                ..Operations::default()
            },
            ..Settings::default()
        };
        let (joint, separate) = joint_and_separate(drawn, &settings);
        assert!(
            joint <= separate + 1e-9,
            "set {set}: jointly {joint}, separately {separate}"
        );
    }
}
