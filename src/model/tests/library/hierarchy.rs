//! The hierarchical model: does it find what made the data, and answer with it?

use edifice_base::rng::stream;
use edifice_model::hierarchy::{Constant, Group, Hierarchy, Learned, Settings, Variant, learn};
use edifice_model::{Cell, ModelError, Table};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Rows of five groups (2 + 1 + 2 + 1 + 1 real columns) and three bits, of `k` styles; the second group
/// depends on the first, and style 0 has no garage.
fn made(n: usize, k: usize, seed: u64) -> (Table, Vec<usize>) {
    let mut rng = stream(seed, "made", 0);
    let mut real: Vec<Vec<Option<f64>>> = vec![Vec::new(); 7];
    let mut bits: Vec<Vec<Option<bool>>> = vec![Vec::new(); 3];
    let mut styles = Vec::new();
    for i in 0..n {
        let s = i % k;
        styles.push(s);
        let z: [f64; 7] = std::array::from_fn(|_| rng.sample(StandardNormal));
        let a = 10.0 + 3.0 * (s % 2) as f64 + 0.5 * z[0];
        let b = 5.0 + 2.0 * (s / 2) as f64 + 0.4 * z[1];
        let c = 100.0 + 20.0 * a - 3.0 * b + 2.0 * z[2];
        let garage = if s == 0 { 0.0 } else { 1.0 };
        let d = garage * (8.0 + s as f64 + 0.3 * z[3]);
        let e = garage * (2.0 + 0.2 * z[4]);
        let f = 4.0 * ((s + 1) % 3) as f64 + 0.5 * z[5];
        let g = 4.0 * (s * s % 3) as f64 + 0.5 * z[6];
        for (column, v) in real.iter_mut().zip([a, b, c, d, e, f, g]) {
            column.push(Some(v));
        }
        for (bit, column) in bits.iter_mut().enumerate() {
            let p = if s == bit { 0.9 } else { 0.1 };
            column.push(Some(rng.random::<f64>() < p));
        }
    }
    let mut table = Table::new();
    for (j, column) in real.into_iter().enumerate() {
        table = table.real(&format!("x{j}"), column).unwrap();
    }
    for (j, column) in bits.into_iter().enumerate() {
        table = table.binary(&format!("b{j}"), column).unwrap();
    }
    (table, styles)
}

fn groups() -> Vec<Group> {
    vec![
        Group::new("size", &["x0", "x1"]),
        Group::new("area", &["x2"]),
        Group::new("garage", &["x3", "x4"]),
        Group::new("porch", &["x5"]),
        Group::new("glass", &["x6"]),
        Group::new("bits", &["b0", "b1", "b2"]),
    ]
}

fn settings() -> Settings {
    Settings {
        styles: 2..=6,
        ..Settings::default()
    }
}

const VARIANTS: [Variant; 4] = [
    Variant::Full,
    Variant::NoLateral,
    Variant::NoSecondLevel,
    Variant::Directed,
];

/// Adjusted Rand index of two labellings.
fn rand_index(a: &[usize], b: &[usize]) -> f64 {
    let pairs = |n: f64| n * (n - 1.0) / 2.0;
    let (ka, kb) = (a.iter().max().unwrap() + 1, b.iter().max().unwrap() + 1);
    let mut cells = vec![vec![0.0; kb]; ka];
    for (&i, &j) in a.iter().zip(b) {
        cells[i][j] += 1.0;
    }
    let sum: f64 = cells.iter().flatten().map(|&n| pairs(n)).sum();
    let rows: f64 = cells.iter().map(|r| pairs(r.iter().sum())).sum();
    let columns: f64 = (0..kb)
        .map(|j| pairs(cells.iter().map(|r| r[j]).sum()))
        .sum();
    let expected = rows * columns / pairs(a.len() as f64);
    (sum - expected) / (0.5 * (rows + columns) - expected)
}

fn styles_of(model: &Hierarchy, table: &Table) -> Vec<usize> {
    let posterior = model.style_posterior(table).unwrap();
    let top = |p: &Vec<f64>| (0..p.len()).max_by(|&a, &b| p[a].total_cmp(&p[b])).unwrap();
    posterior.iter().map(top).collect()
}

fn learned(n: usize) -> (Learned, Table, Vec<usize>) {
    let (table, styles) = made(n, 4, 1);
    (
        learn(&table, &groups(), &settings(), 7).unwrap(),
        table,
        styles,
    )
}

fn real(table: &Table, column: &str, row: usize) -> f64 {
    match table.column(column).unwrap().cell(row) {
        Cell::Real(v) => v,
        cell => panic!("{cell:?} where a number is needed"),
    }
}

