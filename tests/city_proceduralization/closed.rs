//! Derived cities have no more triangles than their input, and closed buildings stay closed: judged on what is written and read
//! again.

use std::path::Path;

use edifice::io::city::{glb, gltf};
use edifice::methods::city_proceduralization::{Budget, Settings, proceduralize};
use edifice::shape::triangles::{City, repair};
use edifice::unwatched;
use edifice_experiments::city_proceduralization::synthetic;

fn closed(city: &City) -> usize {
    let open = city.buildings.iter().map(|b| repair(&b.mesh).1.open_edges);
    open.filter(|&n| n == 0).count()
}

#[test]
fn derived_cities_stay_closed_and_have_no_more_triangles() {
    let (city, _) = synthetic::city(30, 0.03, 9);
    for level in [2, 4] {
        let settings = Settings {
            budget: Budget::Level(level),
            ..Settings::default()
        };
        let grammar = proceduralize(&city, &settings, &unwatched).unwrap().grammar;
        for grammar in [&grammar, &grammar.rules_only()] {
            let bytes = glb::to_bytes(grammar, &grammar.derive().unwrap(), true).unwrap();
            let derived = gltf::parse(&bytes, Path::new("city.glb")).unwrap();
            let (ours, theirs) = (derived.triangles(), city.triangles());
            let (kept, all) = (closed(&derived), closed(&city));
            println!("level {level}: {ours} triangles of {theirs}, {kept} closed of {all}");
            assert!(ours <= theirs, "{ours} {theirs}");
            assert!(kept * 100 >= all * 99, "{kept} {all}");
        }
    }
}
