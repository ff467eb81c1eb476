//! 3D Tiles: what a tile holds lies within its volume, wherever the city is; on the earth where the reference system is known.

use std::path::Path;

use edifice::grammar::instance::InstanceGrammar;
use edifice::io::city::{gltf, tiles};
use edifice::methods::city_proceduralization::{Budget, Mode, Settings, proceduralize};
use edifice::shape::triangles::{City, CityBuilding};
use edifice::unwatched;
use edifice_generators::city_proceduralization as synthetic;
use serde_json::Value;

/// Corners of compressed tiles are within so many metres of their places.
const NEAR: f64 = 0.06;

/// The grammar of a made city elsewhere.
fn made(origin: [f64; 3], system: Option<&str>) -> InstanceGrammar {
    let (mut city, _) = synthetic::city(6, 0.02, 1);
    city.origin = origin;
    city.reference_system = system.map(str::to_owned);
    let settings = Settings {
        mode: Mode::Best,
        budget: Budget::Templates(20),
        ..Settings::default()
    };
    proceduralize(&city, &settings, &unwatched).unwrap().grammar
}

/// The tileset of a made city elsewhere, and its contents by name.
fn tileset(origin: [f64; 3], system: Option<&str>, compress: bool) -> (Value, Vec<(String, City)>) {
    let grammar = made(origin, system);
    let mut settings = tiles::Settings::default();
    settings.most_instances = 20;
    settings.compress = compress;
    let files = tiles::to_files(&grammar, &grammar.derive().unwrap(), &settings).unwrap();
    let (last, contents) = files.split_last().unwrap();
    let read = |(name, bytes): &(String, Vec<u8>)| {
        let text = String::from_utf8_lossy(bytes);
        assert!(text.contains("NORMAL") && !text.contains("origin_node"));
        (name.clone(), gltf::parse(bytes, Path::new(name)).unwrap())
    };
    let document = serde_json::from_slice(&last.1).unwrap();
    (document, contents.iter().map(read).collect())
}

fn numbers(value: &Value) -> Vec<f64> {
    serde_json::from_value(value.clone()).unwrap()
}

#[test]
fn contents_lie_within_their_volumes() {
    let far = [85_000.0, 446_000.0, 10.0];
    for (origin, compress) in [([0.0; 3], false), (far, false), (far, true)] {
        let (tileset, contents) = tileset(origin, None, compress);
        assert!(contents.len() > 2);
        let mut open = vec![tileset["root"].clone()];
        let mut seen = 0;
        while let Some(tile) = open.pop() {
            let children = tile["children"].as_array().cloned().unwrap_or_default();
            let error = |t: &Value| t["geometricError"].as_f64().unwrap();
            assert!(children.iter().all(|c| error(c) <= error(&tile)));
            open.extend(children);
            let Some(uri) = tile["content"]["uri"].as_str() else {
                continue;
            };
            let cube = numbers(&tile["boundingVolume"]["box"]);
            let content = &contents.iter().find(|c| c.0 == uri).unwrap().1;
            let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            for p in content.buildings.iter().flat_map(|b| &b.mesh.positions) {
                for k in 0..3 {
                    low[k] = low[k].min(p[k]);
                    high[k] = high[k].max(p[k]);
                }
            }
            for k in 0..3 {
                let half = cube[3 + 4 * k];
                assert!(
                    (low[k] - (cube[k] - half)).abs() < NEAR,
                    "{uri} {low:?} {cube:?}"
                );
                assert!(
                    (high[k] - (cube[k] + half)).abs() < NEAR,
                    "{uri} {high:?} {cube:?}"
                );
            }
            seen += 1;
        }
        assert_eq!(seen, contents.len());
    }
}

#[test]
fn a_known_reference_system_puts_the_city_on_the_earth() {
    let (tileset, _) = tileset([85_000.0, 446_000.0, 0.0], Some("EPSG:7415"), false);
    let root = &tileset["root"];
    let transform = numbers(&root["transform"]);
    let from_centre = transform[12..15].iter().map(|v| v * v).sum::<f64>().sqrt();
    // Delft is 52 degrees north.
    assert!((6.36e6..6.37e6).contains(&from_centre), "{from_centre}");
    let latitude = (transform[14] / from_centre).asin().to_degrees();
    assert!((51.7..51.9).contains(&latitude), "{latitude}");
    assert_eq!(root["children"].as_array().unwrap().len(), 1);
}

