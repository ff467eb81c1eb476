use std::collections::HashSet;

use super::*;
use edifice_grammar::{Costs, derivation, evaluate};

/// Left, bottom, width and height of the regions that a grammar splits.
fn regions(grammar: &Grammar) -> HashSet<[i64; 4]> {
    let derived = derivation(grammar, 0).unwrap();
    let rects = derived.non_terminals.iter().map(|n| n.rect);
    rects
        .map(|r| [r.x, r.y, r.width, r.height].map(|v| v.round() as i64))
        .collect()
}

#[test]
fn every_reference_derives_its_layout_exactly() {
    for seed in 1..=20 {
        let made = referenced(seed, 3).unwrap();
        assert_eq!(made.len(), 15);
        for one in &made {
            let name = &one.facade.name;
            let count = one.facade.regions.len();
            assert!((50..1500).contains(&count), "{name}: {count} terminals");
            edifice_shape::splittable(&one.facade).unwrap();
            for (kind, grammar) in Kind::ALL.iter().zip(&one.grammars) {
                evaluate(
                    grammar,
                    std::slice::from_ref(&one.facade),
                    &Costs::default(),
                )
                .unwrap_or_else(|e| panic!("seed {seed}, {name}, {kind:?}: {e}"));
            }
        }
    }
}

#[test]
fn kinds_agree_on_tiles_and_differ_above_them() {
    for one in referenced(1, 6).unwrap() {
        let all = one.grammars.each_ref().map(regions);
        let common = all[1..].iter().fold(all[0].clone(), |common, other| {
            common.intersection(other).copied().collect()
        });
        let tiles = common.iter().filter(|r| r[3] < 400).count();
        assert!(tiles > 10, "{}: {tiles} common regions", one.facade.name);
        for (i, first) in all.iter().enumerate() {
            for second in &all[..i] {
                assert_ne!(first, second, "{}", one.facade.name);
            }
        }
    }
}

#[test]
fn first_splits_are_those_that_the_table_of_kinds_says() {
    for one in referenced(2, 4).unwrap() {
        let facade = &one.facade;
        let (width, height) = (facade.width as i64, facade.height as i64);
        let body = [0, 30, width, height - 65];
        let across = |r: &&[i64; 4]| r[2] == width;
        let upright = |r: &&[i64; 4]| r[3] == height - 65 && r[2] < width;
        let count = |kind: usize| {
            let all = regions(&one.grammars[kind]);
            (
                all.contains(&body),
                all.iter().filter(across).count(),
                all.iter().filter(upright).count(),
            )
        };
        let name = &facade.name;
        let [floors, columns, interleaved, symmetric, nested] = [0, 1, 2, 3, 4].map(count);
        assert!(!floors.0 && floors.1 > 2 && floors.2 == 0, "{name}");
        assert!(columns.0 && columns.1 == 2 && columns.2 > 3, "{name}");
        assert!(!interleaved.0 && interleaved.1 == 3, "{name}");
        assert!(symmetric.0 && (2..=6).contains(&symmetric.2), "{name}");
        assert!(!nested.0 && nested.1 > 4 && nested.2 == 0, "{name}");
    }
}

#[test]
fn same_seed_same_references() {
    let all = |seed| -> Vec<_> {
        let made = referenced(seed, 2).unwrap();
        made.into_iter().map(|r| (r.facade, r.grammars)).collect()
    };
    assert_eq!(all(5), all(5));
    assert_ne!(all(5), all(6));
}
