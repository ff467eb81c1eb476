//! The statements of CityEngine's reference on sizes: absolute, floating, fractions, repeats, ranges.

use edifice::grammar::{Grammar, Operation, Rule, Size, derive};
use edifice::io::grammar_cga::{from_str, to_string};
use edifice::shape::Facade;

/// Sizes of the first rule.
fn sizes(grammar: &Grammar) -> Vec<Size> {
    match &grammar.rules[0].operation {
        Operation::Split { successors, .. } | Operation::Repeat { successors, .. } => {
            successors.iter().map(|s| s.size).collect()
        }
        other => panic!("{other:?}"),
    }
}

/// The facade that a text derives at another size.
fn lot(text: &str, width: f64, height: f64) -> Facade {
    let text = format!("//@ facade F {width} x {height}\n{text}");
    derive(&from_str(&text).unwrap(), 0).unwrap()
}

#[test]
fn absolute_sizes_are_exact_and_floating_ones_fill() {
    let text = "F --> split(x) { 3.3 : a | ~3 : b | 5 : c }";
    let widths: Vec<f64> = lot(text, 10.0, 1.0)
        .regions
        .iter()
        .map(|r| r.rect.width)
        .collect();
    assert!(
        (widths[0] - 3.3).abs() < 1e-12 && (widths[1] - 1.7).abs() < 1e-12,
        "{widths:?}"
    );
    let text = "F --> split(x) { ~0.5 : a | ~0.1 : b | ~0.2 : c }";
    let widths: Vec<f64> = lot(text, 10.0, 1.0)
        .regions
        .iter()
        .map(|r| r.rect.width)
        .collect();
    for (width, expected) in widths.iter().zip([6.25, 1.25, 2.5]) {
        assert!((width - expected).abs() < 1e-12, "{widths:?}");
    }
}

#[test]
fn fractions_of_the_whole_are_weights() {
    let widths = |text: &str, width: f64| -> Vec<f64> {
        let facade = lot(text, width, 1.0);
        facade
            .regions
            .iter()
            .map(|r| r.rect.width / width)
            .collect()
    };
    for width in [10.0, 23.0] {
        let found = widths("F --> split(x) { '0.2 : a | ~1 : b | ~3 : c }", width);
        for (fraction, expected) in found.iter().zip([0.2, 0.2, 0.6]) {
            assert!((fraction - expected).abs() < 1e-12, "{found:?}");
        }
        let found = widths(
            "const h = 1/2\nF --> split(x) { 'h : a | '(h/2) : b | '0.25 : c }",
            width,
        );
        assert_eq!(found.len(), 3);
        assert!((found[1] - 0.25).abs() < 1e-12);
        // Fits five times at every size, as the reference says of a tenth of the scope.
        let found = widths("F --> split(x) { '0.1 : a | '0.1 : b }*", width);
        assert_eq!(found.len(), 10);
    }
}

#[test]
fn repeats_fill_with_floating_sizes() {
    for (width, count) in [(10.0, 6), (9.0, 6), (14.5, 10)] {
        let facade = lot("F --> split(x) { ~2 : a | ~1 : b }*", width, 1.0);
        facade.check_tiling().unwrap();
        assert_eq!(facade.regions.len(), count, "{width}");
        let ratio = facade.regions[0].rect.width / facade.regions[1].rect.width;
        assert!((ratio - 2.0).abs() < 1e-9);
    }
    // The interleaved repeat of the reference, and its rhythm A B A B A.
    let facade = lot(
        "F --> split(x) { 1 : X | { ~1 : Y | 0.2 : Z | ~1 : Y }* | 1 : X }",
        10.0,
        1.0,
    );
    facade.check_tiling().unwrap();
    assert_eq!(facade.regions.len(), 14);
    assert!((facade.regions[1].rect.width - 0.9).abs() < 1e-9);
    let facade = lot(
        "F --> split(x) { { 1 : A | ~2.7 : B }* | 1 : A }",
        10.0,
        1.0,
    );
    facade.check_tiling().unwrap();
    let labels: String = facade.regions.iter().map(|r| r.label.as_str()).collect();
    assert!(
        labels.starts_with("AB") && labels.ends_with("BA"),
        "{labels}"
    );
}

