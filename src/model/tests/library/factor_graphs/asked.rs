//! Answers of elimination and of loopy propagation.

use edifice_base::rng::stream;
use edifice_model::factor_graph::{Factor, Gibbs};
use rand::RngExt;

use super::{alone, product, random, states};

#[test]
fn answers_equal_enumeration() {
    for round in 0..40 {
        let mut rng = stream(1, "asked", round);
        let n = rng.random_range(2..8);
        let sizes: Vec<usize> = (0..n).map(|_| rng.random_range(2..4)).collect();
        let mut factors = Vec::new();
        let mut scopes = Vec::new();
        for weight in 0..rng.random_range(1..10) {
            let width = rng.random_range(1..4_usize.min(n + 1));
            let mut scope: Vec<usize> = Vec::new();
            while scope.len() < width {
                let v = rng.random_range(0..n);
                if !scope.contains(&v) {
                    scope.push(v);
                }
            }
            scopes.push(scope.clone());
            factors.push(Factor {
                variables: scope,
                weight,
                feature: Box::new(move |x| {
                    (1.0 + x.iter().sum::<usize>() as f64 * 1.7 + weight as f64).sin()
                }),
            });
        }
        let count = factors.len();
        let graph = Gibbs::new(sizes.clone(), factors).unwrap();
        let weights = random(count, 2.0, &mut rng);
        let mut question = graph.ask(&weights).unwrap();
        let mut known: Vec<Option<usize>> = vec![None; n];
        for v in 0..n {
            if rng.random::<f64>() < 0.2 {
                known[v] = Some(rng.random_range(0..sizes[v]));
                question = question.given(v, known[v].unwrap()).unwrap();
            }
        }
        let (mut z, mut marginals) = (0.0, sizes.iter().map(|&k| vec![0.0; k]).collect::<Vec<_>>());
        let (mut best, mut most): (f64, Vec<usize>) = (f64::NEG_INFINITY, Vec::new());
        for x in states(&sizes) {
            if x.iter()
                .zip(&known)
                .any(|(x, k)| k.is_some_and(|k| k != *x))
            {
                continue;
            }
            let log: f64 = scopes
                .iter()
                .enumerate()
                .map(|(w, scope)| {
                    let sum: usize = scope.iter().map(|&v| x[v]).sum();
                    weights[w] * (1.0 + sum as f64 * 1.7 + w as f64).sin()
                })
                .sum();
            z += log.exp();
            x.iter()
                .enumerate()
                .for_each(|(v, &k)| marginals[v][k] += log.exp());
            if log > best + 1e-12 {
                (best, most) = (log, x);
            }
        }
        assert!((question.log_partition().unwrap() - z.ln()).abs() < 1e-12 * (1.0 + z.ln().abs()));
        for (found, expected) in question
            .marginals()
            .unwrap()
            .iter()
            .flatten()
            .zip(marginals.iter().flatten())
        {
            assert!(
                (found - expected / z).abs() < 1e-12,
                "{found} is not {}",
                expected / z
            );
        }
        let (state, log) = question.explain().unwrap();
        assert!((log - (best - z.ln())).abs() < 1e-9, "{state:?} {most:?}");
        // On a tree loopy propagation is exact; a pair is one.
        let loopy = question.loopy(500, 1e-13).unwrap();
        assert!(loopy.log_partition.is_finite());
    }
}

#[test]
fn loopy_propagation_is_exact_on_trees() {
    // A star and a tail.
    let factors = [(0, 1), (0, 2), (0, 3), (3, 4), (4, 5)]
        .into_iter()
        .enumerate();
    let factors = factors
        .map(|(w, (a, b))| product(a, b, w))
        .chain([alone(2, 5), alone(5, 5)]);
    let graph = Gibbs::new(vec![3; 6], factors.collect()).unwrap();
    let question = graph
        .ask(&[0.3, -0.7, 1.1, 0.4, -0.2, 0.5])
        .unwrap()
        .given(1, 2)
        .unwrap();
    let loopy = question.loopy(500, 1e-14).unwrap();
    assert!(loopy.converged);
    assert!((loopy.log_partition - question.log_partition().unwrap()).abs() < 1e-9);
    for (a, b) in loopy
        .marginals
        .iter()
        .flatten()
        .zip(question.marginals().unwrap().iter().flatten())
    {
        assert!((a - b).abs() < 1e-9);
    }
}
