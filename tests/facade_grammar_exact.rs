//! Inference of facade grammars against the exact search for the smallest grammar.

mod smallest_grammar;

use edifice::grammar::{Costs, evaluate};
use edifice::methods::facade_grammar::Operations;
use edifice::rng::stream;
use rand::RngExt;
use smallest_grammar::{Content, Limits, brute_force, operation_sets, smallest};

const LIMITS: Limits = Limits {
    types: 400,
    steps: 100_000,
    bounds: 5_000,
};

fn operations(text: &str) -> Operations {
    text.parse().unwrap()
}

/// What the exact search finds is a grammar of the layouts and costs what it says.
fn exact(facades: &[Content], operations: Operations, costs: &Costs) -> Option<f64> {
    let found = smallest(facades, operations, costs, &LIMITS)?;
    let layouts: Vec<_> = facades.iter().map(|f| f.facade("tiny")).collect();
    let cost = evaluate(&found.grammar, &layouts, costs).unwrap().cost;
    assert!((cost - found.cost).abs() < 1e-9);
    Some(cost)
}

#[test]
fn the_exact_search_knows_small_optima() {
    for (labels, allowed, cost) in [
        ("a", "split", 0.0),
        ("aaa", "split", 3.1),
        ("aaa", "split,repeat", 1.5),
        ("aba", "split,repeat,repeat_aba", 2.5),
        ("aa", "split,sym_split", 1.1),
        ("abba", "split,repeat,sym_split", 2.1),
        ("baaaacaa", "split,repeat,sym_split", 6.2),
    ] {
        let found = exact(
            &[Content::row(labels)],
            operations(allowed),
            &Costs::default(),
        );
        assert!((found.unwrap() - cost).abs() < 1e-9, "{labels}: {found:?}");
    }
}

#[test]
fn the_exact_search_agrees_with_brute_force() {
    let sets: Vec<Operations> = operation_sets().collect();
    for index in 0..400 {
        let rng = &mut stream(1, "brute_force", index);
        let facades = smallest_grammar::layouts::random_layouts(rng, 1 + index as usize % 2, 1, 6);
        let operations = sets[rng.random_range(0..sets.len())];
        let costs = Costs::default();
        let found = exact(&facades, operations, &costs).unwrap();
        let expected = brute_force(&facades, operations, &costs);
        assert!(
            (found - expected).abs() < 1e-9,
            "{index} {operations}: {found} instead of {expected}: {facades:?}"
        );
    }
}
