//! Every facade of the ECP, Graz and CMP databases: reads, decomposes into a splittable tiling,
//! repaints exactly, and regularizes within the tolerance.
//!
//! Needs the data in the folder that `EDIFICE_DATA` names. `cargo test --release --test real_data facades
//! -- --nocapture` prints the statistics.

use std::path::{Path, PathBuf};
use std::time::Instant;

use edifice::io::{self, LabelMap, ReadOptions};
use edifice::layout::regularize::regularize_grid;
use edifice::shape::{LabelGrid, decompose, splittable};

use crate::cases::cases;
use crate::common::real_data;

/// Files of a folder with an extension, sorted.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == extension));
    files.sort();
    files
}

/// `min/median/max` of numbers.
fn spread(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    let (first, last) = (values[0], values[values.len() - 1]);
    format!("{first:.4}/{:.4}/{last:.4}", values[values.len() / 2])
}

/// Decomposes every picture, checks the result, prints a line of statistics.
fn check_all(name: &str, grids: &[LabelGrid]) {
    let (mut terminals, mut seconds, mut thin, mut cut) = (vec![], vec![], vec![], vec![]);
    let (mut rectangles, mut others) = (vec![], vec![]);
    for grid in grids {
        let start = Instant::now();
        let result = decompose(grid).unwrap();
        seconds.push(start.elapsed().as_secs_f64());
        let facade = &result.facade;
        assert_eq!(facade.check_tiling(), Ok(()), "{}", grid.name);
        assert_eq!(splittable(facade), Ok(()), "{}", grid.name);
        let repainted = LabelGrid::from_facade(facade, None).unwrap().merged();
        assert!(repainted == grid.merged(), "{} does not repaint", grid.name);
        terminals.push(facade.regions.len() as f64);
        let slim = facade
            .regions
            .iter()
            .filter(|r| r.rect.width.min(r.rect.height) <= 2.0);
        thin.push(slim.count() as f64);
        cut.push(result.cut_elements.len() as f64);
        rectangles.push(result.areas.0 as f64);
        others.push(result.areas.1 as f64);
    }
    println!(
        "{name}: {} facades; min/median/max terminals {}, of these 1-2 px thin {}, rectangular areas {}, other areas {}, rectangular areas cut {} (all {}), seconds {}",
        grids.len(),
        spread(terminals),
        spread(thin),
        spread(rectangles),
        spread(others),
        spread(cut.clone()),
        cut.iter().sum::<f64>(),
        spread(seconds),
    );
}

pub(crate) fn label_images(folder: &str) -> Option<Vec<LabelGrid>> {
    let folder = real_data(folder)?.join(folder);
    let read = |file: &PathBuf| io::read_label_grid(file, &ReadOptions::default()).unwrap();
    Some(files(&folder, "png").iter().map(read).collect())
}

#[test]
fn ecp() {
    let Some(grids) = label_images("facades/ecp2011/labels") else {
        return;
    };
    assert_eq!(grids.len(), 104);
    check_all("ecp2011", &grids);
}

#[test]
fn graz() {
    let Some(grids) = label_images("facades/graz50/labels") else {
        return;
    };
    assert_eq!(grids.len(), 30);
    check_all("graz50", &grids);
}

#[test]
fn cmp_images() {
    let Some(grids) = label_images("facades/cmp") else {
        return;
    };
    assert_eq!(grids.len(), 250);
    check_all("cmp png", &grids);
}

#[test]
fn cmp_rectangles() {
    let Some(data) = real_data("facades/cmp") else {
        return;
    };
    let (mut grids, mut agreements) = (vec![], vec![]);
    for file in files(&data.join("facades/cmp"), "xml") {
        let grid = io::read_label_grid(&file, &ReadOptions::default()).unwrap();
        assert_eq!(grid.check(), Ok(()));
        let image = file.with_extension("png");
        let image = io::label_image::read(&image, Some(&LabelMap::cmp())).unwrap();
        agreements.push(agreement(&grid, &image));
        grids.push(grid);
    }
    assert_eq!(grids.len(), 250);
    let mean = agreements.iter().sum::<f64>() / agreements.len() as f64;
    println!(
        "cmp xml: pixels like the image, mean {mean:.4}, {}",
        spread(agreements)
    );
    assert!(mean > 0.96);
    check_all("cmp xml", &grids);
}

