use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

use crate::grammar_cga::{from_str, named_to_string};
use crate::read_facade;
use edifice_base::rng::stream;
use edifice_grammar::parametric::{Library, Named};
use edifice_grammar::{Sampler, derive, same_tiling};
use edifice_shape::{Facade, Rect, Region};

/// The layouts that ship with their libraries, one for each unit.
fn shipped() -> &'static [(Vec<Facade>, Library)] {
    static SHIPPED: OnceLock<Vec<(Vec<Facade>, Library)>> = OnceLock::new();
    SHIPPED.get_or_init(|| {
        // Tests run in the folder of their crate.
        let folder = Path::new("../../datasets/facade_grammar/layouts");
        let mut paths: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.to_string_lossy().ends_with(".facade.json"))
            .collect();
        paths.sort();
        let mut by_unit: BTreeMap<String, Vec<Facade>> = BTreeMap::new();
        for path in paths {
            let facade = read_facade(&path, &Default::default()).unwrap();
            by_unit.entry(facade.unit.clone()).or_default().push(facade);
        }
        let learnt = by_unit.into_values().map(|facades| {
            let library = Library::learn(&facades).unwrap();
            (facades, library)
        });
        learnt.collect()
    })
}

/// The facade that the text of rules with names derives to.
fn read_back(named: &Named) -> Facade {
    let text = named_to_string(named);
    let grammar = from_str(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    derive(&grammar, 0).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

#[test]
fn a_facade_comes_back_from_its_rules_region_for_region() {
    let mut tried = 0;
    for (facades, library) in shipped() {
        let drawn = (0..100).map(|k| library.draw(&mut stream(5, "drawn", k), "drawn").unwrap());
        let coded =
            (0..100).filter_map(|k| library.draw_code(&mut stream(5, "coded", k), "c").ok());
        let coded = coded.filter(|facade| facade.regions.len() < 400);
        for facade in facades.iter().cloned().chain(drawn).chain(coded) {
            let back = read_back(&library.named_facade(&facade).unwrap());
            assert!(same_tiling(&facade, &back), "{}", facade.name);
            tried += 1;
        }
    }
    assert!(tried > 200, "{tried}");
}

fn row(name: &str, labels: &[&str], sizes: &[f64]) -> Facade {
    let mut x = 0.0;
    let regions = labels.iter().zip(sizes).map(|(label, &size)| {
        x += size;
        Region {
            label: (*label).into(),
            rect: Rect::new(x - size, 0.0, size, 7.0),
        }
    });
    let regions = regions.collect();
    Facade::new(name, "m", x, 7.0, regions).unwrap()
}

#[test]
fn labels_may_have_any_name() {
    let odd = [
        "columns",
        "split",
        "Fenster (groß)",
        "Facade1",
        "Facade",
        "rand",
        "n 1",
        "width",
    ];
    let all = row("odd", &odd, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let one = row("one", &["Row1"], &[3.0]);
    let twice = ["columns", "split", "columns", "split", "columns", "split"];
    let repeated = row("repeated", &twice, &[1.0, 2.0, 1.0, 2.0, 1.0, 2.0]);
    let uneven = row("uneven", &twice, &[1.0, 2.0, 1.0, 2.5, 1.0, 2.0]);
    let facades = [all, one, repeated, uneven];
    let library = Library::learn(&facades).unwrap();
    for facade in &facades {
        let back = read_back(&library.named_facade(facade).unwrap());
        assert!(same_tiling(facade, &back), "{}", facade.name);
    }
    from_str(&named_to_string(&library.named())).unwrap();
}

#[test]
fn equal_numbers_share_an_attribute_and_change_together() {
    let labels = ["wall", "window", "wall", "window", "wall"];
    let facade = row("f", &labels, &[2.0, 3.0, 2.0, 3.0, 2.0]);
    let library = Library::learn(std::slice::from_ref(&facade)).unwrap();
    let text = named_to_string(&library.named_facade(&facade).unwrap());
    assert_eq!(text.matches("attr ").count(), 3, "{text}");
    assert!(text.contains("attr columns = 2\n"), "{text}");
    let more = from_str(&text.replace("columns = 2", "columns = 5")).unwrap();
    let derived = derive(&more, 0).unwrap();
    let windows = derived
        .regions
        .iter()
        .filter(|region| region.label == "window");
    assert_eq!(windows.count(), 5);
}

/// The number of regions of each label.
fn labels(facade: &Facade) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for region in &facade.regions {
        *counts.entry(region.label.clone()).or_default() += 1;
    }
    counts
}

/// The greatest distance of observed from expected shares, in standard deviations of a sample.
fn distance(
    observed: &BTreeMap<BTreeMap<String, usize>, usize>,
    expected: &BTreeMap<BTreeMap<String, usize>, f64>,
) -> f64 {
    let draws: usize = observed.values().sum();
    let off = expected.iter().map(|(key, share)| {
        let seen = observed.get(key).copied().unwrap_or(0) as f64 / draws as f64;
        (seen - share).abs() / (share * (1.0 - share) / draws as f64).sqrt()
    });
    off.fold(0.0, f64::max)
}

#[test]
fn derived_facades_are_as_frequent_as_those_of_the_library() {
    // Each facade as often as its place says, so that shares differ.
    let mut facades = Vec::new();
    for (k, columns) in [2, 3, 4, 5].into_iter().enumerate() {
        for door in [false, true] {
            let mut names = ["wall", "window"].repeat(columns);
            names.push(if door { "door" } else { "wall" });
            let sizes: Vec<f64> = (0..names.len()).map(|i| [2.0, 3.0][i % 2]).collect();
            for _ in 0..=(2 * k + usize::from(door)) {
                facades.push(row("f", &names, &sizes));
            }
        }
    }
    let library = Library::learn(&facades).unwrap();
    let grammar = from_str(&named_to_string(&library.named())).unwrap();
    let (mut expected, mut alike) = (BTreeMap::new(), BTreeMap::new());
    for facade in &facades {
        *expected.entry(labels(facade)).or_insert(0.0) += 1.0 / facades.len() as f64;
    }
    for key in expected.keys() {
        alike.insert(key.clone(), 1.0 / expected.len() as f64);
    }
    let sampler = Sampler::new(&grammar).unwrap();
    let start = &grammar.starts[0];
    let mut observed = BTreeMap::new();
    for k in 0..4000 {
        let mut rng = stream(9, "derive", k);
        let derived = sampler
            .derive(0, start.width, start.height, &mut rng)
            .unwrap();
        *observed.entry(labels(&derived.facade)).or_default() += 1;
    }
    assert_eq!(observed.len(), expected.len());
    assert!(distance(&observed, &expected) < 4.0);
    // The same test finds shares that were not learnt.
    assert!(distance(&observed, &alike) > 8.0);
}

#[test]
fn the_shipped_layouts_are_drawn_with_their_numbers_of_elements() {
    for (facades, library) in shipped() {
        let named = library.named();
        let grammar = from_str(&named_to_string(&named)).unwrap();
        let all: usize = named.choices.iter().map(|choice| choice.facades).sum();
        assert_eq!(all, facades.len());
        let known: Vec<_> = facades.iter().map(labels).collect();
        let sampler = Sampler::new(&grammar).unwrap();
        let start = &grammar.starts[0];
        for k in 0..60 {
            let mut rng = stream(3, "derive", k);
            let derived = sampler
                .derive(0, start.width, start.height, &mut rng)
                .unwrap();
            assert_eq!(derived.facade.check_tiling(), Ok(()));
            assert!(known.contains(&labels(&derived.facade)));
        }
    }
}

#[test]
fn what_is_wrong_with_numbers_of_rules_is_named() {
    let head = "//@ facade A 9 x 9\nA --> B(2)\nwall --> color(\"#ffffff\")\n";
    let error = |rules: &str| from_str(&format!("{head}{rules}")).unwrap_err().message;
    let message = error("B(n, m) --> split(x) { ~n : wall | ~m : wall }");
    assert_eq!(message, "B takes 2 numbers, not 1");
    let message = error("B(n) --> split(x) { ~1 : wall | ~1 : B(n + 1) }");
    assert!(message.contains("without end"), "{message}");
    let message = error("B(n) --> split(x) { ~1 : wall | ~k : wall }");
    assert!(message.contains("constant k is not defined"), "{message}");
    let message = error("B(n) --> wall\nB(n) --> wall");
    assert!(message.contains("already has a rule"), "{message}");
}
