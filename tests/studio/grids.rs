//! Edits of the columns and rows of a grid, and of repeats A B A: in all regions of the rule, undone to the same bytes, saved as a
//! script that gives the same bytes.

use std::path::Path;

use edifice::rng::stream;
use edifice_editing::history::Document;
use edifice_editing::open;
use edifice_editing::work::Work;
use rand::RngExt;
use serde_json::{Value, json};

use crate::scripts::same_bytes;

/// Two bays of a grid around a door, below piers with openings between them.
const HALL: &str = r#"{ "format": "edifice/grammar", "version": 1, "axiom": "Hall", "unit": "m", "width": 24, "height": 12,
  "rules": [
    { "symbol": "Hall", "op": "split", "axis": "y", "successors": [ { "symbol": "Ground", "size": 4 }, { "symbol": "Upper", "size": 8 } ] },
    { "symbol": "Ground", "op": "split", "axis": "x",
      "successors": [ { "symbol": "Bay", "size": 8 }, { "symbol": "door", "size": 8 }, { "symbol": "Bay", "size": 8 } ] },
    { "symbol": "Bay", "op": "grid_split", "columns": [2, 4, 2], "rows": [1, 3],
      "cells": [ ["wall", "sill", "wall"], ["wall", "window", "wall"] ] },
    { "symbol": "Upper", "op": "repeat_aba", "axis": "x", 
      "successors": [ { "symbol": "pier", "size": 2 }, { "symbol": "Opening", "size": 3.5 } ] },
    { "symbol": "Opening", "op": "split", "axis": "y", "successors": [ { "symbol": "rail", "size": 2 }, { "symbol": "arch", "size": 6 } ] }
  ] }"#;

fn hall() -> Document {
    let path = Path::new("hall.grammar.json");
    Document::new(open(path, HALL.as_bytes(), &Work::default()).expect("a grammar"))
}

fn done(document: &mut Document, edits: &[&str]) -> Result<(), String> {
    let command = json!({"do": "edit", "edits": edits});
    document.edit(&[command]).map_err(|e| e.to_string())
}

fn view(document: &Document) -> Value {
    document.state().view().expect("a view")
}

/// Left or lower ends and lengths of the terminals of a label, along an axis.
fn placed(view: &Value, label: &str, axis: usize) -> Vec<[f64; 2]> {
    let all = view["terminals"].as_array().expect("terminals").iter();
    let own = all.filter(|t| t[0] == label);
    let number = |v: &Value| (v.as_f64().expect("a number") * 1e9).round() / 1e9;
    own.map(|t| [number(&t[1 + axis]), number(&t[3 + axis])])
        .collect()
}

/// The view after edits; the script gives the same bytes, and undo the bytes before.
fn edited(edits: &[&str]) -> Value {
    let mut document = hall();
    let before = document.state().bytes().expect("bytes");
    done(&mut document, edits).unwrap_or_else(|e| panic!("{edits:?}: {e}"));
    same_bytes(&document);
    let after = view(&document);
    assert!(document.undo());
    assert!(document.state().bytes().expect("bytes") == before);
    after
}

