//! Contrastive divergence against the exact gradient on a small Ising model.

use edifice_base::rng::{Stream, stream};
use edifice_base::unwatched;
use edifice_model::factor_graph::{
    Chain, Factor, Gibbs, Metropolis, Propose, Settings, fit, gradient, sample,
};
use rand::RngExt;

const SIDE: usize = 3;

fn spin(v: usize) -> f64 {
    2.0 * v as f64 - 1.0
}

/// Pairs of neighbours on a 3 x 3 grid.
fn pairs() -> Vec<[usize; 2]> {
    let mut pairs = Vec::new();
    for y in 0..SIDE {
        for x in 0..SIDE {
            let i = y * SIDE + x;
            if x + 1 < SIDE {
                pairs.push([i, i + 1]);
            }
            if y + 1 < SIDE {
                pairs.push([i, i + SIDE]);
            }
        }
    }
    pairs
}

/// Weight 0: all pairs; weight 1: all spins.
fn ising() -> Gibbs {
    let mut factors = Vec::new();
    for pair in pairs() {
        factors.push(Factor {
            variables: pair.to_vec(),
            weight: 0,
            feature: Box::new(|v| spin(v[0]) * spin(v[1])),
        });
    }
    for i in 0..SIDE * SIDE {
        factors.push(Factor {
            variables: vec![i],
            weight: 1,
            feature: Box::new(|v| spin(v[0])),
        });
    }
    Gibbs::new(vec![2; SIDE * SIDE], factors).unwrap()
}

/// The same model with a user's proposal: flip one spin.
struct Flip;

impl Propose for Flip {
    type State = Vec<usize>;

    fn weights(&self) -> usize {
        2
    }

    fn features(&self, state: &Vec<usize>) -> Vec<f64> {
        let pair: f64 = pairs()
            .iter()
            .map(|p| spin(state[p[0]]) * spin(state[p[1]]))
            .sum();
        vec![pair, state.iter().map(|&v| spin(v)).sum()]
    }

    fn propose(&self, state: &Vec<usize>, rng: &mut Stream) -> (Vec<usize>, f64) {
        let mut next = state.clone();
        let i = rng.random_range(0..next.len());
        next[i] = 1 - next[i];
        (next, 0.0)
    }
}

fn data(weights: &[f64], count: usize) -> Vec<Vec<usize>> {
    let start = vec![0; SIDE * SIDE];
    sample(
        &ising(),
        &start,
        weights,
        count,
        5,
        &mut stream(3, "data", 0),
    )
}

fn mean(chain: &impl Chain<State = Vec<usize>>, states: &[Vec<usize>]) -> Vec<f64> {
    let n = states.len() as f64;
    let mut mean = vec![0.0; chain.weights()];
    for s in states {
        for (m, f) in mean.iter_mut().zip(chain.features(s)) {
            *m += f / n;
        }
    }
    mean
}

#[test]
fn both_chains_have_the_exact_expectations() {
    let weights = [0.3, 0.1];
    let (_, exact) = ising().exact(&weights).unwrap();
    let start = vec![0; SIDE * SIDE];
    let gibbs = sample(
        &ising(),
        &start,
        &weights,
        8000,
        2,
        &mut stream(1, "gibbs", 0),
    );
    let flips = sample(
        &Metropolis(Flip),
        &start,
        &weights,
        8000,
        18,
        &mut stream(1, "flip", 0),
    );
    for (states, name) in [(gibbs, "gibbs"), (flips, "flip")] {
        for (m, e) in mean(&ising(), &states).iter().zip(&exact) {
            assert!((m - e).abs() < 0.15, "{name}: {m} is not {e}");
        }
    }
}

#[test]
fn long_chains_give_the_exact_gradient() {
    let data = data(&[0.3, 0.1], 4000);
    let at = [0.1, -0.1];
    let (_, expected) = ising().exact(&at).unwrap();
    let target = mean(&ising(), &data);
    let exact: Vec<f64> = target.iter().zip(&expected).map(|(t, e)| t - e).collect();
    let long = gradient(&ising(), &data, &at, 30, 5).unwrap();
    for (l, e) in long.iter().zip(&exact) {
        assert!((l - e).abs() < 0.2, "{long:?} {exact:?}");
    }
    // One move already points the same way.
    let short = gradient(&ising(), &data, &at, 1, 5).unwrap();
    let dot: f64 = short.iter().zip(&exact).map(|(a, b)| a * b).sum();
    assert!(dot > 0.0);
}

#[test]
fn shared_weights_are_recovered() {
    let truth = [0.3, 0.1];
    let data = data(&truth, 2000);
    let settings = Settings {
        rounds: 300,
        rate: 0.02,
        newton: false,
        ..Settings::default()
    };
    let fitted = fit(&ising(), &data, &settings, 1, &unwatched)
        .unwrap()
        .weights;
    for (l, t) in fitted.iter().zip(truth) {
        assert!((l - t).abs() < 0.04, "{fitted:?}");
    }
    // The exact gradient of the penalised likelihood nearly vanishes there.
    let (_, expected) = ising().exact(&fitted).unwrap();
    for (t, e) in mean(&ising(), &data).iter().zip(&expected) {
        assert!((t - e).abs() < 0.25);
    }
}

#[test]
fn bad_input_is_named() {
    assert!(Gibbs::new(vec![2], Vec::new()).is_err());
    assert!(fit(&ising(), &[], &Settings::default(), 1, &unwatched).is_err());
    let wild = Gibbs::new(
        vec![2],
        vec![Factor {
            variables: vec![0],
            weight: 0,
            feature: Box::new(|_| f64::INFINITY),
        }],
    )
    .unwrap();
    assert!(fit(&wild, &[vec![0]], &Settings::default(), 1, &unwatched).is_err());
}

#[test]
fn exact_sums_are_those_of_enumeration() {
    let weights = [0.37, -0.21];
    let (log_sum, mean) = ising().exact(&weights).unwrap();
    let (mut total, mut slow) = (0.0, [0.0; 2]);
    for state in 0..1_usize << (SIDE * SIDE) {
        let state: Vec<usize> = (0..SIDE * SIDE).map(|i| state >> i & 1).collect();
        let features = ising().features(&state);
        let weight = (weights[0] * features[0] + weights[1] * features[1]).exp();
        total += weight;
        slow.iter_mut()
            .zip(features)
            .for_each(|(s, f)| *s += weight * f);
    }
    assert!((log_sum - f64::ln(total)).abs() < 1e-12);
    for (m, s) in mean.iter().zip(slow) {
        assert!((m - s / total).abs() < 1e-12);
    }
    assert!(ising().exact(&[0.1]).is_err());
    // A variable twice in a factor is refused, one without factors is free.
    let spin_of = |variables: Vec<usize>| Factor {
        variables,
        weight: 0,
        feature: Box::new(|v| spin(v[0])),
    };
    assert!(Gibbs::new(vec![2], vec![spin_of(vec![0, 0])]).is_err());
    let free = Gibbs::new(vec![2, 5], vec![spin_of(vec![0])]).unwrap();
    let (log_sum, _) = free.exact(&[0.0]).unwrap();
    assert!((log_sum - 10.0_f64.ln()).abs() < 1e-12);
}
