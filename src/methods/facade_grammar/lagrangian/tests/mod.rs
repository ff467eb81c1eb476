mod dual;
mod linear_program;

use super::dual::Dual;
use super::*;
use crate::operations::Operations;
use crate::regions::Types;
use crate::rules::extract;
use edifice_base::{Watched, unwatched};
use edifice_grammar::{Costs, evaluate};
use edifice_shape::{Facade, Rect, Region};

/// A facade of unit cells, one character a cell, rows from bottom to top.
fn facade(rows: &[&str]) -> Facade {
    let cells = rows.iter().enumerate().flat_map(|(y, row)| {
        row.chars().enumerate().map(move |(x, label)| Region {
            label: label.to_string(),
            rect: Rect::new(x as f64, y as f64, 1.0, 1.0),
        })
    });
    let (width, height) = (rows[0].len() as f64, rows.len() as f64);
    Facade::new("cells", "cell", width, height, cells.collect()).unwrap()
}

const EXTENSIONS: Operations = Operations {
    repeat: true,
    repeat_aba: true,
    sym_split: true,
    grid_split: false,
};

/// Bound and incumbent after some steps; the incumbent's rules must derive the facades at its cost.
fn solved(facades: &[Facade], operations: Operations, nodes: u64) -> (f64, f64) {
    let costs = Costs::default();
    let program = Program::new(
        Types::new(facades).unwrap(),
        &costs,
        operations,
        usize::MAX,
        &Watched::new(&unwatched),
    )
    .unwrap();
    let mut incumbent = Incumbent::new(f64::INFINITY, &costs, operations);
    let limits = BoundLimits {
        nodes,
        ..BoundLimits::default()
    };
    let (lower, _) = solve(program, &mut incumbent, &limits);
    let mut types = Types::new(facades).unwrap();
    let rules = incumbent.rules(&mut types);
    let grammar = extract::grammar(&mut types, facades, &rules);
    let evaluation = evaluate(&grammar, facades, &costs).unwrap();
    assert!((evaluation.cost - incumbent.cost).abs() < 1e-9);
    assert!(lower <= incumbent.cost + 1e-9);
    (lower, incumbent.cost)
}

#[test]
fn one_rule_is_its_own_optimum() {
    // One split of four different cells.
    let (lower, cost) = solved(&[facade(&["abcd"])], Operations::default(), 1);
    assert!((cost - 4.1).abs() < 1e-9 && (lower - 4.1).abs() < 1e-9);
    // One repeat of two.
    let (_, cost) = solved(&[facade(&["abababab"])], Operations::default(), 1);
    assert!((cost - 2.5).abs() < 1e-9);
}

#[test]
fn extensions_are_operators_of_their_own() {
    let cost = |rows: &[&str]| solved(&[facade(rows)], EXTENSIONS, 1).1;
    // `ababa` as an alternation, `abcba` mirrored about a cell, `abccba` about a line.
    assert!((cost(&["ababa"]) - 2.5).abs() < 1e-9);
    assert!((cost(&["abcba"]) - 3.1).abs() < 1e-9);
    assert!((cost(&["abccba"]) - 3.1).abs() < 1e-9);
}

#[test]
fn facades_share_what_they_have_in_common() {
    let pair = [facade(&["abcde", "fghij"]), facade(&["abcde", "klmno"])];
    let alone: f64 = pair
        .iter()
        .map(|f| solved(std::slice::from_ref(f), Operations::default(), 1).1)
        .sum();
    let (lower, together) = solved(&pair, Operations::default(), 200);
    assert!(together < alone - 1.0 && (lower - together).abs() < 1e-6);
    // The same facade twice needs its rules once.
    let twins = [pair[0].clone(), pair[0].clone()];
    assert!((solved(&twins, Operations::default(), 1).1 - alone / 2.0).abs() < 1e-9);
}

#[test]
fn steps_only_raise_the_bound() {
    let costs = Costs::default();
    let rows = ["abcabd", "bacabd", "abcabd", "cabdab"];
    let facades = [facade(&rows)];
    let program = Program::new(
        Types::new(&facades).unwrap(),
        &costs,
        Operations::default(),
        usize::MAX,
        &Watched::new(&unwatched),
    )
    .unwrap();
    let bound_after = |steps| {
        // An incumbent out of reach, so that all steps are made.
        let mut incumbent = Incumbent::new(f64::INFINITY, &costs, Operations::default());
        Dual::new(&program)
            .ascend(&mut incumbent, steps, &mut { u64::MAX })
            .bound
    };
    let bounds = [1, 10, 100].map(bound_after);
    assert!(bounds.is_sorted(), "{bounds:?}");
    assert!(bounds[2] > bounds[0], "{bounds:?}");
}