#[test]
fn splits_and_repeats_are_nested() {
    let once = from_str("//@ facade F 6 x 1\nF --> split(x) { 1 : A | 2 : B }*").unwrap();
    for text in [
        "F --> split(x) { { 1 : A | 2 : B }* }",
        "F --> split(x) { { 1 : A | 2 : B }* }*",
        "F --> split(x) { { { 1 : A | { 2 : B } }* }* }*",
    ] {
        assert_eq!(
            from_str(&format!("//@ facade F 6 x 1\n{text}")).unwrap(),
            once,
            "{text}"
        );
    }
    let facade = lot("F --> split(x) { { ~1 : A }* | { ~1 : B }* }", 8.0, 1.0);
    facade.check_tiling().unwrap();
    assert_eq!(facade.regions.len(), 8);
    let facade = lot(
        "F --> split(x) { { { ~1 : A }* | 2 : B }* | 1 : C }",
        25.0,
        1.0,
    );
    facade.check_tiling().unwrap();
    let count = |label: &str| facade.regions.iter().filter(|r| r.label == label).count();
    assert!(count("A") >= count("B") && count("B") >= 2 && count("C") == 1);
    let facade = lot(
        "F --> split(y) { ~1 : split(x) { ~1 : A | 2 : B } | 3 : C }",
        9.0,
        9.0,
    );
    facade.check_tiling().unwrap();
    assert_eq!(facade.regions.len(), 3);
}

#[test]
fn ranges_are_equally_likely_sizes() {
    let grammar =
        from_str("//@ facade F 10 x 1\nF --> split(x) { rand(2, 4) : a | ~1 : b | rand(1) : c }")
            .unwrap();
    assert_eq!(grammar.rules.len(), 5);
    let column = |part: usize| -> Vec<f64> {
        let size = |rule: &Rule| match &rule.operation {
            Operation::Split { successors, .. } => successors[part].size.value(),
            other => panic!("{other:?}"),
        };
        let mut sizes: Vec<f64> = grammar.rules.iter().map(size).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    };
    assert!(grammar.rules.iter().all(|r| r.weight == Some(20.0)));
    for (found, expected) in column(0).iter().zip([2.2, 2.6, 3.0, 3.4, 3.8]) {
        assert!((found - expected).abs() < 1e-12);
    }
    for (found, expected) in column(2).iter().zip([0.1, 0.3, 0.5, 0.7, 0.9]) {
        assert!((found - expected).abs() < 1e-12);
    }
    // The two ranges do not move together.
    assert_ne!(sizes(&grammar)[0], Size::Absolute(2.2 + 2.0 * 0.1));
    let text = to_string(&grammar);
    assert_eq!(from_str(&text).unwrap(), grammar, "{text}");
    let mixed = "//@ facade F 10 x 1\nF -->\n40% : split(x) { ~rand(1, 3) : a }*\nelse : split(x) { ~1 : b }";
    let weights: Vec<f64> = from_str(mixed)
        .unwrap()
        .rules
        .iter()
        .filter_map(|r| r.weight)
        .collect();
    assert_eq!(weights, [8.0, 8.0, 8.0, 8.0, 8.0, 60.0]);
    // Constants are evaluated once: the middle of their range.
    let text = "attr w = rand(2, 6)\nF --> split(x) { w : a | ~1 : b }";
    assert_eq!(
        sizes(&from_str(&format!("//@ facade F 9 x 1\n{text}")).unwrap())[0],
        Size::Absolute(4.0)
    );
}

#[test]
fn the_contract_is_still_read() {
    let text = "//@ facade Facade 100 x 38\nFacade --> split(y) { 8 : wall | 30 : Floor }\nFloor --> split(x) { { 50 : Bay }* }";
    let grammar = from_str(text).unwrap();
    assert_eq!(sizes(&grammar), [Size::Absolute(8.0), Size::Absolute(30.0)]);
    assert_eq!(derive(&grammar, 0).unwrap().regions.len(), 3);
}
