//! Reading buildings and tables of houses: round trips and bad files.

use std::path::Path;

use edifice::io::building_json;
use edifice::model::tables::schema::{Kind, Schema, SchemaError, SchemaGroup};

const GOOD: &str = r#"{"format":"edifice/building","version":1,"name":"a","unit":"m","floor_height":3.0,"boxes":[{"style":"main","x":5,"y":4,"width":10,"depth":8,"height":6,"roof":{"style":"hip","pitch":25,"ridge":"x"}}],"facades":[{"side":"front","start":0,"base":0,"width":10,"height":3,"elements":[{"style":"sash","x":1,"y":1,"width":1.2,"height":1.4}]}],"special":["chimney"]}"#;

fn fail(text: &str) -> String {
    let error = building_json::parse(text.as_bytes(), Path::new("h.building.json")).unwrap_err();
    error.to_string()
}

#[test]
fn a_building_and_a_database_come_back_as_written() {
    let building = building_json::parse(GOOD.as_bytes(), Path::new("h")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let one = folder.path().join("one.building.json");
    building_json::write(&building, &one).unwrap();
    assert_eq!(building_json::read(&one).unwrap(), vec![building.clone()]);
    let many = folder.path().join("two.buildings.jsonl");
    let both = vec![building.clone(), building];
    building_json::write_lines(&both, &many).unwrap();
    assert_eq!(building_json::read(&many).unwrap(), both);
}

#[test]
fn bad_buildings_name_their_place() {
    let cases = [
        (
            "\"width\":10,\"depth\"",
            "\"width\":-1,\"depth\"",
            "boxes[0].width",
        ),
        (
            "\"width\":10,\"depth\"",
            "\"width\":NaN,\"depth\"",
            "line 1",
        ),
        (
            "\"width\":1.2",
            "\"width\":1e999",
            "facades[0].elements[0].width",
        ),
        (
            "\"width\":1.2",
            "\"width\":11",
            "facades[0].elements[0] reaches outside",
        ),
        ("\"pitch\":25", "\"pitch\":90", "boxes[0].roof.pitch"),
        ("\"base\":0", "\"base\":-1", "below the ground"),
        ("\"style\":\"main\"", "\"style\":\"barn\"", "boxes[0].style"),
        ("\"floor_height\":3.0", "\"floor_height\":0", "floor_height"),
        ("\"version\":1", "\"version\":2", "unknown version 2"),
        ("edifice/building", "edifice/facade", "unknown format"),
        (
            "\"unit\":\"m\"",
            "\"unit\":\"m\",\"unit\":\"m\"",
            "duplicate field",
        ),
        ("[\"chimney\"]}", "[\"chimney\"]} x", "trailing"),
    ];
    for (from, to, expected) in cases {
        assert!(GOOD.contains(from), "{from}");
        let message = fail(&GOOD.replacen(from, to, 1));
        assert!(message.starts_with("h.building.json: "), "{message}");
        assert!(message.contains(expected), "{expected}: {message}");
    }
}

#[test]
fn a_bad_line_of_a_database_is_named() {
    let text = format!("{GOOD}\n\n{}\n", GOOD.replace("\"x\":5", "\"x\":\"5\""));
    let error = building_json::parse_lines(text.as_bytes(), Path::new("d.jsonl")).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("line 3") && message.contains("boxes[0].x"),
        "{message}"
    );
    let error = building_json::parse_lines(b"\n", Path::new("d.jsonl")).unwrap_err();
    assert!(error.to_string().contains("no buildings"));
}

fn schema() -> Schema {
    let group = |name: &str, kind, column: &str| SchemaGroup {
        name: name.into(),
        kind,
        columns: vec![column.into()],
    };
    Schema {
        keep: [("type".to_string(), vec!["house".to_string()])].into(),
        missing: vec![String::new(), "NA".into()],
        groups: vec![
            group("size", Kind::Continuous, "w"),
            group("porch", Kind::Binary, "p"),
            group("roof", Kind::Category, "r"),
        ],
        relations: None,
    }
}

fn rows(rows: &[[&str; 4]]) -> Vec<Vec<String>> {
    rows.iter().map(|r| r.map(str::to_owned).to_vec()).collect()
}

#[test]
fn a_schema_reads_kinds_and_keeps_missing_missing() {
    let header = ["type", "w", "p", "r"].map(str::to_owned);
    let cells = [
        ["house", "9.5", "yes", "hip"],
        ["shed", "x", "x", "x"],
        ["house", "NA", "", "gable"],
    ];
    let data = schema().read(&header, &rows(&cells)).unwrap();
    assert_eq!(data.table.rows(), 2);
    let column = |name: &str| data.table.column(name).unwrap();
    use edifice::model::Cell;
    assert_eq!(column("w").cell(0), Cell::Real(9.5));
    assert_eq!(column("w").cell(1), Cell::Missing);
    assert_eq!(column("p").cell(0), Cell::Code(1));
    assert_eq!(column("p").cell(1), Cell::Missing);
    assert_eq!(column("r").categories().unwrap(), ["gable", "hip"]);
}

#[test]
fn bad_cells_name_column_and_row() {
    let header = ["type", "w", "p", "r"].map(str::to_owned);
    let bad = |row: [&str; 4]| schema().read(&header, &rows(&[["house", "1", "0", "hip"], row]));
    for text in ["wide", "inf", "NaN"] {
        let error = bad(["house", text, "0", "hip"]).unwrap_err();
        let expected = SchemaError::NotANumber {
            row: 2,
            column: "w".into(),
            text: text.into(),
        };
        assert_eq!(error, expected);
    }
    let error = bad(["house", "1", "2", "hip"]).unwrap_err().to_string();
    assert!(error.contains("row 2") && error.contains("`p`"), "{error}");
    let error = schema()
        .read(&header[..3], &rows(&[["house", "1", "0", ""]]))
        .unwrap_err();
    assert_eq!(error, SchemaError::UnknownColumn { column: "r".into() });
    let error = schema()
        .read(&header, &rows(&[["shed", "1", "0", "hip"]]))
        .unwrap_err();
    assert_eq!(error, SchemaError::NothingKept);
}
