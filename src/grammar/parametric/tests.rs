//! Laws of libraries, and the exhaustive check of shared phrases.

use edifice_base::rng::stream;
use edifice_shape::{Axis, Facade, Rect, Region};
use proptest::prelude::*;

use super::*;
use crate::{Costs, same_tiling};

/// A facade from nested splits: each number says how a region is split, or its label.
fn facade(name: &str, choices: &[u8], width: u32, height: u32) -> Facade {
    let mut choices = choices.iter().copied();
    let mut regions = Vec::new();
    let mut stack = vec![(0, 0, width, height, 0)];
    while let Some((x, y, w, h, depth)) = stack.pop() {
        let choice = choices.next().unwrap_or(0);
        let axis = if choice % 2 == 0 { Axis::X } else { Axis::Y };
        let side = if axis == Axis::X { w } else { h };
        let parts = u32::from(choice / 8 % 4) + 2;
        if depth == 4 || choice % 8 > 4 || side < 4 * parts {
            let label = ["wall", "window", "door"][usize::from(choice / 16 % 3)];
            let rect = Rect::new(x.into(), y.into(), w.into(), h.into());
            regions.push(Region {
                label: label.to_string(),
                rect,
            });
            continue;
        }
        let mut at = 0;
        for k in 0..parts {
            let size = if k + 1 == parts {
                side - at
            } else {
                side / parts + k % 2
            };
            stack.push(match axis {
                Axis::X => (x + at, y, size, h, depth + 1),
                Axis::Y => (x, y + at, w, size, depth + 1),
            });
            at += size;
        }
    }
    Facade::new(name, "px", width.into(), height.into(), regions).unwrap()
}

fn facades() -> impl Strategy<Value = Vec<Facade>> {
    let one = (
        prop::collection::vec(any::<u8>(), 1..40),
        8u32..90,
        8u32..90,
    );
    prop::collection::vec(one, 1..6).prop_map(|all| {
        let made = all.iter().enumerate();
        made.map(|(k, (choices, w, h))| facade(&format!("f{k}"), choices, *w, *h))
            .collect()
    })
}

/// The letters that a part of a string stands for: splits of the same direction are strings that it shares.
fn expand(sharing: &Sharing, axis: Axis, part: Part) -> Vec<Part> {
    match part {
        Part::Rule(rule) => match &sharing.rules[rule as usize] {
            shared if shared.axis == axis && !shared.repeat => shared
                .parts
                .iter()
                .flat_map(|&part| expand(sharing, axis, part))
                .collect(),
            _ => vec![part],
        },
        Part::Label(_) => vec![part],
    }
}

/// The least cost over every set of phrases: each string costs its cheapest path.
fn exhaustive(bodies: &Bodies, costs: &Costs) -> Option<f64> {
    let mut phrases: Vec<(Axis, Vec<Letter>)> = Vec::new();
    for body in &bodies.bodies {
        for from in 0..body.letters.len() {
            for to in from + 2..=body.letters.len() {
                let phrase = (body.axis, body.letters[from..to].to_vec());
                let whole = |b: &Body| !b.repeat && b.axis == phrase.0 && b.letters == phrase.1;
                if !phrases.contains(&phrase) && !bodies.bodies.iter().any(whole) {
                    phrases.push(phrase);
                }
            }
        }
    }
    if phrases.len() > 11 {
        return None;
    }
    let path = |axis: Axis, letters: &[Letter], open: &[&(Axis, Vec<Letter>)], own: bool| {
        let mut best = vec![usize::MAX; letters.len() + 1];
        best[0] = 0;
        for to in 1..=letters.len() {
            best[to] = best[to - 1] + 1;
            let splits = bodies
                .bodies
                .iter()
                .filter(|b| !b.repeat)
                .map(|b| (b.axis, &b.letters));
            for (other, phrase) in open.iter().map(|p| (p.0, &p.1)).chain(splits) {
                let itself = own && phrase.len() == letters.len();
                if other == axis && phrase.len() >= 2 && !itself && letters[..to].ends_with(phrase)
                {
                    best[to] = best[to].min(best[to - phrase.len()] + 1);
                }
            }
        }
        best[letters.len()] as f64
    };
    let mut least = f64::INFINITY;
    for set in 0..1u32 << phrases.len() {
        let open: Vec<&(Axis, Vec<Letter>)> = (0..phrases.len())
            .filter(|k| (set >> k) & 1 == 1)
            .map(|k| &phrases[k])
            .collect();
        let of_bodies = bodies.bodies.iter().map(|b| {
            let operation = if b.repeat { costs.repeat } else { costs.split };
            operation + path(b.axis, &b.letters, &open, !b.repeat)
        });
        let of_phrases = open
            .iter()
            .map(|p| costs.split + path(p.0, &p.1, &open, true));
        least = least.min(of_bodies.chain(of_phrases).sum());
    }
    Some(least)
}

