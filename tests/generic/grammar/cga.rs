//! Grammars as CGA text: round trips, what is understood, and errors with their place.

use super::support::{random_grammar, size_independent, stochastic};
use edifice::grammar::{Costs, Grammar, Operation, Size, derive, evaluate, listing};
use edifice::io::grammar_cga::{from_str, parse, to_string};
use edifice::io::grammar_json;
use edifice::shape::Axis;
use proptest::prelude::*;

const FIG9: &str = include_str!("../../../datasets/facade_grammar/wu2014_fig9.cga");

/// The rules of each symbol brought together, as text does.
fn gathered(grammar: &Grammar) -> Grammar {
    let mut out = grammar.clone();
    let first = |symbol: &str| grammar.rules.iter().position(|r| r.symbol == symbol);
    out.rules.sort_by_key(|rule| first(&rule.symbol));
    out
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn round_trip_keeps_every_bit(seed: u64) {
        let absolute = random_grammar(seed);
        for grammar in [size_independent(&absolute), stochastic(&absolute, seed), absolute] {
            let text = to_string(&grammar);
            let back = from_str(&text).map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
            prop_assert_eq!(&back, &gathered(&grammar), "{}", text);
            // Text to value to text is a fixed point, and JSON agrees.
            prop_assert_eq!(&to_string(&back), &text);
            let json = grammar_json::to_string(&back);
            let from_json = grammar_json::parse(json.as_bytes(), "f".as_ref()).unwrap();
            prop_assert_eq!(from_json, back);
        }
    }

    #[test]
    fn any_text_is_an_error_or_a_grammar(text in "\\PC*|([A-C ]|-->|split|\\(x\\)|[{}:|*~%/\n\"@#]|[0-9.]{1,3}|//@|é|attr|else)*") {
        if let Err(error) = from_str(&text) {
            prop_assert!(error.line >= 1 && error.column >= 1);
        }
    }

    #[test]
    fn changed_text_never_panics(seed: u64, at: prop::sample::Index, cut in 0usize..4, insert in "\\PC{0,3}|[{}()|:*~]") {
        let text = to_string(&random_grammar(seed));
        let places: Vec<usize> = text.char_indices().map(|(i, _)| i).collect();
        let from = at.index(places.len());
        let to = (from + cut).min(places.len() - 1);
        let changed = format!("{}{insert}{}", &text[..places[from]], &text[places[to]..]);
        if let Err(error) = from_str(&changed) {
            prop_assert!(!error.to_string().is_empty());
        }
    }

    #[test]
    fn any_bytes_are_no_panic(bytes: Vec<u8>) {
        let _ = parse(&bytes, "f.cga".as_ref());
    }
}

#[test]
fn the_printed_grammar_has_fifty_terminals_and_its_printed_cost() {
    let grammar = from_str(FIG9).unwrap();
    let facade = derive(&grammar, 0).unwrap();
    assert_eq!(facade.regions.len(), 50);
    let costs = Costs::default();
    let cost = |g: &Grammar| {
        evaluate(g, std::slice::from_ref(&facade), &costs)
            .unwrap()
            .cost
    };
    assert!((cost(&grammar) - 39.4).abs() < 1e-9);
    let mut split_only = grammar.clone();
    let Operation::Repeat { axis, successors } = grammar.rules[1].operation.clone() else {
        panic!("NT2 repeats");
    };
    let successors = [successors.clone(), successors].concat();
    split_only.rules[1].operation = Operation::Split { axis, successors };
    assert!((cost(&split_only) - 40.0).abs() < 1e-9);
}

