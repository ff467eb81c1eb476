//! A restricted Boltzmann machine: bars in a 3 x 3 image, explained by hidden bits.
//! `cargo run --release --example model_rbm --no-default-features`

use edifice::model::ModelError;
use edifice::model::factor_graph::{Factor, Gibbs, Settings, exact_gradient, fit};
use edifice::unwatched;

const HIDDEN: usize = 4;

fn main() -> Result<(), ModelError> {
    // A bias for each pixel and hidden bit, a weight for each pair of both.
    let bit = |i: usize| Factor {
        variables: vec![i],
        weight: i,
        feature: Box::new(|x| x[0] as f64),
    };
    let mut factors: Vec<Factor> = (0..9 + HIDDEN).map(bit).collect();
    for pixel in 0..9 {
        for hidden in 9..9 + HIDDEN {
            factors.push(Factor {
                variables: vec![pixel, hidden],
                weight: 9 + HIDDEN + pixel * HIDDEN + hidden - 9,
                feature: Box::new(|x| (x[0] * x[1]) as f64),
            });
        }
    }
    let hidden: Vec<usize> = (9..9 + HIDDEN).collect();
    let machine = Gibbs::new(vec![2; 9 + HIDDEN], factors)?.hidden(&hidden)?;
    // Images of one row or one column; the hidden bits start anyhow, all unlike, so that they learn to differ.
    let mut data = Vec::new();
    for i in 0..600_usize {
        let bar = i % 6;
        let mut image: Vec<usize> = (0..9)
            .map(|p| {
                usize::from(if bar < 3 {
                    p / 3 == bar
                } else {
                    p % 3 == bar - 3
                })
            })
            .collect();
        image.extend((0..HIDDEN).map(|h| (i / 6 + h * (i % 7)) % 2));
        data.push(image);
    }
    let fitted = fit(
        &machine,
        &data,
        &Settings {
            rounds: 1500,
            ..Settings::default()
        },
        1,
        &unwatched,
    )?;
    let (log, _) = exact_gradient(&machine, &data, &fitted.weights)?;
    let independent = 9.0 * (1.0_f64 / 3.0 * 3.0_f64.ln() + 2.0 / 3.0 * 1.5_f64.ln());
    println!(
        "{:?}: {:.3} nats an image; six bars alone would have {:.3}, independent pixels {:.3}",
        fitted.outcome,
        log,
        -6.0_f64.ln(),
        -independent
    );
    assert!(log > -independent + 0.5);
    Ok(())
}
