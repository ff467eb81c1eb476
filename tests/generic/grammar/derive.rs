//! Derivation, checking and evaluation of split grammars.

use super::support::{naive, random_grammar};
use edifice::grammar::{
    Costs, Grammar, GrammarError, Operation, Rule, Size, Start, Successor, Warning, check,
    derivation, derive, evaluate, same_tiling,
};
use edifice::shape::{Axis, Facade, Rect};
use proptest::prelude::*;

fn start(symbol: &str, width: f64, height: f64) -> Start {
    Start {
        name: symbol.into(),
        symbol: symbol.into(),
        width,
        height,
    }
}

fn rule(symbol: &str, operation: Operation) -> Rule {
    Rule {
        symbol: symbol.into(),
        weight: None,
        operation,
    }
}

fn split(axis: Axis, parts: &[(&str, f64)]) -> Operation {
    let successors = parts.iter().map(|&(s, v)| Successor::new(s, v)).collect();
    Operation::Split { axis, successors }
}

fn repeat(axis: Axis, parts: &[(&str, f64)]) -> Operation {
    let successors = parts.iter().map(|&(s, v)| Successor::new(s, v)).collect();
    Operation::Repeat { axis, successors }
}

fn grammar(width: f64, height: f64, rules: Vec<Rule>) -> Grammar {
    Grammar {
        unit: "px".into(),
        starts: vec![start("F", width, height)],
        rules,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn derivation_equals_the_naive_one(seed: u64) {
        let grammar = random_grammar(seed);
        prop_assert_eq!(check(&grammar), Ok(Vec::new()));
        let facade = derive(&grammar, 0).unwrap();
        let mut regions = Vec::new();
        let start = &grammar.starts[0];
        let domain = Rect::new(0.0, 0.0, start.width, start.height);
        naive(&grammar, &start.symbol, domain, &mut regions);
        prop_assert_eq!(&facade.regions, &regions);
        let area: f64 = regions.iter().map(|r| r.rect.area()).sum();
        prop_assert!((area - domain.area()).abs() < 1e-6 * domain.area());
        let evaluation = evaluate(&grammar, &[facade], &Costs::default()).unwrap();
        prop_assert_eq!(evaluation.terminals, regions.len());
        prop_assert_eq!(evaluation.rules, grammar.rules.len());
    }

    #[test]
    fn a_broken_size_is_found(seed: u64, pick: prop::sample::Index) {
        let mut grammar = random_grammar(seed);
        prop_assume!(!grammar.rules.is_empty());
        let index = pick.index(grammar.rules.len());
        match &mut grammar.rules[index].operation {
            Operation::Split { successors, .. }
            | Operation::Repeat { successors, .. }
            | Operation::SymSplit { successors, .. } => {
                successors[0].size = Size::Absolute(successors[0].size.value() + 1000.5);
            }
            Operation::RepeatAba { a, .. } => a.size = Size::Absolute(a.size.value() + 1000.5),
            Operation::GridSplit { rows, .. } => rows[0] = Size::Absolute(rows[0].value() + 1000.5),
        }
        prop_assert!(check(&grammar).is_err());
        prop_assert!(derive(&grammar, 0).is_err());
    }

    #[test]
    fn same_tiling_ignores_order_and_sees_moves(seed: u64, pick: prop::sample::Index) {
        let facade = derive(&random_grammar(seed), 0).unwrap();
        let mut other = facade.clone();
        other.regions.reverse();
        prop_assert!(same_tiling(&facade, &other));
        let index = pick.index(other.regions.len());
        other.regions[index].rect.width += 1e-9;
        prop_assert!(same_tiling(&facade, &other));
        other.regions[index].rect.width -= 0.25;
        prop_assert!(!same_tiling(&facade, &other));
        other.regions.remove(index);
        prop_assert!(!same_tiling(&facade, &other));
        prop_assert!(!same_tiling(&other, &facade));
    }
}

#[test]
fn a_cycle_is_named() {
    let rules = vec![
        rule("F", split(Axis::X, &[("wall", 4.0), ("A", 6.0)])),
        rule("A", split(Axis::X, &[("B", 6.0)])),
        rule("B", split(Axis::X, &[("A", 6.0)])),
    ];
    let grammar = grammar(10.0, 10.0, rules);
    let symbols = vec!["A".to_owned(), "B".into(), "A".into()];
    let expected = Err(GrammarError::Cycle { symbols });
    assert_eq!(check(&grammar).map(|_| ()), expected);
    assert_eq!(derive(&grammar, 0).map(|_| ()), expected);
}

#[test]
fn every_way_to_be_wrong_has_its_error() {
    use GrammarError as E;
    let wall = |v| split(Axis::X, &[("wall", v)]);
    let fails = |g: &Grammar| check(g).unwrap_err();
    let one = |operation| grammar(10.0, 4.0, vec![rule("F", operation)]);

    let mut none = one(wall(10.0));
    none.starts.clear();
    assert_eq!(fails(&none), E::NoStart);
    let g = grammar(f64::NAN, 4.0, vec![]);
    assert!(matches!(
        fails(&g),
        E::StartSize {
            dimension: "width",
            ..
        }
    ));
    let g = grammar(10.0, 4.0, vec![rule("Foo", wall(10.0))]);
    assert_eq!(fails(&g), E::UndefinedStart { symbol: "F".into() });
    let g = one(split(Axis::X, &[("", 10.0)]));
    let place = "rules[0].successors[0].symbol".to_owned();
    assert_eq!(fails(&g), E::EmptySymbol { place });
    let g = one(split(Axis::X, &[]));
    assert!(matches!(fails(&g), E::NoSuccessors { rule: 0, .. }));
    for value in [0.0, -3.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            fails(&one(wall(value))),
            E::SizeNumber { rule: 0, .. }
        ));
        let mut g = one(wall(10.0));
        g.rules[0].weight = Some(value);
        assert!(matches!(fails(&g), E::Weight { rule: 0, .. }));
    }
    let g = grammar(
        10.0,
        4.0,
        vec![rule("F", wall(10.0)), rule("F", wall(10.0))],
    );
    assert!(matches!(
        fails(&g),
        E::DuplicateRule {
            first: 0,
            second: 1,
            ..
        }
    ));
    let mut weighted = g.clone();
    weighted.rules[0].weight = Some(1.0);
    assert!(matches!(fails(&weighted), E::DuplicateRule { .. }));
    weighted.rules[1].weight = Some(2.0);
    assert_eq!(check(&weighted), Ok(vec![]));
    assert!(matches!(
        derive(&weighted, 0),
        Err(E::Stochastic { count: 2, .. })
    ));
    let sum = fails(&one(split(Axis::X, &[("wall", 4.0), ("door", 5.0)])));
    assert!(matches!(
        sum,
        E::SizesDoNotAddUp {
            sum: 9.0,
            extent: 10.0,
            ..
        }
    ));
    for period in [3.0, 10.0, 30.0] {
        let g = one(repeat(Axis::X, &[("wall", period)]));
        assert!(matches!(fails(&g), E::RepeatDoesNotFit { least: 2, .. }));
    }
    let grid = Operation::GridSplit {
        columns: vec![Size::Absolute(5.0); 2],
        rows: vec![Size::Absolute(4.0)],
        cells: vec![vec!["wall".into(); 3]],
    };
    assert!(matches!(
        fails(&one(grid)),
        E::GridShape {
            found: 3,
            expected: 2,
            ..
        }
    ));
    let g = one(repeat(Axis::X, &[("wall", 1e-7)]));
    assert!(matches!(derive(&g, 0), Err(E::TooManyRegions { .. })));
    assert!(matches!(
        derive(&one(wall(10.0)), 3),
        Err(E::StartIndex { index: 3, count: 1 })
    ));
}

