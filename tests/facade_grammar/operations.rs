//! Sets of operations: one that allows more never costs more.

use super::inference::{cost, facade_i, random_layout, random_layout_of};
use edifice::methods::facade_grammar::{Operations, Settings};

#[test]
fn extensions_never_cost_more_than_split_and_repeat() {
    let with = Operations {
        repeat_aba: true,
        sym_split: true,
        ..Operations::default()
    };
    let extended = cost(
        &facade_i(),
        &Settings {
            operations: with,
            ..Settings::default()
        },
    );
    assert!(extended < 38.1 + 1e-6, "{extended}");
}

/// Splits alone are allowed wherever more is, so more may not cost more, even where too little work is allowed to prove anything.
#[test]
fn more_operations_never_cost_more_than_splits_alone() {
    // Small ones are mostly proven, large ones never.
    let small = (0..2000).map(|seed| (seed, random_layout(seed, 1 + (seed % 7) as u32)));
    let large = (0..20).map(|seed| (seed, random_layout_of(32.0, 24.0, seed, 10)));
    for (seed, layout) in small.chain(large) {
        let settings = |operations| Settings {
            operations,
            iterations: 1 + seed % 3,
            ..Settings::default()
        };
        let splits = cost(&layout, &settings(Operations::split_only()));
        for operations in [Operations::default(), Operations::all()] {
            let more = cost(&layout, &settings(operations));
            assert!(
                more <= splits + 1e-6,
                "{seed} {operations}: {more} > {splits}"
            );
        }
    }
}
