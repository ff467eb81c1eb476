//! Small glTF, with `EXT_meshopt_compression` and `KHR_mesh_quantization`: every building comes back within the limit, damaged
//! files are refused.

use std::path::Path;

use edifice::grammar::instance::{InstanceDerivation, InstanceGrammar, Template, TemplateInstance};
use edifice::io::city::{glb, glb_compressed, gltf, grammar_file};
use edifice::methods::city_proceduralization::{Budget, Mode, Settings, proceduralize};
use edifice::rng::{Stream, stream};
use edifice::shape::triangles::{City, CityBuilding, TriangleMesh};
use edifice::unwatched;
use edifice_generators_city_proceduralization as synthetic;
use rand::RngExt;
use serde_json::Map;

/// Corners are so near to their places, in metres.
const NEAR: f64 = 0.05;

fn made(blocks: usize, budget: Budget) -> InstanceGrammar {
    let (city, _) = synthetic::city(blocks, 0.02, 1);
    let settings = Settings {
        mode: Mode::Best,
        budget,
        ..Settings::default()
    };
    proceduralize(&city, &settings, &unwatched).unwrap().grammar
}

fn shipped() -> InstanceGrammar {
    let path = "datasets/city_proceduralization/town.city-grammar.json";
    grammar_file::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// The largest distance of a corner of one building to the nearest corner of the other, both ways.
fn apart(a: &CityBuilding, b: &CityBuilding) -> f64 {
    let far = |p: &[f64; 3], q: &[f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>();
    let from = |a: &[[f64; 3]], b: &[[f64; 3]]| {
        let nearest = |p| b.iter().map(|q| far(p, q)).fold(f64::INFINITY, f64::min);
        a.iter().map(nearest).fold(0.0, f64::max).sqrt()
    };
    let [a, b] = [&a.mesh.positions, &b.mesh.positions];
    from(a, b).max(from(b, a))
}

#[test]
fn every_building_comes_back_within_the_limit() {
    for grammar in [
        made(6, Budget::Templates(20)),
        made(30, Budget::Level(2)),
        shipped(),
    ] {
        let derivation = grammar.derive().unwrap();
        let bytes = glb_compressed::to_bytes(&grammar, &derivation).unwrap();
        let plain = glb::to_bytes(&grammar, &derivation, true).unwrap();
        assert!(bytes.len() < plain.len(), "{} bytes", bytes.len());
        let city: City = derivation.city(&grammar);
        let read = gltf::parse(&bytes, Path::new("city.glb")).unwrap();
        assert_eq!(read.origin, city.origin);
        assert_eq!(read.buildings.len(), city.buildings.len());
        for ours in &city.buildings {
            let theirs = read.buildings.iter().find(|b| b.id == ours.id).unwrap();
            assert_eq!(ours.mesh.triangles.len(), theirs.mesh.triangles.len());
            let apart = apart(ours, theirs);
            assert!(apart <= NEAR * 3.0_f64.sqrt(), "{}: {apart}", ours.id);
        }
    }
}

#[test]
fn instances_of_many_kinds_are_drawn_out_and_those_of_few_are_not() {
    for (budget, instanced) in [(Budget::Templates(3), true), (Budget::All, false)] {
        let grammar = made(6, budget);
        let mut derivation = grammar.derive().unwrap();
        if instanced {
            // A hundred cities, each in the place of the last.
            let one = derivation.instances.clone();
            derivation.instances = (0..100).flat_map(|_| one.clone()).collect();
        }
        let bytes = glb_compressed::to_bytes(&grammar, &derivation).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert_eq!(text.contains("EXT_mesh_gpu_instancing"), instanced);
    }
}

#[test]
fn damaged_files_are_refused_and_none_aborts() {
    let grammar = made(6, Budget::Templates(20));
    let bytes = glb_compressed::to_bytes(&grammar, &grammar.derive().unwrap()).unwrap();
    let mut rng = stream(1, "damaged", 0);
    let (mut refused, mut read) = (0, 0);
    for _ in 0..3000 {
        let mut damaged = bytes.clone();
        for _ in 0..rng.random_range(1..4) {
            let at = rng.random_range(0..damaged.len());
            damaged[at] = rng.random();
        }
        match gltf::parse(&damaged, Path::new("city.glb")) {
            Ok(_) => read += 1,
            Err(e) => {
                assert!(!e.to_string().is_empty());
                refused += 1;
            }
        }
    }
    assert!(
        refused > 300 && read > 300,
        "{refused} refused, {read} read"
    );
}

#[test]
fn compression_that_promises_too_much_is_refused() {
    let grammar = made(6, Budget::Templates(20));
    let bytes = glb_compressed::to_bytes(&grammar, &grammar.derive().unwrap()).unwrap();
    let find = |text: &[u8], from: usize| {
        let places = bytes[from..].windows(text.len());
        from + places.into_iter().position(|w| w == text).unwrap()
    };
    let at = find(b"\"count\":", find(b"\"bufferViews\"", 0)) + 8;
    let digits = bytes[at..]
        .iter()
        .take_while(|b| b.is_ascii_digit())
        .count();
    let mut damaged = bytes.clone();
    damaged[at..at + digits].fill(b'9');
    let said = gltf::parse(&damaged, Path::new("city.glb")).map(|_| ());
    let said = said.unwrap_err().to_string();
    assert!(said.contains("bufferViews["), "{said}");
}

/// Of any length, empty and doubled ones among them, in any letters: each building has the one it had.
#[test]
fn random_identifiers_come_back() {
    let grammar = made(6, Budget::Templates(20));
    let mut rng = stream(3, "identifiers", 0);
    for case in 0..200 {
        let mut derivation = grammar.derive().unwrap();
        let length = rng.random_range(0..40);
        for (i, (id, _)) in derivation.buildings.iter_mut().enumerate() {
            *id = match case % 4 {
                0 => format!("{i:0length$}"),
                1 => format!("{}-{i}", "é".repeat(rng.random_range(0..length + 1))),
                2 => format!(
                    "NL.Pand.{}",
                    rng.random_range(10_u64.pow(15)..10_u64.pow(16))
                ),
                // One may be empty.
                _ => "名".repeat(i),
            };
        }
        let bytes = glb_compressed::to_bytes(&grammar, &derivation).unwrap();
        let read = gltf::parse(&bytes, Path::new("city.glb")).unwrap();
        let plain = glb::to_bytes(&grammar, &derivation, true).unwrap();
        let plain = gltf::parse(&plain, Path::new("city.glb")).unwrap();
        let ids = |c: &City| c.buildings.iter().map(|b| b.id.clone()).collect::<Vec<_>>();
        assert_eq!(ids(&read), ids(&plain), "{case}");
        let drawn = derivation.city(&grammar);
        for building in &drawn.buildings {
            let same = read.buildings.iter().find(|b| b.id == building.id).unwrap();
            assert!(apart(same, building) < NEAR, "{case} {}", building.id);
        }
    }
}

#[test]
fn empty_identifiers_leave_no_view_empty() {
    let grammar = made(6, Budget::Templates(20));
    let mut derivation = grammar.derive().unwrap();
    derivation.buildings.iter_mut().for_each(|b| b.0.clear());
    let bytes = glb_compressed::to_bytes(&grammar, &derivation).unwrap();
    assert!(!String::from_utf8_lossy(&bytes).contains("\"byteLength\":0,"));
    assert!(gltf::parse(&bytes, Path::new("city.glb")).is_ok());
}

/// Instances of random shapes and sizes, up to 300 m long and 6 km from the origin, flat ones and needles among them.
#[test]
fn random_instances_come_back_within_the_limit() {
    let mut rng = stream(2, "random instances", 0);
    let mut largest: f64 = 0.0;
    for _ in 0..40 {
        let templates: Vec<Template> = (0..6)
            .map(|t| Template {
                symbol: format!("T{t}"),
                mesh: TriangleMesh {
                    positions: (0..12)
                        .map(|_| {
                            let at = |rng: &mut Stream| rng.random_range(-0.5..0.5);
                            [at(&mut rng), at(&mut rng), at(&mut rng) + 0.5]
                        })
                        .collect(),
                    triangles: (0..10).map(|i| [i, i + 1, i + 2]).collect(),
                },
                texture: None,
            })
            .collect();
        let count = rng.random_range(1..400);
        let instances: Vec<TemplateInstance> = (0..count)
            .map(|b| TemplateInstance {
                template: rng.random_range(0..6),
                building: Some(b),
                at: [0, 1, 2].map(|k| rng.random_range(-1.0..1.0) * [6000.0, 6000.0, 100.0][k]),
                turn: rng.random_range(0.0..360.0),
                size: [0, 1, 2].map(|_| 0.05 * 6000.0_f64.powf(rng.random_range(0.0..1.0))),
            })
            .collect();
        let grammar = InstanceGrammar {
            name: "random".into(),
            reference_system: None,
            origin: [0.0; 3],
            axiom: "City".into(),
            templates,
            rules: Vec::new(),
        };
        let mut derivation = InstanceDerivation::default();
        derivation.buildings = (0..count).map(|b| (format!("b{b}"), Map::new())).collect();
        derivation.instances = instances;
        let bytes = glb_compressed::to_bytes(&grammar, &derivation).unwrap();
        let read = gltf::parse(&bytes, Path::new("city.glb")).unwrap();
        let city = derivation.city(&grammar);
        for (ours, theirs) in city.buildings.iter().zip(&read.buildings) {
            assert_eq!(ours.id, theirs.id);
            largest = largest.max(apart(ours, theirs));
        }
    }
    assert!(largest <= NEAR * 3.0_f64.sqrt(), "{largest}");
}
