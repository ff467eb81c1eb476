//! The grammar of a city does not depend on the order of buildings or on threads.

use edifice::grammar::instance::InstanceGrammar;
use edifice::io::city::{compact, grammar_json};
use edifice::methods::city_proceduralization::{Budget, Mode, Precision, Settings, proceduralize};
use edifice::rng::stream;
use edifice::shape::triangles::City;
use edifice::unwatched;
use edifice_generators_city_proceduralization as synthetic;
use rand::seq::SliceRandom;

fn settings(mode: Mode, budget: Budget) -> Settings {
    Settings {
        mode,
        budget,
        ..Settings::default()
    }
}

fn grammar(city: &City, settings: &Settings) -> InstanceGrammar {
    proceduralize(city, settings, &unwatched).unwrap().grammar
}

/// The bytes of a grammar, its buildings by identifier.
fn bytes(mut grammar: InstanceGrammar) -> Vec<u8> {
    for rule in grammar
        .rules
        .iter_mut()
        .filter(|r| r.symbol == grammar.axiom)
    {
        rule.successors.sort_by(|a, b| a.id.cmp(&b.id));
    }
    grammar_json::to_string(&grammar).unwrap().into_bytes()
}

/// The bytes of a grammar in which all buildings have one identifier.
fn nameless(grammar: &InstanceGrammar) -> Vec<u8> {
    let mut grammar = grammar.clone();
    for placed in grammar.rules.iter_mut().flat_map(|r| &mut r.successors) {
        placed.id = placed.id.take().map(|_| String::new());
    }
    compact::to_bytes(&grammar).unwrap()
}

#[test]
fn the_order_of_buildings_is_no_matter() {
    for (case, noise) in [0.0, 0.03].into_iter().enumerate() {
        let (mut city, _) = synthetic::city(4 + 3 * case, noise, case as u64);
        let mut empty = city.buildings[4].clone();
        (empty.id, empty.mesh) = ("empty".to_owned(), Default::default());
        city.buildings.push(empty);
        for (mode, twins) in [
            (Mode::Best, false),
            (Mode::Best, true),
            (Mode::Paper, false),
        ] {
            let mut city = city.clone();
            if twins {
                // The same building twice at one place: only its identifiers may change places.
                let mut twin = city.buildings[3].clone();
                twin.id = "twin".to_owned();
                city.buildings.push(twin);
            }
            let asked = settings(mode, Budget::Level(2));
            let whole = grammar(&city, &asked);
            for shuffle in 0..2 {
                let mut other = city.clone();
                other.buildings.shuffle(&mut stream(7, "order", shuffle));
                let found = grammar(&other, &asked);
                match twins {
                    true => assert!(nameless(&found) == nameless(&whole), "{noise}"),
                    false => assert!(bytes(found) == bytes(whole.clone()), "{noise} {mode:?}"),
                }
            }
        }
    }
}

#[test]
fn threads_do_not_change_few_bytes() {
    let (city, _) = synthetic::city(8, 0.03, 8);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let asked = Settings {
            precision: Some(Precision::Decimetre),
            ..settings(Mode::Best, Budget::Level(3))
        };
        pool.install(|| compact::to_bytes(&grammar(&city, &asked)).unwrap())
    };
    let one = run(1);
    assert!(one == run(2) && one == run(8));
}
