//! Two engines, one distribution: hierarchical models and the networks that they are.

use edifice_base::rng::stream;
use edifice_model::hierarchy::{Group, Hierarchy, Settings, Variant, learn};
use edifice_model::network::Evidence;
use edifice_model::{Cell, Table};
use rand::RngExt;

const VARIANTS: [Variant; 4] = [
    Variant::Full,
    Variant::NoLateral,
    Variant::NoSecondLevel,
    Variant::Directed,
];

type Cells<T> = Vec<Option<T>>;

/// Width, depth and area, garage and roof as a table.
fn table_of(lengths: Vec<Cells<f64>>, garage: Cells<bool>, roof: Cells<&str>) -> Table {
    let mut table = Table::new();
    for (name, column) in ["width", "depth", "area"].iter().zip(lengths) {
        table = table.real(name, column).unwrap();
    }
    table = table.binary("garage", garage).unwrap();
    let names = ["flat", "gable", "hip"];
    table.categorical("roof", &names, roof).unwrap()
}

/// Houses of three kinds: a group of two lengths, one of a single area that goes with them, a yes or no, a category; one
/// cell in ten missing.
fn houses(rows: usize, seed: u64) -> (Table, Vec<Group>) {
    let mut rng = stream(seed, "houses", 0);
    let mut columns: Vec<Vec<Option<f64>>> = vec![Vec::new(); 3];
    let (mut garage, mut roof) = (Vec::new(), Vec::new());
    for i in 0..rows {
        let kind = (i % 3) as f64;
        let width = 8.0 + 5.0 * kind + rng.random::<f64>();
        let depth = 7.0 + 0.5 * width + rng.random::<f64>();
        let area = 20.0 * width + 100.0 * rng.random::<f64>();
        for (column, value) in columns.iter_mut().zip([width, depth, area]) {
            column.push((rng.random::<f64>() > 0.1).then_some(value));
        }
        let seen = |rng: &mut edifice_base::rng::Stream| rng.random::<f64>() > 0.1;
        garage.push(seen(&mut rng).then_some(kind > 0.5 || rng.random::<f64>() < 0.2));
        let names = ["gable", "hip", "flat"];
        let at = match rng.random::<f64>() < 0.8 {
            true => i % 3,
            false => rng.random_range(0..3),
        };
        roof.push(seen(&mut rng).then_some(names[at]));
    }
    let table = table_of(columns, garage, roof);
    let groups = vec![
        Group::new("box", &["width", "depth"]),
        Group::new("size", &["area"]),
        Group::new("parts", &["garage"]),
        Group::new("roof", &["roof"]),
    ];
    (table, groups)
}

fn model(variant: Variant, background: f64, seed: u64) -> (Hierarchy, Table) {
    let (table, groups) = houses(90, seed);
    let settings = Settings {
        variant,
        background,
        styles: 2..=3,
        restarts: 1,
        ..Settings::default()
    };
    let learned = learn(&table, &groups, &settings, seed).unwrap();
    (learned.model, table)
}

/// A row in the words of the network.
fn evidence(table: &Table, row: usize) -> Evidence {
    let real = |name: &str| match table.column(name).unwrap().cell(row) {
        Cell::Real(v) => Some(v),
        _ => None,
    };
    let mut given = Evidence::new()
        .partly("box", &[real("width"), real("depth")])
        .partly("area", &[real("area")]);
    for name in ["garage", "roof"] {
        let column = table.column(name).unwrap();
        if let (Cell::Code(code), Some(names)) = (column.cell(row), column.categories()) {
            given = given.is(name, &names[code]);
        }
    }
    given
}

#[test]
fn densities_and_posteriors_are_equal() {
    for variant in VARIANTS {
        for (background, seed) in [(0.0, 1), (0.0, 2), (0.05, 3)] {
            let (model, table) = model(variant, background, seed);
            let network = model.to_network().unwrap();
            let logs = model.log_likelihood(&table).unwrap();
            let styles = model.style_posterior(&table).unwrap();
            for row in 0..table.rows() {
                let given = evidence(&table, row);
                let log = network.log_probability(&given).unwrap();
                let near = (log - logs[row]).abs() < 1e-9 * (1.0 + log.abs());
                assert!(near, "{variant:?} row {row}: {log} {}", logs[row]);
                let posterior = network.marginal(&given, "style").unwrap();
                for (a, b) in posterior.iter().zip(&styles[row]) {
                    assert!((a - b).abs() < 1e-9, "{variant:?} row {row}: {posterior:?}");
                }
            }
        }
    }
}