#[test]
fn columns_and_rows_of_a_grid_in_all_its_regions() {
    let (x, y) = (0, 1);
    let moved = edited(&["border 2.c0=0.5"]);
    assert_eq!(placed(&moved, "window", x), [[2.5, 3.5], [18.5, 3.5]]);
    let moved = edited(&["border 2.r0=-0.25"]);
    assert_eq!(placed(&moved, "window", y), [[0.75, 3.25], [0.75, 3.25]]);
    // The others give way in proportion.
    let wider = edited(&["resize 2.c1=6"]);
    assert_eq!(placed(&wider, "sill", x), [[1.0, 6.0], [17.0, 6.0]]);
    // A copy of the upper row before it; a row of one symbol on top.
    let copied = edited(&["insert 2.r1=1"]);
    let own = placed(&copied, "window", y);
    assert_eq!(own, [[0.75, 1.0], [1.75, 2.25], [0.75, 1.0], [1.75, 2.25]]);
    let topped = edited(&["insert 2.r2=cornice:1"]);
    assert_eq!(placed(&topped, "cornice", y), [[3.0, 1.0]; 6]);
    assert_eq!(placed(&topped, "cornice", x)[1], [2.0, 4.0]);
    let behind = edited(&["insert 2.c3=pilaster:2"]);
    assert_eq!(placed(&behind, "pilaster", x)[0], [6.0, 2.0]);
    let without = edited(&["remove 2.c0"]);
    assert_eq!(
        placed(&without, "window", x)[0],
        [0.0, 8.0 * 2.0 / 3.0].map(nine)
    );
    // One column of a window more and the old one out: the same again.
    assert_eq!(
        edited(&["insert 2.c1=4", "remove 2.c1"])["terminals"],
        edited(&["outline 24,12"])["terminals"]
    );
    // Cells keep their own edit.
    let named = edited(&["symbol 2.4=oriel"]);
    assert_eq!(placed(&named, "oriel", x), [[2.0, 4.0], [18.0, 4.0]]);
    let grid = &edited(&["insert 2.c1=4"])["rules"][2];
    assert_eq!(
        (
            grid["columns"].as_array().map(Vec::len),
            grid["rows"].as_array().map(Vec::len)
        ),
        (Some(4), Some(2))
    );
    assert_eq!(grid["parts"].as_array().map(Vec::len), Some(8));
}

fn nine(v: f64) -> f64 {
    (v * 1e9).round() / 1e9
}

#[test]
fn the_facade_grows_by_a_column_or_row_of_a_grid() {
    // Two of four columns of windows are 12 m beside 8 m: the bays and all else beside them grow in proportion.
    let wide = edited(&["grow 2.c1"]);
    assert_eq!(
        (&wide["width"], &wide["height"]),
        (&json!(36.0), &json!(12.0))
    );
    let windows = placed(&wide, "window", 0);
    assert_eq!(windows, [[2.0, 4.0], [6.0, 4.0], [26.0, 4.0], [30.0, 4.0]]);
    let high = edited(&["grow 2.r1"]);
    assert_eq!(
        (&high["width"], &high["height"]),
        (&json!(24.0), &json!(21.0))
    );
    assert_eq!(placed(&high, "window", 1)[..2], [[1.0, 3.0], [4.0, 3.0]]);
    let less = edited(&["shrink 2.c0"]);
    assert_eq!(less["width"], 18.0);
    assert_eq!(placed(&less, "window", 0), [[0.0, 4.0], [12.0, 4.0]]);
    let same = edited(&["grow 2.c2", "shrink 2.c2", "grow 2.r0", "shrink 2.r0"]);
    assert_eq!(same["terminals"], edited(&["outline 24,12"])["terminals"]);
}

#[test]
fn a_and_b_of_a_repeat_and_its_periods() {
    let piers = |view: &Value| placed(view, "pier", 0);
    let arches = |view: &Value| placed(view, "arch", 0);
    // The period stays, and with it the number of openings.
    let moved = edited(&["border 3.0=0.25"]);
    assert_eq!((piers(&moved).len(), arches(&moved).len()), (5, 4));
    let [pier, arch] = [piers(&moved)[1][1], arches(&moved)[1][1]];
    assert!((pier / arch - 2.25 / 3.25).abs() < 1e-8);
    // Another size of one of both: as many as then fit, in proportion.
    for (edit, count, ratio) in [
        ("resize 3.0=4", 3, 4.0 / 3.5),
        ("resize 3.1=9", 2, 2.0 / 9.0),
    ] {
        let sized = edited(&[edit]);
        assert_eq!(arches(&sized).len(), count, "{edit}");
        let all = piers(&sized);
        assert_eq!(all.len(), count + 1);
        assert!(all.iter().all(|p| (p[1] - all[0][1]).abs() < 1e-8));
        assert!((all[0][1] / arches(&sized)[0][1] - ratio).abs() < 1e-8);
    }
    let longer = edited(&["grow 3.1"]);
    assert_eq!(longer["width"], 29.5);
    assert_eq!((piers(&longer).len(), arches(&longer)[4]), (6, [24.0, 3.5]));
    let shorter = edited(&["shrink 3.0", "shrink 3.0"]);
    assert_eq!(
        (&shorter["width"], arches(&shorter).len()),
        (&json!(13.0), 2)
    );
    let named = edited(&["symbol 3.0=column"]);
    assert_eq!(placed(&named, "column", 0).len(), 5);
}

