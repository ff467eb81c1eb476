use proptest::prelude::*;

use super::*;
use edifice_shape::{Rect, Region, decompose, splittable};

/// A wall with windows given as (x, y, width, height), in whole pixels.
fn wall(width: usize, height: usize, windows: &[(usize, usize, usize, usize)]) -> LabelGrid {
    let mut cells = vec![0; width * height];
    for &(x, y, w, h) in windows {
        for row in y..y + h {
            cells[row * width + x..row * width + x + w].fill(1);
        }
    }
    LabelGrid {
        name: "w".into(),
        unit: "px".into(),
        xs: (0..=width).map(|k| k as f64).collect(),
        ys: (0..=height).map(|k| k as f64).collect(),
        labels: vec!["wall".into(), "window".into()],
        cells,
    }
}

#[test]
fn nearly_equal_windows_become_equal() {
    let grid = wall(
        100,
        60,
        &[
            (10, 10, 20, 15),
            (41, 11, 19, 15),
            (70, 10, 21, 14),
            (10, 40, 20, 14),
            (40, 40, 21, 15),
            (71, 39, 20, 15),
        ],
    );
    let (result, report) = regularize_grid(&grid, 2.0).unwrap();
    assert_eq!(report.sizes["window"], (5, 1));
    assert!(report.largest_move <= 2.0);
    let before = decompose(&grid).unwrap().facade.regions.len();
    let after = decompose(&result).unwrap().facade.regions.len();
    // Three strips of wall and two floors of seven.
    assert_eq!(after, 3 + 2 * 7);
    assert!(before > after);
    assert_eq!((result.xs[0], result.xs[result.columns()]), (0.0, 100.0));
}

#[test]
fn thin_walls_between_windows_stay() {
    let grid = wall(30, 10, &[(5, 2, 5, 5), (11, 2, 5, 5), (17, 2, 6, 5)]);
    let (result, report) = regularize_grid(&grid, 3.0).unwrap();
    assert_eq!(report.sizes["window"].1, 1);
    let windows = decompose(&result).unwrap().facade.regions;
    assert_eq!(windows.iter().filter(|r| r.label == "window").count(), 3);
}

/// Painted over a wall in their order: label, x, y, width, height.
fn painted(parts: &[(&str, f64, f64, f64, f64)]) -> LabelGrid {
    let region = |&(label, x, y, width, height): &(&str, f64, f64, f64, f64)| Region {
        label: label.into(),
        rect: Rect::new(x, y, width, height),
    };
    let regions = parts.iter().map(region).collect();
    let facade = Facade::new("p", "px", 100.0, 60.0, regions).unwrap();
    LabelGrid::from_facade(&facade, Some("wall")).unwrap()
}

/// Distinct terminals of the tiling, and how many there are.
fn terminals(grid: &LabelGrid) -> (usize, usize) {
    let regions = decompose(grid).unwrap().facade.regions;
    let key = |r: &Region| (r.label.clone(), r.rect.width as i64, r.rect.height as i64);
    let kinds: std::collections::BTreeSet<_> = regions.iter().map(key).collect();
    (kinds.len(), regions.len())
}

#[test]
fn slivers_of_wall_between_elements_vanish() {
    // Under three windows a sill: one touches its window, one lies two pixels below, one is overlapped
    // by a pixel, and its window starts a pixel further left.
    let grid = painted(&[
        ("window", 10.0, 20.0, 20.0, 30.0),
        ("window", 40.0, 22.0, 20.0, 28.0),
        ("window", 69.0, 19.0, 21.0, 31.0),
        ("sill", 10.0, 16.0, 20.0, 4.0),
        ("sill", 40.0, 16.0, 20.0, 4.0),
        ("sill", 70.0, 16.0, 20.0, 4.0),
    ]);
    let (result, report) = regularize_grid(&grid, 2.0).unwrap();
    assert!(report.largest_move <= 2.0);
    assert_eq!((report.sizes["window"].1, report.sizes["sill"].1), (1, 1));
    // Walls below, above and between, windows and sills: three strips, the middle one of columns.
    assert_eq!(terminals(&result).1, 2 + 4 + 3 * 2);
    // Without room to move, all is kept.
    let (kept, _) = regularize_grid(&grid, 0.5).unwrap();
    assert!(terminals(&kept).1 > terminals(&result).1);
}

#[test]
fn a_sliver_wider_than_the_tolerance_stays() {
    let grid = painted(&[
        ("window", 10.0, 20.0, 20.0, 30.0),
        ("sill", 10.0, 13.0, 20.0, 4.0),
    ]);
    let (result, _) = regularize_grid(&grid, 2.0).unwrap();
    assert_eq!(terminals(&result).1, terminals(&grid).1);
    let (result, _) = regularize_grid(&grid, 3.0).unwrap();
    // Window and sill stand between two walls of their common height.
    assert_eq!(terminals(&result).1, 2 + 2 + 2);
}

