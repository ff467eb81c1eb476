//! A photograph under a drawing: kept in the document's own file, with a script that gives the same bytes; text that holds a picture and
//! nothing else is taken.

use std::io::Cursor;
use std::path::Path;

use edifice::io::photograph::{address, of_bytes};
use edifice::rng::stream;
use edifice_editing::examples::example;
use edifice_editing::history::Document;
use edifice_editing::open;
use edifice_editing::work::Work;
use edifice_studio::Settings;
use image::{ImageFormat, RgbImage};
use rand::RngExt;
use serde_json::{Value, json};

use crate::client::Api;
use crate::scripts::same_bytes;
use crate::socket::Server;

/// A picture of noise, as a file.
fn file(format: ImageFormat, width: u32, height: u32) -> Vec<u8> {
    let mut rng = stream(1, "studio/photograph", 0);
    let picture = RgbImage::from_fn(width, height, |_, _| image::Rgb(rng.random()));
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("written");
    bytes.into_inner()
}

fn picture(format: ImageFormat) -> String {
    address(&of_bytes(file(format, 40, 30)).expect("a picture"))
}

fn done(document: &mut Document, command: Value) -> Result<(), String> {
    document.edit(&[command]).map_err(|e| e.to_string())
}

fn shown(document: &Document) -> (Value, Value) {
    let state = document.state();
    let said = state.ask(&json!({"ask": "photograph"})).expect("an answer");
    let view = state.view().expect("a view");
    (view["photograph"].clone(), said["picture"].clone())
}

fn reopened(document: &Document) -> Document {
    let bytes = document.state().bytes().expect("bytes");
    let path = Path::new("again.facade.json");
    Document::new(open(path, &bytes, &Work::default()).expect("opens"))
}

#[test]
fn a_photograph_is_saved_with_the_document_and_opened_again() {
    let mut drawing = Document::new(example("four", &Work::default()).expect("ships"));
    let start = drawing.state().bytes().expect("bytes");
    assert_eq!(shown(&drawing), (Value::Null, Value::Null));
    let jpeg = picture(ImageFormat::Jpeg);
    done(&mut drawing, json!({"do": "photograph", "picture": jpeg})).expect("taken");
    let first = shown(&drawing);
    assert!(first.0.is_string());
    assert_eq!(first.1, jpeg);
    same_bytes(&drawing);
    // Edits and completions keep it.
    for command in [
        json!({"do": "complete", "count": 2, "seed": 1}),
        json!({"do": "choose", "answer": 2}),
        json!({"do": "edit", "edits": ["move d1=10.2,0", "outline 16,12"]}),
    ] {
        done(&mut drawing, command).expect("done");
        assert_eq!(shown(&drawing), first);
    }
    same_bytes(&drawing);
    let mut again = reopened(&drawing);
    assert_eq!(again.state().kind(), "completion");
    assert_eq!(shown(&again), first);
    let bytes = |d: &Document| d.state().bytes().expect("bytes");
    assert!(bytes(&again) == bytes(&drawing));
    // A script may begin with it, and another one take its place.
    done(&mut again, json!({"do": "complete", "count": 1})).expect("done");
    same_bytes(&again);
    let png = picture(ImageFormat::Png);
    done(&mut again, json!({"do": "photograph", "picture": png})).expect("taken");
    assert_ne!(shown(&again).0, first.0);
    same_bytes(&again);
    done(&mut again, json!({"do": "photograph", "picture": null})).expect("taken out");
    assert_eq!(shown(&again), (Value::Null, Value::Null));
    same_bytes(&again);
    assert!(again.undo() && shown(&again).1 == png);
    while drawing.undo() {}
    assert!(bytes(&drawing) == start);
}

#[test]
fn a_whole_facade_with_a_photograph_is_opened_to_be_drawn_over() {
    let text = format!(
        r#"{{ "format": "edifice/facade", "version": 1, "name": "f", "unit": "m", "width": 4, "height": 4,
        "regions": [ {{ "label": "wall", "x": 0, "y": 0, "width": 4, "height": 4 }} ], "photograph": "{}" }}"#,
        picture(ImageFormat::Png)
    );
    let path = Path::new("f.facade.json");
    let state = open(path, text.as_bytes(), &Work::default()).expect("opens");
    assert_eq!(state.kind(), "completion");
}