/// Strings over a few letters as one library of rows, the counts of their repeats taken out.
fn strings(texts: &[String]) -> Rules {
    let mut rules = Rules::default();
    for text in texts {
        let symbols: Vec<Symbol> = text
            .bytes()
            .map(|b| rules.label(&char::from(b).to_string()))
            .collect();
        if symbols.len() > 1 {
            let items = symbols.into_iter().map(Item::Part).collect();
            rules.intern(Rule {
                axis: Axis::X,
                items,
            });
        }
    }
    rules
}

proptest! {
    #[test]
    fn every_facade_comes_back_from_its_code(all in facades()) {
        let library = Library::learn(&all).unwrap();
        for (facade, member) in all.iter().zip(library.members()) {
            let back = library.facade(&member.parse, "back").unwrap();
            prop_assert!(same_tiling(facade, &back));
            let code = library.encode(facade).unwrap();
            prop_assert!(same_tiling(facade, &library.decode(&code.bytes, "back").unwrap()));
            prop_assert_eq!(code.bits, library.bits(facade).unwrap());
            prop_assert!(code.bytes.len() as f64 * 8.0 <= code.bits + 10.0);
        }
    }

    #[test]
    fn facades_that_the_library_does_not_know_come_back_too(all in facades(), new in facades()) {
        let library = Library::learn(&all).unwrap();
        for facade in &new {
            let code = library.encode(facade).unwrap();
            prop_assert!(same_tiling(facade, &library.decode(&code.bytes, "back").unwrap()));
        }
    }

    #[test]
    fn facades_come_back_from_codes_of_their_own(all in facades(), new in facades()) {
        let library = Library::learn(&all).unwrap();
        let nothing = Separate::new(library.unit().to_owned(), library.step());
        for separate in [Separate::of(&library).unwrap(), nothing] {
            for facade in &new {
                let code = separate.encode(facade).unwrap();
                prop_assert!(same_tiling(facade, &separate.decode(&code.bytes, "back").unwrap()));
                prop_assert!(code.bytes.len() as f64 * 8.0 <= code.bits + 10.0);
            }
        }
    }

    #[test]
    fn normal_sizes_are_read_back_too(all in facades(), new in facades()) {
        let shared = Library::learn(&all).unwrap();
        let (unit, rules) = (shared.unit().to_owned(), shared.rules().clone());
        let members = shared.members().to_vec();
        let normal = Library::from_members_with(unit, shared.step(), rules, members, SizeModel::Normal);
        let normal = normal.unwrap();
        for facade in &new {
            let code = normal.encode(facade).unwrap();
            prop_assert!(same_tiling(facade, &normal.decode(&code.bytes, "back").unwrap()));
        }
    }

    #[test]
    fn bytes_that_are_no_code_do_not_panic(all in facades(), bytes in prop::collection::vec(any::<u8>(), 0..60)) {
        let library = Library::learn(&all).unwrap();
        if let Ok(read) = library.decode(&bytes, "noise") {
            prop_assert_eq!(read.check_tiling(), Ok(()));
        }
    }

    #[test]
    fn draws_are_tilings(all in facades(), seed: u64) {
        let library = Library::learn(&all).unwrap();
        let drawn = library.draw(&mut stream(seed, "draw", 0), "drawn").unwrap();
        prop_assert_eq!(edifice_shape::splittable(&drawn), Ok(()));
        prop_assert!(library.bits(&drawn).is_ok());
        if let Ok(drawn) = library.draw_code(&mut stream(seed, "code", 0), "drawn") {
            prop_assert_eq!(drawn.check_tiling(), Ok(()));
        }
    }

    #[test]
    fn written_rules_say_what_the_rules_say_at_the_cost_that_is_claimed(all in facades()) {
        let library = Library::learn(&all).unwrap();
        let costs = Costs::default();
        let sharing = library.sharing(&costs);
        let grammar = library.grammar(&sharing);
        prop_assert!((costs.grammar(&grammar) - sharing.cost).abs() < 1e-9);
        prop_assert!(sharing.lower_bound <= sharing.cost + 1e-9);
        if !grammar.rules.is_empty() {
            crate::check(&grammar).unwrap();
        }
        let bodies = Bodies::new(library.rules());
        for (written, body) in sharing.rules.iter().zip(&bodies.bodies) {
            let letters: Vec<Part> =
                written.parts.iter().flat_map(|&part| expand(&sharing, body.axis, part)).collect();
            let own: Vec<Part> = body.letters.iter().map(|letter| match *letter {
                Letter::Label(label) => Part::Label(label),
                Letter::Body(body) => Part::Rule(body),
            }).collect();
            prop_assert_eq!(letters, own);
        }
    }

    #[test]
    fn phrases_are_proven_where_every_set_of_them_can_be_tried(texts in prop::collection::vec("[ab]{2,6}", 1..4)) {
        let bodies = Bodies::new(&strings(&texts));
        let costs = Costs::default();
        if let Some(least) = exhaustive(&bodies, &costs) {
            let sharing = share(&bodies, &costs);
            prop_assert!((sharing.cost - least).abs() < 1e-6, "{} against {least}", sharing.cost);
            prop_assert!(sharing.lower_bound <= least + 1e-6);
        }
    }
}

