//! `edifice city` from the command line: every command on a small city, and bad input, which ends with code 1, the file's
//! and the element's name, and nothing written.

use std::path::Path;

use assert_cmd::Command;
use edifice::io::city::obj;
use edifice_generators_city_proceduralization as synthetic;

/// Runs a command in `folder`; exit code, what it printed, and messages.
fn run(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("edifice").unwrap();
    let output = command
        .arg("city")
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let messages = text(output.stderr);
    assert!(!messages.contains("panicked"), "{messages}");
    (output.status.code().unwrap(), text(output.stdout), messages)
}

/// A folder with a made city and its grammar.
fn made() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let (city, _) = synthetic::city(16, 0.0, 3);
    std::fs::write(folder.path().join("c.obj"), obj::to_string(&city)).unwrap();
    let args = [
        "proceduralize",
        "c.obj",
        "-o",
        "g.city-grammar.json",
        "--json",
    ];
    let (code, out, messages) = run(folder.path(), &args);
    assert_eq!(code, 0, "{messages}");
    let summary: serde_json::Value = serde_json::from_str(out.lines().last().unwrap()).unwrap();
    assert_eq!(summary["buildings"], 96);
    assert!(summary["iou"].as_f64().unwrap() > 0.95, "{summary}");
    folder
}

const SHAPE: &str = r#"{"type":"Polygon","coordinates":[[[0,0],[400,0],[400,300],[0,300],[0,0]]]}"#;

#[test]
fn shapes_are_filled_and_views_are_found() {
    let folder = made();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("p.geojson"), SHAPE).unwrap();
    let fill = |seed: &str, out: &str| {
        let args = [
            "synthesize",
            "g.city-grammar.json",
            "--shape",
            "p.geojson",
            "--seed",
            seed,
            "-o",
            out,
        ];
        let (code, _, messages) = run(folder.path(), &args);
        assert_eq!(code, 0, "{messages}");
        std::fs::read(path(out)).unwrap()
    };
    let first = fill("1", "a.city-grammar.json");
    assert_eq!(first, fill("1", "b.city-grammar.json"));
    assert_ne!(first, fill("2", "b.city-grammar.json"));
    // What was made is a grammar of the same kind, inside the shape.
    let (code, _, messages) = run(
        folder.path(),
        &["derive", "a.city-grammar.json", "-o", "a.obj"],
    );
    assert_eq!(code, 0, "{messages}");
    let city = obj::parse(&std::fs::read(path("a.obj")).unwrap(), "a.obj".as_ref()).unwrap();
    assert!(city.buildings.len() > 20, "{}", city.buildings.len());
    for b in &city.buildings {
        for p in &b.mesh.positions {
            assert!(
                (-1.5..401.5).contains(&p[0]) && (-1.5..301.5).contains(&p[1]),
                "{p:?}"
            );
        }
    }
    let view = r#"{"format":"edifice/city-view","version":1,"unit":"m","buildings":[
        {"width":22,"depth":14,"height":15},{"width":25,"depth":13,"height":30,"solid":0.5}]}"#;
    std::fs::write(path("v.json"), view).unwrap();
    let args = [
        "locate",
        "g.city-grammar.json",
        "--view",
        "v.json",
        "--top",
        "3",
        "--json",
    ];
    let (code, out, messages) = run(folder.path(), &args);
    assert_eq!(code, 0, "{messages}");
    let costs: Vec<f64> = out
        .lines()
        .map(|l| {
            serde_json::from_str::<serde_json::Value>(l).unwrap()["cost"]
                .as_f64()
                .unwrap()
        })
        .collect();
    assert_eq!(costs.len(), 3);
    assert!(costs.is_sorted(), "{costs:?}");
}

