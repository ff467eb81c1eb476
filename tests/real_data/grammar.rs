//! The printed grammar of Wu et al. 2014 against the facade of the data folder, and how often grammars of real facades are
//! proven optimal (needs `EDIFICE_DATA` or `../shared/data`).

use std::path::Path;

use edifice::grammar::{Costs, evaluate};
use edifice::io::{facade_json, grammar_cga, read_label_grid};
use edifice::layout::regularize::regularize_grid;
use edifice::methods::facade_grammar::{BoundLimits, Settings, lower_bound};
use edifice::shape::decompose;
use edifice::unwatched;

#[test]
fn the_printed_grammar_derives_facade_i() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = "facades/wu2014_fig9.facade.json";
    let Some(data) = crate::common::real_data(file) else {
        return;
    };
    let facade = facade_json::read(&data.join(file)).unwrap();
    let grammar = grammar_cga::read(&here.join("datasets/facade_grammar/wu2014_fig9.cga")).unwrap();
    let found = evaluate(&grammar, &[facade], &Costs::default()).unwrap();
    assert_eq!((found.rules, found.terminals), (10, 50));
    assert!((found.cost - 39.4).abs() < 1e-9);
}

#[test]
fn most_grammars_of_real_facades_are_proven_optimal() {
    let mut gaps = Vec::new();
    for (folder, ending) in [
        ("facades/ecp2011/labels", ".png"),
        ("facades/graz50/labels", ".png"),
        ("facades/cmp", ".xml"),
    ] {
        let Some(data) = crate::common::real_data(folder) else {
            continue;
        };
        let entries = std::fs::read_dir(data.join(folder)).unwrap();
        let mut files: Vec<_> = entries.map(|e| e.unwrap().path()).collect();
        files.retain(|f| f.to_string_lossy().ends_with(ending));
        files.sort();
        for file in files.iter().step_by(8) {
            let grid = read_label_grid(file, &Default::default()).unwrap();
            let size = grid.xs[grid.xs.len() - 1].max(grid.ys[grid.ys.len() - 1]);
            let (grid, _) = regularize_grid(&grid, (0.01 * size).round()).unwrap();
            let settings = Settings {
                iterations: 300,
                ..Settings::default()
            };
            let limits = BoundLimits {
                root_steps: 200,
                nodes: 5,
                ..BoundLimits::default()
            };
            let facade = decompose(&grid).unwrap().facade;
            let bound = lower_bound(&facade, &settings, &limits, &unwatched).unwrap();
            assert!(bound.lower <= bound.upper + 1e-6, "{}", grid.name);
            gaps.push((bound.proven, 1.0 - bound.lower / bound.upper));
        }
    }
    if gaps.is_empty() {
        return;
    }
    let count = gaps.len() as f64;
    let proven = gaps.iter().filter(|(proven, _)| *proven).count() as f64 / count;
    let gap = gaps.iter().map(|(_, gap)| gap).sum::<f64>() / count;
    println!("{count} facades: {proven:.3} proven optimal, mean gap {gap:.5}");
    assert!(proven > 0.85 && gap < 0.005, "{proven} proven, gap {gap}");
}
