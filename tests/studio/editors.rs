//! The editors on the wishes of designers: attributes, floors and columns, joint grammars, three dimensions; each with
//! a script that gives the same bytes.

use std::path::Path;
use std::process::Command;

use edifice::rng::stream;
use edifice_editing::building_exteriors::ranges;
use edifice_editing::examples::example;
use edifice_editing::history::Document;
use edifice_editing::work::Work;
use rand::RngExt;
use serde_json::{Value, json};

use crate::cases::cases;
use crate::scripts::same_bytes;

fn document(id: &str) -> Document {
    Document::new(example(id, &Work::default()).expect("ships"))
}

fn view(document: &Document) -> Value {
    document.state().view().expect("a view")
}

fn done(document: &mut Document, command: Value) -> Result<(), String> {
    document.edit(&[command]).map_err(|e| e.to_string())
}

fn column(document: &Document, name: &str) -> Value {
    let view = view(document);
    let columns = view["columns"].as_array().expect("columns");
    columns
        .iter()
        .find(|c| c["name"] == name)
        .expect("the column")
        .clone()
}

#[test]
fn a_wished_house_has_what_was_wished() {
    let mut house = document("house");
    let wish = json!({"do": "wish", "given": ["bbox.w=14", "roof.hip=yes", "roof.gable=no"], "keep": true, "seed": 2});
    done(&mut house, wish).expect("can be built");
    let value =
        |house: &Document, name: &str| column(house, name)["value"].as_f64().expect("a number");
    assert!(
        (value(&house, "bbox.w") - 14.0).abs() < 0.2,
        "{}",
        value(&house, "bbox.w")
    );
    assert_eq!(
        (value(&house, "roof.hip"), value(&house, "roof.gable")),
        (1.0, 0.0)
    );
    assert_eq!(column(&house, "bbox.w")["wish"], 14.0);
    assert!(column(&house, "bbox.d")["wish"].is_null());
    same_bytes(&house);
    // A style of the model, with a wish.
    let styles = view(&house)["styles"].as_array().map_or(0, Vec::len);
    done(
        &mut house,
        json!({"do": "wish", "given": ["bbox.w=12"], "style": styles, "seed": 1}),
    )
    .expect("can be built");
    assert!((value(&house, "bbox.w") - 12.0).abs() < 0.2);
    assert_eq!(view(&house)["style"], styles);
    // All else by the model.
    done(
        &mut house,
        json!({"do": "wish", "given": ["bbox.d=11"], "seed": 3}),
    )
    .expect("can be built");
    same_bytes(&house);
    let none = done(
        &mut house,
        json!({"do": "wish", "given": [], "style": styles + 1}),
    );
    assert!(none.expect_err("refused").contains("no style"));
}

#[test]
fn contradictory_wishes_name_the_two_that_clash() {
    let mut house = document("house");
    let before = house.state().bytes().expect("bytes");
    for (wishes, named) in [
        (vec!["bbox.h=3", "garage.h=5"], vec!["garage.h", "bbox.h"]),
        (vec!["arf.1=0.6", "arf.0=0.3"], vec!["arf.1", "arf.0"]),
        (
            vec!["bbox.w=10", "bbox.d=10", "bcr=0.5", "bdry=4"],
            vec!["bdry", "bcr"],
        ),
        (vec!["bcr=0.6", "far=2", "arf.0=0.5"], vec!["far", "bcr"]),
        (
            vec!["bbox.w=8", "garage.x=0.9", "garage.w=6"],
            vec!["garage.x", "bbox.w"],
        ),
    ] {
        for keep in [true, false] {
            let wish = json!({"do": "wish", "given": wishes, "keep": keep});
            let message = done(&mut house, wish).expect_err("a contradiction");
            for name in &named {
                assert!(message.contains(name), "{wishes:?}: {message}");
            }
        }
    }
    assert_eq!(house.state().bytes().expect("bytes"), before);
    for wrong in [
        "bbox.w",
        "bbox.q=3",
        "bbox.w=wide",
        "roof.hip=0.5",
        "bbox.w=-3",
    ] {
        assert!(
            done(&mut house, json!({"do": "wish", "given": [wrong]})).is_err(),
            "{wrong}"
        );
    }
}

#[test]
fn the_ranges_of_the_sliders_are_the_models() {
    let ranges = ranges().expect("the model ships");
    for (c, [low, high]) in ranges.iter().enumerate() {
        assert!(
            low <= high && low.is_finite() && high.is_finite(),
            "column {c}"
        );
    }
    // Houses are neither huts nor halls.
    assert!(ranges[0][0] > 3.0 && ranges[0][1] < 60.0, "{:?}", ranges[0]);
}

/// Widths or heights of all terminals, largest extent of the facade.
fn lengths(view: &Value, side: usize) -> Vec<f64> {
    let all = view["terminals"].as_array().expect("terminals").iter();
    all.map(|t| t[side].as_f64().expect("a length")).collect()
}

/// The same of the terminals that are parts of a rule.
fn of_rule(view: &Value, rule: usize, side: usize) -> Vec<f64> {
    let all = view["terminals"].as_array().expect("terminals").iter();
    let own = all.filter(|t| t[5][0] == json!(rule));
    own.map(|t| t[side].as_f64().expect("a length")).collect()
}

