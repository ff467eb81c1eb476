//! `edifice building from-facades` from end to end.

use std::path::Path;

use assert_cmd::Command;
use edifice::io::building_json;
use edifice::shape::{ElementStyle, Side};

fn edifice(args: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command.args(["building", "from-facades"]).args(args);
    command.assert()
}

#[test]
fn the_command_writes_a_house_and_says_what_was_placed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_string_lossy().into_owned();
    let datasets = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets");
    let path = |name: &str| datasets.join(name).to_string_lossy().into_owned();
    let (front, right, lot) = (
        path("examples/front.facade.json"),
        path("examples/right.facade.json"),
        path("examples/lot.geojson"),
    );
    let scaled = [
        "--front",
        &front,
        "--right",
        &right,
        "--footprint",
        &lot,
        "--height",
        "6",
        "-o",
        &out,
        "--json",
        "--format",
        "json,png",
    ];
    let run = || edifice(&scaled).success().get_output().stdout.clone();
    let line: serde_json::Value = serde_json::from_slice(&run()).unwrap();
    let bytes = std::fs::read(folder.path().join("front.building.json")).unwrap();
    assert_eq!(
        line,
        serde_json::from_slice::<serde_json::Value>(&run()).unwrap()
    );
    assert_eq!(
        bytes,
        std::fs::read(folder.path().join("front.building.json")).unwrap()
    );
    let report = std::fs::read_to_string(folder.path().join("front.report.json")).unwrap();
    assert_eq!(report.trim(), line.to_string());
    let told = line["elements"].as_array().unwrap();
    let left_out = told.iter().filter(|e| e["off"].is_null());
    assert_eq!(told.len(), 14);
    assert!(
        left_out
            .clone()
            .all(|e| e["label"] == "balcony" && e["reason"].is_string())
    );
    assert_eq!(left_out.count(), 3);
    assert_eq!(line["storeys"], 2);
    let house = building_json::read(&folder.path().join("front.building.json")).unwrap();
    let pieces = house[0].facades.iter().filter(|p| p.side == Side::Front);
    let mut elements = pieces.flat_map(|p| p.elements.iter().map(move |e| (p.start + e.x, e)));
    assert!(elements.any(|(x, e)| {
        let own = (x - 6.8).abs() < 1e-6 && (e.height - 2.2).abs() < 1e-6;
        e.style == ElementStyle::Door && own
    }));

    let complaint = |args: &[&str]| {
        let failed = edifice(args).failure();
        String::from_utf8(failed.get_output().stderr.clone()).unwrap()
    };
    let rest = ["--footprint", &lot, "-o", &out];
    let with = |more: &[&str]| complaint(&[more, &rest[..]].concat());
    assert!(with(&[]).contains("--front"));
    let unit = with(&["--front", &front]);
    assert!(unit.contains("px") && unit.contains("--height"), "{unit}");
    let wide = with(&["--front", &front, "--height", "8"]);
    assert!(
        wide.contains("12.00 m") && wide.contains("9.00 m"),
        "{wide}"
    );
    assert!(with(&["--front", &front, "--height", "-3"]).contains("-3"));
    let none = with(&["--front", &front, "--height", "6", "-n", "0"]);
    assert!(none.contains("--count"), "{none}");
}