/// At 200 rows three and four styles can score within a nat or two of each other, so one draw in
/// five may lump two styles; at 400 none does.
#[test]
fn finds_styles_and_the_lateral_edge() {
    // Two draws, or five where `EDIFICE_ALL_CASES` is set, as in `.ci/full`; styles may be missed in one of those of 200 rows.
    let draws = std::env::var_os("EDIFICE_ALL_CASES").map_or(2, |_| 5);
    for (n, least_found) in [(200, draws - 1), (400, draws)] {
        let found = (1..=draws).filter(|&draw| {
            let (table, styles) = made(n, 4, draw);
            let model = learn(&table, &groups(), &settings(), 7).unwrap().model;
            assert!(model.styles().abs_diff(4) <= 1);
            let edges = model.lateral_edges();
            let area = |a: &str, b: &str| [a, b] == ["size", "area"] || [a, b] == ["area", "size"];
            assert!(
                edges.iter().any(|(a, b)| area(a, b)),
                "{n} rows, draw {draw}: {edges:?}"
            );
            rand_index(&styles_of(&model, &table), &styles) > 0.9
        });
        let found = found.count() as u64;
        assert!(found >= least_found, "{n} rows: {found} of {draws} draws");
    }
}

#[test]
fn variants_answer_and_ours_generalises_best() {
    let (table, _) = made(200, 4, 1);
    let (test, _) = made(400, 4, 2);
    let mut mean = Vec::new();
    for variant in VARIANTS {
        let settings = Settings {
            variant,
            ..settings()
        };
        let learned = learn(&table, &groups(), &settings, 7).unwrap();
        let l = learned.model.log_likelihood(&test).unwrap();
        assert!(l.iter().all(|v| v.is_finite()));
        mean.push(l.iter().sum::<f64>() / l.len() as f64);
        let again = Hierarchy::from_json(&learned.model.to_json().unwrap()).unwrap();
        assert_eq!(again.log_likelihood(&test).unwrap(), l);
    }
    println!("mean held-out log-likelihood {mean:?}");
    assert!(mean[0] > mean[1] && mean[0] > mean[3], "{mean:?}");
}

#[test]
fn completion_keeps_what_is_given_and_follows_the_rest() {
    let (learned, table, _) = learned(400);
    let given = table.select(&[0, 1]).only(&["x0", "x3"]).unwrap();
    let draws = learned
        .model
        .complete(&given, 50, &mut stream(3, "draws", 0))
        .unwrap();
    assert_eq!(draws.table.rows(), 100);
    for i in 0..100 {
        for column in draws.table.columns() {
            assert_ne!(column.cell(i), Cell::Missing);
        }
        assert!((real(&draws.table, "x0", i) - real(&given, "x0", i / 50)).abs() < 1e-9);
    }
    // Style 0 has no garage: where x3 is 0, so is x4.
    assert!(real(&draws.table, "x4", 0).abs() < 0.8);
    assert!(draws.log_density.iter().all(|v| v.is_finite()));
}

#[test]
fn same_seed_same_bytes_with_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| learned(60).0.model.to_json().unwrap())
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn two_rows_still_answer() {
    let (table, _) = made(120, 4, 1);
    let two = learn(&table.select(&[1, 2]), &groups(), &settings(), 7);
    assert!(matches!(two, Err(ModelError::Constant { .. })), "{two:?}");
    for variant in VARIANTS {
        let lenient = Settings {
            variant,
            constant: Constant::Keep,
            ..settings()
        };
        let two = learn(&table.select(&[1, 2]), &groups(), &lenient, 7).unwrap();
        let l = two.model.log_likelihood(&table).unwrap();
        assert!(l.iter().all(|l| l.is_finite()));
    }
}

#[test]
fn missing_values_still_answer() {
    let (table, _) = made(60, 4, 1);
    let mut holes = Table::new();
    for (j, column) in table.columns().iter().enumerate() {
        let cells = (0..60).map(|i| match column.cell(i) {
            cell if !(i * 7 + j * 5).is_multiple_of(3) => cell,
            _ => Cell::Missing,
        });
        holes = match column.categories() {
            None => holes.real(
                column.name(),
                cells.map(|c| match c {
                    Cell::Real(v) => Some(v),
                    _ => None,
                }),
            ),
            Some(_) => holes.binary(
                column.name(),
                cells.map(|c| match c {
                    Cell::Code(v) => Some(v == 1),
                    _ => None,
                }),
            ),
        }
        .unwrap();
    }
    for variant in VARIANTS {
        let settings = Settings {
            variant,
            styles: 2..=2,
            most_states: 3,
            ..settings()
        };
        let learned = learn(&holes, &groups(), &settings, 7).unwrap();
        let l = learned.model.log_likelihood(&holes).unwrap();
        assert!(l.iter().all(|l| l.is_finite()), "{variant:?}");
        let mut rng = stream(1, "d", 0);
        let draws = learned.model.complete(&holes, 1, &mut rng).unwrap();
        assert_eq!(draws.table.rows(), 60);
    }
}

