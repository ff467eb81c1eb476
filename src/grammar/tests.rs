//! Costs of rules, derivation and evaluation of a grammar of a few rules, by hand.

use super::cost::Costs;
use super::derive::{derivation, derive};
use super::evaluate::{EvaluateError, evaluate};
use super::rule::{Grammar, Operation, Rule, Start, Successor};
use edifice_shape::{Axis, Facade};

fn rule(symbol: &str, operation: Operation) -> Rule {
    Rule {
        symbol: symbol.into(),
        weight: None,
        operation,
    }
}

fn split(axis: Axis, parts: &[(&str, f64)]) -> Operation {
    let successors = parts.iter().map(|(s, size)| Successor::new(*s, *size));
    Operation::Split {
        axis,
        successors: successors.collect(),
    }
}

/// A facade that begins with `F`.
fn grammar(width: f64, height: f64, rules: Vec<Rule>) -> Grammar {
    Grammar {
        unit: "m".into(),
        starts: vec![Start {
            name: "F".into(),
            symbol: "F".into(),
            width,
            height,
        }],
        rules,
    }
}

/// A wall of 6 by 4 with two equal windows of 1 by 2 in its upper floor.
fn house() -> Grammar {
    let rules = vec![
        rule("F", split(Axis::Y, &[("wall", 2.0), ("Floor", 2.0)])),
        rule(
            "Floor",
            Operation::Repeat {
                axis: Axis::X,
                successors: vec![Successor::new("Tile", 3.0)],
            },
        ),
        rule(
            "Tile",
            split(Axis::X, &[("wall", 1.0), ("window", 1.0), ("wall", 1.0)]),
        ),
    ];
    grammar(6.0, 4.0, rules)
}

#[test]
fn kinds_of_splits_and_of_repeats_cost_alike() {
    let costs = Costs::of(0.3, 0.7);
    assert_eq!([costs.split, costs.sym_split, costs.grid_split], [0.3; 3]);
    assert_eq!([costs.repeat, costs.repeat_aba], [0.7; 2]);
    assert_eq!(costs.successor, Costs::default().successor);
    assert!(costs.check().is_ok());
    for (wrong, name) in [
        (Costs::of(-1.0, 0.5), "split"),
        (Costs::of(0.1, 2e3), "repeat"),
    ] {
        assert_eq!(wrong.check().unwrap_err().name, name);
    }
    // Eq. 2: the operation and one for each successor; Eq. 1: the sum over the rules.
    let default = Costs::default();
    assert!((default.grammar(&house()) - (0.1 + 2.0 + 0.5 + 1.0 + 0.1 + 3.0)).abs() < 1e-12);
}

#[test]
fn a_grammar_is_derived_rule_by_rule() {
    let derived = derivation(&house(), 0).unwrap();
    let of = |label: &str| {
        derived
            .facade
            .regions
            .iter()
            .filter(|r| r.label == label)
            .count()
    };
    assert_eq!(
        (of("wall"), of("window"), derived.facade.regions.len()),
        (5, 2, 7)
    );
    let windows = derived
        .facade
        .regions
        .iter()
        .filter(|r| r.label == "window");
    let places: Vec<[f64; 4]> = windows
        .map(|r| [r.rect.x, r.rect.y, r.rect.width, r.rect.height])
        .collect();
    assert_eq!(places, [[1.0, 2.0, 1.0, 2.0], [4.0, 2.0, 1.0, 2.0]]);
    let depths: Vec<usize> = derived.non_terminals.iter().map(|n| n.depth).collect();
    assert_eq!(depths, [0, 1, 2, 2]);
    assert!(derived.shrunk.is_empty());
    assert!(derivation(&house(), 1).is_err());
    let mut two = house();
    two.rules
        .push(rule("Tile", split(Axis::X, &[("wall", 3.0)])));
    assert!(derivation(&two, 0).is_err());
}

#[test]
fn evaluation_rejects_what_does_not_explain_the_input() {
    // `A` is used at two heights: the widths add up, the contents differ.
    let rules = vec![
        rule("F", split(Axis::Y, &[("A", 1.0), ("A", 3.0)])),
        rule("A", split(Axis::X, &[("wall", 4.0), ("door", 6.0)])),
    ];
    let g = grammar(10.0, 4.0, rules);
    let facade = derive(&g, 0).unwrap();
    let costs = Costs::default();
    let outcome = evaluate(&g, std::slice::from_ref(&facade), &costs);
    assert!(matches!(outcome, Err(EvaluateError::Contents { .. })));
    let outcome = evaluate(&g, &[], &costs);
    assert!(matches!(
        outcome,
        Err(EvaluateError::Count {
            starts: 1,
            facades: 0
        })
    ));
    let mut other: Facade = facade;
    other.regions[0].label = "door".into();
    let outcome = evaluate(&g, &[other], &costs);
    assert!(matches!(
        outcome,
        Err(EvaluateError::Different { index: 0, .. })
    ));
}

/// The tolerance grows with the facade: lengths may differ by a millionth of its larger side.
#[test]
fn equal_contents_may_differ_by_a_millionth_of_the_facade() {
    let outcome = |width: f64, difference: f64| {
        let half = width / 2.0;
        let rules = vec![
            rule(
                "F",
                split(Axis::X, &[("A", half), ("A", half + difference)]),
            ),
            rule("A", split(Axis::Y, &[("wall", 0.5), ("door", 0.5)])),
        ];
        let g = grammar(width + difference, 1.0, rules);
        let facade = derive(&g, 0).unwrap();
        evaluate(&g, &[facade], &Costs::default())
    };
    for width in [1.0, 10.0, 1e3, 1e4] {
        assert_eq!(outcome(width, 0.5e-6 * width).unwrap().terminals, 4);
        let different = outcome(width, 2e-6 * width);
        assert!(
            matches!(different, Err(EvaluateError::Contents { ref symbol, .. }) if symbol == "A"),
            "{width}: {different:?}"
        );
    }
}

/// The limit is one of the number of regions: thousands are far from it however they come together.
#[test]
fn thousands_of_regions_are_derived() {
    let tiles = 5_000;
    let mut row = vec![("Tower", 1.0)];
    row.resize(1 + tiles, ("Tile", 1.0));
    let tower = Operation::Repeat {
        axis: Axis::Y,
        successors: vec![Successor::new("cell", 1.0)],
    };
    let rules = vec![
        rule("F", split(Axis::X, &row)),
        rule("Tower", tower),
        rule(
            "Tile",
            split(Axis::Y, &[("wall", 1_000.0), ("window", 1_000.0)]),
        ),
    ];
    let derived = derivation(&grammar(5_001.0, 2_000.0, rules), 0).unwrap();
    assert_eq!(derived.facade.regions.len(), 2_000 + 2 * tiles);
    assert_eq!(derived.non_terminals.len(), 2 + tiles);
}
