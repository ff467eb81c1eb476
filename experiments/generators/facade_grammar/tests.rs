use std::collections::HashSet;

use super::*;
use edifice_grammar::{Costs, evaluate};

#[test]
fn layouts_are_splittable_tilings_that_their_grammars_derive() {
    let made = layouts(1).unwrap();
    assert_eq!(made.len(), 34);
    let names: HashSet<_> = made.iter().map(|m| m.facade.name.clone()).collect();
    assert_eq!(names.len(), 34);
    for Synthetic { facade, grammar } in &made {
        let count = facade.regions.len();
        assert!(
            (45..=1200).contains(&count),
            "{}: {count} terminals",
            facade.name
        );
        edifice_shape::splittable(facade).unwrap();
        evaluate(grammar, std::slice::from_ref(facade), &Costs::default())
            .unwrap_or_else(|e| panic!("{}: {e}", facade.name));
        let whole = |v: f64| v.fract() == 0.0;
        assert!(
            facade
                .regions
                .iter()
                .all(|r| whole(r.rect.x) && whole(r.rect.top()))
        );
    }
}

#[test]
fn same_seed_same_layouts() {
    let names = |seed| -> Vec<_> {
        layouts(seed)
            .unwrap()
            .into_iter()
            .map(|m| m.facade)
            .collect()
    };
    assert_eq!(names(3), names(3));
    assert_ne!(names(3), names(4));
}

#[test]
fn any_number_of_terminals_can_be_had() {
    for terminals in [60, 400, 5_000] {
        let made = sized(1, terminals).unwrap();
        let count = made.facade.regions.len();
        assert!(
            count.abs_diff(terminals) * 4 < terminals,
            "{count} for {terminals}"
        );
        edifice_shape::splittable(&made.facade).unwrap();
    }
}
