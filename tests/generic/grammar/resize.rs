//! Size-independent and stochastic grammars.

use super::support::{random_grammar, stochastic};
use edifice::grammar::{
    Grammar, GrammarError, Operation, Sampler, Size, Successor, check, derive, derive_at,
    same_tiling, scaled, size_independent,
};
use edifice::io::grammar_cga::from_str;
use edifice::rng::stream;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn at_its_own_size_nothing_changes(seed: u64) {
        let grammar = random_grammar(seed);
        let relaxed = size_independent(&grammar);
        prop_assert_eq!(check(&relaxed), Ok(vec![]));
        let (own, same) = (derive(&grammar, 0).unwrap(), derive(&relaxed, 0).unwrap());
        prop_assert!(same_tiling(&own, &same));
        prop_assert_eq!(size_independent(&relaxed), relaxed);
    }

    #[test]
    fn any_size_is_tiled(seed: u64, width in -1.0f64..1.0, height in -1.0f64..1.0) {
        let grammar = size_independent(&random_grammar(seed));
        let start = &grammar.starts[0];
        let (width, height) = (10f64.powf(width) * start.width, 10f64.powf(height) * start.height);
        let facade = derive_at(&grammar, 0, width, height, &mut stream(seed, "size", 0)).unwrap().facade;
        prop_assert_eq!((facade.width, facade.height), (width, height));
        // Parts of parts can be too thin for the tiling check; they have an extent all the same.
        let area: f64 = facade.regions.iter().map(|r| r.rect.area()).sum();
        prop_assert!(facade.regions.iter().all(|r| r.rect.width > 0.0 && r.rect.height > 0.0));
        prop_assert!((area / (width * height) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_seed_decides(seed: u64) {
        let grammar = stochastic(&random_grammar(seed), seed);
        let start = &grammar.starts[0];
        let derive = |index| derive_at(&grammar, 0, start.width, start.height, &mut stream(seed, "choice", index));
        let first = derive(0).unwrap();
        prop_assert_eq!(&first, &derive(0).unwrap());
        // One rule serves all regions of a symbol.
        let mut rules = std::collections::BTreeMap::new();
        for region in &first.non_terminals {
            let symbol = &grammar.rules[region.rule].symbol;
            prop_assert_eq!(*rules.entry(symbol).or_insert(region.rule), region.rule);
        }
    }

    #[test]
    fn a_change_of_unit_scales_the_facade(seed: u64) {
        let grammar = random_grammar(seed);
        let metres = scaled(&grammar, 0.05, "m");
        let (px, m) = (derive(&grammar, 0).unwrap(), derive(&metres, 0).unwrap());
        prop_assert_eq!(px.regions.len(), m.regions.len());
        for (a, b) in px.regions.iter().zip(&m.regions) {
            prop_assert!((a.rect.x * 0.05 - b.rect.x).abs() < 1e-9);
            prop_assert!((a.rect.top() * 0.05 - b.rect.top()).abs() < 1e-9);
        }
    }
}

#[test]
fn thin_structures_keep_their_size() {
    let text = "//@ facade F 100 x 50\nF --> split(x) { 2 : frame | 96 : glass | 2 : frame }";
    let grammar = size_independent(&from_str(text).unwrap());
    let Operation::Split { successors, .. } = &grammar.rules[0].operation else {
        panic!("a split stays one");
    };
    let sizes: Vec<Size> = successors.iter().map(|s| s.size).collect();
    assert_eq!(
        sizes,
        [
            Size::Absolute(2.0),
            Size::Relative(96.0),
            Size::Absolute(2.0)
        ]
    );
    let mut rng = stream(0, "none", 0);
    let wide = derive_at(&grammar, 0, 300.0, 50.0, &mut rng)
        .unwrap()
        .facade;
    assert_eq!(wide.regions[1].rect.width, 296.0);
    assert!(wide_is_as_written(&grammar, 300.0) && wide_is_as_written(&grammar, 8.0));
    // Without thicker neighbours nothing is thin.
    let text = "//@ facade F 100 x 50\nF --> split(x) { { 1 : a | 1 : b }* }";
    let grammar = size_independent(&from_str(text).unwrap());
    let Operation::Repeat { successors, .. } = &grammar.rules[0].operation else {
        panic!("a repeat stays one");
    };
    let relative = |s: &Successor| matches!(s.size, Size::Relative(_));
    assert!(successors.iter().all(relative));
}

/// True if frames of 2 keep their size at a width.
fn wide_is_as_written(grammar: &Grammar, width: f64) -> bool {
    let derivation = derive_at(grammar, 0, width, 50.0, &mut stream(0, "none", 0)).unwrap();
    let widths = derivation.facade.regions.iter().map(|r| r.rect.width);
    derivation.shrunk.is_empty() && widths.eq([2.0, width - 4.0, 2.0])
}

#[test]
fn absolute_sizes_give_way_last_and_in_proportion() {
    let text =
        "//@ facade F 100 x 50\nF --> split(x) { 2 : frame | ~90 : glass | 6 : wall | 2 : frame }";
    let grammar = from_str(text).unwrap();
    let derive = |width| derive_at(&grammar, 0, width, 50.0, &mut stream(0, "none", 0)).unwrap();
    let mut before = 1.0;
    for width in [100.0, 21.0, 14.0, 13.0, 10.0, 3.0, 1e-3, 1e-9] {
        let derivation = derive(width);
        let widths: Vec<f64> = derivation
            .facade
            .regions
            .iter()
            .map(|r| r.rect.width)
            .collect();
        let sum: f64 = widths.iter().sum();
        assert!(
            widths.iter().all(|w| *w > 0.0) && (sum - width).abs() < 1e-12 * width,
            "{widths:?}"
        );
        let factor = derivation.shrunk.get(&0).copied().unwrap_or(1.0);
        for (found, written) in [(widths[0], 2.0), (widths[2], 6.0), (widths[3], 2.0)] {
            assert!(
                (found - factor * written).abs() < 1e-12,
                "{width}: {widths:?}"
            );
        }
        assert_eq!(factor < 1.0, width < 20.0, "{width}");
        assert!(factor <= before);
        before = factor;
    }
    // A rule that an author gave a relative size keeps its absolute ones; others get relative sizes.
    let text = "//@ facade F 100 x 40\nF --> split(y) { 10 : Row | 30 : Rest }\n\
                Row --> split(x) { 30 : wall | ~40 : door | 30 : wall }\n\
                Rest --> split(x) { { 20 : window }* }";
    let grammar = size_independent(&from_str(text).unwrap());
    let facade = derive_at(&grammar, 0, 150.0, 20.0, &mut stream(0, "none", 0))
        .unwrap()
        .facade;
    assert_eq!(facade.check_tiling(), Ok(()));
    let door = facade.regions.iter().find(|r| r.label == "door").unwrap();
    assert_eq!(
        (door.rect.x, door.rect.width, door.rect.height),
        (30.0, 90.0, 5.0)
    );
}

#[test]
fn weights_whose_sum_overflows_keep_their_proportions() {
    let text = "//@ facade F 8 x 8\nF --> split(x) { ~1e308 : a | ~1e308 : b | ~0.5e308 : c }";
    let facade = derive(&from_str(text).unwrap(), 0).unwrap();
    let widths: Vec<f64> = facade.regions.iter().map(|r| r.rect.width).collect();
    assert!(
        widths
            .iter()
            .zip([3.2, 3.2, 1.6])
            .all(|(w, e)| (w - e).abs() < 1e-12),
        "{widths:?}"
    );
    let text = "//@ facade F 8 x 8\nF --> 50% : split(x) { ~1 : a } 25% : split(x) { ~1 : b } else : split(x) { ~1 : c }";
    let small = from_str(text).unwrap();
    let mut large = small.clone();
    for (rule, weight) in large.rules.iter_mut().zip([1e308, 0.5e308, 0.5e308]) {
        rule.weight = Some(weight);
    }
    for seed in 0..100 {
        let label = |grammar: &Grammar| {
            let mut rng = stream(seed, "weights", 0);
            derive_at(grammar, 0, 8.0, 8.0, &mut rng)
                .unwrap()
                .facade
                .regions[0]
                .label
                .clone()
        };
        assert_eq!(label(&small), label(&large));
    }
    assert!(edifice::grammar::listing(&large, false)[0].contains("[50%]"));
    let text = edifice::io::grammar_cga::to_string(&large);
    assert_eq!(from_str(&text).unwrap(), large);
}

#[test]
fn repeats_fill_the_space() {
    let text = "//@ facade F 100 x 50\nF --> split(x) { { 8 : a | 12 : b }* }";
    let grammar = size_independent(&from_str(text).unwrap());
    let count = |width| {
        let mut rng = stream(0, "none", 0);
        derive_at(&grammar, 0, width, 50.0, &mut rng)
            .unwrap()
            .facade
            .regions
            .len()
            / 2
    };
    assert_eq!(
        [5.0, 29.0, 31.0, 100.0, 109.0, 111.0].map(count),
        [1, 1, 2, 5, 5, 6]
    );
    let mut rng = stream(0, "none", 0);
    let bad = derive_at(&grammar, 0, f64::NAN, 50.0, &mut rng);
    assert!(matches!(
        bad,
        Err(GrammarError::AskedSize {
            dimension: "width",
            ..
        })
    ));
}

#[test]
fn parts_larger_or_smaller_than_written_are_stretched() {
    let text = "//@ facade F 10 x 40\nF --> split(y) { 10 : Shop | 30 : Floors }\n\
                Floors --> split(y) { { 10 : Floor }* }\n\
                Floor --> split(y) { 4 : wall | 6 : window }\n\
                Shop --> split(x) { 2 : wall | 8 : shop }";
    let grammar = size_independent(&from_str(text).unwrap());
    let sampler = Sampler::new(&grammar).unwrap();
    let stretch = |width, height| {
        let mut rng = stream(0, "none", 0);
        let derivation = sampler.derive(0, width, height, &mut rng).unwrap();
        sampler.stretch(&derivation)
    };
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    assert!(near(stretch(10.0, 40.0), 1.0));
    // The whole by 1.25; three floors become four.
    assert!(near(stretch(10.0, 50.0), 1.25));
    assert!(near(stretch(20.0, 40.0), 2.0));
    assert!(near(stretch(5.0, 40.0), 2.0));
}

mod combining {
    use super::*;
    use edifice::grammar::combine;

    /// Ground floor, a stack of floors, a roof; `window` names the style.
    fn house(window: &str, ground: f64, floors: f64) -> Grammar {
        let height = ground + 30.0 * floors + 20.0;
        from_str(&format!(
            "//@ unit \"dm\"\n//@ facade House 100 x {height}\n\
             House --> split(y) {{ {ground} : Ground | {} : Floors | 20 : Roof }}\n\
             Ground --> split(x) {{ 40 : wall | 20 : door | 40 : wall }}\n\
             Floors --> split(y) {{ {{ 30 : Floor }}* }}\n\
             Floor --> split(x) {{ {{ 8 : wall | 12 : {window} }}* }}\n\
             Roof --> split(x) {{ 50 : roof | 10 : dormer | 40 : roof }}",
            30.0 * floors
        ))
        .unwrap()
    }

    #[test]
    fn parts_of_one_role_become_alternatives() {
        let combined = combine(&[house("window", 30.0, 3.0), house("glass", 35.0, 5.0)]).unwrap();
        let of = |symbol: &str| combined.rules.iter().filter(|r| r.symbol == symbol).count();
        let axiom = &combined.starts[0].symbol;
        assert_eq!(of(axiom), 2);
        for rule in combined.rules.iter().filter(|r| r.symbol == *axiom) {
            assert_eq!(
                rule.operation
                    .symbols()
                    .iter()
                    .map(|s| of(s))
                    .collect::<Vec<_>>(),
                [2, 2, 2]
            );
        }
        // Both kinds of window occur, never both in one facade.
        let mut seen = std::collections::BTreeSet::new();
        for seed in 0..40 {
            let mut rng = stream(seed, "combined", 0);
            let facade = derive_at(&combined, 0, 120.0, 210.0, &mut rng)
                .unwrap()
                .facade;
            assert_eq!(facade.check_tiling(), Ok(()));
            let labels: std::collections::BTreeSet<String> =
                facade.regions.into_iter().map(|r| r.label).collect();
            assert_eq!(labels.len(), 5);
            seen.extend(labels);
        }
        assert_eq!(seen.len(), 6);
    }

    #[test]
    fn each_facade_of_a_joint_grammar_is_combined() {
        let text = "//@ facade One 40 x 60\n//@ facade Two 40 x 50\n//@ facade sky 5 x 5\n\
                    One --> split(y) { { 30 : Floor }* }\nTwo --> split(y) { 20 : shop | 30 : Floor }\n\
                    Floor --> split(x) { { 8 : wall | 12 : window }* }";
        let joint = from_str(text).unwrap();
        let each = joint.of_each_start();
        let count = |k: usize| (each[k].starts[0].name.as_str(), each[k].rules.len());
        assert_eq!([0, 1, 2].map(count), [("One", 2), ("Two", 2), ("sky", 0)]);
        for (k, own) in each.iter().enumerate() {
            assert_eq!(derive(own, 0), derive(&joint, k));
        }
        let combined = combine(std::slice::from_ref(&joint)).unwrap();
        assert_eq!(combined, combine(&each).unwrap());
        let seen: std::collections::BTreeSet<String> = (0..40)
            .flat_map(|seed| {
                let mut rng = stream(seed, "joint", 0);
                let made = derive_at(&combined, 0, 40.0, 60.0, &mut rng).unwrap();
                made.facade.regions.into_iter().map(|r| r.label)
            })
            .collect();
        let labels: Vec<&str> = seen.iter().map(String::as_str).collect();
        assert_eq!(labels, ["shop", "sky", "wall", "window"]);
    }

    #[test]
    fn one_grammar_stays_itself() {
        let house = house("window", 30.0, 3.0);
        let combined = combine(std::slice::from_ref(&house)).unwrap();
        assert!(same_tiling(
            &derive(&house, 0).unwrap(),
            &derive(&combined, 0).unwrap()
        ));
        assert_eq!(combine(&[]), Err(GrammarError::NoStart));
        let metres = scaled(&house, 0.1, "m");
        assert!(matches!(
            combine(&[house, metres]),
            Err(GrammarError::Units { .. })
        ));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]

        #[test]
        fn any_grammars_combine(seeds in proptest::collection::vec(any::<u64>(), 1..5)) {
            let grammars: Vec<Grammar> = seeds.iter().map(|&s| random_grammar(s)).collect();
            match combine(&grammars) {
                Err(error) => prop_assert!(matches!(error, GrammarError::TooSmall { .. }), "{}", error),
                Ok(combined) => {
                    let start = &combined.starts[0];
                    let mut rng = stream(1, "any", 0);
                    let derived = derive_at(&combined, 0, start.width, start.height, &mut rng);
                    prop_assert_eq!(derived.unwrap().facade.check_tiling(), Ok(()));
                }
            }
        }
    }
}
