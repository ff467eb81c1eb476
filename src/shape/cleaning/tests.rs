use super::*;
use edifice_base::rng::stream;
use rand::RngExt;

/// A wall of 160 x 120 pixels with two rows of four windows, whose sides waver by up to `noise`.
fn windows(noise: i64, seed: u64) -> LabelGrid {
    let mut rng = stream(seed, "windows", 0);
    let mut cells = vec![0; 160 * 120];
    for (left, bottom) in (0..8).map(|k| (12 + 38 * (k % 4), 16 + 52 * (k / 4))) {
        let mut side = |place: i64| (place + rng.random_range(-noise..=noise)) as usize;
        let (from, to) = (side(left), side(left + 24));
        for y in side(bottom)..side(bottom + 36) {
            cells[y * 160 + from..y * 160 + to].fill(1);
        }
    }
    LabelGrid {
        name: "windows".into(),
        unit: "px".into(),
        xs: (0..=160).map(f64::from).collect(),
        ys: (0..=120).map(f64::from).collect(),
        labels: vec!["wall".into(), "window".into()],
        cells,
    }
}

fn transposed(grid: &LabelGrid) -> LabelGrid {
    let (columns, rows) = (grid.columns(), grid.rows());
    LabelGrid {
        xs: grid.ys.clone(),
        ys: grid.xs.clone(),
        cells: (0..columns * rows)
            .map(|k| grid.at(k / rows, k % rows))
            .collect(),
        ..grid.clone()
    }
}

fn scaled(grid: &LabelGrid, factor: f64) -> LabelGrid {
    let scale = |cuts: &[f64]| cuts.iter().map(|cut| cut * factor).collect();
    LabelGrid {
        xs: scale(&grid.xs),
        ys: scale(&grid.ys),
        ..grid.clone()
    }
}

#[test]
fn exact_rows_and_columns_stay() {
    let exact = windows(0, 1);
    assert_eq!(clean(&exact, 2.0), Ok(exact.merged()));
    assert_eq!(clean(&exact, 0.0), Ok(exact));
}

#[test]
fn wavering_edges_become_rows_and_columns() {
    let exact = windows(0, 1).merged();
    for seed in 0..10 {
        let found = clean(&windows(2, seed), 2.0).expect("a tolerance");
        assert_eq!(found.cells, exact.cells, "seed {seed}");
        for (found, exact) in [(&found.xs, &exact.xs), (&found.ys, &exact.ys)] {
            let near = found.iter().zip(exact).all(|(a, b)| (a - b).abs() <= 2.0);
            assert!(near, "seed {seed}: {found:?}");
        }
        assert_eq!(clean(&found, 2.0), Ok(found), "a second time");
    }
}

#[test]
fn specks_vanish_and_nothing_else_changes() {
    let exact = windows(0, 1);
    let mut specked = exact.clone();
    specked.labels.push("door".into());
    let mut rng = stream(5, "specks", 0);
    for _ in 0..60 {
        // Inside a window or the wall, two pixels from any edge, so that a speck touches no other label.
        let (x, y) = (rng.random_range(2..157), rng.random_range(2..117));
        let around = (y - 2..=y + 3).flat_map(|j| (x - 2..=x + 3).map(move |i| (i, j)));
        let mut around = around.filter(|&(i, j)| i < 160 && j < 120);
        if around.all(|(i, j)| specked.at(i, j) == specked.at(x, y)) {
            for j in y..=y + 1 {
                specked.cells[j * 160 + x..=j * 160 + x + 1].fill(2);
            }
        }
    }
    assert!(specked.cells.iter().filter(|&&label| label == 2).count() > 40);
    assert_eq!(absorb_specks(&specked, 5.0).merged(), exact.merged());
    assert_eq!(clean(&specked, 2.0), Ok(exact.merged()));
    // Four pixels are not smaller than four.
    assert_eq!(absorb_specks(&specked, 4.0), specked);
}

#[test]
fn units_and_orientation_do_not_matter() {
    for seed in 0..5 {
        let noisy = windows(3, seed);
        let found = clean(&noisy, 2.0).expect("a tolerance");
        assert_eq!(clean(&scaled(&noisy, 4.0), 8.0), Ok(scaled(&found, 4.0)));
        assert_eq!(clean(&transposed(&noisy), 2.0), Ok(transposed(&found)));
    }
}

