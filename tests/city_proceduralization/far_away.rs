//! Coordinates of a reference system, through the program and a reader of glTF that is not ours, come back to the millimetre; a
//! file without objects is split into buildings.

use std::path::Path;

use assert_cmd::Command;
use edifice::io::city::{obj, read};
use serde_json::Value;

/// Corners of the file's buildings: four sheared prisms far from the origin.
fn corners() -> Vec<[[f64; 3]; 8]> {
    let building = |b: usize| {
        let (x, y) = (
            391_234.567 + 31.25 * b as f64,
            5_820_123.456 + 7.125 * b as f64,
        );
        let (sin, cos) = (0.3 + 0.4 * b as f64).sin_cos();
        let (w, d, h) = (9.0 + b as f64, 7.0, 5.5 + 3.0 * b as f64);
        let plan = [[0.0, 0.0], [w, 0.0], [w, d], [0.0, d]];
        std::array::from_fn(|k| {
            let [u, v] = plan[k % 4];
            let z = if k < 4 { 34.0 } else { 34.0 + h };
            [x + u * cos - v * sin, y + u * sin + v * cos, z]
        })
    };
    (0..4).map(building).collect()
}

fn text(named: bool) -> String {
    shifted(named, [0.0; 2])
}

/// The file with its buildings elsewhere.
fn shifted(named: bool, [east, north]: [f64; 2]) -> String {
    let faces = [
        [1, 4, 3, 2],
        [5, 6, 7, 8],
        [1, 2, 6, 5],
        [2, 3, 7, 6],
        [3, 4, 8, 7],
        [4, 1, 5, 8],
    ];
    let mut out = String::new();
    for (b, corners) in corners().iter().enumerate() {
        if named {
            out += &format!("o house{b}\n");
        }
        for [x, y, z] in corners {
            let (x, y) = (x + east, y + north);
            out += &format!("v {x:.6} {y:.6} {z:.6}\n");
        }
        for face in faces {
            let [p, q, r, s] = face.map(|i| i + 8 * b);
            out += &format!("f {p} {q} {r} {s}\n");
        }
    }
    out + "l 1 2\n"
}