#[test]
fn floors_and_columns_come_and_go() {
    let mut rng = stream(5, "studio/floors", 0);
    let (mut tried, mut stiff) = (0, 0);
    let each = cases(40).max(20);
    for id in ["fig9", "boulevard"] {
        for _ in 0..each {
            let mut grammar = document(id);
            // Sizes are made relative by any edit: compare with the grammar after one.
            let own = view(&grammar);
            let outline = json!({"do": "edit", "edits": [format!("outline {},{}", own["width"], own["height"])]});
            done(&mut grammar, outline).expect("stays");
            let before = view(&grammar);
            let rules = before["rules"].as_array().expect("rules");
            let rule = rng.random_range(0..rules.len());
            let parts = rules[rule]["parts"].as_array().map_or(0, Vec::len);
            let part = rng.random_range(0..parts.max(1));
            let operation = rules[rule]["operation"].as_str().unwrap_or("");
            let grown = done(
                &mut grammar,
                json!({"do": "edit", "edits": [format!("grow {rule}.{part}")]}),
            );
            if !["split", "repeat", "sym_split"].contains(&operation) {
                assert!(grown.is_err(), "{operation}");
                continue;
            }
            if grown.as_ref().is_err_and(|e| e.contains("fixed length")) {
                continue;
            }
            grown.expect("grows");
            let after = view(&grammar);
            let (side, length) = match rules[rule]["axis"].as_str() {
                Some("x") => ("width", 3),
                _ => ("height", 4),
            };
            let extent = |v: &Value| v[side].as_f64().expect("a length");
            assert!(extent(&after) > extent(&before), "{id} rule {rule}.{part}");
            let other = if side == "width" { "height" } else { "width" };
            assert_eq!(after[other], before[other]);
            // Where the rule's region spans the facade, nothing else is stretched.
            let inner = before["nonTerminals"].as_array().expect("regions");
            let spans =
                |n: &&Value| (n[length + 1].as_f64().unwrap_or(0.0) - extent(&before)).abs() < 1e-9;
            let own: Vec<&Value> = inner.iter().filter(|n| n[0] == json!(rule)).collect();
            if operation == "split" && own.len() == 1 && own.iter().all(spans) {
                let (old, new) = (
                    of_rule(&before, rule, length),
                    of_rule(&after, rule, length),
                );
                let known = |v: &f64| old.iter().any(|o| (o - v).abs() < 1e-6 * extent(&before));
                assert!(
                    new.iter().all(known),
                    "{id} rule {rule}.{part}: {old:?} {new:?}"
                );
                stiff += 1;
            }
            let back = done(
                &mut grammar,
                json!({"do": "edit", "edits": [format!("shrink {rule}.{part}")]}),
            );
            back.expect("shrinks");
            let again = view(&grammar);
            // Where the rule has regions of several sizes, the longest one may be another one after the first edit.
            let slack = match own.iter().all(spans) {
                true => 1e-6 * extent(&before),
                false => 0.01 * extent(&before),
            };
            assert!(
                (extent(&again) - extent(&before)).abs() < slack,
                "{id} rule {rule}.{part} ({operation})"
            );
            let (a, b) = (lengths(&again, length), lengths(&before, length));
            assert_eq!(a.len(), b.len());
            assert!(
                a.iter().zip(&b).all(|(a, b)| (a - b).abs() < slack),
                "{id} rule {rule}.{part}"
            );
            tried += 1;
            if tried % 20 == 0 {
                same_bytes(&grammar);
            }
        }
    }
    assert!(tried > each / 2 && stiff > 0, "{tried} {stiff}");
}

#[test]
fn facades_are_merged_into_one_grammar() {
    let one = document("fig9");
    let text = |d: &Document| {
        String::from_utf8(d.state().export("facade.json").expect("a facade")).expect("text")
    };
    let mut wide = document("fig9");
    done(&mut wide, json!({"do": "derive", "size": [170.0, 90.0]})).expect("derives");
    let mut joint = document("fig9");
    done(&mut joint, json!({"do": "merge", "facades": [text(&wide)]})).expect("merges");
    let merged = view(&joint);
    let starts = merged["starts"].as_array().expect("starts");
    assert_eq!(starts.len(), 2);
    assert_ne!(starts[0]["name"], starts[1]["name"]);
    // Both facades are derived from it, region by region.
    for (k, other) in [&one, &wide].into_iter().enumerate() {
        done(&mut joint, json!({"do": "derive", "start": k})).expect("derives");
        let (a, b) = (view(&joint), view(other));
        assert_eq!(
            a["terminals"].as_array().map(Vec::len),
            b["terminals"].as_array().map(Vec::len)
        );
    }
    same_bytes(&joint);
    let wrong = text(&one).replacen("\"unit\": \"", "\"unit\": \"x", 1);
    let message =
        done(&mut joint, json!({"do": "merge", "facades": [wrong]})).expect_err("another unit");
    assert!(message.contains("unit"), "{message}");
}

#[test]
fn a_facade_in_relief_is_that_of_the_command() {
    let grammar = document("fig9");
    let own = grammar.state().export("glb").expect("a scene");
    assert_eq!(&own[..4], b"glTF");
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    std::fs::write(
        place("g.grammar.json"),
        grammar.state().bytes().expect("bytes"),
    )
    .expect("written");
    let run = |input: &Path, output: &Path| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_edifice"));
        let done = command
            .args(["grammar", "derive"])
            .arg(input)
            .arg("-o")
            .arg(output)
            .output()
            .expect("runs");
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
    };
    run(&place("g.grammar.json"), &place("g.glb"));
    let made = std::fs::read(place("g.glb")).expect("there");
    assert!(made == own);
}