#[test]
fn steps_climb_to_the_optimum_of_the_linear_program() {
    let costs = Costs::default();
    for (rows, operations) in [
        (
            &["abcabd", "bacabd", "abcabd", "cabdab"][..],
            Operations::default(),
        ),
        (
            &["abcabd", "bacabd", "abcabd", "cabdab"],
            Operations::split_only(),
        ),
        (&["abacaba", "bcbabcb", "abacaba"], EXTENSIONS),
    ] {
        let facades = [facade(rows)];
        let program = Program::new(
            Types::new(&facades).unwrap(),
            &costs,
            operations,
            usize::MAX,
            &Watched::new(&unwatched),
        )
        .unwrap();
        let optimum = linear_program::optimum(&program);
        let mut incumbent = Incumbent::new(f64::INFINITY, &costs, operations);
        let found = Dual::new(&program).ascend(&mut incumbent, 2_000, &mut { u64::MAX });
        assert!(
            found.bound <= optimum + 1e-6,
            "{} above {optimum}",
            found.bound
        );
        // It stops where the bound shows that the incumbent is optimal.
        let reached = found.bound > optimum - 0.05 || incumbent.is_optimal(found.bound);
        assert!(reached, "{} far below {optimum}", found.bound);
    }
}

#[test]
fn overlapping_occurrences_share_a_clique() {
    let costs = Costs::default();
    // `ab` has three occurrences apart, `abab` two that overlap, `ba` two apart.
    let facades = [facade(&["ababab"])];
    let split = Operations::split_only();
    let program = Program::new(
        Types::new(&facades).unwrap(),
        &costs,
        split,
        usize::MAX,
        &Watched::new(&unwatched),
    )
    .unwrap();
    let mut cliques: Vec<(usize, usize)> = program
        .region_types
        .iter()
        .map(|region_type| (region_type.occurrences.len(), region_type.cliques.len()))
        .collect();
    cliques.sort_unstable();
    assert_eq!(
        cliques,
        // ababab; ababa, babab; abab twice in one clique, baba; aba and bab twice; ab, ba.
        [
            (1, 1),
            (1, 1),
            (1, 1),
            (1, 1),
            (2, 1),
            (2, 1),
            (2, 1),
            (2, 2),
            (3, 3)
        ]
    );
    for region_type in &program.region_types {
        for (index, own) in region_type.cliques_of.iter().enumerate() {
            assert!(!own.is_empty());
            for &clique in own {
                assert!(region_type.cliques[clique as usize].contains(&(index as u32)));
            }
        }
    }
}

#[test]
fn multipliers_of_an_item_sum_to_its_cost() {
    let costs = Costs::default();
    let facades = [facade(&["abcabc", "abdabd", "abcabc"])];
    let program = Program::new(
        Types::new(&facades).unwrap(),
        &costs,
        Operations::default(),
        usize::MAX,
        &Watched::new(&unwatched),
    )
    .unwrap();
    let mut dual = Dual::new(&program);
    let mut incumbent = Incumbent::new(f64::INFINITY, &costs, Operations::default());
    dual.ascend(&mut incumbent, 50, &mut { u64::MAX });
    for region_type in &program.region_types {
        for (item, cost) in region_type.costs.iter().enumerate() {
            let multiplier = |clique| {
                dual.multipliers
                    [region_type.first_multiplier + clique * region_type.costs.len() + item]
            };
            let split: Vec<f64> = (0..region_type.cliques.len()).map(multiplier).collect();
            assert!(split.iter().all(|s| *s >= 0.0));
            assert!((split.iter().sum::<f64>() - cost).abs() < 1e-9);
        }
    }
}

#[test]
fn too_many_items_and_grids_are_refused() {
    let (costs, facades) = (Costs::default(), [facade(&["abc", "abd"])]);
    assert!(
        Program::new(
            Types::new(&facades).unwrap(),
            &costs,
            Operations::default(),
            3,
            &Watched::new(&unwatched)
        )
        .is_none()
    );
    assert!(
        Program::new(
            Types::new(&facades).unwrap(),
            &costs,
            Operations::all(),
            usize::MAX,
            &Watched::new(&unwatched)
        )
        .is_none()
    );
}

