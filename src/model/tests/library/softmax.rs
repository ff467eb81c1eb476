//! Softmax weights learned inside networks: stationary points, known weights, hidden parents and children, units.

use edifice_base::rng::stream;
use edifice_model::Table;
use edifice_model::network::{FitSettings, Network, Variable};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Rows of `x`, `z` and a category that follows a softmax of them, for each value of a switch.
fn rows(n: usize, unit: f64, weights: &[[[f64; 3]; 3]; 2], seed: u64) -> Table {
    let mut rng = stream(seed, "softmax", 0);
    let (mut xs, mut zs, mut on, mut kinds) = (vec![], vec![], vec![], vec![]);
    for i in 0..n {
        let x: f64 = rng.sample(StandardNormal);
        let z = 0.5 * x + rng.sample::<f64, _>(StandardNormal);
        let logits = weights[i % 2].map(|w| (w[0] + w[1] * x + w[2] * z).exp());
        let mut u = rng.random::<f64>() * logits.iter().sum::<f64>();
        let kind = logits.iter().position(|l| {
            u -= l;
            u < 0.0
        });
        xs.push(Some(unit * (x + 3.0)));
        zs.push(Some(z));
        on.push(Some(i % 2 == 1));
        kinds.push(Some(kind.unwrap_or(2)));
    }
    let table = Table::new().real("x", xs).unwrap().real("z", zs).unwrap();
    let table = table.binary("on", on).unwrap();
    table.codes("kind", &["a", "b", "c"], kinds).unwrap()
}

fn network() -> Network {
    Network::new(vec![
        Variable::continuous("x", 1, &[]),
        Variable::continuous("z", 1, &["x"]),
        Variable::discrete("on", &["no", "yes"], &[]),
        Variable::discrete("kind", &["a", "b", "c"], &["x", "on", "z"]),
    ])
    .unwrap()
}

const WEIGHTS: [[[f64; 3]; 3]; 2] = [
    [[0.0, 0.0, 0.0], [0.5, 2.0, -1.0], [-0.5, -1.0, 1.5]],
    [[0.0, 0.0, 0.0], [-1.0, 0.5, 0.5], [1.0, -2.0, 0.0]],
];

#[test]
fn what_made_the_rows_is_found_and_no_small_move_gains() {
    let data = rows(6000, 1.0, &WEIGHTS, 1);
    let fitted = network()
        .fit(&data, &FitSettings::default(), &mut stream(1, "fit", 0))
        .unwrap();
    let truth: Vec<f64> = WEIGHTS.iter().flatten().flatten().copied().collect();
    let made = |weights: &[f64]| {
        Network::new(vec![
            Variable::linear("x", 1, &[], &[(&[3.0], &[1.0])]),
            Variable::linear("z", 1, &["x"], &[(&[-1.5, 0.5], &[1.0])]),
            Variable::table("on", &["no", "yes"], &[], &[0.5, 0.5]),
            Variable::softmax("kind", &["a", "b", "c"], &["x", "on", "z"], weights),
        ])
        .unwrap()
    };
    let total = |n: &Network| n.log_likelihood(&data).unwrap().iter().sum::<f64>();
    // x is measured from 3 further down: w_0 - 3 w_1.
    let mut own = truth.clone();
    own.chunks_mut(3).for_each(|w| w[0] -= 3.0 * w[1]);
    let generator = total(&made(&own));
    assert!(
        fitted.log_likelihood > generator,
        "{} {generator}",
        fitted.log_likelihood
    );
    // 20 or so parameters gain about half a nat each over those that made the data.
    assert!(fitted.log_likelihood < generator + 30.0);
    let learned = fitted.network.clone();
    let best = total(&learned);
    assert!((best - fitted.log_likelihood).abs() < 1e-6 * best.abs());
    let mut rng = stream(2, "moves", 0);
    let weights = learned.weights("kind").unwrap().to_vec();
    let (x, z) = (
        learned.regression("x", 0).unwrap(),
        learned.regression("z", 0).unwrap(),
    );
    let on = learned.probabilities("on").unwrap();
    let with = |weights: &[f64]| {
        Network::new(vec![
            Variable::linear("x", 1, &[], &[x]),
            Variable::linear("z", 1, &["x"], &[z]),
            Variable::table("on", &["no", "yes"], &[], on),
            Variable::softmax("kind", &["a", "b", "c"], &["x", "on", "z"], weights),
        ])
        .unwrap()
    };
    assert!((total(&with(&weights)) - best).abs() < 1e-9 * best.abs());
    for _ in 0..30 {
        let moved: Vec<f64> = weights
            .iter()
            .map(|w| w + 1e-3 * rng.sample::<f64, _>(StandardNormal))
            .collect();
        assert!(total(&with(&moved)) < best + 1e-3);
    }
}

#[test]
fn units_do_not_matter() {
    let settings = FitSettings::default();
    let fit = |unit: f64| {
        let data = rows(400, unit, &WEIGHTS, 3);
        let fitted = network()
            .fit(&data, &settings, &mut stream(1, "fit", 0))
            .unwrap();
        fitted.log_likelihood + 400.0 * unit.ln()
    };
    for unit in [1e-6, 1e6] {
        assert!((fit(unit) - fit(1.0)).abs() < 1e-4, "{unit}");
    }
}

#[test]
fn a_hidden_switch_and_missing_kinds_are_learned_without_loss() {
    let mut data = rows(600, 1.0, &WEIGHTS, 4);
    let kinds: Vec<Option<usize>> = (0..600)
        .map(|i| match data.column("kind").unwrap().cell(i) {
            edifice_model::Cell::Code(c) if i % 5 > 0 => Some(c),
            _ => None,
        })
        .collect();
    data = data.in_order(&["x", "z"]).unwrap();
    let data = data.codes("kind", &["a", "b", "c"], kinds).unwrap();
    let fitted = network()
        .fit(&data, &FitSettings::default(), &mut stream(1, "fit", 0))
        .unwrap();
    assert!(fitted.trace.windows(2).all(|w| w[1] >= w[0]));
    assert!(fitted.log_likelihood.is_finite());
    // A switch that nobody saw tells at least as much as none.
    let plain = Network::new(vec![
        Variable::continuous("x", 1, &[]),
        Variable::continuous("z", 1, &["x"]),
        Variable::discrete("kind", &["a", "b", "c"], &["x", "z"]),
    ])
    .unwrap();
    let plain = plain
        .fit(&data, &FitSettings::default(), &mut stream(1, "fit", 0))
        .unwrap();
    let (with, without) = (fitted.log_likelihood, plain.log_likelihood);
    assert!(with > without - 1.0, "{with} {without}");
}