/// The 64-bit positions of a binary glTF, z up: nodes with translations, rotations and scales, and their instances.
fn positions(bytes: &[u8]) -> Vec<[f64; 3]> {
    let size = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let document: Value = serde_json::from_slice(&bytes[20..20 + size(12)]).unwrap();
    let binary = &bytes[28 + size(12)..];
    let floats = |accessor: &Value| -> Vec<f64> {
        let accessor = &document["accessors"][accessor.as_u64().unwrap() as usize];
        assert_eq!(accessor["componentType"], 5126);
        let view = &document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let start =
            view["byteOffset"].as_u64().unwrap_or(0) + accessor["byteOffset"].as_u64().unwrap_or(0);
        let width = match accessor["type"].as_str().unwrap() {
            "VEC3" => 3,
            "VEC4" => 4,
            other => panic!("{other}"),
        };
        let count = width * accessor["count"].as_u64().unwrap() as usize;
        let own = binary[start as usize..].chunks_exact(4).take(count);
        own.map(|c| f64::from(f32::from_le_bytes(c.try_into().unwrap())))
            .collect()
    };
    let numbers = |v: &Value, or: &[f64]| -> Vec<f64> {
        let list = v.as_array();
        list.map_or(or.to_vec(), |l| {
            l.iter().map(|v| v.as_f64().unwrap()).collect()
        })
    };
    // Scale, rotation by a quaternion, translation.
    let moved = |p: &[f64], t: &[f64], r: &[f64], s: &[f64]| -> Vec<f64> {
        let p: Vec<f64> = (0..3).map(|k| p[k] * s[k]).collect();
        let cross = |a: &[f64], b: &[f64]| {
            vec![
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        let once = cross(&r[..3], &p);
        let twice = cross(&r[..3], &once);
        (0..3)
            .map(|k| p[k] + 2.0 * (r[3] * once[k] + twice[k]) + t[k])
            .collect()
    };
    let zero = [0.0; 3];
    let (still, one) = ([0.0, 0.0, 0.0, 1.0], [1.0; 3]);
    let mut out = Vec::new();
    let roots = document["scenes"][0]["nodes"].as_array().unwrap();
    let mut open: Vec<(usize, Vec<f64>)> = roots
        .iter()
        .map(|n| (n.as_u64().unwrap() as usize, zero.to_vec()))
        .collect();
    while let Some((n, shift)) = open.pop() {
        let node = &document["nodes"][n];
        let t = numbers(&node["translation"], &zero);
        let (r, s) = (
            numbers(&node["rotation"], &still),
            numbers(&node["scale"], &one),
        );
        for child in node["children"].as_array().into_iter().flatten() {
            // Parents only shift.
            assert!(node["rotation"].is_null() && node["scale"].is_null());
            let all = (0..3).map(|k| shift[k] + t[k]).collect();
            open.push((child.as_u64().unwrap() as usize, all));
        }
        let Some(mesh) = node["mesh"].as_u64() else {
            continue;
        };
        let instances = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        let of = |name: &str| (!instances[name].is_null()).then(|| floats(&instances[name]));
        let (ts, rs, ss) = (of("TRANSLATION"), of("ROTATION"), of("SCALE"));
        let count = ts.as_ref().map_or(1, |t| t.len() / 3);
        let part = |list: &Option<Vec<f64>>, i: usize, or: &[f64]| match list {
            Some(list) => list[i * or.len()..(i + 1) * or.len()].to_vec(),
            None => or.to_vec(),
        };
        for primitive in document["meshes"][mesh as usize]["primitives"]
            .as_array()
            .unwrap()
        {
            for p in floats(&primitive["attributes"]["POSITION"]).chunks_exact(3) {
                for i in 0..count {
                    let p = moved(
                        p,
                        &part(&ts, i, &zero),
                        &part(&rs, i, &still),
                        &part(&ss, i, &one),
                    );
                    let p = moved(&p, &t, &r, &s);
                    let [x, y, z] = [0, 1, 2].map(|k| p[k] + shift[k]);
                    out.push([x, -z, y]);
                }
            }
        }
    }
    out
}

#[test]
fn metres_of_a_reference_system_come_back_to_the_millimetre() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("c.obj"), text(true)).unwrap();
    let args = ["city", "proceduralize", "c.obj", "--templates", "all"];
    Command::cargo_bin("edifice")
        .unwrap()
        .args(args)
        .args(["-o", "g.city-grammar.json", "--glb", "c.glb"])
        .current_dir(folder.path())
        .assert()
        .success();
    let found = positions(&std::fs::read(folder.path().join("c.glb")).unwrap());
    for corner in corners().iter().flatten() {
        let away = |p: &[f64; 3]| {
            (0..3)
                .map(|k| (p[k] - corner[k]).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let nearest = found.iter().map(away).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-3, "{corner:?} is {nearest} m from its nearest");
    }
}

#[test]
fn a_file_without_objects_is_split_into_buildings() {
    let path = Path::new("heap.obj");
    let named = obj::parse(text(true).as_bytes(), path).unwrap();
    let heap = obj::parse(text(false).as_bytes(), path).unwrap();
    assert_eq!(heap.buildings.len(), 4);
    for (a, b) in named.buildings.iter().zip(&heap.buildings) {
        assert_eq!(a.mesh, b.mesh);
    }
    assert_eq!(heap.buildings[2].id, "heap-3");
    assert!(heap.notes.iter().any(|n| n.contains("split into 4")));
    assert!(heap.notes.iter().any(|n| n.starts_with("1 lines left out")));
    // Each face with corners of its own, and a chimney on the first roof.
    let mut lines = String::new();
    let mut count = 0;
    let mut put = |t: [[f64; 3]; 3]| {
        for [x, y, z] in t {
            lines += &format!("v {x} {y} {z}\n");
        }
        lines += &format!("f {} {} {}\n", count + 1, count + 2, count + 3);
        count += 3;
    };
    for building in &named.buildings {
        building.mesh.corners().for_each(&mut put);
    }
    let first = &named.buildings[0].mesh;
    let (low, high) = first.bounds().unwrap();
    let middle = [0, 1].map(|k| (low[k] + high[k]) / 2.0);
    let small = |t: [[f64; 3]; 3]| {
        t.map(|p| {
            let [x, y] = [0, 1].map(|k| middle[k] + 0.1 * (p[k] - middle[k]));
            [x, y, high[2] + 0.2 * (p[2] - low[2])]
        })
    };
    first.corners().map(small).for_each(&mut put);
    let soup = obj::parse(lines.as_bytes(), path).unwrap();
    let sizes: Vec<usize> = soup
        .buildings
        .iter()
        .map(|b| b.mesh.triangles.len())
        .collect();
    assert_eq!(sizes, [24, 12, 12, 12]);
    // One building is not cut, and has the file's name.
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("alone.obj");
    let lines: Vec<String> = text(false).lines().take(14).map(str::to_owned).collect();
    std::fs::write(&alone, lines.join("\n")).unwrap();
    let alone = read(&alone).unwrap();
    assert_eq!(
        (alone.buildings.len(), alone.buildings[0].id.as_str()),
        (1, "alone")
    );
}

#[test]
fn a_picture_is_the_same_wherever_the_city_stands() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |shift: [f64; 2]| -> Vec<f64> {
        std::fs::write(folder.path().join("c.obj"), shifted(true, shift)).unwrap();
        Command::cargo_bin("edifice")
            .unwrap()
            .args(["city", "draw", "c.obj", "--size", "240x180", "-o", "c.png"])
            .current_dir(folder.path())
            .assert()
            .success();
        let picture = image::open(folder.path().join("c.png")).unwrap().to_luma8();
        picture.into_raw().into_iter().map(f64::from).collect()
    };
    let spread = |grey: &[f64]| {
        let n = grey.len() as f64;
        let mean = grey.iter().sum::<f64>() / n;
        (grey.iter().map(|g| (g - mean).powi(2)).sum::<f64>() / n).sqrt()
    };
    let here = drawn([-391_234.0, -5_820_123.0]);
    assert!(spread(&here) >= 10.0, "{}", spread(&here));
    let there = drawn([1e7, 1e7]);
    let apart: f64 = here.iter().zip(&there).map(|(a, b)| (a - b).abs()).sum();
    let apart = apart / here.len() as f64;
    assert!(apart < 0.5, "{apart}");
    assert!((spread(&here) - spread(&there)).abs() < 0.5);
}