#[test]
fn cityengine_idioms_are_understood() {
    let text = r#"
        /* as CityEngine writes it */
        version "2019.0"
        attr floor_height = 3
        const half = (floor_height - 1) / 2 # a comment
        Unused --> split(x) { 1 : wall }
        @StartRule
        Lot --> split(y) { floor_height + 1 : Ground | { floor_height : Floor }* | 1 : cornice }
        Floor --> split(x) { ~half : Bay }*
        Bay --> split(x) { ~1 : wall | 0.5 : split(y) { 1 : sill | ~1 : window } | ~1 : wall }
        Ground --> split(x) { 12 : Shop }
        Shop -->
            30% : split(x) { ~1 : shop }
            else : split(x) { ~1 : door }
    "#;
    let error = from_str(text).unwrap_err();
    assert!(error.message.contains("//@ facade Lot"), "{error}");
    let grammar = from_str(&format!("//@ facade Lot 12 x 20\n{text}")).unwrap();
    assert_eq!(grammar.unit, "m");
    let names: Vec<&str> = grammar.rules.iter().map(|r| r.symbol.as_str()).collect();
    assert_eq!(
        names,
        [
            "Unused", "Lot", "Lot_1", "Floor", "Bay", "Bay_1", "Ground", "Shop", "Shop"
        ]
    );
    let Operation::Split { successors, .. } = &grammar.rules[1].operation else {
        panic!()
    };
    let sizes: Vec<Size> = successors.iter().map(|s| s.size).collect();
    assert_eq!(
        sizes,
        [
            Size::Absolute(4.0),
            Size::Relative(3.0),
            Size::Absolute(1.0)
        ]
    );
    assert!(matches!(
        &grammar.rules[3].operation,
        Operation::Repeat { axis: Axis::X, .. }
    ));
    assert_eq!(grammar.rules[8].weight, Some(70.0));
}

#[test]
fn the_size_follows_from_absolute_sizes() {
    let grammar =
        from_str("F --> split(y) { 2 : wall | 3 : G }\nG --> split(x) { 4 : a | 5 : b }").unwrap();
    assert_eq!(
        (grammar.starts[0].width, grammar.starts[0].height),
        (9.0, 5.0)
    );
    let aba =
        from_str("//@ facade F 28 x 1\nF --> split(x) { 8 : A | { 12 : B | 8 : A }* }").unwrap();
    assert!(matches!(
        aba.rules[0].operation,
        Operation::RepeatAba { .. }
    ));
    assert_eq!(derive(&aba, 0).unwrap().regions.len(), 3);
}