#[test]
fn a_missing_value_is_integrated_out() {
    // log p(rest) = log of the integral of p(rest, x) over x, by the trapezoid rule: once over a
    // parent of a lateral edge, once over a child.
    let (learned, table, _) = learned(100);
    for (column, from, to) in [("x0", 0.0, 30.0), ("x1", -10.0, 20.0), ("x2", 0.0, 700.0)] {
        for row in [1, 2, 6] {
            let steps = 30_000;
            let width = (to - from) / f64::from(steps);
            let mut grid = Table::new();
            let mut hole = Table::new();
            let copies: Vec<usize> = vec![row; steps as usize];
            let many = table.select(&copies);
            for c in table.columns() {
                let name = c.name();
                let value = match c.cell(row) {
                    Cell::Real(v) => Some(v),
                    _ => None,
                };
                (grid, hole) = if name == column {
                    let values = (0..steps).map(|i| Some(from + width * f64::from(i)));
                    (
                        grid.real(name, values).unwrap(),
                        hole.real(name, [None]).unwrap(),
                    )
                } else if value.is_some() {
                    let values = copies.iter().map(|_| value);
                    (
                        grid.real(name, values).unwrap(),
                        hole.real(name, [value]).unwrap(),
                    )
                } else {
                    let code = |t: &Table, i: usize| match t.column(name).unwrap().cell(i) {
                        Cell::Code(v) => Some(v == 1),
                        _ => None,
                    };
                    let values: Vec<Option<bool>> =
                        (0..copies.len()).map(|i| code(&many, i)).collect();
                    (
                        grid.binary(name, values).unwrap(),
                        hole.binary(name, [code(&table, row)]).unwrap(),
                    )
                };
            }
            let slow: f64 = learned
                .model
                .log_likelihood(&grid)
                .unwrap()
                .iter()
                .map(|l| l.exp() * width)
                .sum();
            let fast = learned.model.log_likelihood(&hole).unwrap()[0];
            assert!(
                (fast - slow.ln()).abs() < 1e-4,
                "{column} {row}: {fast} {}",
                slow.ln()
            );
        }
    }
}

#[test]
fn bad_input_is_named() {
    let (table, _) = made(30, 4, 1);
    let fit = |t: &Table, g: &[Group]| learn(t, g, &settings(), 1).map(|_| ());
    let one = |name: &str| [Group::new("g", &[name])];
    let extra = |v: Vec<Option<f64>>| table.clone().real("extra", v).unwrap();
    assert!(matches!(
        fit(&extra(vec![None; 30]), &one("extra")),
        Err(ModelError::AllMissing { column }) if column == "extra"
    ));
    assert!(matches!(
        fit(&extra(vec![Some(0.1); 30]), &one("extra")),
        Err(ModelError::Constant { column, .. }) if column == "extra"
    ));
    assert!(matches!(
        table
            .clone()
            .real("extra", (0..30).map(|i| Some(1.0 / f64::from(i)))),
        Err(ModelError::NotFinite { row: 0, .. })
    ));
    assert!(matches!(
        fit(&table, &one("none")),
        Err(ModelError::Unknown { .. })
    ));
    assert!(matches!(
        fit(&table, &[Group::new("g", &["x0", "b0"])]),
        Err(ModelError::Kind { column, .. }) if column == "b0"
    ));
    let styled = Table::new().categorical("roof", &["flat", "hip"], [Some("flat"), Some("hip")]);
    let settings = Settings {
        styles: 1..=1,
        ..settings()
    };
    let model = learn(&styled.unwrap(), &one("roof"), &settings, 1)
        .unwrap()
        .model;
    let new = Table::new()
        .categorical("roof", &["gable"], [Some("gable")])
        .unwrap();
    assert!(matches!(
        model.log_likelihood(&new),
        Err(ModelError::UnseenCategory { column, row: 0, category })
            if column == "roof" && category == "gable"
    ));
    let text = model.to_json().unwrap();
    for cut in (0..text.len() - 2).step_by(31) {
        assert!(matches!(
            Hierarchy::from_json(&text[..cut]),
            Err(ModelError::Corrupt { .. })
        ));
    }
    assert!(Hierarchy::from_json(&text.replace("0.5", "0.7")).is_err());
}
