//! The stories of the papers, and their scripts run by a shell.

use std::path::Path;
use std::process::Command;

use edifice_editing::examples::example;
use edifice_editing::history::Document;
use edifice_editing::work::Work;
use serde_json::{Value, json};

fn document(id: &str) -> Document {
    Document::new(example(id, &Work::default()).expect("ships"))
}

fn edit(document: &mut Document, commands: Value) {
    let commands = commands.as_array().expect("a list").clone();
    document.edit(&commands).expect("can be done");
}

/// Runs the script with the command itself; what it wrote.
fn run(document: &Document, folder: &Path) -> Vec<u8> {
    let script = folder.join("edits.sh");
    std::fs::write(&script, document.script().expect("a script")).expect("written");
    let done = Command::new("sh")
        .arg(&script)
        .arg("made.file")
        .current_dir(folder)
        .env("EDIFICE", env!("CARGO_BIN_EXE_edifice"))
        .output()
        .expect("sh runs");
    let errors = String::from_utf8_lossy(&done.stderr);
    let text = std::fs::read_to_string(&script).expect("there");
    assert!(done.status.success(), "{errors}\n{text}");
    std::fs::read(folder.join("made.file")).expect("made")
}

pub(crate) fn same_bytes(document: &Document) {
    let folder = tempfile::tempdir().expect("a folder");
    let own = document.state().bytes().expect("a file");
    assert!(
        run(document, folder.path()) == own,
        "{}",
        document.script().expect("a script")
    );
}

fn elements(document: &Document) -> Vec<Value> {
    let view = document.state().view().expect("a view");
    view["elements"].as_array().expect("elements").clone()
}

#[test]
fn figure_15_of_fan_et_al() {
    let mut facade = document("four");
    let complete = json!({"do": "complete", "count": 3, "seed": 1});
    // (a) four elements, (c) a completion.
    edit(&mut facade, json!([complete]));
    assert!(elements(&facade).len() > 4);
    let first = elements(&facade);
    // (d) the door to another place: a new completion, in which it stays.
    edit(
        &mut facade,
        json!([{"do": "edit", "edits": ["move d1=10.2,0"]}, complete]),
    );
    let moved = elements(&facade);
    assert!(moved.iter().any(|e| e["id"] == "d1" && e["x"] == 10.2));
    assert_ne!(first, moved);
    // (e) another type for an element, (f) a column of windows moved; one answer picked of three.
    let of_completion = |e: &&Value| e["observed"] == false && e["class"] == "window";
    let own = moved
        .iter()
        .find(of_completion)
        .expect("a window was added");
    let id = own["id"].as_str().expect("an id").to_owned();
    edit(
        &mut facade,
        json!([{"do": "edit", "edits": [format!("relabel {id}=balcony")]}, complete]),
    );
    assert!(
        elements(&facade)
            .iter()
            .any(|e| e["label"] == "balcony" && e["observed"] == true)
    );
    edit(
        &mut facade,
        json!([{"do": "edit", "edits": ["move w1=1,4.2", "move w3=1,7.4"]}, complete]),
    );
    edit(&mut facade, json!([{"do": "choose", "answer": 2}]));
    same_bytes(&facade);
    // Pins, forbidden and unknown rectangles.
    let pin = elements(&facade)
        .iter()
        .find(|e| e["observed"] == false)
        .expect("one was added")["id"]
        .clone();
    edit(
        &mut facade,
        json!([{"do": "edit", "edits": ["unknown 0,9.5,15,2.5"]},
            {"do": "complete", "count": 2, "seed": 4, "pins": [], "forbid": [[9.0, 0.0, 6.0, 3.0]]}]),
    );
    assert!(!pin.is_null());
    same_bytes(&facade);
    // After an undo the script is that of the state before.
    assert!(facade.undo());
    same_bytes(&facade);
}

#[test]
fn figure_19_of_fan_and_wonka() {
    let mut house = document("house");
    let boxes = |house: &Document| house.state().view().expect("a view")["boxes"].clone();
    let before = boxes(&house);
    // (a) a garage at the left front corner; the model suggests the rest.
    let garage = "add garage@-1.8,4.3,3.6,6,2.6";
    edit(
        &mut house,
        json!([{"do": "edit", "edits": [garage], "suggest": true, "seed": 2}]),
    );
    let with = boxes(&house);
    let index = with
        .as_array()
        .expect("boxes")
        .iter()
        .position(|b| b["style"] == "garage");
    let index = index.expect("the garage stays");
    assert_eq!(with[index]["x"], -1.8);
    assert_ne!(with, before);
    // (c) the garage to the back of the building.
    let to = format!("move {index}=-1.8,6");
    edit(
        &mut house,
        json!([{"do": "edit", "edits": [to], "suggest": true, "seed": 2}]),
    );
    same_bytes(&house);
    // (d) another size for a box, all others as they are; then other plans, and one of them.
    let first = boxes(&house)[0].clone();
    let size = |k: &str| first[k].as_f64().expect("a number");
    let to = format!(
        "resize 0={},{},{}",
        size("width"),
        size("depth"),
        size("height") + 0.3
    );
    edit(
        &mut house,
        json!([{"do": "edit", "edits": [to], "seed": 2}]),
    );
    edit(
        &mut house,
        json!([{"do": "variations", "count": 2, "seed": 3}]),
    );
    let answers = house.state().view().expect("a view")["answers"]
        .as_array()
        .map_or(0, Vec::len);
    assert!(answers > 0);
    edit(&mut house, json!([{"do": "choose", "answer": 1}]));
    same_bytes(&house);
}

#[test]
fn edits_of_a_grammar() {
    let mut grammar = document("fig9");
    let rules = grammar.state().view().expect("a view")["rules"].clone();
    let rules = rules.as_array().expect("rules");
    let split = rules
        .iter()
        .position(|r| r["operation"] == "split")
        .expect("a split");
    let part = &rules[split]["parts"][0];
    let (symbol, size) = (
        part["symbol"].as_str().unwrap_or(""),
        part["size"].as_f64().unwrap_or(1.0),
    );
    edit(
        &mut grammar,
        json!([{"do": "edit", "edits": [
            format!("insert {split}.0={symbol}:{size}"),
            format!("symbol {split}.0=new wall's \"$label\""),
            format!("resize {split}.1={}", size * 1.5),
        ]}]),
    );
    edit(
        &mut grammar,
        json!([{"do": "derive", "size": [150.0, 90.0], "seed": 3}]),
    );
    edit(
        &mut grammar,
        json!([{"do": "edit", "edits": ["outline 160,80", format!("remove {split}.0")]}]),
    );
    same_bytes(&grammar);
}

#[test]
fn a_city_is_scaled_and_grown() {
    let mut city = document("town");
    edit(
        &mut city,
        json!([{"do": "edit", "edits": ["scale house=1,1,1.5"]}]),
    );
    same_bytes(&city);
    edit(
        &mut city,
        json!([{"do": "synthesize", "polygon": [[0, 0], [150, 0], [150, 120], [0, 120]], "seed": 2}]),
    );
    let view = city.state().view().expect("a view");
    assert!(view["instances"].as_array().is_some_and(|i| i.len() > 3));
    same_bytes(&city);
}
