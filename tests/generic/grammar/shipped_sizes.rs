//! Every shipped grammar, and grammars inferred from the shipped facades, at other sizes than their own.

use std::path::{Path, PathBuf};

use edifice::grammar::{Grammar, derivation, derive, derive_at, same_tiling, size_independent};
use edifice::io::{facade_json, read_grammar};
use edifice::layout::resize::align;
use edifice::methods::facade_grammar::{Method, Settings, infer};
use edifice::rng::stream;
use edifice::shape::{Facade, is_background};
use edifice::unwatched;
use rand::RngExt;

fn files(ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar");
    let mut files = Vec::new();
    for folder in [folder.clone(), folder.join("layouts")] {
        let entries = std::fs::read_dir(folder).unwrap();
        files.extend(entries.map(|entry| entry.unwrap().path()));
    }
    files.retain(|file| file.to_string_lossy().ends_with(ending));
    files.sort();
    files
}

/// The 35 shipped grammars, and one inferred from each shipped facade.
fn grammars() -> Vec<(String, Grammar)> {
    let settings = Settings {
        method: Method::Greedy,
        ..Settings::default()
    };
    let shipped = files(".cga").into_iter().chain(files(".grammar.json"));
    let shipped = shipped.map(|file| (file.display().to_string(), read_grammar(&file).unwrap()));
    let inferred = files(".facade.json").into_iter().map(|file| {
        let facade = facade_json::read(&file).unwrap();
        let found = infer(&[facade], &settings, &unwatched).unwrap();
        (format!("inferred from {}", file.display()), found.grammar)
    });
    let all: Vec<(String, Grammar)> = shipped.chain(inferred).collect();
    assert_eq!(all.len(), 70);
    all
}

#[test]
fn every_size_is_tiled_and_the_own_size_is_exact() {
    let mut refused_before = 0;
    for (number, (name, grammar)) in grammars().iter().enumerate() {
        let free = size_independent(grammar);
        let start = &grammar.starts[0];
        let own = derive(grammar, 0).unwrap();
        let mut rng = stream(7, "sizes", number as u64);
        let same = derive_at(&free, 0, start.width, start.height, &mut rng).unwrap();
        assert!(
            same_tiling(&own, &same.facade) && same.shrunk.is_empty(),
            "{name}"
        );
        let mut random = || 10f64.powf(rng.random_range(-1.0..1.0));
        let fixed = [(0.5, 0.5), (0.3, 0.3), (0.1, 0.1), (0.1, 10.0), (10.0, 0.1)];
        let factors: Vec<(f64, f64)> = fixed
            .into_iter()
            .chain((0..4).map(|_| (random(), random())))
            .collect();
        for (wide, high) in factors {
            let (width, height) = (wide * start.width, high * start.height);
            let derived = derive_at(&free, 0, width, height, &mut stream(0, "none", 0));
            let derived = derived.unwrap_or_else(|e| panic!("{name}, {wide} x {high}: {e}"));
            let facade = &derived.facade;
            assert_eq!((facade.width, facade.height), (width, height));
            assert_eq!(facade.check_tiling(), Ok(()), "{name}, {wide} x {high}");
            refused_before += usize::from(wide == 0.5 && high == 0.5 && !derived.shrunk.is_empty());
        }
    }
    assert!(
        refused_before > 10,
        "the test needs absolute sizes that do not fit"
    );
}

/// Labels of elements of one size at the own size, and of several in `facade`.
fn sizes(facade: &Facade) -> usize {
    let noise = 1e-5 * facade.width.max(facade.height);
    let whole = |v: f64| (v / noise).round() as i64;
    let elements = facade.regions.iter().filter(|r| !is_background(&r.label));
    let sizes = elements.map(|r| (&r.label, whole(r.rect.width), whole(r.rect.height)));
    sizes.collect::<std::collections::BTreeSet<_>>().len()
}

#[test]
fn equal_terminals_stay_equal_when_aligned() {
    let layouts = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar/layouts");
    let mut improved = 0;
    for name in [
        "terrace_a",
        "terrace_b",
        "shophouse_1",
        "cottage_1",
        "townhouse_4",
    ] {
        let grammar = read_grammar(&layouts.join(format!("{name}.grammar.json"))).unwrap();
        let free = size_independent(&grammar);
        let own = derivation(&free, 0).unwrap();
        for (wide, high) in [(0.5, 0.5), (1.4, 1.0), (0.8, 1.3)] {
            let (width, height) = (wide * own.facade.width, high * own.facade.height);
            let derived = derive_at(&free, 0, width, height, &mut stream(0, "none", 0)).unwrap();
            let aligned = align(&own, &derived).unwrap();
            let facade = &aligned.facade;
            assert_eq!((facade.width, facade.height), (width, height));
            assert_eq!(facade.check_tiling(), Ok(()), "{name}");
            assert_eq!(facade.regions.len(), derived.facade.regions.len());
            let (before, after) = (sizes(&derived.facade), sizes(facade));
            assert!(
                after <= before,
                "{name}, {wide} x {high}: {before} sizes became {after}"
            );
            if aligned.unequal.is_empty() {
                assert!(after <= sizes(&own.facade), "{name}, {wide} x {high}");
            }
            improved += usize::from(after < before);
            if high == 1.0 {
                let rows = |f: &Facade| f.regions.iter().map(|r| r.rect.y).collect::<Vec<_>>();
                assert_eq!(rows(facade), rows(&derived.facade), "{name}");
            }
        }
    }
    assert!(improved >= 5, "{improved}");
}
