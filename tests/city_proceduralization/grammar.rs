//! Cities as grammars: fixed points, order, threads, dirty meshes, recovery, formats and bad input.

use std::path::Path;

use edifice::cluster::adjusted_rand_index;
use edifice::grammar::instance::{
    InstanceGrammar, InstanceGrammarError, InstanceRule, Placement, Template,
};
use edifice::io::city::{cityjson, glb, grammar_json, npz, obj};
use edifice::methods::city_proceduralization::{
    Budget, Mode, Precision, Settings, Structure, decompose, proceduralize,
};
use edifice::shape::triangles::{City, CityBuilding, TriangleMesh, VolumeRaster};
use edifice::unwatched;
use edifice_experiments::city_proceduralization::synthetic;

fn settings(mode: Mode, budget: Budget) -> Settings {
    Settings {
        mode,
        budget,
        ..Settings::default()
    }
}

fn derived(city: &City, settings: &Settings) -> (City, InstanceGrammar) {
    let made = proceduralize(city, settings, &unwatched).unwrap();
    (
        made.grammar.derive().unwrap().city(&made.grammar),
        made.grammar,
    )
}

fn iou(a: &City, b: &City) -> f64 {
    let [a, b]: [Vec<&TriangleMesh>; 2] =
        [a, b].map(|c| c.buildings.iter().map(|b| &b.mesh).collect());
    VolumeRaster { size: 0.5 }.compare(&a, &b).iou()
}

#[test]
fn deriving_what_was_made_gives_the_city_back() {
    let (city, _) = synthetic::city(12, 0.02, 1);
    let (first, _) = derived(&city, &settings(Mode::Best, Budget::All));
    assert!(iou(&city, &first) > 0.995, "{}", iou(&city, &first));
    // And once more: a fixed point.
    let (second, _) = derived(&first, &settings(Mode::Best, Budget::All));
    assert!(iou(&first, &second) > 0.995, "{}", iou(&first, &second));
    let ids = |c: &City| c.buildings.iter().map(|b| b.id.clone()).collect::<Vec<_>>();
    assert_eq!(ids(&city), ids(&second));
    let (paper, _) = derived(&city, &settings(Mode::Paper, Budget::Level(0)));
    assert!(iou(&city, &paper) > 0.97, "{}", iou(&city, &paper));
}

#[test]
fn more_templates_are_no_worse_and_best_beats_paper() {
    let (city, _) = synthetic::city(20, 0.03, 2);
    let mut last = 0.0;
    for k in [3, 12, 48, 120] {
        let best = iou(
            &city,
            &derived(&city, &settings(Mode::Best, Budget::Templates(k))).0,
        );
        let paper = iou(
            &city,
            &derived(&city, &settings(Mode::Paper, Budget::Templates(k))).0,
        );
        assert!(best >= last - 0.005, "{k}: {best} after {last}");
        assert!(best > paper, "{k}: {best} {paper}");
        last = best;
    }
}

#[test]
fn threads_do_not_matter() {
    let (city, _) = synthetic::city(10, 0.03, 3);
    for mode in [Mode::Best, Mode::Paper] {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let made = pool.install(|| {
                proceduralize(&city, &settings(mode, Budget::Level(2)), &unwatched).unwrap()
            });
            grammar_json::to_string(&made.grammar).unwrap()
        };
        let one = run(1);
        assert!(one == run(2) && one == run(8), "{mode:?}");
    }
}

#[test]
fn the_order_of_buildings_changes_no_volume() {
    let (city, _) = synthetic::city(10, 0.03, 4);
    let mut other = city.clone();
    other.buildings.reverse();
    let run = |c: &City| derived(c, &settings(Mode::Best, Budget::Level(2))).0;
    let (a, b) = (run(&city), run(&other));
    let (x, y) = (iou(&city, &a), iou(&city, &b));
    assert!((x - y).abs() < 0.005, "{x} {y}");
}

#[test]
fn inverted_opened_and_doubled_meshes_cost_little() {
    let (city, _) = synthetic::city(10, 0.02, 5);
    let s = settings(Mode::Best, Budget::Level(2));
    let clean = iou(&city, &derived(&city, &s).0);
    let dirty = |change: &dyn Fn(&mut TriangleMesh)| {
        let mut copy = city.clone();
        copy.buildings.iter_mut().for_each(|b| change(&mut b.mesh));
        iou(&city, &derived(&copy, &s).0)
    };
    let open = |m: &mut TriangleMesh| {
        // Without its bottom.
        let low = m.bounds().unwrap().0[2];
        let positions = m.positions.clone();
        m.triangles
            .retain(|t| t.iter().any(|&i| positions[i as usize][2] > low + 0.1));
    };
    let double = |m: &mut TriangleMesh| m.append(&m.clone());
    for (name, found) in [
        ("inverted", dirty(&TriangleMesh::flip)),
        ("opened", dirty(&open)),
        ("doubled", dirty(&double)),
    ] {
        assert!((found - clean).abs() < 0.005, "{name}: {found} {clean}");
    }
}

