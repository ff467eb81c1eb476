//! Regularization is a projection: on the shipped layouts, and on a sample of the real ones.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use edifice::io::{facade_json, read_label_grid};
use edifice::layout::regularize::{regularize_facade, regularize_grid};
use edifice::shape::{Facade, LabelGrid, decompose};

const TOLERANCES: [f64; 7] = [0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0];

fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    files.retain(|f| f.to_string_lossy().ends_with(ending));
    files.sort();
    files
}

/// Distinct labels and sizes of the regions; all coordinates are whole numbers here.
fn sizes(facade: &Facade) -> usize {
    let size = |v: f64| (v * 1e3).round() as i64;
    let key =
        |r: &edifice::shape::Region| (r.label.clone(), size(r.rect.width), size(r.rect.height));
    facade
        .regions
        .iter()
        .map(key)
        .collect::<BTreeSet<_>>()
        .len()
}

#[test]
fn shipped_layouts_keep_what_is_equal() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar/layouts");
    let files = files(&folder, ".facade.json");
    assert_eq!(files.len(), 34);
    for file in files {
        let facade = facade_json::read(&file).unwrap();
        // The large ones at few tolerances, for time.
        let step = if facade.regions.len() < 600 { 1 } else { 3 };
        for tolerance in TOLERANCES.into_iter().step_by(step) {
            let (moved, report) = regularize_facade(&facade, tolerance).unwrap();
            let place = format!("{} at {tolerance}", facade.name);
            assert!(report.largest_move <= tolerance, "{place}");
            assert_eq!(moved.check_tiling(), Ok(()), "{place}");
            assert_eq!(moved.regions.len(), facade.regions.len(), "{place}");
            assert!(sizes(&moved) <= sizes(&facade), "{place}");
            assert_eq!((moved.width, moved.height), (facade.width, facade.height));
            if tolerance == 0.0 {
                assert_eq!(moved, facade, "{place}");
            }
            let (again, _) = regularize_facade(&moved, tolerance).unwrap();
            assert_eq!(again, moved, "{place}");
        }
    }
}

fn check(grid: &LabelGrid, tolerance: f64) {
    let (result, report) = regularize_grid(grid, tolerance).unwrap();
    let place = format!("{} at {tolerance}", grid.name);
    assert!(report.largest_move <= tolerance, "{place}");
    assert_eq!(result.merged().labels, grid.merged().labels, "{place}");
    let (before, after) = (decompose(grid).unwrap(), decompose(&result).unwrap());
    assert!(sizes(&after.facade) <= sizes(&before.facade), "{place}");
    let sum = |of: fn(&(usize, usize)) -> usize| report.sizes.values().map(of).sum::<usize>();
    assert!(sum(|s| s.1) <= sum(|s| s.0), "{place}");
    assert!(report.largest_move <= tolerance, "{place}");
    let (again, _) = regularize_grid(&result, tolerance).unwrap();
    assert_eq!(again, result, "{place}");
}

#[test]
fn real_pictures_are_projected() {
    for (folder, ending, step) in [
        ("facades/ecp2011/labels", ".png", 13),
        ("facades/graz50/labels", ".png", 6),
        ("facades/cmp", ".xml", 83),
    ] {
        let Some(data) = crate::common::real_data(folder) else {
            return;
        };
        for file in files(&data.join(folder), ending).iter().step_by(step) {
            let grid = read_label_grid(file, &Default::default()).unwrap();
            for tolerance in [0.0, 1.0, 5.0] {
                check(&grid, tolerance);
            }
        }
    }
}

/// Guards the strength: most of the sizes of hand-made annotations differ by their noise alone.
#[test]
fn most_sizes_of_real_pictures_become_equal() {
    let folder = "facades/graz50/labels";
    let Some(data) = crate::common::real_data(folder) else {
        return;
    };
    let (mut sum_before, mut sum_after) = (0, 0);
    for file in files(&data.join(folder), ".png").iter().step_by(3) {
        let grid = read_label_grid(file, &Default::default()).unwrap();
        let longer = grid.xs[grid.columns()].max(grid.ys[grid.rows()]);
        let (result, _) = regularize_grid(&grid, (0.01 * longer).round()).unwrap();
        sum_before += sizes(&decompose(&grid).unwrap().facade);
        sum_after += sizes(&decompose(&result).unwrap().facade);
    }
    assert!(
        4 * sum_after < sum_before,
        "{sum_before} -> {sum_after} sizes"
    );
}
