//! A country in tiles: the bytes do not depend on workers, kills lose nothing, the dictionary is the one that was meant, and all
//! tiles together are the city.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use edifice::io::city::earth::geodetic;
use edifice::io::city::{cityjson, compact, obj};
use edifice::rng::stream;
use edifice_generators_city_proceduralization as synthetic;
use rand::RngExt;
use serde_json::Value;

fn edifice(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("edifice"));
    command.arg("city").args(args).current_dir(folder);
    command
}

/// Runs a command; what it printed last, as JSON.
fn line(folder: &Path, args: &[&str]) -> Value {
    let output = edifice(folder, args).arg("--json").output().unwrap();
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {messages}");
    let text = String::from_utf8(output.stdout).unwrap();
    serde_json::from_str(text.lines().last().unwrap()).unwrap()
}

/// Runs a command that fails; its messages.
fn refused(folder: &Path, args: &[&str]) -> String {
    let output = edifice(folder, args).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{args:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// A folder with a made city of 96 buildings, `c.obj`.
fn made() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let (city, _) = synthetic::city(16, 0.05, 3);
    std::fs::write(folder.path().join("c.obj"), obj::to_string(&city)).unwrap();
    folder
}

/// Plans the city in tiles; the folder of the results.
fn plan(folder: &Path, out: &str) -> PathBuf {
    let args = ["plan", "c.obj", "--tile", "150", "--level", "2", "--scenes"];
    let planned = line(folder, &[&args[..], &["-o", out]].concat());
    assert_eq!(planned["buildings"], 96);
    assert!(planned["tiles"].as_u64().unwrap() >= 4, "{planned}");
    let key = planned["key"].as_str().unwrap();
    folder.join(out).join(format!("city-{key}"))
}

/// All files below a folder, by their paths in it.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let (mut open, mut found) = (vec![folder.to_path_buf()], BTreeMap::new());
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => open.push(path),
                false => {
                    let bytes = std::fs::read(&path).unwrap();
                    found.insert(path.strip_prefix(folder).unwrap().to_path_buf(), bytes);
                }
            }
        }
    }
    found
}