#[test]
fn slivers_at_the_border_vanish_and_the_size_stays() {
    let grid = painted(&[("cornice", 2.0, 40.0, 98.0, 18.0)]);
    let (result, report) = regularize_grid(&grid, 2.0).unwrap();
    assert_eq!(report.sizes["cornice"].1, 1);
    assert_eq!(terminals(&result).1, 2);
    assert_eq!(
        (result.xs[result.columns()], result.ys[result.rows()]),
        (100.0, 60.0)
    );
}

#[test]
fn missing_corners_are_filled() {
    let mut grid = wall(30, 20, &[(5, 5, 8, 8), (18, 5, 8, 8)]);
    grid.cells[5 * 30 + 5] = 0;
    let (_, report) = regularize_grid(&grid, 1.0).unwrap();
    assert_eq!((report.squared, report.sizes["window"]), (1, (1, 1)));
}

#[test]
fn metres_work_like_pixels() {
    let grid = wall(
        100,
        60,
        &[(10, 10, 20, 15), (41, 11, 19, 15), (70, 10, 21, 14)],
    );
    let mut facade = decompose(&grid).unwrap().facade;
    facade.width *= 0.013;
    facade.height *= 0.013;
    for region in &mut facade.regions {
        let r = region.rect;
        region.rect = Rect::new(r.x * 0.013, r.y * 0.013, r.width * 0.013, r.height * 0.013);
    }
    let (result, report) = regularize_facade(&facade, 0.03).unwrap();
    assert_eq!(report.sizes["window"], (3, 1));
    assert!(report.largest_move <= 0.03 + 1e-9);
    assert_eq!(result.check_tiling(), Ok(()));
    assert_eq!((result.width, result.height), (facade.width, facade.height));
}

#[test]
fn bad_tolerances_are_refused() {
    let grid = wall(3, 3, &[]);
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        let error = regularize_grid(&grid, tolerance).unwrap_err();
        assert!(matches!(error, RegularizeError::Tolerance(_)));
    }
}

/// Distinct sizes of regions.
fn sizes_of(facade: &Facade) -> usize {
    counts::of_regions(facade).values().sum()
}

/// True if regions that had one label and one size still have one size.
fn stays_equal(before: &Facade, after: &Facade) -> bool {
    let same = 1e-7 * before.width.max(before.height);
    let equal = |f: &Facade, i: usize, j: usize| {
        let (a, b) = (&f.regions[i], &f.regions[j]);
        a.label == b.label
            && (a.rect.width - b.rect.width).abs() <= same
            && (a.rect.height - b.rect.height).abs() <= same
    };
    let n = before.regions.len();
    (0..n).all(|i| (0..i).all(|j| !equal(before, i, j) || equal(after, i, j)))
}

fn scaled_by(facade: &Facade, factor: f64) -> Facade {
    let region = |r: &Region| Region {
        label: r.label.clone(),
        rect: Rect::new(
            factor * r.rect.x,
            factor * r.rect.y,
            factor * r.rect.width,
            factor * r.rect.height,
        ),
    };
    let regions = facade.regions.iter().map(region).collect();
    let (width, height) = (factor * facade.width, factor * facade.height);
    Facade::new("s", "in", width, height, regions).unwrap()
}

#[test]
fn tolerance_0_is_the_identity() {
    let grid = wall(30, 10, &[(5, 2, 5, 5), (11, 2, 5, 5), (17, 2, 6, 5)]);
    assert_eq!(regularize_grid(&grid, 0.0).unwrap().0, grid);
    let facade = decompose(&grid).unwrap().facade;
    let (same, report) = regularize_facade(&facade, 0.0).unwrap();
    assert_eq!((same, report.largest_move), (facade, 0.0));
}

/// Number of connected areas of windows.
fn windows_of(grid: &LabelGrid) -> usize {
    let elements = edifice_shape::elements_of_grid(grid).unwrap();
    elements.regions.len()
}

