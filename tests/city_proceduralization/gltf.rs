//! Cities read from glTF: what we write comes back, with and without instancing; transforms, strips, quantized positions,
//! buffers beside and inside the file; broken files are refused by place.

use std::path::Path;

use edifice::io::city::{glb, gltf, read};
use edifice::methods::city_proceduralization::{Budget, Mode, Settings, proceduralize};
use edifice::rng::stream;
use edifice::shape::triangles::City;
use edifice::unwatched;
use edifice_generators_city_proceduralization as synthetic;
use rand::RngExt;
use serde_json::json;

/// A small city as its grammar derives it, and as binary glTF.
fn written(instancing: bool) -> (City, Vec<u8>) {
    let (city, _) = synthetic::city(6, 0.02, 1);
    let settings = Settings {
        mode: Mode::Best,
        budget: Budget::Templates(20),
        ..Settings::default()
    };
    let grammar = proceduralize(&city, &settings, &unwatched).unwrap().grammar;
    let derivation = grammar.derive().unwrap();
    let bytes = glb::to_bytes(&grammar, &derivation, instancing).unwrap();
    (derivation.city(&grammar), bytes)
}

#[test]
fn what_is_written_comes_back() {
    for instancing in [true, false] {
        let (city, bytes) = written(instancing);
        let read = gltf::parse(&bytes, Path::new("city.glb")).unwrap();
        assert_eq!(read.origin, city.origin);
        let sorted = |c: &City| {
            let mut all: Vec<(String, usize, f64, [[f64; 3]; 2])> = c
                .buildings
                .iter()
                .map(|b| {
                    let (low, high) = b.mesh.bounds().unwrap();
                    let volume = b.mesh.volume_above(low[2]);
                    (b.id.clone(), b.mesh.triangles.len(), volume, [low, high])
                })
                .collect();
            all.sort_by(|a, b| a.0.cmp(&b.0));
            all
        };
        let (ours, theirs) = (sorted(&city), sorted(&read));
        assert_eq!(ours.len(), theirs.len());
        for (a, b) in ours.iter().zip(&theirs) {
            assert_eq!((&a.0, a.1), (&b.0, b.1));
            // Single precision in the file.
            assert!((a.2 - b.2).abs() < 1e-3 * a.2.abs().max(1.0), "{a:?} {b:?}");
            let (a, b) = (a.3.as_flattened(), b.3.as_flattened());
            assert!(
                a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-3),
                "{a:?} {b:?}"
            );
        }
    }
}

/// A glTF text with one buffer of bytes and what follows.
fn document(bytes: usize, uri: &str, rest: serde_json::Value) -> String {
    let mut document = json!({ "asset": { "version": "2.0" },
        "buffers": [ { "byteLength": bytes, "uri": uri } ],
        "scenes": [ { "nodes": [0] } ] });
    for (key, value) in rest.as_object().unwrap() {
        document[key] = value.clone();
    }
    document.to_string()
}

/// A unit tetrahedron-like strip of four points: two triangles.
fn points() -> Vec<u8> {
    let points: [f32; 12] = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 5.0, 0.0, 4.0, 5.0, 0.0];
    points.iter().flat_map(|v| v.to_le_bytes()).collect()
}

fn strip() -> serde_json::Value {
    json!({
        "bufferViews": [ { "buffer": 0, "byteLength": 48 } ],
        "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" } ],
        "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 }, "mode": 5 } ] } ],
        "nodes": [ { "children": [1], "translation": [10.0, 0.0, 0.0] },
                   { "mesh": 0, "name": "wall", "scale": [2.0, 2.0, 2.0], "extras": { "use": "shop" },
                     "rotation": [0.0, 1.0, 0.0, 0.0] } ] })
}

#[test]
fn transforms_strips_and_files_beside() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wall.gltf");
    std::fs::write(folder.path().join("wall.bin"), points()).unwrap();
    std::fs::write(&path, document(48, "wall.bin", strip())).unwrap();
    let city = read(&path).unwrap();
    let wall = &city.buildings[0];
    assert_eq!((wall.id.as_str(), wall.mesh.triangles.len()), ("wall", 2));
    assert_eq!(wall.attributes["use"], "shop");
    // Half a turn about y, twice as large, ten to the side; y up becomes z up.
    let (low, high) = wall.mesh.bounds().unwrap();
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(
        near(low, [2.0, 0.0, 0.0]) && near(high, [10.0, 0.0, 10.0]),
        "{low:?} {high:?}"
    );
    // The same inside the file.
    let data = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAQAAAAAAAAAAAAAAAAAAAoEAAAAAAAACAQAAAoEAAAAAA";
    let inside = gltf::parse(document(48, data, strip()).as_bytes(), &path).unwrap();
    assert_eq!(inside.buildings, city.buildings);
    // A name that leads out of the folder.
    for uri in ["../secret", "/etc/hostname"] {
        let error = gltf::parse(document(48, uri, strip()).as_bytes(), &path).unwrap_err();
        assert!(error.to_string().contains("outside the folder"), "{error}");
    }
}