#[test]
fn doubling_rules_do_not_eat_the_memory() {
    let mut rules: Vec<Rule> = (0..50)
        .map(|i| {
            let next = format!("S{}", i + 1);
            let half = 2f64.powi(-i - 1);
            rule(
                &format!("S{i}"),
                split(Axis::X, &[(&next, half), (&next, half)]),
            )
        })
        .collect();
    rules[0].symbol = "F".into();
    let grammar = grammar(1.0, 1.0, rules);
    assert_eq!(check(&grammar), Ok(vec![]));
    let outcome = derive(&grammar, 0);
    assert!(matches!(outcome, Err(GrammarError::TooManyRegions { .. })));
}

#[test]
fn depth_is_no_limit() {
    let depth = 100_000;
    let mut rules: Vec<Rule> = (0..depth)
        .map(|i| {
            let size = f64::from(depth - i);
            let next = format!("S{}", i + 1);
            rule(
                &format!("S{i}"),
                split(Axis::X, &[("wall", 1.0), (&next, size)]),
            )
        })
        .collect();
    rules[0].symbol = "F".into();
    let grammar = grammar(f64::from(depth + 1), 1.0, rules);
    assert_eq!(check(&grammar), Ok(vec![]));
    let facade = derive(&grammar, 0).unwrap();
    assert_eq!(facade.regions.len(), depth as usize + 1);
}

#[test]
fn unused_rules_are_warned_of() {
    let rules = vec![
        rule("F", split(Axis::X, &[("wall", 10.0)])),
        rule("Floor", split(Axis::X, &[("wall", 10.0)])),
    ];
    let warnings = check(&grammar(10.0, 4.0, rules)).unwrap();
    let symbol = "Floor".to_owned();
    assert_eq!(warnings, [Warning::Unreachable { rule: 1, symbol }]);
}

#[test]
fn a_joint_grammar_derives_each_start() {
    let rules = vec![
        rule("F", split(Axis::Y, &[("A", 1.0), ("A", 1.0)])),
        rule("G", split(Axis::Y, &[("A", 1.0), ("wall", 2.0)])),
        rule("A", split(Axis::X, &[("wall", 4.0), ("door", 6.0)])),
    ];
    let mut g = grammar(10.0, 2.0, rules);
    g.starts.push(start("G", 10.0, 3.0));
    g.starts.push(start("wall", 2.0, 3.0));
    assert_eq!(check(&g), Ok(vec![]));
    let facades: Vec<Facade> = (0..3).map(|i| derive(&g, i).unwrap()).collect();
    let counts: Vec<usize> = facades.iter().map(|f| f.regions.len()).collect();
    assert_eq!(counts, [4, 3, 1]);
    let evaluation = evaluate(&g, &facades, &Costs::default()).unwrap();
    assert!((evaluation.cost - 6.3).abs() < 1e-12);
    assert_eq!(derivation(&g, 1).unwrap().non_terminals.len(), 2);
}
