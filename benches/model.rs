//! Times of the model layer: fixed seeds, sizes in the names.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use edifice::model::Table;
use edifice::model::em::Stopping;
use edifice::model::gmm::{Points, Settings, fit};
use edifice::model::hierarchy::{self, Group, learn};
use edifice::model::network::{Evidence, Network};
use edifice::rng::stream;
use edifice_base::unwatched;
use linfa::Dataset;
use linfa::traits::Fit;
use linfa_clustering::GaussianMixtureModel;
use ndarray::Array2;
use rand::RngExt;
use rand_distr::StandardNormal;

/// Dimensions of the real groups of a house (39 in all; with 10 bits 49 attributes).
const GROUPS: [usize; 10] = [3, 1, 1, 1, 3, 6, 12, 4, 4, 4];

/// Houses of seven styles: each prefers one of three clusters per group and some bits.
fn houses(n: usize) -> (Table, Vec<Group>) {
    let mut rng = stream(1, "houses", 0);
    let centres: Vec<f64> = (0..3 * 39)
        .map(|_| 3.0 * rng.sample::<f64, _>(StandardNormal))
        .collect();
    let taste: Vec<usize> = (0..70).map(|_| rng.random_range(0..3)).collect();
    let mut real = vec![Vec::new(); 39];
    let mut bits = vec![Vec::new(); 10];
    for _ in 0..n {
        let s = rng.random_range(0..7);
        let mut column = 0;
        for (g, d) in GROUPS.iter().enumerate() {
            let odd = rng.random::<f64>() < 0.15;
            let h = if odd {
                rng.random_range(0..3)
            } else {
                taste[s * 10 + g]
            };
            for _ in 0..*d {
                let noise: f64 = rng.sample(StandardNormal);
                real[column].push(Some(centres[h * 39 + column] + 0.5 * noise));
                column += 1;
            }
        }
        for (b, bit) in bits.iter_mut().enumerate() {
            let p = if taste[s * 10 + b] == 0 { 0.9 } else { 0.1 };
            bit.push(Some(rng.random::<f64>() < p));
        }
    }
    let mut table = Table::new();
    for (j, column) in real.into_iter().enumerate() {
        table = table.real(&format!("x{j}"), column).expect("finite");
    }
    for (j, column) in bits.into_iter().enumerate() {
        table = table.binary(&format!("b{j}"), column).expect("same rows");
    }
    let mut groups = Vec::new();
    let mut column = 0;
    for (g, d) in GROUPS.iter().enumerate() {
        let columns = (column..column + d).map(|j| format!("x{j}")).collect();
        let name = format!("g{g}");
        groups.push(Group { name, columns });
        column += d;
    }
    let columns = (0..10).map(|j| format!("b{j}")).collect();
    let name = "bits".to_owned();
    groups.push(Group { name, columns });
    (table, groups)
}

fn search(c: &mut Criterion) {
    let (table, groups) = houses(200);
    let mut group = c.benchmark_group("hierarchy");
    group.sample_size(10);
    let settings = hierarchy::Settings::default();
    group.bench_function("structure_search_200x49_styles_2_to_25", |b| {
        b.iter(|| learn(black_box(&table), &groups, &settings, 1, &unwatched).expect("learns"));
    });
    for n in [1_000, 10_000] {
        let (table, groups) = houses(n);
        group.bench_function(format!("em_{n}x49_styles_7_states_3_rounds_10"), |b| {
            b.iter(|| em(black_box(&table), &groups));
        });
    }
    group.finish();
}

/// Ten rounds of EM at fixed cardinalities.
fn em(table: &Table, groups: &[Group]) -> f64 {
    let stopping = Stopping {
        max_rounds: 10,
        ..Stopping::default()
    };
    let settings = hierarchy::Settings {
        stopping,
        ..hierarchy::Settings::default()
    };
    let fitted = hierarchy::fit(table, groups, 7, &[3; 10], &settings, 1, &unwatched);
    fitted.expect("fits").score
}

fn mixtures(c: &mut Criterion) {
    let mut group = c.benchmark_group("gmm");
    group.sample_size(10);
    for (n, d, k) in [(200, 49, 2), (20_000, 49, 5)] {
        let mut rng = stream(2, "points", n as u64);
        let values: Vec<f64> = (0..n * d)
            .map(|i| 3.0 * ((i / d) % k) as f64 + rng.sample::<f64, _>(StandardNormal))
            .collect();
        let settings = Settings {
            restarts: 1,
            stopping: Stopping {
                gain: 1e-3 * n as f64,
                max_rounds: 100,
                ..Stopping::default()
            },
            ..Settings::default()
        };
        group.bench_function(format!("ours_{n}x{d}_k{k}"), |b| {
            let points = Points::new(d, &values).expect("finite");
            b.iter(|| fit(&points, k, &settings, &mut stream(1, "fit", 0)).expect("fits"));
        });
        let data = Dataset::from(Array2::from_shape_vec((n, d), values).expect("sized"));
        group.bench_function(format!("linfa_{n}x{d}_k{k}"), |b| {
            b.iter(|| {
                let model = GaussianMixtureModel::params(k).n_runs(1).tolerance(1e-3);
                black_box(model.fit(&data).is_ok())
            });
        });
    }
    group.finish();
}

fn inference(c: &mut Criterion) {
    let text = std::fs::read_to_string("datasets/model/asia.bif").expect("shipped");
    let asia = Network::from_bif(&text).expect("valid");
    let given = Evidence::new().is("asia", "yes").is("dysp", "yes");
    c.bench_function("network/asia_8_variables_all_marginals", |b| {
        b.iter(|| asia.marginals(black_box(&given)).expect("possible"));
    });
}

criterion_group!(benches, search, mixtures, inference);
criterion_main!(benches);
