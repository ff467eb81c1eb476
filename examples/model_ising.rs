//! A factor graph with shared weights: an Ising model learned by contrastive divergence.
//! `cargo run --example model_ising --no-default-features`

use edifice::model::ModelError;
use edifice::model::factor_graph::{Factor, Gibbs, Settings, fit, sample};
use edifice::rng::stream;
use edifice::unwatched;

const SIDE: usize = 3;

fn spin(v: usize) -> f64 {
    2.0 * v as f64 - 1.0
}

/// Weight 0 is shared by all pairs of neighbours, weight 1 by all spins.
fn ising() -> Result<Gibbs, ModelError> {
    let mut factors = Vec::new();
    for i in 0..SIDE * SIDE {
        let (x, y) = (i % SIDE, i / SIDE);
        for (inside, other) in [(x + 1 < SIDE, i + 1), (y + 1 < SIDE, i + SIDE)] {
            if inside {
                factors.push(Factor {
                    variables: vec![i, other],
                    weight: 0,
                    feature: Box::new(|v| spin(v[0]) * spin(v[1])),
                });
            }
        }
        factors.push(Factor {
            variables: vec![i],
            weight: 1,
            feature: Box::new(|v| spin(v[0])),
        });
    }
    Gibbs::new(vec![2; SIDE * SIDE], factors)
}

fn main() -> Result<(), ModelError> {
    let (model, truth) = (ising()?, [0.3, 0.1]);
    let start = vec![0; SIDE * SIDE];
    let data = sample(&model, &start, &truth, 2_000, 10, &mut stream(1, "data", 0));
    let weights = fit(&model, &data, &Settings::default(), 1, &unwatched)?.weights;
    println!("weights {weights:.3?}, those of the data {truth:?}");
    assert!(weights.iter().zip(truth).all(|(w, t)| (w - t).abs() < 0.05));
    Ok(())
}