#[test]
fn tiles_over_one_dictionary_are_the_city_whoever_made_them() {
    let made = made();
    let folder = made.path();
    let alone = plan(folder, "alone");
    let worked = line(folder, &["work", "alone"]);
    assert_eq!(worked["finished"], worked["tasks"]);
    let one = files(&alone);

    // Several workers, of which one is killed in its first task.
    let together = plan(folder, "together");
    let mut killed = edifice(folder, &["work", "together", "--threads", "1"])
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let work = together.with_file_name(
        together
            .file_name()
            .unwrap()
            .to_string_lossy()
            .replacen("city", "work", 1),
    );
    let start = Instant::now();
    let claimed = || {
        work.join("claims")
            .read_dir()
            .is_ok_and(|mut found| found.next().is_some())
    };
    while !claimed() {
        assert!(
            start.elapsed() < Duration::from_secs(20),
            "no task was claimed"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    line(folder, &["work", "together", "--workers", "3"]);
    assert_eq!(files(&together), one);
    let again = line(folder, &["work", "together"]);
    assert_eq!(again["finished"], 0);

    let compared = line(folder, &["compare", "c.obj", alone.to_str().unwrap()]);
    assert_eq!(compared["buildings"][1], 96);
    assert_eq!(compared["bytes"][1], worked["bytes"]);
    assert!(compared["iou"].as_f64().unwrap() > 0.9, "{compared}");

    // 3D Tiles of all tiles hang below one root, which holds them.
    let index: Value = serde_json::from_slice(&one[Path::new("3dtiles/tileset.json")]).unwrap();
    let children = index["root"]["children"].as_array().unwrap();
    let grammars = one
        .keys()
        .filter(|name| name.extension().is_some_and(|e| e == "bin"));
    assert_eq!(children.len() + 1, grammars.count());
    for child in children {
        let uri = Path::new("3dtiles").join(child["content"]["uri"].as_str().unwrap());
        assert!(one.contains_key(&uri), "{uri:?}");
    }

    // Another dictionary is refused, and so is none.
    let tile = one
        .keys()
        .find(|name| name.starts_with("x0_y0.city-grammar.bin"))
        .unwrap();
    let tile = alone.join(tile);
    let dictionary = alone.join("dictionary.city-grammar.bin");
    let other = edifice(folder, &["proceduralize", "c.obj", "--level", "6", "-o"])
        .arg(&dictionary)
        .output()
        .unwrap();
    assert!(other.status.success());
    let messages = refused(folder, &["show", tile.to_str().unwrap()]);
    assert!(messages.contains("SHA-256"), "{messages}");
    std::fs::remove_file(&dictionary).unwrap();
    let messages = refused(folder, &["show", tile.to_str().unwrap()]);
    assert!(
        messages.contains("dictionary.city-grammar.bin"),
        "{messages}"
    );
}

#[test]
fn a_country_of_a_known_system_stands_on_the_earth_within_its_region() {
    let folder = tempfile::tempdir().unwrap();
    let (mut city, _) = synthetic::city(16, 0.05, 3);
    city.origin = [85_000.0, 446_000.0, 0.0];
    city.reference_system = Some("EPSG:28992".to_owned());
    std::fs::write(
        folder.path().join("c.city.json"),
        cityjson::to_string(&city),
    )
    .unwrap();
    let args = [
        "plan",
        "c.city.json",
        "--tile",
        "150",
        "--level",
        "2",
        "--scenes",
        "-o",
        "out",
    ];
    let key = line(folder.path(), &args)["key"]
        .as_str()
        .unwrap()
        .to_owned();
    line(folder.path(), &["work", "out"]);
    let tiles = folder.path().join(format!("out/city-{key}/3dtiles"));
    let index = std::fs::read(tiles.join("tileset.json")).unwrap();
    let index: Value = serde_json::from_slice(&index).unwrap();
    let numbers = |v: &Value| serde_json::from_value::<Vec<f64>>(v.clone()).unwrap();
    let r = numbers(&index["root"]["boundingVolume"]["region"]);
    // Latitude and longitude of Delft, in radians; a city 400 m wide is a ten thousandth of them.
    assert!(
        (r[0] - 0.0763).abs() < 2e-4 && (r[1] - 0.9076).abs() < 2e-4,
        "{r:?}"
    );
    for child in index["root"]["children"].as_array().unwrap() {
        let (m, cube) = (
            numbers(&child["transform"]),
            numbers(&child["boundingVolume"]["box"]),
        );
        for corner in 0..8 {
            let p = [0, 1, 2]
                .map(|k| cube[k] + cube[3 + 4 * k] * if corner >> k & 1 == 1 { 1.0 } else { -1.0 });
            let [x, y, z] = geodetic(
                [0, 1, 2].map(|i| (0..3).map(|k| m[4 * k + i] * p[k]).sum::<f64>() + m[12 + i]),
            );
            assert!(
                (r[0]..=r[2]).contains(&x) && (r[1]..=r[3]).contains(&y),
                "{r:?} {x} {y}"
            );
            assert!((r[4]..=r[5]).contains(&z), "{r:?} {z}");
        }
    }
    // Read again it is upright, and has all buildings at their heights.
    let read = edifice::io::city::read(&tiles.join("tileset.json")).unwrap();
    let name = files(tiles.parent().unwrap()).into_keys().find(|name| {
        let name = name.to_string_lossy();
        name.ends_with(".bin") && !name.starts_with("dictionary")
    });
    let tile = tiles.parent().unwrap().join(name.unwrap());
    let grammar = compact::read(&tile).unwrap();
    let derived = grammar.derive().unwrap().city(&grammar);
    assert_eq!(read.buildings.len(), city.buildings.len());
    for building in &derived.buildings {
        let same = read.buildings.iter().find(|b| b.id == building.id).unwrap();
        let [a, b] = [same, building].map(|b| b.mesh.bounds().unwrap());
        let heights = [a, b].map(|(low, high)| high[2] - low[2]);
        assert!((heights[0] - heights[1]).abs() < 0.05, "{heights:?}");
    }
}

#[test]
fn a_building_in_two_tiles_and_a_changed_tile_are_refused() {
    let made = made();
    let folder = made.path();
    std::fs::copy(folder.join("c.obj"), folder.join("d.obj")).unwrap();
    let messages = refused(folder, &["plan", "c.obj", "d.obj", "-o", "twice"]);
    assert!(
        messages.contains("d.obj") && messages.contains("belongs to one tile"),
        "{messages}"
    );
    line(folder, &["plan", "d.obj", "-o", "one"]);
    let mut text = std::fs::read_to_string(folder.join("d.obj")).unwrap();
    text.push_str("# changed\n");
    std::fs::write(folder.join("d.obj"), text).unwrap();
    let messages = refused(folder, &["work", "one"]);
    assert!(
        messages.contains("d.obj") && messages.contains("has changed"),
        "{messages}"
    );
}

/// Meshes that are open and partly inside out, whose volumes may come out below 0, are work like any other.
#[test]
fn damaged_buildings_are_coded_too() {
    let folder = tempfile::tempdir().unwrap();
    let (mut city, _) = synthetic::city(16, 0.05, 3);
    let mut rng = stream(1, "tests/damaged", 0);
    for building in &mut city.buildings {
        building.mesh.triangles.retain(|_| rng.random_bool(0.6));
        for t in &mut building.mesh.triangles {
            if rng.random_bool(0.5) {
                t.swap(0, 1);
            }
        }
    }
    std::fs::write(folder.path().join("c.obj"), obj::to_string(&city)).unwrap();
    line(
        folder.path(),
        &["plan", "c.obj", "--level", "0", "-o", "out"],
    );
    line(folder.path(), &["work", "out", "--workers", "1"]);
}