#[test]
fn errors_name_line_column_and_text() {
    let cases = [
        (
            "F --> split(x) { 3 : A || 2 : B }",
            (1, 25),
            "|",
            "found '|', expected",
        ),
        (
            "F --> split(x) { 3 : A |",
            (1, 25),
            "",
            "the end of the text",
        ),
        (
            "\n  F --> split(z) { 3 : A }",
            (2, 15),
            "z",
            "expected x or y",
        ),
        ("F --> split(x) { 3 ? A }", (1, 20), "?", "no meaning"),
        (
            "F --> split(x) { h : A }",
            (1, 18),
            "h",
            "constant h is not defined",
        ),
        (
            "F --> split(x) { 3-3 : A }",
            (1, 18),
            "3-3",
            "size 0, expected a positive number",
        ),
        (
            "F --> split(x) { 1/0 : A }",
            (1, 18),
            "1/0",
            "expected a finite number",
        ),
        ("const a = 1\nconst a = 2", (2, 7), "a", "defined twice"),
        (
            "//@ facade F 5 x 5\nF --> split(x) { 3 : A }",
            (2, 1),
            "F",
            "add up to 3, the region has 5",
        ),
        (
            "//@ facade F 5 x 5\nF --> split(x) { 5 : G }\nG --> split(x) { 5 : F }",
            (2, 1),
            "F",
            "cycle: F -> G -> F",
        ),
        (
            "F --> split(x) { 5 : G }\n F --> split(x) { 5 : G }",
            (2, 2),
            "F",
            "both define F",
        ),
        (
            "//@ facade F 5\nF --> split(x) { 5 : G }",
            (1, 1),
            "//@ facade F 5",
            "//@ facade Symbol 400 x 600",
        ),
        (
            "//@ sum\nF --> split(x) { 5 : G }",
            (1, 1),
            "//@ sum",
            "expected //@ unit",
        ),
        (
            "F -->\n//@ sym_split\nsplit(x) { 5 : G | 2 : H }",
            (2, 1),
            "//@ sym_split",
            "not the same from both ends",
        ),
        (
            "F -->\n//@ grid_split\nsplit(y) { 5 : G }",
            (2, 1),
            "//@ grid_split",
            "not one grid",
        ),
        (
            "//@ weights 1 3\nF --> 50% : A else : B",
            (1, 1),
            "//@ weights 1 3",
            "do not match the percentages",
        ),
        (
            "//@ facade F 5 x 5\nF --> 120% : A else : B",
            (2, 23),
            "B",
            "weight (F) is -20",
        ),
        ("F --> extrude(3) { A }", (1, 18), "{", "found '{'"),
        (
            "F --> comp(f) A",
            (1, 7),
            "comp",
            "no operation of split grammars",
        ),
        (
            "F --> split(x) { 3 : comp(f) A }",
            (1, 22),
            "comp",
            "no operation of split grammars",
        ),
        (
            "F --> split(x) { 3 : color(1, (0), 0) | 2 : B }",
            (1, 22),
            "color(1, (0), 0)",
            "this part becomes no symbol",
        ),
        (
            "a --> color(1, 0, 0)\na --> i(\"a.obj\")",
            (2, 1),
            "a",
            "already has a rule",
        ),
        (
            "a --> color(1, 0, 0)\n//@ facade a 3 x 3\na --> split(x) { 3 : B }",
            (1, 1),
            "a",
            "already has a rule",
        ),
        (
            "F --> split(x) { '0.5 : A | '0.4 : B }",
            (1, 19),
            "0.5",
            "add up to 0.9 of the whole",
        ),
        (
            "F --> split(x) { '0.5 : A | '0.6 : B | ~1 : C }",
            (1, 19),
            "0.5",
            "add up to 1.1 of the whole",
        ),
        (
            "F --> split(x) { '0.5 : A | 2 : B }",
            (1, 29),
            "2",
            "different gaps at different sizes",
        ),
        (
            "F --> split(x) { '0.3 : A | '0.1 : B }*",
            (1, 39),
            "*",
            "takes 0.4 of the whole",
        ),
        (
            "F --> split(x) { '0.5 : A | ~1 : B }*",
            (1, 37),
            "*",
            "either ' sizes only or none",
        ),
        (
            "F --> split(x) { rand(0, -1) : A | ~1 : B }",
            (1, 18),
            "rand(0, -1)",
            "size -0.1, expected a positive number",
        ),
        (
            "F -->\n//@ relative\nsplit(x) { 5 : G }",
            (2, 1),
            "//@ relative",
            "needs //@ sizes absolute",
        ),
        (
            "//@ sizes small\nF --> split(x) { 5 : G }",
            (1, 1),
            "//@ sizes small",
            "expected //@ sizes absolute",
        ),
        ("", (1, 1), "", "no rules"),
    ];
    for (text, place, found, message) in cases {
        let error = from_str(text).expect_err(text);
        assert!(error.message.contains(message), "{text}: {error}");
        assert_eq!(
            ((error.line, error.column), error.found.as_str()),
            (place, found),
            "{text}: {error}"
        );
    }
    let error = parse(b"\nF --> split(x) { 3 : A | 2 \xff }", "a.cga".as_ref()).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("a.cga: line 2: invalid utf-8"),
        "{error}"
    );
    let error = parse(b"F -->\n  split(x) { 3 : A | : B }", "a.cga".as_ref())
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("a.cga: line 2, column 22: found ':'"),
        "{error}"
    );
    assert!(error.contains("split(x) { 3 : A | : B }"), "{error}");
}

#[test]
fn deep_nesting_is_refused() {
    let text = format!("F --> {}A", "split(x) { 1 : ".repeat(100_000));
    let error = from_str(&text).unwrap_err();
    assert!(error.message.contains("nested too deeply"), "{error}");
    let error = from_str(&format!("const a = {}1", "-".repeat(100_000))).unwrap_err();
    assert_eq!(error.line, 1);
}

#[test]
fn a_listing_reads_like_the_paper() {
    let text = "//@ facade NT1 36 x 9\nNT1 --> split(x) { 8 : NT8 | { 6 : T | 8 : NT8 }* }\n\
                NT8 -->\n//@ sym_split\nsplit(x) { 3 : Window1 | 2 : Wall1 | 3 : Window1 }\n\
                NT9 --> 25% : split(x) { ~1 : a } else : split(x) { ~1 : b }";
    let grammar = from_str(text).unwrap();
    let expected = [
        "NT1 → repeatABA(x){NT8 | T}",
        "NT8 → symsplit(x){Window1 | Wall1}",
        "NT9 → [25%] split(x){a}",
        "NT9 → [75%] split(x){b}",
    ];
    assert_eq!(listing(&grammar, false), expected);
    assert_eq!(
        listing(&grammar, true)[0],
        "NT1 → repeatABA(x){8: NT8 | 6: T}"
    );
    assert!((Costs::default().grammar(&grammar) - 6.8).abs() < 1e-9);
}