#[test]
fn a_grid_of_windows_is_a_few_rules_whatever_its_size() {
    let grid = |columns: u32, rows: u32| {
        let mut regions = Vec::new();
        for j in 0..=2 * rows {
            let (y, h) = (f64::from(j) * 10.0, 10.0);
            if j % 2 == 0 {
                let rect = Rect::new(0.0, y, f64::from(2 * columns + 1) * 5.0, h);
                regions.push(Region {
                    label: "wall".into(),
                    rect,
                });
                continue;
            }
            for i in 0..=2 * columns {
                let label = if i % 2 == 0 { "wall" } else { "window" };
                regions.push(Region {
                    label: label.into(),
                    rect: Rect::new(f64::from(i) * 5.0, y, 5.0, h),
                });
            }
        }
        let (w, h) = (
            f64::from(2 * columns + 1) * 5.0,
            f64::from(2 * rows + 1) * 10.0,
        );
        Facade::new(format!("{columns}x{rows}"), "px", w, h, regions).unwrap()
    };
    let one = Library::learn(&[grid(3, 4)]).unwrap();
    let many = Library::learn(&[grid(3, 4), grid(9, 2), grid(5, 7)]).unwrap();
    assert_eq!(one.rules().rules().len(), 2);
    assert_eq!(many.rules().rules(), one.rules().rules());
    let costs = Costs::default();
    assert!(many.sharing(&costs).is_proven());
    assert_eq!(many.sharing(&costs).cost, one.sharing(&costs).cost);
}

#[test]
fn what_is_wrong_is_named() {
    assert_eq!(Library::learn(&[]).unwrap_err(), LibraryError::NoFacades);
    let wall = |width: f64, unit: &str| {
        let region = Region {
            label: "wall".into(),
            rect: Rect::new(0.0, 0.0, width, 2.0),
        };
        Facade::new("f", unit, width, 2.0, vec![region]).unwrap()
    };
    let mixed = Library::learn(&[wall(3.0, "px"), wall(3.0, "m")]).unwrap_err();
    assert!(matches!(mixed, LibraryError::Unit { .. }));
    let off = Library::learn(&[wall(std::f64::consts::PI, "m")]).unwrap_err();
    assert!(matches!(off, LibraryError::OffStep { .. }), "{off}");
    let large = Library::learn(&[wall(1e6, "px")]).unwrap_err();
    assert!(matches!(large, LibraryError::TooLarge { .. }));
    let library = Library::learn(&[wall(3.5, "m")]).unwrap();
    assert_eq!(library.step(), 0.5);
    assert!(matches!(
        library.bits(&wall(3.25, "m")),
        Err(LibraryError::OffStep { .. })
    ));
}