#[test]
fn cuts_of_a_known_grammar_are_found() {
    let (city, truth) = synthetic::city(40, 0.0, 6);
    let made = decompose(&city, true, &unwatched);
    let mut wrong = 0;
    for (b, t) in truth.iter().enumerate() {
        let own = made.components.iter().filter(|c| c.building == b).skip(1);
        let found: Vec<f64> = own.map(|c| c.frame.base[2]).collect();
        let close = found.len() == t.cuts.len()
            && found.iter().zip(&t.cuts).all(|(a, b)| (a - b).abs() < 0.01);
        wrong += usize::from(!close);
    }
    assert_eq!(wrong, 0, "of {}", truth.len());
}

#[test]
fn types_and_motifs_of_a_known_grammar_are_found() {
    for (noise, least) in [(0.0, 0.99), (0.03, 0.95)] {
        let (city, truth) = synthetic::city(160, noise, 9);
        let made =
            proceduralize(&city, &settings(Mode::Best, Budget::Level(4)), &unwatched).unwrap();
        let Structure::Patterns {
            buildings,
            patterns,
        } = &made.structure
        else {
            panic!("no patterns");
        };
        let found: Vec<usize> = buildings.labels.iter().map(|l| l.unwrap()).collect();
        let kinds: Vec<usize> = truth.iter().map(|t| t.kind).collect();
        let agreement = adjusted_rand_index(&found, &kinds);
        assert!(agreement >= least, "noise {noise}: {agreement}");
        if noise == 0.0 {
            // Each motif is one rule of its six types, as often as the city has it.
            let mut motifs: Vec<Vec<usize>> = Vec::new();
            for p in patterns {
                let kind = |l: usize| kinds[found.iter().position(|&f| f == l).unwrap()];
                let mut own: Vec<usize> = p.members.iter().map(|m| kind(m.kind)).collect();
                own.sort_unstable();
                let count = kinds.iter().filter(|&&k| k == own[0]).count();
                assert_eq!(p.count, count);
                motifs.push(own);
            }
            motifs.sort();
            let expected: Vec<Vec<usize>> = (0..synthetic::MOTIFS)
                .map(|m| (6 * m..6 * m + 6).collect())
                .collect();
            assert_eq!(motifs, expected);
        }
    }
}

#[test]
fn parts_of_another_template_are_placed() {
    let mut grammar = by_hand();
    let mut other = grammar.templates[0].clone();
    other.symbol = "T2".to_owned();
    grammar.templates.push(other);
    let part = grammar.rules[0].successors[1].parts[0].as_mut().unwrap();
    part.symbol = "T2".to_owned();
    assert_eq!(grammar.derive().unwrap().instances[2].template, 1);
    // But not of a rule.
    let part = grammar.rules[0].successors[1].parts[0].as_mut().unwrap();
    part.symbol = "H".to_owned();
    let error = grammar.derive().unwrap_err();
    assert!(
        matches!(error, InstanceGrammarError::Part { .. }),
        "{error}"
    );
}

/// A grammar by hand: a block, and a house of two blocks of which one instance lacks the second.
fn by_hand() -> InstanceGrammar {
    let mut block = TriangleMesh::default();
    block.push([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 1.0]]);
    let rule = |symbol: &str, successors| InstanceRule::new(symbol, 1.0, successors);
    let two = vec![
        Placement::new("T1", [0.0; 3], 0.0, [4.0, 2.0, 3.0]),
        Placement::new("T1", [1.0, 0.0, 3.0], 90.0, [2.0; 3]),
    ];
    let mut house = Placement::new("H", [10.0, 0.0, 0.0], 90.0, [2.0; 3]);
    house.id = Some("a \"b\"".to_owned());
    house.attributes.insert("year".to_owned(), 1931.into());
    let mut half = Placement::new("H", [0.0; 3], 0.0, [1.0; 3]);
    half.parts = vec![
        Some(Placement::new("T1", [5.0, 0.0, 0.0], 0.0, [1.0; 3])),
        None,
    ];
    InstanceGrammar {
        name: "by hand".to_owned(),
        reference_system: Some("EPSG:7415".to_owned()),
        origin: [1e5, 2.5e5, 0.0],
        axiom: "City".to_owned(),
        templates: vec![Template {
            symbol: "T1".to_owned(),
            mesh: block,
            texture: None,
        }],
        rules: vec![rule("City", vec![house, half]), rule("H", two)],
    }
}