#[test]
fn costs_that_a_bound_allows_are_multiples_of_their_granularity() {
    let incumbent = Incumbent::new(38.1, &Costs::default(), Operations::default());
    assert!((incumbent.round_up(37.93) - 38.0).abs() < 1e-9);
    assert!(incumbent.is_optimal(38.01) && !incumbent.is_optimal(37.99));
    // Thirds, halves and ones are sixths.
    let thirds = Costs {
        split: 1.0 / 3.0,
        ..Costs::default()
    };
    let round_up = |costs, operations| Incumbent::new(1.0, costs, operations).round_up(0.51);
    assert!((round_up(&thirds, Operations::default()) - 2.0 / 3.0).abs() < 1e-9);
    // The cost of an operation that is not allowed does not count; nothing divides 1 and its root of two.
    assert!((round_up(&thirds, Operations::split_only()) - 2.0 / 3.0).abs() < 1e-9);
    let roots = Costs {
        split: 2f64.sqrt(),
        ..Costs::default()
    };
    assert_eq!(round_up(&roots, Operations::default()), 0.51);
}

/// The items of every rule of a type: a path of arcs from node 0 to an operator's last node, and its operation.
fn items_of_rules(known: &region_type::RegionType) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    for (index, operator) in known.operators.iter().enumerate() {
        let mut open = vec![(0, vec![known.operation(index)])];
        while let Some((node, items)) = open.pop() {
            if node == operator.last {
                found.push(items);
                continue;
            }
            for arc in operator.arcs.clone() {
                if known.arcs[arc].from == node {
                    let longer = [items.as_slice(), &[arc]].concat();
                    open.push((known.arcs[arc].to, longer));
                }
            }
        }
    }
    found
}

/// A program that takes many steps to bound.
pub(super) fn program_of_many_steps() -> Program {
    let types = Types::new(&[facade(&["abcabd", "bacabd", "abcabd", "cabdab"])]).unwrap();
    let watched = Watched::new(&unwatched);
    let (costs, operations) = (Costs::default(), Operations::default());
    Program::new(types, &costs, operations, usize::MAX, &watched).unwrap()
}

pub(super) fn programs_of_small_facades() -> Vec<Program> {
    let facades = [facade(&["abab", "cdcd"]), facade(&["abcba", "abcba"])];
    let program = |facade| {
        let types = Types::new(&[facade]).unwrap();
        let watched = Watched::new(&unwatched);
        Program::new(types, &Costs::default(), EXTENSIONS, usize::MAX, &watched).unwrap()
    };
    facades.map(program).into()
}

/// The two branches of an item share out the rules: a rule has the item, or something that excludes it, and never both.
#[test]
fn a_rule_has_an_item_or_something_that_excludes_it() {
    for program in programs_of_small_facades() {
        let mut compared = 0;
        for known in &program.region_types {
            let rules = items_of_rules(known);
            for item in 0..known.arcs.len() + known.operators.len() {
                let excluded: Vec<usize> = known.excluded_by(item).collect();
                for rule in &rules {
                    let excludes = rule.iter().any(|other| excluded.contains(other));
                    assert_ne!(rule.contains(&item), excludes);
                    compared += 1;
                }
            }
        }
        assert!(compared > 100, "{compared} comparisons say little");
    }
}

/// The least that a required type pays, whatever its rule, is taken from each of its rules, once.
#[test]
fn a_required_type_pays_in_advance_what_all_its_rules_cost() {
    let mut paid = 0;
    for mut program in programs_of_small_facades() {
        for index in 0..program.region_types.len() {
            let mut multipliers = vec![0.5; program.multipliers];
            let costs = program.region_types[index].costs.clone();
            let before = program.constant;
            program.require(index, &mut multipliers);
            let constant = program.constant - before;
            let known = &program.region_types[index];
            for rule in items_of_rules(known) {
                let cost = |costs: &[f64]| rule.iter().map(|&item| costs[item]).sum::<f64>();
                assert!((cost(&costs) - cost(&known.costs) - constant).abs() < 1e-9);
                assert!(rule.iter().all(|&item| known.costs[item] >= 0.0));
                paid += usize::from(constant > 0.0);
            }
            assert!(multipliers.iter().all(|m| (0.0..=0.5).contains(m)));
        }
    }
    assert!(paid > 100, "{paid} rules say little");
}
