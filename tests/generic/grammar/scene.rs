//! The city of Fig. 15 and 16, and its file read back.

use edifice::grammar::{Grammar, combine, scaled};
use edifice::io::grammar_cga::from_str;
use edifice::io::scene_png::scene_png;
use edifice::io::{gltf, grammar_json};
use edifice::methods::facade_grammar::city::{City, Settings, city};
use edifice::scene::render::Camera;
use serde_json::Value;

fn grammars() -> Vec<Grammar> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar");
    let read =
        |name: &str| grammar_json::read(&folder.join(format!("layouts/{name}.grammar.json")));
    ["cottage_1", "townhouse_1", "shophouse_1"]
        .map(|n| read(n).unwrap())
        .to_vec()
}

fn small() -> City {
    let settings = Settings {
        buildings: 150,
        types: 8,
        ..Settings::default()
    };
    city(&grammars(), &settings, 3).unwrap()
}

fn count(value: &Value) -> usize {
    value.as_u64().unwrap() as usize
}

#[test]
fn the_file_reads_back_consistent() {
    let city = small();
    let bytes = gltf::to_bytes(&city.scene).unwrap();
    assert_eq!(&bytes[..4], b"glTF");
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((word(4), word(8)), (2, bytes.len()));
    let text_end = 20 + word(12);
    assert_eq!(&bytes[16..20], b"JSON");
    assert_eq!(&bytes[text_end + 4..text_end + 8], b"BIN\0");
    let binary = &bytes[text_end + 8..];
    assert_eq!(word(text_end), binary.len());
    let document: Value = serde_json::from_slice(&bytes[20..text_end]).unwrap();
    // The crate's own validation, on the document read back.
    let root: gltf_json::Root = serde_json::from_slice(&bytes[20..text_end]).unwrap();
    let mut faults = Vec::new();
    gltf_json::validation::Validate::validate(
        &root,
        &root,
        gltf_json::Path::new,
        &mut |path, e| {
            faults.push(format!("{}: {e:?}", path()));
        },
    );
    assert_eq!(faults, Vec::<String>::new());

    let views = document["bufferViews"].as_array().unwrap();
    let accessors = document["accessors"].as_array().unwrap();
    assert!(count(&document["buffers"][0]["byteLength"]) <= binary.len());
    // Bytes of an accessor, bounds checked.
    let data = |index: &Value, size: usize| {
        let accessor = &accessors[count(index)];
        let view = &views[count(&accessor["bufferView"])];
        let offset = accessor["byteOffset"].as_u64().unwrap_or(0) as usize;
        let length = count(&accessor["count"]) * size;
        assert!(offset + length <= count(&view["byteLength"]));
        assert_eq!(offset % if size == 2 { 2 } else { 4 }, 0);
        let start = view["byteOffset"].as_u64().unwrap_or(0) as usize + offset;
        &binary[start..start + length]
    };
    let mut triangles = Vec::new();
    for mesh in document["meshes"].as_array().unwrap() {
        let mut sum = 0;
        for primitive in mesh["primitives"].as_array().unwrap() {
            let position = &primitive["attributes"]["POSITION"];
            let floats: Vec<f32> = data(position, 12)
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes(b.try_into().unwrap()))
                .collect();
            for axis in [0usize, 1, 2] {
                let values = || floats.iter().skip(axis).step_by(3).copied();
                let limit =
                    |name: &str| accessors[count(position)][name][axis].as_f64().unwrap() as f32;
                assert_eq!(values().fold(f32::INFINITY, f32::min), limit("min"));
                assert_eq!(values().fold(f32::NEG_INFINITY, f32::max), limit("max"));
            }
            let indices = &primitive["indices"];
            let largest = match count(&accessors[count(indices)]["componentType"]) {
                5123 => data(indices, 2)
                    .chunks_exact(2)
                    .map(|b| u32::from(u16::from_le_bytes(b.try_into().unwrap())))
                    .max(),
                5125 => data(indices, 4)
                    .chunks_exact(4)
                    .map(|b| u32::from_le_bytes(b.try_into().unwrap()))
                    .max(),
                other => panic!("component type {other}"),
            };
            assert!((largest.unwrap() as usize) < floats.len() / 3);
            assert!(
                count(&primitive["material"]) < document["materials"].as_array().unwrap().len()
            );
            sum += count(&accessors[count(indices)]["count"]) / 3;
        }
        triangles.push(sum);
    }
    // Every node has one parent; the triangles shown are those that the city counts.
    let nodes = document["nodes"].as_array().unwrap();
    let roots = document["scenes"][0]["nodes"].as_array().unwrap();
    let children = |node: &Value| node["children"].as_array().cloned().unwrap_or_default();
    let mut seen: Vec<usize> = roots.iter().map(count).collect();
    seen.extend(nodes.iter().flat_map(children).map(|c| count(&c)));
    seen.sort_unstable();
    assert_eq!(seen, (0..nodes.len()).collect::<Vec<_>>());
    let meshes = nodes.iter().filter_map(|n| n["mesh"].as_u64());
    let shown: u64 = meshes.map(|m| triangles[m as usize] as u64).sum();
    assert_eq!(shown, city.triangles);
    assert_eq!(
        triangles.iter().sum::<usize>() as u64,
        city.stored_triangles
    );
    assert_eq!(city.buildings, 150);
    assert!(city.triangles > 20 * city.stored_triangles);
}