#[test]
fn a_grammar_by_hand_derives_as_computed() {
    let derivation = by_hand().derive().unwrap();
    assert_eq!((derivation.instances.len(), derivation.depth), (3, 2));
    let second = &derivation.instances[1];
    // Scaled by 2, turned by 90 degrees, shifted by 10.
    let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12);
    assert!(close(second.at, [10.0, 2.0, 6.0]), "{:?}", second.at);
    assert!(close(second.size, [4.0; 3]) && second.turn == 180.0);
    assert_eq!(derivation.instances[2].at, [5.0, 0.0, 0.0]);
    assert_eq!(derivation.instances[2].building, None);
}

#[test]
fn grammars_are_read_as_written() {
    let path: &Path = "g.city-grammar.json".as_ref();
    let grammar = by_hand();
    let text = grammar_json::to_string(&grammar).unwrap();
    assert_eq!(grammar_json::parse(text.as_bytes(), path).unwrap(), grammar);
    let (city, _) = synthetic::city(6, 0.02, 7);
    for mode in [Mode::Best, Mode::Paper] {
        let (_, grammar) = derived(&city, &settings(mode, Budget::Level(2)));
        let text = grammar_json::to_string(&grammar).unwrap();
        let again = grammar_json::parse(text.as_bytes(), path).unwrap();
        assert_eq!(grammar_json::to_string(&again).unwrap(), text);
    }
}

#[test]
fn unsound_grammars_are_refused() {
    let fault = |change: &dyn Fn(&mut InstanceGrammar)| {
        let mut grammar = by_hand();
        change(&mut grammar);
        grammar.derive().unwrap_err()
    };
    let cyclic = fault(&|g| {
        g.rules[1].successors[0] = Placement::new("City", [0.0; 3], 0.0, [1.0; 3]);
    });
    assert!(
        matches!(cyclic, InstanceGrammarError::Cyclic(_)),
        "{cyclic}"
    );
    let unknown = fault(&|g| g.rules[1].successors[0].symbol = "X".to_owned());
    assert!(
        unknown.to_string().contains("rules[1].successors[0]"),
        "{unknown}"
    );
    let number = fault(&|g| g.rules[0].successors[0].turn = f64::NAN);
    assert!(
        matches!(number, InstanceGrammarError::Number { .. }),
        "{number}"
    );
    let shear = fault(&|g| g.rules[0].successors[0].size = [1.0, 2.0, 1.0]);
    assert!(
        matches!(shear, InstanceGrammarError::Number { .. }),
        "{shear}"
    );
    let parts = fault(&|g| g.rules[0].successors[1].parts.push(None));
    assert!(
        matches!(parts, InstanceGrammarError::Parts { .. }),
        "{parts}"
    );
    let index = fault(&|g| g.templates[0].mesh.triangles[0][0] = 9);
    assert!(
        matches!(index, InstanceGrammarError::Dangling { .. }),
        "{index}"
    );
    let axiom = fault(&|g| g.axiom = "T1".to_owned());
    assert!(matches!(axiom, InstanceGrammarError::NoAxiom(_)), "{axiom}");
}

#[test]
fn obj_and_cityjson_carry_the_city() {
    let (city, _) = synthetic::city(4, 0.0, 8);
    let from_obj = obj::parse(obj::to_string(&city).as_bytes(), "c.obj".as_ref()).unwrap();
    let text = cityjson::to_string(&city);
    let from_json = cityjson::parse(text.as_bytes(), "c.city.json".as_ref()).unwrap();
    for found in [from_obj, from_json] {
        assert!(iou(&city, &found) > 0.999);
        let mut ids: Vec<&str> = found.buildings.iter().map(|b| b.id.as_str()).collect();
        let mut own: Vec<&str> = city.buildings.iter().map(|b| b.id.as_str()).collect();
        ids.sort_unstable();
        own.sort_unstable();
        assert_eq!(ids, own);
    }
}

#[test]
fn bad_files_name_their_place() {
    let say = |text: &str, name: &str| {
        let path: &Path = name.as_ref();
        let error = match name.rsplit('.').next() {
            Some("obj") => obj::parse(text.as_bytes(), path).unwrap_err(),
            Some("npz") => npz::parse(text.as_bytes().to_vec(), path).unwrap_err(),
            _ => cityjson::parse(text.as_bytes(), path).unwrap_err(),
        };
        let message = error.to_string();
        assert!(message.starts_with(name), "{message}");
        message
    };
    assert!(say("v 0 0 nan", "a.obj").contains("line 1"));
    assert!(say("v 0 0 0\nf 1 2 1000000000", "a.obj").contains("line 2"));
    assert!(say("v 0 0 0\nf 1 1", "a.obj").contains("fewer than 3"));
    say("PK\u{3}\u{4} not an archive", "a.npz");
    say("", "a.npz");
    say("{", "a.json");
    let head = r#"{"type":"CityJSON","version":"2.0","vertices":[[0,0,0]],"CityObjects":{"b":"#;
    let dangling = r#"{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,0,7]]]}]}}}"#;
    assert!(say(&format!("{head}{dangling}"), "a.json").contains("CityObjects.b"));
    let orphan = r#"{"type":"BuildingPart","parents":["c"]}}}"#;
    assert!(say(&format!("{head}{orphan}"), "a.json").contains("does not exist"));
}