#[test]
fn what_a_grid_or_a_repeat_does_not_have_is_refused() {
    let mut document = hall();
    let before = document.state().bytes().expect("bytes");
    for (edit, expected) in [
        ("resize 2.1=3", "name a column (c0) or a row (r0)"),
        ("border 2.c2=0.1", "rules[2] has no column 3: it has 3"),
        ("border 2.c0=4", "size 6 for column 0 of rules[2]"),
        ("border 2.r0=-1", "size 0 for row 0"),
        ("resize 2.r7=1", "rules[2] has no row 7: it has 2"),
        ("resize 2.c0=9", "size 9 for column 0"),
        ("resize 2.c0=-1", "size -1 for column 0"),
        ("insert 2.c9=wall:1", "has no column 8"),
        ("insert 2.c3=1", "has no column 3"),
        ("insert 2.c0=wall:99", "size 99 for column 0"),
        ("insert 2.c0=:1", "is empty"),
        ("symbol 2.c0=wall", "named by a number"),
        ("symbol 2.6=wall", "has no part 6: it has 6"),
        ("grow 2.0", "name a column"),
        ("resize 1.c0=3", "only a grid has columns and rows"),
        ("resize 2.cx=3", "\"x\" is no index"),
        ("resize 2.c=3", "\"\" is no index"),
        ("resize 3.2=3", "rules[3] has no part 2: it has 2"),
        ("insert 3.1=pier:1", "always has two parts"),
        ("remove 3.0", "always has two parts"),
        ("border 3.1=1", "has no part 2"),
        ("resize 3.0=0", "size 0 for part 0"),
        ("grow 9.0", "there is no rules[9]"),
    ] {
        let message = done(&mut document, &[edit]).expect_err(edit);
        assert!(message.contains(expected), "{edit}: {message}");
    }
    // The last column, row and period stay.
    for edit in ["remove 2.r0", "shrink 2.r0", "shrink 3.0"] {
        let many = [edit; 9];
        let message = done(&mut document, &many).expect_err(edit);
        assert!(message.contains("size 0"), "{edit}: {message}");
    }
    assert!(document.state().bytes().expect("bytes") == before);
}

#[test]
fn any_edits_of_lines_are_undone_and_saved_as_a_script() {
    let mut rng = stream(11, "studio/grids", 0);
    for _ in 0..6 {
        let mut document = hall();
        let mut states = vec![document.state().bytes().expect("bytes")];
        for _ in 0..12 {
            let place = ["2.c0", "2.c1", "2.r0", "2.r1", "3.0", "3.1", "4.1"];
            let place = place[rng.random_range(0..place.len())];
            let size = rng.random_range(0.2..3.0);
            let edit = match rng.random_range(0..6) {
                0 => format!("resize {place}={size}"),
                1 => format!("border {place}={}", size - 1.5),
                2 => format!("insert {place}={size}"),
                3 => format!("remove {place}"),
                4 => format!("grow {place}"),
                _ => format!("shrink {place}"),
            };
            if done(&mut document, &[&edit]).is_ok() {
                states.push(document.state().bytes().expect("bytes"));
            }
        }
        assert!(states.len() > 3);
        same_bytes(&document);
        while let Some(bytes) = states.pop() {
            assert!(document.state().bytes().expect("bytes") == bytes);
            assert_eq!(document.undo(), !states.is_empty());
        }
    }
}