#[test]
fn any_picture_is_cleaned() {
    let mut rng = stream(2, "random pictures", 0);
    for _ in 0..40 {
        let (columns, rows) = (rng.random_range(1..12), rng.random_range(1..12));
        let noise = LabelGrid {
            xs: (0..=columns).map(f64::from).collect(),
            ys: (0..=rows).map(f64::from).collect(),
            cells: (0..columns * rows)
                .map(|_| rng.random_range(0..2))
                .collect(),
            ..windows(0, 1)
        };
        for tolerance in [0.1, 1.0, 3.0, 1e9] {
            let found = clean(&noise, tolerance).expect("a tolerance");
            assert_eq!(found.check(), Ok(()));
            let extent = |grid: &LabelGrid| (grid.xs.last().copied(), grid.ys.last().copied());
            assert_eq!(extent(&found), extent(&noise));
        }
    }
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(clean(&windows(0, 1), wrong).is_err());
    }
}

/// A wall of 160 x 120 pixels with boxes of numbered labels (1 is `window`, 2 is `door`): left, right, bottom, top.
fn painted(boxes: &[(u16, [usize; 4])]) -> LabelGrid {
    let mut grid = windows(0, 1);
    grid.labels.push("door".into());
    grid.cells.fill(0);
    for &(label, [left, right, bottom, top]) in boxes {
        for y in bottom..top {
            grid.cells[y * 160 + left..y * 160 + right].fill(label);
        }
    }
    grid
}

/// The boxes of the areas of a label, from the bottom up.
fn found(grid: &LabelGrid, label: &str) -> Vec<[f64; 4]> {
    let elements = crate::elements_of_grid(grid).expect("elements");
    let own = elements.regions.iter().filter(|r| r.label == label);
    own.map(|r| [r.rect.x, r.rect.right(), r.rect.y, r.rect.top()])
        .collect()
}

#[test]
fn windows_of_a_stairwell_stay_between_the_floors() {
    // Five columns on three floors, one side a pixel off, and a sixth whose windows stand half a floor higher.
    let mut boxes = Vec::new();
    for (column, floor) in (0..5).flat_map(|c| (0..3).map(move |f| (c, f))) {
        let (x, y) = (10 + 24 * column, 10 + 36 * floor);
        let off = usize::from(column + floor == 0);
        boxes.push((1, [x, x + 14, y, y + 20 + off]));
    }
    for floor in 0..2 {
        let y = 10 + 36 * floor + 18;
        boxes.push((1, [10 + 24 * 5, 24 + 24 * 5, y, y + 20]));
    }
    let clean = on_lattice(&painted(&boxes));
    let stairs = found(&clean, "window");
    let stairs: Vec<_> = stairs.into_iter().filter(|b| b[0] > 125.0).collect();
    assert_eq!(
        stairs,
        [[130.0, 144.0, 28.0, 48.0], [130.0, 144.0, 64.0, 84.0]]
    );
    assert_eq!(found(&clean, "window").len(), 17);
}

#[test]
fn every_door_on_the_ground_stays() {
    let mut boxes = vec![
        (2, [10, 26, 0, 30]),
        (2, [70, 84, 2, 30]),
        (2, [130, 148, 0, 33]),
        // Above the ground, and a speck.
        (2, [40, 56, 90, 118]),
        (2, [100, 104, 0, 4]),
    ];
    for (column, floor) in (0..3).flat_map(|c| (0..2).map(move |f| (c, f))) {
        let (x, y) = (20 + 50 * column, 40 + 26 * floor);
        boxes.push((1, [x, x + 14 + usize::from(column + floor == 0), y, y + 18]));
    }
    let clean = on_lattice(&painted(&boxes));
    let doors = found(&clean, "door");
    let expected = [
        [10.0, 26.0, 0.0, 30.0],
        [70.0, 84.0, 0.0, 30.0],
        [130.0, 148.0, 0.0, 33.0],
    ];
    assert_eq!(doors, expected);
}
