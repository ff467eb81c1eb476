//! A conditional random field: labels of a line of words from noisy signs of each, and what is known of neighbours.
//! `cargo run --release --example model_crf --no-default-features`

use edifice::model::ModelError;
use edifice::model::factor_graph::{Factor, Gibbs, fit_exact};
use edifice::rng::stream;
use rand::RngExt;

const LENGTH: usize = 8;

fn main() -> Result<(), ModelError> {
    let equal = |a, b, weight| Factor {
        variables: vec![a, b],
        weight,
        feature: Box::new(|x| f64::from(u8::from(x[0] == x[1]))),
    };
    // Labels 0 .. 8, signs 8 .. 16: neighbours are alike, and signs are like their labels.
    let mut factors: Vec<Factor> = (1..LENGTH).map(|i| equal(i - 1, i, 0)).collect();
    factors.extend((0..LENGTH).map(|i| equal(i, i + LENGTH, 1)));
    let inputs: Vec<usize> = (LENGTH..2 * LENGTH).collect();
    let field = Gibbs::new(vec![2; 2 * LENGTH], factors)?.inputs(&inputs)?;
    // Labels change seldom, one sign in four is wrong.
    let mut rng = stream(1, "field", 0);
    let mut line = || {
        let mut label = usize::from(rng.random::<bool>());
        let mut labels = Vec::new();
        for _ in 0..LENGTH {
            if rng.random::<f64>() < 0.1 {
                label = 1 - label;
            }
            labels.push(label);
        }
        let signs: Vec<usize> = labels
            .iter()
            .map(|l| {
                if rng.random::<f64>() < 0.25 {
                    1 - l
                } else {
                    *l
                }
            })
            .collect();
        [labels, signs].concat()
    };
    let (train, test): (Vec<_>, Vec<_>) = (
        (0..300).map(|_| line()).collect(),
        (0..300).map(|_| line()).collect(),
    );
    let weights = fit_exact(&field, &train, 0.0)?.weights;
    let (mut right, mut by_sign) = (0, 0);
    for example in &test {
        let mut question = field.ask(&weights)?;
        for (i, sign) in example.iter().enumerate().skip(LENGTH) {
            question = question.given(i, *sign)?;
        }
        let (labels, _) = question.explain()?;
        right += (0..LENGTH).filter(|&i| labels[i] == example[i]).count();
        by_sign += (0..LENGTH)
            .filter(|&i| example[i + LENGTH] == example[i])
            .count();
    }
    println!(
        "weights {weights:.2?}: {right} of {} labels right, {by_sign} by their signs alone",
        300 * LENGTH
    );
    assert!(right > by_sign);
    Ok(())
}
