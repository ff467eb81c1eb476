//! Learnt models do not depend on the units of the data: mixtures, networks, hierarchies.

use edifice_base::rng::stream;
use edifice_model::Table;
use edifice_model::em::Outcome;
use edifice_model::gmm::{self, Covariance, Points};
use edifice_model::hierarchy::{self, Group};
use edifice_model::network::{FitSettings, Network, Variable};
use rand::RngExt;
use rand_distr::StandardNormal;

const UNITS: [f64; 5] = [1e-6, 1e-3, 0.0254, 1e3, 1e6];
const ROWS: usize = 240;

/// Rows of two correlated clusters.
fn clusters() -> Vec<[f64; 2]> {
    let mut rng = stream(5, "scale", 0);
    let row = |i: usize| {
        let at = if i.is_multiple_of(3) { 0.0 } else { 4.0 };
        let (a, b): (f64, f64) = (rng.sample(StandardNormal), rng.sample(StandardNormal));
        [at + a, 2.0 * at + 0.5 * a + b]
    };
    (0..ROWS).map(row).collect()
}

/// The same in another unit, as a table with a category that goes with the clusters.
fn table(unit: f64) -> Table {
    let rows = clusters();
    let column = |k: usize| rows.iter().map(move |r| Some(r[k] * unit));
    let table = Table::new().real("a", column(0)).unwrap();
    let table = table.real("b", column(1)).unwrap();
    let garage = (0..ROWS).map(|i| Some(i.is_multiple_of(3)));
    table.binary("garage", garage).unwrap()
}

/// `log_likelihood` of the rows of two real columns in a unit is the same per row, converted back, for all units.
fn assert_invariant(log_likelihood: impl Fn(f64) -> f64) {
    let per_row = |unit: f64| log_likelihood(unit) / ROWS as f64 + 2.0 * unit.ln();
    let own = per_row(1.0);
    for unit in UNITS {
        let other = per_row(unit);
        assert!((other - own).abs() < 1e-6, "{unit}: {other} {own}");
    }
}

#[test]
fn mixtures() {
    for covariance in [Covariance::Full, Covariance::Diagonal, Covariance::Tied] {
        let settings = gmm::Settings {
            covariance,
            ..gmm::Settings::default()
        };
        assert_invariant(|unit| {
            let values: Vec<f64> = clusters().into_iter().flatten().map(|v| v * unit).collect();
            let points = Points::new(2, &values).unwrap();
            let fitted = gmm::fit(&points, 3, &settings, &mut stream(1, "gmm", 0)).unwrap();
            assert_ne!(fitted.outcome, Outcome::MaxRounds);
            fitted.log_likelihood
        });
    }
}

#[test]
fn mixtures_with_a_constant_coordinate() {
    assert_invariant(|unit| {
        let rows = clusters().into_iter();
        let values: Vec<f64> = rows.flat_map(|r| [r[0] * unit, 7.1 * unit]).collect();
        let points = Points::new(2, &values).unwrap();
        let settings = gmm::Settings::default();
        let fitted = gmm::fit(&points, 2, &settings, &mut stream(1, "gmm", 0)).unwrap();
        fitted.log_likelihood
    });
}

#[test]
fn networks() {
    let network = Network::new(vec![
        Variable::discrete("kind", &["0", "1"], &[]),
        Variable::discrete("garage", &["no", "yes"], &["kind"]),
        Variable::continuous("a", 1, &["kind"]),
        Variable::continuous("b", 1, &["kind", "a"]),
    ])
    .unwrap();
    assert_invariant(|unit| {
        let settings = FitSettings::default();
        let fitted = network.fit(&table(unit), &settings, &mut stream(2, "network", 0));
        fitted.unwrap().log_likelihood
    });
}

#[test]
fn hierarchies() {
    let groups = [
        Group::new("size", &["a", "b"]),
        Group::new("parts", &["garage"]),
    ];
    for background in [0.0, 0.01] {
        let settings = hierarchy::Settings {
            styles: 2..=3,
            restarts: 1,
            background,
            ..hierarchy::Settings::default()
        };
        assert_invariant(|unit| {
            let data = table(unit);
            let learned = hierarchy::learn(&data, &groups, &settings, 1);
            let model = learned.unwrap().model;
            model.log_likelihood(&data).unwrap().iter().sum()
        });
    }
}