#[test]
fn gltf_instances_are_those_of_the_derivation() {
    let grammar = by_hand();
    let derivation = grammar.derive().unwrap();
    for instancing in [true, false] {
        let bytes = glb::to_bytes(&grammar, &derivation, instancing).unwrap();
        let length = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], length(8)), (b"glTF".as_slice(), bytes.len()));
        let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length(12)]).unwrap();
        let binary = &bytes[20 + length(12) + 8..];
        assert_eq!(json["scenes"][0]["extras"]["origin"][1], 2.5e5);
        let nodes = json["nodes"].as_array().unwrap();
        if !instancing {
            // And the origin's.
            assert_eq!(nodes.len(), 4);
            assert_eq!(nodes[3]["translation"][2], -2.5e5);
            assert!(json["extensionsRequired"].is_null());
            continue;
        }
        assert_eq!(json["extensionsRequired"][0], "EXT_mesh_gpu_instancing");
        let attributes = &nodes[0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        let accessor = &json["accessors"][attributes["TRANSLATION"].as_u64().unwrap() as usize];
        assert_eq!(accessor["count"], 3);
        let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let offset = view["byteOffset"].as_u64().unwrap() as usize;
        for (i, instance) in derivation.instances.iter().enumerate() {
            let float = |k: usize| {
                let at = offset + 12 * i + 4 * k;
                f32::from_le_bytes(binary[at..at + 4].try_into().unwrap())
            };
            let [x, y, z] = instance.at.map(|v| v as f32);
            assert_eq!([float(0), float(1), float(2)], [x, z, -y]);
        }
    }
}

#[test]
fn a_file_of_instances_becomes_the_grammar_it_was_derived_from() {
    let folder = tempfile::tempdir().unwrap();
    let large = [
        (15, Budget::Level(4)),
        (15, Budget::Level(1)),
        (15, Budget::Templates(5)),
        (15, Budget::All),
    ];
    let small = (0..60).map(|i| (2 + i % 3, Budget::Level(i as u32 % 4)));
    for (seed, (motifs, budget)) in large.into_iter().chain(small).enumerate() {
        let (city, _) = synthetic::city(motifs, 0.04, seed as u64);
        let asked = Settings {
            precision: [None, Some(Precision::Decimetre)][seed % 2],
            ..settings(Mode::Best, budget)
        };
        let (_, mut grammar) = derived(&city, &asked);
        let instancing = seed % 3 > 0;
        let mut last: Option<Vec<u8>> = None;
        for round in 0..3 {
            let derivation = grammar.derive().unwrap();
            let bytes = glb::to_bytes(&grammar, &derivation, instancing).unwrap();
            if let Some(last) = &last {
                assert!(*last == bytes, "seed {seed}, round {round}, {instancing}");
            }
            let path = folder.path().join("city.glb");
            std::fs::write(&path, &bytes).unwrap();
            let read = edifice::io::city::read(&path).unwrap();
            grammar = derived(&read, &asked).1;
            last = Some(bytes);
        }
    }
}

#[test]
fn parts_that_are_not_all_of_a_building_are_not_believed() {
    let (city, _) = synthetic::city(3, 0.0, 1);
    let (mut derived, _) = derived(&city, &settings(Mode::Best, Budget::All));
    assert!(derived.buildings.iter().all(|b| b.stated_parts().is_some()));
    let more = derived.buildings[1].mesh.clone();
    derived.buildings[0].mesh.append(&more);
    assert!(derived.buildings[0].stated_parts().is_none());
    // A template that reaches out of its box has no box.
    let mesh = derived.buildings[1].mesh.clone();
    let mut frame = derived.buildings[1].parts[0].frame;
    frame.size[2] *= 0.5;
    let mut building = CityBuilding::default();
    building.append_instance(&mesh, 0, Some(frame), None);
    assert!(building.stated_parts().is_none());
    assert_eq!(building.mesh.triangles, mesh.triangles);
    let components = decompose(&derived, true, &unwatched).components;
    let stated = |b: usize| {
        let mut own = components.iter().filter(move |c| c.building == b);
        own.all(|c| c.stated.is_some())
    };
    assert!(!stated(0) && stated(1));
}