/// Fraction of the area in which two pictures of one size show the same label.
fn agreement(a: &LabelGrid, b: &LabelGrid) -> f64 {
    let cut = |p: &[f64], q: &[f64]| {
        let mut all: Vec<f64> = p.iter().chain(q).copied().collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (xs, ys) = (cut(&a.xs, &b.xs), cut(&a.ys, &b.ys));
    let name = |g: &LabelGrid, x: f64, y: f64| {
        let i = g.xs.partition_point(|&v| v <= x) - 1;
        let j = g.ys.partition_point(|&v| v <= y) - 1;
        g.labels[usize::from(g.at(i, j))].clone()
    };
    let mut same = 0.0;
    for y in ys.windows(2) {
        for x in xs.windows(2) {
            if name(a, x[0], y[0]) == name(b, x[0], y[0]) {
                same += (x[1] - x[0]) * (y[1] - y[0]);
            }
        }
    }
    same / (xs[xs.len() - 1] * ys[ys.len() - 1])
}

/// Regularizes every picture and prints one line for each tolerance.
fn regularize_all(name: &str, grids: &[LabelGrid], label: &str) -> Vec<(f64, usize, usize)> {
    let count = |grid: &LabelGrid| decompose(grid).unwrap().facade.regions.len() as f64;
    let mut rows = vec![];
    for tolerance in [1.0, 2.0, 3.0, 5.0] {
        let (mut before, mut after, mut most) = (vec![], vec![], 0.0f64);
        let (mut old, mut new, mut squared, mut seconds) = (vec![], vec![], 0, vec![]);
        for grid in grids {
            let start = Instant::now();
            let (result, report) = regularize_grid(grid, tolerance).unwrap();
            seconds.push(start.elapsed().as_secs_f64());
            assert_eq!(result.check(), Ok(()));
            let facade = decompose(&result).unwrap().facade;
            assert_eq!(facade.check_tiling(), Ok(()), "{}", grid.name);
            assert_eq!(splittable(&facade), Ok(()), "{}", grid.name);
            assert_eq!(
                (facade.width, facade.height),
                (grid.xs[grid.columns()], grid.ys[grid.rows()])
            );
            assert!(
                report.largest_move <= tolerance,
                "{}: {}",
                grid.name,
                report.largest_move
            );
            let whole = result.xs.iter().chain(&result.ys).all(|v| v.fract() == 0.0);
            assert!(whole, "{} left the pixel grid", grid.name);
            most = most.max(report.largest_move);
            squared += report.squared;
            let (from, to) = report.sizes.get(label).copied().unwrap_or_default();
            old.push(from as f64);
            new.push(to as f64);
            before.push(count(grid));
            after.push(facade.regions.len() as f64);
        }
        let sum = |v: &[f64]| v.iter().sum::<f64>() as usize;
        rows.push((tolerance, sum(&old), sum(&new)));
        println!(
            "{name}, tolerance {tolerance} px: distinct {label} sizes {} -> {} (all {} -> {}), largest move {most}, squared areas {squared}, terminals {} -> {} (all {} -> {}), seconds {}",
            spread(old.clone()),
            spread(new.clone()),
            sum(&old),
            sum(&new),
            spread(before.clone()),
            spread(after.clone()),
            sum(&before),
            sum(&after),
            spread(seconds),
        );
    }
    rows
}

#[test]
fn regularized_ecp() {
    let Some(grids) = label_images("facades/ecp2011/labels") else {
        return;
    };
    for (_, before, after) in regularize_all("ecp2011", &grids, "window") {
        assert!(after <= before);
    }
}

#[test]
fn regularized_graz() {
    let Some(grids) = label_images("facades/graz50/labels") else {
        return;
    };
    for (tolerance, before, after) in regularize_all("graz50", &grids, "window") {
        assert!(after < before && (tolerance < 2.0 || 2 * after < before));
    }
}

#[test]
fn regularized_cmp() {
    let Some(grids) = label_images("facades/cmp") else {
        return;
    };
    for (_, before, after) in regularize_all("cmp", &grids[..cases(12)], "window") {
        assert!(after <= before);
    }
}
