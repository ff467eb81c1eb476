//! From a photograph to a completion: its corners give the outline, a script gives the same bytes.

use std::io::Cursor;
use std::path::Path;
use std::process::Command;

use edifice::io::photograph::{address, of_bytes};
use edifice_studio::Settings;
use image::{ImageFormat, Rgb, RgbImage};
use serde_json::{Value, json};

use crate::client::Api;

/// A street whose facade, 16 m wide and 12 m high, is seen from its left and from below, by a camera of a phone: the four corners as
/// it sees them, in pixels.
const CORNERS: [[f64; 2]; 4] = [
    [373.2, 293.0],
    [1038.4, 79.9],
    [1126.3, 820.7],
    [336.4, 784.8],
];

/// A picture that is darker inside the corners.
fn street(format: ImageFormat) -> Vec<u8> {
    let inside = |x: f64, y: f64| {
        (0..4).all(|k| {
            let [a, b] = [CORNERS[k], CORNERS[(k + 1) % 4]];
            (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0.0
        })
    };
    let picture = RgbImage::from_fn(1280, 960, |x, y| match inside(f64::from(x), f64::from(y)) {
        true => Rgb([120, 80, 60]),
        false => Rgb([230, 235, 240]),
    });
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("written");
    bytes.into_inner()
}

/// The file that the document's script writes is the one that the studio saved.
fn script_gives_the_same(api: &Api, folder: &Path) {
    let saved = api.post("/api/documents/d1/save", json!({}));
    let name = |key: &str| folder.join(saved[key].as_str().expect("a name"));
    let again = folder.join("again.facade.json");
    let done = Command::new("sh")
        .arg(name("script"))
        .arg(&again)
        .env("EDIFICE", env!("CARGO_BIN_EXE_edifice"))
        .output()
        .expect("sh runs");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert!(std::fs::read(name("file")).expect("there") == std::fs::read(again).expect("there"));
}

#[test]
fn a_photograph_is_completed_in_four_actions() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("street.jpg");
    std::fs::write(&path, street(ImageFormat::Jpeg)).expect("written");
    let api = Api::new(&Settings {
        files: vec![path],
        ..Settings::default()
    });
    let opened = api.get("/api/documents/d1");
    assert_eq!(opened["kind"], "completion");
    let original = json!({"file": "street.jpg", "width": 1280, "height": 960});
    assert_eq!(opened["view"]["original"], original);
    let asked = api.post("/api/documents/d1/ask", json!({"ask": "original"}));
    let picture = asked["picture"].as_str().expect("an address");
    assert!(picture.starts_with("data:image/jpeg;base64,"));
    // 1: the corners and the height. The proportions follow.
    let straighten = json!({"do": "straighten", "corners": CORNERS, "height": 12.0});
    let made = api.edit("d1", json!([straighten]));
    let view = &made["view"];
    let width = view["width"].as_f64().expect("a number");
    assert!((width / 16.0 - 1.0).abs() < 0.05, "{width}");
    assert!(view["original"].is_null() && view["photograph"].is_string());
    // 2, 3: two windows in a row, drawn. 4: the rest.
    for x in [1.5, 4.5] {
        let add = format!("add window@{x},4,1.2,1.8");
        api.edit("d1", json!([{"do": "edit", "edits": [add]}]));
    }
    let done = api.edit("d1", json!([{"do": "complete", "count": 1}]));
    let elements = done["view"]["elements"].as_array().expect("elements");
    assert!(elements.len() > 4, "{}", elements.len());
    assert!(done["view"]["photograph"].is_string());
    script_gives_the_same(&api, folder.path());
    // Inside the corners all is wall: the picture shows nothing of the sky.
    let asked = api.post("/api/documents/d1/ask", json!({"ask": "photograph"}));
    let picture = edifice::io::photograph::of_address(asked["picture"].as_str().expect("one"));
    let read = image::load_from_memory(picture.expect("a picture").bytes()).expect("read");
    let read = read.into_luma8();
    let sky = read.pixels().filter(|p| p.0[0] > 160).count();
    // But along its edge, where a pixel is of both.
    assert!(100 * sky < read.pixels().len(), "{sky}");
}

#[test]
fn a_picture_from_the_page_begins_or_underlies_a_drawing() {
    let folder = tempfile::tempdir().expect("a folder");
    let empty = folder.path().join("f.facade.json");
    let text = r#"{ "format": "edifice/facade", "version": 1, "name": "f", "unit": "m", "width": 4, "height": 4, "regions": [] }"#;
    std::fs::write(&empty, text).expect("written");
    let api = Api::new(&Settings {
        files: vec![empty],
        ..Settings::default()
    });
    let picture = address(&of_bytes(street(ImageFormat::Png)).expect("a picture"));
    let straighten = |height: Value| json!([{"do": "straighten", "picture": picture, "corners": CORNERS, "height": height}]);
    let made = api.edit("d1", straighten(9.0.into()));
    assert!((made["view"]["width"].as_f64().expect("a number") / 12.0 - 1.0).abs() < 0.05);
    api.edit(
        "d1",
        json!([{"do": "edit", "edits": ["add window@2,4,1.2,1.8"]}]),
    );
    // With an element the outline stays; a height is refused.
    let before = api.get("/api/documents/d1");
    let body = json!({"commands": straighten(7.0.into()), "revision": before["revision"]});
    let (status, answer) = api.send("POST", "/api/documents/d1/edit", &body);
    assert!(
        status == 422 && answer.to_string().contains("outline stays"),
        "{answer}"
    );
    let after = api.edit("d1", straighten(Value::Null));
    assert_eq!(after["view"]["width"], before["view"]["width"]);
    assert_eq!(after["view"]["elements"], before["view"]["elements"]);
    script_gives_the_same(&api, folder.path());
}

#[test]
fn what_cannot_be_straightened_is_refused() {
    let api = Api::new(&Settings::default());
    let first = api.post("/api/documents", json!({"example": "sketch"}));
    let picture = address(&of_bytes(street(ImageFormat::Png)).expect("a picture"));
    let crossed = [CORNERS[0], CORNERS[2], CORNERS[1], CORNERS[3]];
    let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]];
    for (command, expected) in [
        (
            json!({"corners": CORNERS, "height": 12}),
            "not opened from a photograph",
        ),
        (
            json!({"corners": crossed, "height": 12, "picture": picture}),
            "corners",
        ),
        (
            json!({"corners": line, "height": 12, "picture": picture}),
            "corners",
        ),
        (
            json!({"corners": CORNERS, "height": 0, "picture": picture}),
            "height",
        ),
        (
            json!({"corners": CORNERS, "height": -3, "picture": picture}),
            "height",
        ),
        (
            json!({"corners": CORNERS, "height": 12, "picture": "data:image/png;base64,AAAA"}),
            "neither",
        ),
        (
            json!({"corners": [[0, 0]], "height": 12, "picture": picture}),
            "not a command",
        ),
    ] {
        let mut command = command;
        command["do"] = "straighten".into();
        let body = json!({"commands": [command], "revision": 0});
        let (status, answer) = api.send("POST", "/api/documents/d1/edit", &body);
        assert!(
            status == 422 && answer.to_string().contains(expected),
            "{expected}: {answer}"
        );
    }
    assert_eq!(api.get("/api/documents/d1"), first);
}