#[test]
fn what_holds_no_picture_is_refused() {
    let jpeg = picture(ImageFormat::Jpeg);
    let png = picture(ImageFormat::Png);
    let wide = of_bytes(file(ImageFormat::Png, 8001, 1)).expect_err("too wide");
    assert!(wide.to_string().contains("8001 x 1"), "{wide}");
    let large = of_bytes(file(ImageFormat::Png, 1300, 1200)).expect_err("too large");
    assert!(large.to_string().contains("bytes"), "{large}");
    let api = Api::new(&Settings::default());
    let first = api.post("/api/documents", json!({"example": "four"}));
    for (address, expected) in [
        ("http://example.org/x.png", "expected a picture as text"),
        ("file:///etc/passwd", "expected a picture as text"),
        ("../../secret.png", "expected a picture as text"),
        (
            "data:image/svg+xml;base64,PHN2Zy8+",
            "expected a picture as text",
        ),
        ("data:text/html;base64,PGI+", "expected a picture as text"),
        ("data:image/png;base64,@@@", "not base64"),
        ("data:image/png;base64,", "neither a JPEG nor a PNG"),
        (
            "data:image/jpeg;base64,PHN2Zy8+",
            "neither a JPEG nor a PNG",
        ),
        (
            &jpeg.replace("jpeg", "png"),
            "another one than its address says",
        ),
        (&png[..62], "cannot be read"),
    ] {
        let command = json!({"do": "photograph", "picture": address});
        let body = json!({"commands": [command], "revision": 0});
        let (status, answer) = api.send("POST", "/api/documents/d1/edit", &body);
        let said = answer["error"].as_str().unwrap_or_default();
        assert_eq!(status, 422, "{address}: {answer}");
        assert!(said.contains(expected), "{address}: {said}");
        // Nor is it read from a file.
        let text = json!({"format": "edifice/facade", "version": 1, "name": "f", "unit": "m", "width": 4, "height": 4, "regions": [],
            "photograph": address});
        let path = Path::new("f.facade.json");
        let read = open(path, text.to_string().as_bytes(), &Work::default());
        let said = read.err().expect("refused").to_string();
        assert!(said.starts_with("f.facade.json: photograph: "), "{said}");
    }
    assert_eq!(api.get("/api/documents/d1"), first);
    // Houses and grammars have no photograph.
    api.post("/api/documents", json!({"example": "house"}));
    let question = json!({"ask": "photograph"});
    assert_eq!(api.send("POST", "/api/documents/d2/ask", &question).0, 422);
}

#[test]
fn a_studio_that_may_only_read_shows_a_large_one_and_writes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("f.facade.json");
    let text = r#"{ "format": "edifice/facade", "version": 1, "name": "f", "unit": "m", "width": 4, "height": 4, "regions": [] }"#;
    std::fs::write(&path, text).expect("written");
    let server = Server::start(&Settings {
        files: vec![path.clone()],
        read_only: true,
        ..Settings::default()
    });
    // About as large as the page makes them.
    let large = of_bytes(file(ImageFormat::Png, 600, 600)).expect("a picture");
    let large = address(&large);
    assert!(large.len() > 1_400_000, "{}", large.len());
    let body = json!({"commands": [{"do": "photograph", "picture": large}], "revision": 0});
    let answer = server.page("POST /api/documents/d1/edit", &body.to_string());
    assert_eq!(answer.status, 200, "{}", answer.text);
    // The picture is sent when it is asked for, not with every answer.
    assert!(answer.text.len() < 10_000, "{}", answer.text.len());
    let asked = server.page("POST /api/documents/d1/ask", "{\"ask\": \"photograph\"}");
    assert!(asked.text.contains(&large));
    let refused = server.page("POST /api/documents/d1/save", "{}");
    assert_eq!(refused.status, 403, "{}", refused.text);
    assert_eq!(std::fs::read_to_string(&path).expect("there"), text);
    assert_eq!(std::fs::read_dir(folder.path()).expect("listed").count(), 1);
}