proptest! {
    /// Rectangles anywhere: nothing vanishes, nothing moves too far, tilings stay splittable.
    #[test]
    fn areas_and_sizes_survive(
        windows in prop::collection::vec((0usize..25, 0usize..25, 1usize..8, 1usize..8), 0..12),
        tolerance in 1u8..5,
    ) {
        let grid = wall(33, 33, &windows);
        let tolerance = f64::from(tolerance);
        let (result, report) = regularize_grid(&grid, tolerance).unwrap();
        prop_assert_eq!(result.check(), Ok(()));
        prop_assert!(report.largest_move <= tolerance + 1e-9);
        prop_assert_eq!(result.xs[result.columns()], 33.0);
        prop_assert!(result.xs.iter().chain(&result.ys).all(|v| v.fract() == 0.0));
        let tiling = decompose(&result).unwrap().facade;
        prop_assert_eq!(splittable(&tiling), Ok(()));
        // Elements neither vanish nor touch others of their label, and no label is lost.
        prop_assert_eq!(windows_of(&result), windows_of(&grid));
        prop_assert_eq!(result.merged().labels, grid.merged().labels);
        prop_assert!(sizes_of(&tiling) <= sizes_of(&decompose(&grid).unwrap().facade));
        // Applied twice it changes nothing more.
        prop_assert_eq!(&regularize_grid(&result, tolerance).unwrap().0, &result);

        let facade = decompose(&grid).unwrap().facade;
        let (moved, report) = regularize_facade(&facade, tolerance).unwrap();
        prop_assert_eq!(moved.check_tiling(), Ok(()));
        prop_assert_eq!(splittable(&moved), Ok(()));
        prop_assert_eq!(moved.regions.len(), facade.regions.len());
        prop_assert!(report.largest_move <= tolerance + 1e-9);
        prop_assert!(stays_equal(&facade, &moved));
        prop_assert_eq!(&regularize_facade(&moved, tolerance).unwrap().0, &moved);

        // The same in other units, off every decimal grid.
        let scaled = scaled_by(&facade, 1.0 / 2.54);
        let (other, _) = regularize_facade(&scaled, tolerance / 2.54).unwrap();
        let expected = scaled_by(&moved, 1.0 / 2.54);
        for (a, b) in other.regions.iter().zip(&expected.regions) {
            prop_assert!((a.rect.x - b.rect.x).abs() < 1e-6 && (a.rect.width - b.rect.width).abs() < 1e-6);
            prop_assert!((a.rect.y - b.rect.y).abs() < 1e-6 && (a.rect.height - b.rect.height).abs() < 1e-6);
        }
        prop_assert_eq!(&regularize_facade(&other, tolerance / 2.54).unwrap().0, &other);
    }
}

/// A row of windows of one kind, of another, and of walls, by width.
fn row(y: f64, parts: &[(&str, f64)]) -> Vec<Region> {
    let mut x = 0.0;
    let part = parts.iter().map(|&(label, width)| {
        x += width;
        Region {
            label: label.into(),
            rect: Rect::new(x - width, y, width, 10.0),
        }
    });
    part.collect()
}

/// Sizes of the regions of one kind.
fn widths(facade: &Facade, kinds: &[u16], kind: u16) -> Vec<f64> {
    let of = facade.regions.iter().zip(kinds).filter(|r| *r.1 == kind);
    of.map(|(region, _)| region.rect.width).collect()
}

#[test]
fn terminals_of_one_kind_become_equal_however_far() {
    // Two floors whose windows were of one size and were stretched differently; a door of its own.
    let lower = row(
        0.0,
        &[
            ("wall", 10.0),
            ("window", 20.0),
            ("wall", 30.0),
            ("door", 30.0),
            ("wall", 10.0),
        ],
    );
    let upper = row(
        10.0,
        &[
            ("wall", 8.0),
            ("window", 36.0),
            ("wall", 14.0),
            ("window", 36.0),
            ("wall", 6.0),
        ],
    );
    let regions: Vec<Region> = lower.into_iter().chain(upper).collect();
    let kinds = [0, 1, 0, 2, 0, 0, 1, 0, 1, 0];
    let facade = Facade::new("f", "cm", 100.0, 20.0, regions).unwrap();
    let (aligned, report) = align_resized(&facade, &kinds, 30.0, 8.0).unwrap();
    aligned.check_tiling().unwrap();
    let windows = widths(&aligned, &kinds, 1);
    assert_eq!(windows.len(), 3);
    assert!(
        windows.iter().all(|w| (w - windows[0]).abs() < 1e-4),
        "{windows:?}"
    );
    assert_eq!((aligned.width, aligned.height), (100.0, 20.0));
    // The left sides of the first windows become one line.
    assert_eq!(aligned.regions[1].rect.x, aligned.regions[6].rect.x);
    assert!(
        report.largest_move > 8.0 && report.lines.1 < report.lines.0,
        "{report:?}"
    );
}

#[test]
fn kinds_that_cannot_be_equal_stay_a_tiling() {
    // No wall that could give way: one window fills a floor, four fill another.
    let lower = row(0.0, &[("window", 40.0)]);
    let upper = row(10.0, &[("window", 10.0); 4]);
    let regions: Vec<Region> = lower.into_iter().chain(upper).collect();
    let facade = Facade::new("f", "cm", 40.0, 20.0, regions).unwrap();
    let (aligned, _) = align_resized(&facade, &[0; 5], 40.0, 1.0).unwrap();
    aligned.check_tiling().unwrap();
    assert_eq!(widths(&aligned, &[0; 5], 0), [40.0, 10.0, 10.0, 10.0, 10.0]);
    let few = align_resized(&facade, &[0; 4], 40.0, 1.0);
    let expected = RegularizeError::Kinds {
        found: 4,
        expected: 5,
    };
    assert_eq!(few.unwrap_err(), expected);
}
