//! Cities and their grammars through the formats: what is written is read back, what is wrong names its place.

use std::path::Path;

use edifice::io::city::{cityjson, glb, npz, obj};
use edifice::methods::city_proceduralization::{Budget, Mode, Precision, Settings, decompose};
use edifice::shape::triangles::CityBuilding;
use edifice::unwatched;
use edifice_generators_city_proceduralization as synthetic;

use crate::cases::cases;

use super::grammar::{by_hand, derived, iou, settings};

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
    let all = large.into_iter().chain(small).enumerate();
    // Every fifth, odd and even ones, or all.
    let step = if cases(2) < 2 { 5 } else { 1 };
    for (seed, (motifs, budget)) in all.step_by(step) {
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
