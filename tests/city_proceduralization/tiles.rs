//! 3D Tiles: what a tile holds lies within its volume, wherever the city is; on the earth where the reference system is known.

use std::path::Path;

use edifice::grammar::instance::InstanceGrammar;
use edifice::io::city::{gltf, tiles};
use edifice::methods::city_proceduralization::{Budget, Mode, Settings, proceduralize};
use edifice::shape::triangles::{City, CityBuilding};
use edifice::unwatched;
use edifice_generators_city_proceduralization as synthetic;
use serde_json::Value;

/// Corners of compressed tiles are within so many metres of their places.
const NEAR: f64 = 0.06;

/// A made city elsewhere.
fn elsewhere(origin: [f64; 3], system: Option<&str>) -> City {
    let (mut city, _) = synthetic::city(6, 0.02, 1);
    city.origin = origin;
    city.reference_system = system.map(str::to_owned);
    city
}

fn grammar_of(city: &City) -> InstanceGrammar {
    let settings = Settings {
        mode: Mode::Best,
        budget: Budget::Templates(20),
        ..Settings::default()
    };
    proceduralize(city, &settings, &unwatched).unwrap().grammar
}

/// The tileset of a made city elsewhere, and its contents by name.
fn tileset(origin: [f64; 3], system: Option<&str>, compress: bool) -> (Value, Vec<(String, City)>) {
    let grammar = grammar_of(&elsewhere(origin, system));
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

/// `b` first, then `a`.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let sum = |i: usize| (0..4).map(|k| a[4 * k + i % 4] * b[i / 4 * 4 + k]).sum();
    (0..16).map(sum).collect()
}

/// A city of which every second building is 20 km farther to the east and the north: the earth is 63 m lower there than a plane.
#[test]
fn a_known_reference_system_puts_the_city_on_the_earth() {
    let mut city = elsewhere([85_000.0, 446_000.0, 0.0], Some("EPSG:7415"));
    for building in city.buildings.iter_mut().step_by(2) {
        for p in &mut building.mesh.positions {
            *p = [p[0] + 2e4, p[1] + 2e4, p[2]];
        }
    }
    let grammar = grammar_of(&city);
    let derivation = grammar.derive().unwrap();
    let mut settings = tiles::Settings::default();
    settings.most_instances = 20;
    let files = tiles::to_files(&grammar, &derivation, &settings).unwrap();
    let document: Value = serde_json::from_slice(&files.last().unwrap().1).unwrap();
    let unit: Vec<f64> = (0..16).map(|i| f64::from(u8::from(i % 5 == 0))).collect();
    let mut open = vec![(document["root"].clone(), unit, Vec::<Vec<f64>>::new())];
    let (mut contents, mut regions) = (0, 0);
    while let Some((tile, above, mut around)) = open.pop() {
        let own = match tile["transform"].is_array() {
            true => product(&above, &numbers(&tile["transform"])),
            false => above,
        };
        if tile["boundingVolume"]["region"].is_array() {
            around.push(numbers(&tile["boundingVolume"]["region"]));
            regions += 1;
        }
        if let Some(uri) = tile["content"]["uri"].as_str() {
            let bytes = &files.iter().find(|f| f.0 == uri).unwrap().1;
            let at = numbers(&tile["extras"]["at"]);
            for p in gltf::parse(bytes, Path::new(uri))
                .unwrap()
                .buildings
                .iter()
                .flat_map(|b| &b.mesh.positions)
            {
                let place =
                    |i: usize| (0..3).map(|k| own[4 * k + i] * p[k]).sum::<f64>() + own[12 + i];
                let [x, y, z] = edifice::io::city::earth::geodetic([0, 1, 2].map(place));
                // Above the ellipsoid as it is above zero in its system, and near Delft.
                // A content that others replace is off by its error at most.
                let near = tile["geometricError"].as_f64().unwrap().max(0.03);
                assert!((z - at[2] - p[2]).abs() < near, "{z} {at:?} {p:?}");
                assert!((x - 0.076).abs() < 0.006 && (y - 0.906).abs() < 0.006);
                for r in &around {
                    assert!(
                        (r[0]..=r[2]).contains(&x) && (r[1]..=r[3]).contains(&y),
                        "{r:?}"
                    );
                    assert!((r[4]..=r[5]).contains(&z), "{r:?} {z}");
                }
            }
            contents += 1;
        }
        let children = tile["children"].as_array().cloned().unwrap_or_default();
        open.extend(
            children
                .into_iter()
                .map(|c| (c, own.clone(), around.clone())),
        );
    }
    assert_eq!(contents, files.len() - 1);
    assert!(regions > 3);
    let error = &document["root"]["geometricError"];
    assert!((16.0..40.0).contains(&error.as_f64().unwrap()), "{error}");
}

/// The city of a tileset in a folder, and what its grammar derives.
fn written_and_read(system: Option<&str>, compress: bool, is_of_others: bool) -> (City, City) {
    let grammar = grammar_of(&elsewhere([85_000.0, 446_000.0, 10.0], system));
    let mut settings = tiles::Settings::default();
    settings.most_instances = 20;
    settings.compress = compress;
    let derivation = grammar.derive().unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in tiles::to_files(&grammar, &derivation, &settings).unwrap() {
        let bytes = match is_of_others && name == "tileset.json" {
            true => String::from_utf8(bytes)
                .unwrap()
                .replace("\"at\"", "\"other\"")
                .into_bytes(),
            false => bytes,
        };
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let read = edifice::io::city::read(&folder.path().join("tileset.json")).unwrap();
    (derivation.city(&grammar), read)
}

#[test]
fn a_tileset_is_read_as_the_city_it_was() {
    for (system, compress, near) in [
        (None, false, 2e-3),
        (None, true, NEAR),
        (Some("EPSG:28992"), false, 2e-3),
    ] {
        let (city, read) = written_and_read(system, compress, false);
        assert_eq!((read.origin, &read.name), (city.origin, &city.name));
        assert_eq!(read.reference_system.as_deref(), system);
        assert_eq!(read.buildings.len(), city.buildings.len());
        for ours in &city.buildings {
            let theirs = read.buildings.iter().find(|b| b.id == ours.id).unwrap();
            let [(a, b), (c, d)] = [ours, theirs].map(|b| b.mesh.bounds().unwrap());
            let apart = (0..3).map(|k| (a[k] - c[k]).abs().max((b[k] - d[k]).abs()));
            assert!(apart.fold(0.0, f64::max) < near, "{}", ours.id);
        }
    }
}

/// As others write it, without saying where in its reference system it is.
#[test]
fn a_tileset_on_the_earth_is_read_upright() {
    let (city, read) = written_and_read(Some("EPSG:28992"), false, true);
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
