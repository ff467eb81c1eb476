//! Inference of facade grammars against the exact search for the smallest grammar.

use edifice::grammar::{Costs, evaluate};
use edifice::methods::facade_grammar::Operations;
use edifice::rng::stream;
use edifice_smallest_grammar::compare::{Case, prices};
use edifice_smallest_grammar::{Content, Limits, brute_force, layouts, operation_sets, smallest};
use rand::RngExt;

const LIMITS: Limits = Limits {
    types: 400,
    steps: 100_000,
    bounds: 2_000,
};
/// Work of inference.
const ITERATIONS: u64 = 200;

fn operations(text: &str) -> Operations {
    text.parse().unwrap()
}

/// The cost that the exact search finds; its grammar is one of the layouts and costs that much.
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
    for index in 0..320 {
        let rng = &mut stream(1, "brute force", index);
        let most = if index % 8 == 0 { 6 } else { 5 };
        let facades = layouts::random_layouts(rng, 1 + index as usize % 2, 1, most);
        let operations = sets[rng.random_range(0..sets.len())];
        let (prices, costs) = prices()[rng.random_range(0..prices().len())];
        let found = exact(&facades, operations, &costs).unwrap();
        let expected = brute_force(&facades, operations, &costs);
        assert!(
            (found - expected).abs() < 1e-9,
            "{index} {operations}, {prices}: {found} instead of {expected}: {facades:?}"
        );
    }
}

/// No bound of inference is above the least cost, whatever the operations and costs.
fn no_proof_is_false(seed: u64, count: u64, most: usize) {
    let (mut finished, mut proven, mut optimal) = (0, 0, 0);
    let mut faults = Vec::new();
    for index in 0..count {
        let case = Case::random(seed, index, most);
        let found = case.compare(ITERATIONS, &LIMITS);
        finished += u64::from(found.exact.is_some());
        proven += u64::from(found.proven());
        optimal += u64::from(found.optimal());
        faults.extend(
            found
                .fault()
                .map(|fault| format!("{index}: {fault}: {case}")),
        );
    }
    println!("{count} cases: {finished} searched, {optimal} optimal, {proven} proven");
    assert!(
        faults.is_empty(),
        "{} false of {proven} proven:\n{}",
        faults.len(),
        faults.join("\n")
    );
    // Half of the cases allow grids, with which nothing is proven.
    assert!(finished * 20 > count * 19 && optimal * 10 > finished * 9 && proven * 5 > count * 2);
}

#[test]
fn no_proof_is_false_up_to_nine_tiles() {
    no_proof_is_false(5, 1_600, 9);
}

#[test]
fn no_proof_is_false_up_to_fourteen_tiles() {
    no_proof_is_false(6, 400, 14);
}