/// Assignments of missing cells are given up by a bound: here on rows that lie anywhere, also far from every group, with up
/// to all cells missing, where the other engine gives up none.
#[test]
fn rows_anywhere_are_as_dense_in_both() {
    for (k, variant) in VARIANTS.into_iter().enumerate() {
        for background in [0.0, 0.002] {
            let (model, _) = model(variant, background, 4);
            let network = model.to_network().unwrap();
            let mut rng = stream(5, "anywhere", k as u64);
            let rows = 400;
            let mut columns: Vec<Vec<Option<f64>>> = vec![Vec::new(); 3];
            let (mut garage, mut roof) = (Vec::new(), Vec::new());
            for _ in 0..rows {
                let reach = [1.0, 3.0, 30.0, 1e4][rng.random_range(0..4)];
                let share = rng.random::<f64>();
                let mut seen = || rng.random::<f64>() < share;
                let known = [seen(), seen(), seen(), seen(), seen()];
                for (c, (low, high)) in [(8.0, 20.0), (10.0, 18.0), (150.0, 500.0)]
                    .into_iter()
                    .enumerate()
                {
                    let value = low + (high - low) * reach * (rng.random::<f64>() - 0.3);
                    columns[c].push(known[c].then_some(value));
                }
                garage.push(known[3].then_some(rng.random()));
                let name = ["gable", "hip", "flat"][rng.random_range(0..3)];
                roof.push(known[4].then_some(name));
            }
            let table = table_of(columns, garage, roof);
            let logs = model.log_likelihood(&table).unwrap();
            for (row, &own) in logs.iter().enumerate() {
                let log = network.log_probability(&evidence(&table, row)).unwrap();
                let near = (log - own).abs() < 1e-9 * (1.0 + log.abs());
                assert!(near, "{variant:?} {background} row {row}: {log} {own}");
            }
        }
    }
}

#[test]
fn a_network_scores_a_table_as_its_evidence() {
    let (model, table) = model(Variant::Full, 0.0, 3);
    let network = model.to_network().unwrap();
    // Without the vector-valued group, whose columns the network names by coordinate.
    let table = table.only(&["area", "garage", "roof"]).unwrap();
    let (own, other) = (network.log_likelihood(&table), model.log_likelihood(&table));
    for (a, b) in own.unwrap().iter().zip(other.unwrap()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn draws_of_both_have_the_same_moments() {
    let (model, _) = model(Variant::Full, 0.05, 4);
    let network = model.to_network().unwrap();
    const DRAWS: usize = 20_000;
    let mut rng = stream(1, "draws", 0);
    let own = model.sample(DRAWS, &mut rng).unwrap().table;
    let other = network.sample(&Evidence::new(), DRAWS, &mut rng).unwrap();
    let moments = |table: &Table, name: &str| {
        let column = table.column(name).unwrap();
        let values = (0..DRAWS).map(|row| match column.cell(row) {
            Cell::Real(v) => v,
            Cell::Code(c) => c as f64,
            Cell::Missing => f64::NAN,
        });
        let values: Vec<f64> = values.collect();
        let mean = values.iter().sum::<f64>() / DRAWS as f64;
        let square: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        (mean, (square / DRAWS as f64).sqrt())
    };
    for (a, b) in [
        ("area", "area"),
        ("garage", "garage"),
        ("width", "box[0]"),
        ("depth", "box[1]"),
    ] {
        let ((m, s), (n, t)) = (moments(&own, a), moments(&other, b));
        // Five standard errors of a difference of means.
        assert!(
            (m - n).abs() < 5.0 * s * (2.0 / DRAWS as f64).sqrt(),
            "{a}: {m} {n}"
        );
        assert!((s / t - 1.0).abs() < 0.05, "{a}: {s} {t}");
    }
}