#[test]
fn primitives_of_one_mesh_have_points_of_their_own() {
    // The same four points by two accessors: one primitive names its corners, one takes all.
    let data = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAQAAAAAAAAAAAAAAAAAAAoEAAAAAAAACAQAAAoEAAAAAA";
    let mut mesh = strip();
    let accessor = mesh["accessors"][0].clone();
    mesh["accessors"].as_array_mut().unwrap().push(accessor);
    let second = json!({ "attributes": { "POSITION": 1 }, "mode": 5 });
    let primitives = mesh["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(second);
    let city = gltf::parse(document(48, data, mesh).as_bytes(), Path::new("two.gltf")).unwrap();
    let wall = &city.buildings[0].mesh;
    assert_eq!((wall.positions.len(), wall.triangles.len()), (8, 4));
    let ends = |t: &[[u32; 3]]| {
        t.iter()
            .flatten()
            .copied()
            .min()
            .zip(t.iter().flatten().copied().max())
    };
    assert_eq!(ends(&wall.triangles[..2]), Some((0, 3)));
    assert_eq!(ends(&wall.triangles[2..]), Some((4, 7)));
}

#[test]
fn broken_files_are_refused_by_place() {
    let data = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAQAAAAAAAAAAAAAAAAAAAoEAAAAAAAACAQAAAoEAAAAAA";
    let complaint = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut rest = strip();
        change(&mut rest);
        let text = document(48, data, rest);
        gltf::parse(text.as_bytes(), Path::new("x.gltf"))
            .unwrap_err()
            .to_string()
    };
    let huge = 1_u64 << 62;
    for (complaint, expected) in [
        (
            complaint(&|d| d["accessors"][0]["count"] = json!(5)),
            "outside its view",
        ),
        (
            complaint(&|d| d["accessors"][0]["count"] = json!(huge)),
            "outside its view",
        ),
        (
            complaint(&|d| d["accessors"][0]["byteOffset"] = json!(huge)),
            "outside its view",
        ),
        (
            complaint(&|d| d["bufferViews"][0]["byteLength"] = json!(49)),
            "outside its buffer",
        ),
        (
            complaint(&|d| d["bufferViews"][0]["byteStride"] = json!(huge)),
            "outside its view",
        ),
        (
            complaint(&|d| d["accessors"][0]["type"] = json!("VEC2")),
            "VEC2",
        ),
        (
            complaint(&|d| d["accessors"][0]["componentType"] = json!(1)),
            "accessors[0]",
        ),
        (
            complaint(&|d| d["nodes"][1]["mesh"] = json!(7)),
            "meshes[7]",
        ),
        (
            complaint(&|d| d["nodes"][0]["children"] = json!([9])),
            "nodes[9]",
        ),
        (
            complaint(&|d| d["nodes"][1]["children"] = json!([0])),
            "circle",
        ),
        (complaint(&|d| d["scene"] = json!(3)), "scenes[3]"),
        (
            complaint(&|d| d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"])),
            "draco",
        ),
        (
            complaint(&|d| d["meshes"][0]["primitives"][0]["indices"] = json!(0)),
            "VEC3",
        ),
    ] {
        assert!(complaint.contains(expected), "{complaint}");
    }
    let long = document(4000, data, strip());
    let error = gltf::parse(long.as_bytes(), Path::new("x.gltf")).unwrap_err();
    assert!(error.to_string().contains("buffers[0]"), "{error}");
}

#[test]
fn changed_bytes_never_panic() {
    let (_, whole) = written(true);
    for cut in (0..whole.len()).step_by(whole.len() / 97) {
        let _ = gltf::parse(&whole[..cut], Path::new("x.glb"));
    }
    for case in 0..1500 {
        let mut rng = stream(5, "changed", case);
        let mut bytes = whole.clone();
        for _ in 0..rng.random_range(1..6) {
            let at = rng.random_range(0..bytes.len().min(6000));
            bytes[at] = rng.random();
        }
        let _ = gltf::parse(&bytes, Path::new("x.glb"));
    }
}
