//! 3D Tiles: what a tile holds lies within its volume, wherever the city is; on the earth where the reference system is known.

use std::path::Path;

use edifice::io::city::{gltf, tiles};
use edifice::methods::city_proceduralization::{Budget, Mode, Settings, proceduralize};
use edifice::shape::triangles::City;
use edifice::unwatched;
use edifice_generators::city_proceduralization as synthetic;
use serde_json::Value;

/// Corners of compressed tiles are within so many metres of their places.
const NEAR: f64 = 0.06;

/// The tileset of a made city elsewhere, and its contents by name.
fn tileset(origin: [f64; 3], system: Option<&str>, compress: bool) -> (Value, Vec<(String, City)>) {
    let (mut city, _) = synthetic::city(6, 0.02, 1);
    city.origin = origin;
    city.reference_system = system.map(str::to_owned);
    let settings = Settings {
        mode: Mode::Best,
        budget: Budget::Templates(20),
        ..Settings::default()
    };
    let grammar = proceduralize(&city, &settings, &unwatched).unwrap().grammar;
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
