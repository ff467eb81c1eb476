//! Annealed importance sampling on squares of spins.

use edifice_model::factor_graph::{Annealing, Factor, Gibbs};

/// A square of spins with weight w for equal neighbours, -w for others.
fn ising(side: usize) -> Gibbs {
    let spin = |v: usize| 2.0 * v as f64 - 1.0;
    let pair = |a, b| Factor {
        variables: vec![a, b],
        weight: 0,
        feature: Box::new(move |x| spin(x[0]) * spin(x[1])),
    };
    let mut factors = Vec::new();
    for y in 0..side {
        for x in 0..side {
            let i = y * side + x;
            if x + 1 < side {
                factors.push(pair(i, i + 1));
            }
            if y + 1 < side {
                factors.push(pair(i, i + side));
            }
        }
    }
    Gibbs::new(vec![2; side * side], factors).unwrap()
}

#[test]
fn annealed_partition_functions_are_right_and_their_errors_cover() {
    let graph = ising(10);
    let question = graph.ask(&[0.4]).unwrap();
    let truth = question.log_partition().unwrap();
    let (mut covered, mut worst) = (0, 0.0_f64);
    // A quarter of the runs, or all where `EDIFICE_ALL_CASES` is set, as in `.ci/full`.
    let (runs, expected) = match std::env::var_os("EDIFICE_ALL_CASES") {
        Some(_) => (100, 90..=98),
        None => (25, 21..=25),
    };
    for seed in 0..runs {
        let settings = Annealing {
            chains: 50,
            steps: 200,
            seed,
        };
        let found = question.annealed(&settings).unwrap();
        covered += u32::from((found.log - truth).abs() <= 1.96 * found.error);
        worst = worst.max((found.log - truth).abs());
    }
    println!("log Z {truth:.4}; {covered} of {runs} covered, worst error {worst:.3}");
    let found = question.annealed(&Annealing::default()).unwrap();
    println!("defaults: {found:?}");
    assert!((found.log - truth).abs() < 0.1);
    assert!(expected.contains(&covered), "{covered}");
}

#[test]
fn wide_squares_are_not_refused() {
    let graph = ising(30);
    let question = graph.ask(&[0.2]).unwrap();
    assert!(question.log_partition().is_err());
    let settings = Annealing {
        chains: 20,
        steps: 100,
        seed: 1,
    };
    let found = question.annealed(&settings).unwrap();
    // High temperature: log Z is near n log 2 + edges log cosh w.
    let series = 900.0 * 2_f64.ln() + 1740.0 * 0.2_f64.cosh().ln();
    println!("{found:?}, leading terms {series:.2}");
    assert!((found.log - series).abs() < 10.0);
    assert!(question.loopy(200, 1e-6).unwrap().converged);
}
