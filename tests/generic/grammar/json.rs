//! Grammar files in JSON: round trips, and every way to be wrong named with its place.

use super::support::{random_grammar, size_independent, stochastic};
use edifice::grammar::{Grammar, Size, Start};
use edifice::io::grammar_json::{parse, to_string};
use proptest::prelude::*;

const GOOD: &str = r#"{ "format": "edifice/grammar", "version": 1, "axiom": "Facade", "unit": "px", "width": 10.0, "height": 6.0,
  "rules": [
    { "symbol": "Facade", "op": "split", "axis": "y", "successors": [ { "symbol": "wall", "size": 2.0 }, { "symbol": "Floor", "size": 4 } ] },
    { "symbol": "Floor", "op": "repeat", "axis": "x", "successors": [ { "symbol": "Bay", "size": 5.0 } ] },
    { "symbol": "Bay", "op": "grid_split", "columns": [2, 3], "rows": [1, { "size": 3, "relative": true }],
      "cells": [["wall", "wall"], ["wall", "window"]] } ] }"#;

fn read(text: &str) -> edifice::Result<Grammar> {
    parse(text.as_bytes(), "f.grammar.json".as_ref())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn round_trip_keeps_every_bit(seed: u64) {
        let grammar = random_grammar(seed);
        prop_assert_eq!(&read(&to_string(&grammar)).unwrap(), &grammar);
        let relative = size_independent(&grammar);
        prop_assert_eq!(&read(&to_string(&relative)).unwrap(), &relative);
        let weighted = stochastic(&grammar, seed);
        prop_assert_eq!(&read(&to_string(&weighted)).unwrap(), &weighted);
    }

    #[test]
    fn cut_and_changed_files_never_panic(seed: u64, cut: prop::sample::Index, byte: u8) {
        let mut bytes = to_string(&random_grammar(seed)).into_bytes();
        let at = cut.index(bytes.len());
        let changed = bytes[at];
        bytes[at] = byte;
        let _ = parse(&bytes, "f".as_ref());
        bytes[at] = changed;
        bytes.truncate(at.min(bytes.len() - 2));
        prop_assert!(parse(&bytes, "f".as_ref()).is_err());
    }
}

#[test]
fn joint_grammars_list_their_facades() {
    let mut grammar = read(GOOD).unwrap();
    grammar.starts[0].name = "a".into();
    assert_eq!(read(&to_string(&grammar)).unwrap(), grammar);
    grammar.starts.push(Start {
        name: "b".into(),
        symbol: "wall".into(),
        width: 3.0,
        height: 0.1,
    });
    let text = to_string(&grammar);
    assert_eq!(read(&text).unwrap(), grammar);
    let message = read(&text.replacen("10.0", "11.0", 1))
        .unwrap_err()
        .to_string();
    assert!(message.contains("facades[0]"), "{message}");
}

#[test]
fn relative_sizes_are_read() {
    let grammar = read(GOOD).unwrap();
    let edifice::grammar::Operation::GridSplit { rows, .. } = &grammar.rules[2].operation else {
        panic!("the third rule is a grid split");
    };
    assert_eq!(rows[..], [Size::Absolute(1.0), Size::Relative(3.0)]);
}

#[test]
fn bad_files_name_their_place() {
    let cases = [
        (
            "edifice/grammar",
            "edifice/facade",
            "format: unknown format",
        ),
        (
            "\"version\": 1",
            "\"version\": 9",
            "version: unknown version 9",
        ),
        ("\"size\": 2.0", "\"size\": NaN", "line 3"),
        ("\"size\": 2.0", "\"size\": 1e999", "rules[0].successors[0]"),
        (
            "\"size\": 2.0",
            "\"size\": -2.0",
            "rules[0].successors[0].size",
        ),
        (
            "\"size\": 2.0",
            "\"size\": 2.5",
            "rules[0] (Facade): sizes along y add up to 6.5, the region has 6",
        ),
        (
            "\"size\": 5.0",
            "\"size\": 4.0",
            "rules[1] (Floor): a period of 4 along x fits 2.5 times",
        ),
        (
            "\"size\": 2.0",
            "\"size\": 2.0, \"size\": 2.0",
            "duplicate field `size`",
        ),
        (
            "\"size\": 2.0",
            "\"size\": 2.0, \"weigth\": 2.0",
            "unknown field `weigth`",
        ),
        (
            "\"size\": 2.0",
            "\"relative\": true",
            "missing field `size`",
        ),
        ("\"op\": \"split\"", "\"op\": \"cut\"", "rules[0].op"),
        ("\"axis\": \"y\"", "\"axis\": \"z\"", "rules[0].axis"),
        ("\"axis\": \"y\",", "", "rules[0].axis: missing"),
        (
            "\"axis\": \"y\",",
            "\"axis\": \"y\", \"center\": true,",
            "rules[0].center",
        ),
        (
            "\"op\": \"repeat\"",
            "\"op\": \"repeat_aba\"",
            "exactly two",
        ),
        (
            "[\"wall\", \"wall\"]",
            "[\"wall\"]",
            "cells[0] has 1 entries, expected 2 (columns)",
        ),
        (
            "\"columns\": [2, 3]",
            "\"columns\": [2, true]",
            "rules[2].columns[1]",
        ),
        (
            "\"wall\", \"size\"",
            "\"Facade\", \"size\"",
            "cycle: Facade -> Facade",
        ),
        (
            "\"axiom\": \"Facade\"",
            "\"axiom\": \"Fassade\"",
            "start symbol Fassade is undefined",
        ),
        (
            "\"symbol\": \"Bay\", \"op\"",
            "\"symbol\": \"Floor\", \"op\"",
            "both define Floor",
        ),
        (
            "\"symbol\": \"Bay\", \"op\"",
            "\"symbol\": \"Bay\", \"weight\": 0, \"op\"",
            "rules[2].weight",
        ),
        ("]] } ] }", "]] } ] } }", "line 6"),
        ("]] } ] }", "]] } ]", "line 6"),
    ];
    for (from, to, expected) in cases {
        let text = GOOD.replacen(from, to, 1);
        assert_ne!(text, GOOD, "{from}");
        let message = read(&text).expect_err(to).to_string();
        assert!(message.starts_with("f.grammar.json: "), "{message}");
        assert!(message.contains(expected), "{to}: {message}");
    }
}