#[test]
fn same_seed_same_city() {
    assert_eq!(
        gltf::to_bytes(&small().scene).unwrap(),
        gltf::to_bytes(&small().scene).unwrap()
    );
}

#[test]
fn a_combined_grammar_makes_a_city() {
    let combined = combine(&grammars()).unwrap();
    let settings = Settings {
        buildings: 40,
        types: 6,
        ..Settings::default()
    };
    let city = city(&[combined], &settings, 1).unwrap();
    assert_eq!(city.buildings, 40);
}

#[test]
fn each_facade_of_a_joint_grammar_is_a_kind_of_building() {
    let text = "//@ unit \"m\"\n//@ facade One 10 x 12\n//@ facade Two 8 x 9\n\
                One --> split(y) { 3 : Floor | 9 : roof }\nTwo --> split(y) { 6 : stone | 3 : Floor }\n\
                Floor --> split(x) { { 1 : wall | 1 : window }* }";
    let settings = Settings {
        buildings: 10,
        types: 1,
        ..Settings::default()
    };
    let made = city(&[from_str(text).unwrap()], &settings, 1).unwrap();
    // A front and a side of each.
    assert_eq!(made.facades, 4);
}

#[test]
fn buildings_do_not_overlap() {
    let city = small();
    let boxes: Vec<[f32; 4]> = city.scene.groups[..city.buildings]
        .iter()
        .map(|group| {
            let mut bounds = [
                f32::INFINITY,
                f32::INFINITY,
                f32::NEG_INFINITY,
                f32::NEG_INFINITY,
            ];
            for wall in &group.instances[..4] {
                let [x, _, z] = group.place(wall.place([0.0; 3]));
                bounds = [
                    bounds[0].min(x),
                    bounds[1].min(z),
                    bounds[2].max(x),
                    bounds[3].max(z),
                ];
            }
            bounds
        })
        .collect();
    for (i, a) in boxes.iter().enumerate() {
        for b in &boxes[i + 1..] {
            let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
            assert!(apart, "{a:?} {b:?}");
        }
    }
}

#[test]
fn a_picture_shows_the_city() {
    let camera = Camera {
        eye: [-150.0, 60.0, 170.0],
        target: [0.0; 3],
        angle: 40.0,
    };
    let bytes = scene_png(&small().scene, &camera, 160, 90).unwrap();
    let picture = image::load_from_memory(&bytes).unwrap().to_rgb8();
    let colors: std::collections::BTreeSet<[u8; 3]> = picture.pixels().map(|p| p.0).collect();
    assert!(colors.len() > 500, "{}", colors.len());
}

#[test]
fn bad_scenes_are_refused() {
    let mut scene = small().scene;
    scene.meshes[0].positions[0][1] = f32::NAN;
    assert!(matches!(
        gltf::to_bytes(&scene),
        Err(gltf::GltfError::NotFinite { index: 0, .. })
    ));
    let mut scene = small().scene;
    scene.groups[0].instances[0].mesh = 10_000;
    assert!(matches!(
        gltf::to_bytes(&scene),
        Err(gltf::GltfError::Dangling { what: "mesh", .. })
    ));
    let mut scene = small().scene;
    scene.meshes[0].parts.clear();
    assert!(matches!(
        gltf::to_bytes(&scene),
        Err(gltf::GltfError::EmptyMesh { .. })
    ));
    assert!(city(&[], &Settings::default(), 0).is_err());
    let pixels = scaled(&from_str("//@ unit \"px\"\n//@ facade F 90 x 90\nF --> split(x) { { 30 : wall | 15 : window }* }").unwrap(), 1.0, "px");
    assert!(
        city(
            &[pixels],
            &Settings {
                buildings: 5,
                types: 2,
                height: 9.0
            },
            0
        )
        .is_ok()
    );
}