#[test]
fn tiles_hold_every_instance_once() {
    let folder = made();
    let args = [
        "tiles",
        "g.city-grammar.json",
        "-o",
        "t",
        "--instances",
        "40",
    ];
    let (code, _, messages) = run(folder.path(), &args);
    assert_eq!(code, 0, "{messages}");
    let read = |name: &str| std::fs::read(folder.path().join("t").join(name)).unwrap();
    let tileset: serde_json::Value = serde_json::from_slice(&read("tileset.json")).unwrap();
    assert_eq!(tileset["asset"]["version"], "1.1");
    let mut open = vec![tileset["root"].clone()];
    let (mut buildings, mut coarse) = (Vec::new(), 0);
    while let Some(tile) = open.pop() {
        let children = tile["children"].as_array().cloned().unwrap_or_default();
        let error = |t: &serde_json::Value| t["geometricError"].as_f64().unwrap();
        assert!(children.iter().all(|c| error(c) <= error(&tile)));
        assert!(tile["boundingVolume"]["box"].as_array().unwrap().len() == 12);
        // Boxes, which the tiles below replace.
        let is_coarse = !children.is_empty();
        open.extend(children);
        let Some(uri) = tile["content"]["uri"].as_str() else {
            continue;
        };
        if is_coarse {
            assert_eq!(tile["refine"], "REPLACE");
            assert!(error(&tile) > 0.0);
            coarse += 1;
            continue;
        }
        let bytes = read(uri);
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        let ids = json["scenes"][0]["extras"]["buildings"].as_array().unwrap();
        buildings.extend(ids.iter().map(|id| id.as_str().unwrap().to_owned()));
    }
    buildings.sort();
    let count = buildings.len();
    buildings.dedup();
    assert_eq!((buildings.len(), count, coarse), (96, 96, 1));
}

#[test]
fn bad_input_names_file_and_element_and_writes_nothing() {
    let folder = made();
    let path = |name: &str| folder.path().join(name);
    let whole = std::fs::read_to_string(path("g.city-grammar.json")).unwrap();
    let files = [
        ("empty.obj", String::new(), ""),
        ("nan.obj", "v 0 0 nan\nf 1 1 1\n".to_owned(), "line 1"),
        (
            "far.obj",
            "v 0 0 0\nf 1 2 1000000000\n".to_owned(),
            "line 2",
        ),
        (
            "degrees.obj",
            "v 4.35 52.01 0\nv 4.36 52.01 0\nv 4.36 52.02 9\nf 1 2 3\n".to_owned(),
            "degrees",
        ),
        (
            "cut.city.json",
            r#"{"type":"CityJSON","version"#.to_owned(),
            "line 1",
        ),
        ("cut.npz", "PK\u{3}\u{4}".to_owned(), ""),
        ("what.xyz", "1 2 3".to_owned(), "unknown city format"),
    ];
    for (name, text, place) in files {
        std::fs::write(path(name), text).unwrap();
        let args = [
            "proceduralize",
            name,
            "-o",
            "out.city-grammar.json",
            "--glb",
            "out.glb",
        ];
        let (code, _, messages) = run(folder.path(), &args);
        assert_eq!(code, 1, "{name}: {messages}");
        assert!(
            messages.contains(name) && messages.contains(place),
            "{messages}"
        );
    }
    let cyclic = whole.replacen(
        "\"successors\":[",
        "\"successors\":[{\"symbol\":\"City\"},",
        1,
    );
    let grammars = [
        ("cyclic", cyclic, "\"City\" contains itself"),
        ("half", whole[..whole.len() / 2].to_owned(), "line"),
        (
            "version",
            whole.replacen("\"version\": 2", "\"version\": 7", 1),
            "version",
        ),
        (
            "symbol",
            whole.replacen("\"symbol\":\"B", "\"symbol\":\"Q", 1),
            "unknown symbol \"B",
        ),
        (
            "size",
            whole.replacen("\"size\":[", "\"size\":[-", 1),
            "size",
        ),
    ];
    for (name, text, place) in grammars {
        assert_ne!(text, whole, "{name}: nothing was changed");
        let name = format!("{name}.city-grammar.json");
        std::fs::write(path(&name), text).unwrap();
        for args in [
            ["derive", &name, "-o", "out.glb"],
            ["tiles", &name, "-o", "out-tiles"],
        ] {
            let (code, _, messages) = run(folder.path(), &args);
            assert_eq!(code, 1, "{name}: {messages}");
            assert!(
                messages.contains(&name) && messages.contains(place),
                "{messages}"
            );
        }
    }
    for name in ["out.city-grammar.json", "out.glb", "out-tiles"] {
        assert!(!path(name).exists(), "{name}");
    }
    // No temporary files either.
    let rest = std::fs::read_dir(folder.path()).unwrap();
    let hidden = rest.filter(|e| {
        e.as_ref()
            .unwrap()
            .file_name()
            .to_string_lossy()
            .starts_with('.')
    });
    assert_eq!(hidden.count(), 0);
}