/// The city of a tileset in a folder, and what its grammar derives.
fn written_and_read(system: Option<&str>, compress: bool) -> (City, City) {
    let grammar = made([85_000.0, 446_000.0, 10.0], system);
    let mut settings = tiles::Settings::default();
    settings.most_instances = 20;
    settings.compress = compress;
    let derivation = grammar.derive().unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in tiles::to_files(&grammar, &derivation, &settings).unwrap() {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let read = edifice::io::city::read(&folder.path().join("tileset.json")).unwrap();
    (derivation.city(&grammar), read)
}

#[test]
fn a_tileset_is_read_as_the_city_it_was() {
    for (compress, near) in [(false, 2e-3), (true, NEAR)] {
        let (city, read) = written_and_read(None, compress);
        assert_eq!((read.origin, &read.name), (city.origin, &city.name));
        assert_eq!(read.buildings.len(), city.buildings.len());
        for ours in &city.buildings {
            let theirs = read.buildings.iter().find(|b| b.id == ours.id).unwrap();
            let [(a, b), (c, d)] = [ours, theirs].map(|b| b.mesh.bounds().unwrap());
            let apart = (0..3).map(|k| (a[k] - c[k]).abs().max((b[k] - d[k]).abs()));
            assert!(apart.fold(0.0, f64::max) < near, "{}", ours.id);
        }
    }
}

#[test]
fn a_tileset_on_the_earth_is_read_upright() {
    let (city, read) = written_and_read(Some("EPSG:28992"), false);
    assert_eq!(read.reference_system, None);
    let height = |c: &City, id: &str| {
        let building = c.buildings.iter().find(|b| b.id == id).unwrap();
        let (low, high) = building.mesh.bounds().unwrap();
        high[2] - low[2]
    };
    let own = |b: &CityBuilding| {
        let (low, _) = b.mesh.bounds().unwrap();
        b.mesh.volume_above(low[2])
    };
    let volume = |c: &City| c.buildings.iter().map(own).sum::<f64>();
    for building in &city.buildings {
        let [ours, theirs] = [&city, &read].map(|c| height(c, &building.id));
        assert!((ours - theirs).abs() < 0.05, "{ours} {theirs}");
    }
    let [ours, theirs] = [&city, &read].map(volume);
    assert!((ours / theirs - 1.0).abs() < 1e-5, "{ours} {theirs}");
}

#[test]
fn tiles_of_others_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    // A plate of two triangles, 4 by 5 m, standing up in glTF's axes.
    let plate = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"wall"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":48}],"buffers":[{"byteLength":48,
        "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAQAAAAAAAAAAAAAAAAAAAoEAAAAAAAACAQAAAoEAAAAAA"}]}"#;
    write("plate.gltf", plate.as_bytes());
    let table = br#"{"BATCH_LENGTH":0,"RTC_CENTER":[100,0,0]}   "#;
    let mut batched = b"b3dm".to_vec();
    let length = 28 + table.len() + plate.len();
    for word in [1, length, table.len(), 0, 0, 0] {
        batched.extend((word as u32).to_le_bytes());
    }
    batched.extend(table);
    batched.extend(plate.as_bytes());
    write("old.b3dm", &batched);
    let tile = |content: &str| {
        format!(
            r#"{{"boundingVolume":{{"sphere":[0,0,0,9]}},"geometricError":0,"content":{{"uri":"{content}"}}}}"#
        )
    };
    let inner = format!(
        r#"{{"asset":{{"version":"1.0"}},"geometricError":9,"root":{}}}"#,
        tile("old.b3dm")
    );
    write("inner.json", inner.as_bytes());
    let outer = format!(
        r#"{{"asset":{{"version":"1.0"}},"geometricError":9,"root":{{"boundingVolume":{{"sphere":[0,0,0,9]}},"geometricError":9,"refine":"REPLACE",
        "content":{{"uri":"missing.glb"}},"transform":[1,0,0,0,0,1,0,0,0,0,1,0,0,7,0,1],"children":[{},{},{}]}}}}"#,
        tile("plate.gltf"),
        tile("inner.json"),
        tile("cloud.pnts")
    );
    write("tileset.json", outer.as_bytes());
    let path = folder.path().join("tileset.json");
    let city = edifice::io::city::read(&path).unwrap();
    let ids: Vec<&str> = city.buildings.iter().map(|b| b.id.as_str()).collect();
    assert_eq!(ids, ["plate/wall", "old/wall"]);
    let bounds = |i: usize| city.buildings[i].mesh.bounds().unwrap();
    assert_eq!(bounds(0), ([0.0, 7.0, 0.0], [4.0, 7.0, 5.0]));
    assert_eq!(bounds(1), ([100.0, 7.0, 0.0], [104.0, 7.0, 5.0]));
    assert_eq!(city.notes, ["left out: 1 tiles that are not read"]);
    for (content, said) in [
        ("../plate.gltf", "lies outside"),
        ("tileset.json", "deep"),
        ("none.glb", "none.glb"),
    ] {
        write(
            "tileset.json",
            format!(r#"{{"asset":{{}},"root":{}}}"#, tile(content)).as_bytes(),
        );
        let error = edifice::io::city::read(&path).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains(said), "{error}");
    }
}