#[test]
fn a_building_far_from_the_others_does_not_hold_up_a_synthesis() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("c.obj"), text(true)).unwrap();
    let run = |args: &[&str]| {
        let mut command = Command::cargo_bin("edifice").unwrap();
        command.args(["city"]).args(args).current_dir(folder.path());
        command.timeout(std::time::Duration::from_secs(60)).assert()
    };
    run(&["proceduralize", "c.obj", "-o", "g.city-grammar.json"]).success();
    let read = || std::fs::read_to_string(folder.path().join("g.city-grammar.json")).unwrap();
    let mut grammar: Value = serde_json::from_str(&read()).unwrap();
    let wide = "0,0,1e7,0,1e7,60,0,60";
    let asked = [
        "synthesize",
        "g.city-grammar.json",
        "--polygon",
        wide,
        "-o",
        "s.obj",
    ];
    let asked = run(&asked).failure();
    let said = String::from_utf8_lossy(&asked.get_output().stderr);
    assert!(said.contains("10000000 m wide"), "{said}");
    let polygon = "0,0,60,0,60,60,0,60";
    for (far, done) in [(9e8, true), (-1e18, false), (1e308, false)] {
        let rules = grammar["rules"].as_array_mut().unwrap();
        let city = rules.iter_mut().find(|r| r["symbol"] == "City").unwrap();
        city["successors"][1]["at"] = serde_json::json!([far, 0.0, 0.0]);
        std::fs::write(
            folder.path().join("far.city-grammar.json"),
            grammar.to_string(),
        )
        .unwrap();
        let asked = run(&[
            "synthesize",
            "far.city-grammar.json",
            "--polygon",
            polygon,
            "-o",
            "s.obj",
        ]);
        if done {
            asked.success();
        } else {
            let asked = asked.failure();
            let said = String::from_utf8_lossy(&asked.get_output().stderr);
            assert!(said.contains("is to be copied"), "{said}");
        }
    }
}
