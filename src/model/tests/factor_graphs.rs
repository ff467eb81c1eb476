//! Questions to factor graphs and their fits against enumeration of all states.

use edifice_base::rng::{Stream, stream};
use edifice_base::unwatched;
use edifice_model::factor_graph::{
    Annealing, Factor, Gibbs, Outcome, Settings, exact_gradient, fit, fit_exact, gradient, sample,
};
use rand::RngExt;

fn product(a: usize, b: usize, weight: usize) -> Factor {
    Factor {
        variables: vec![a, b],
        weight,
        feature: Box::new(|x| (x[0] * x[1]) as f64),
    }
}

fn alone(a: usize, weight: usize) -> Factor {
    Factor {
        variables: vec![a],
        weight,
        feature: Box::new(|x| x[0] as f64),
    }
}

/// A Boltzmann machine of n bits: a weight for each bit and each pair.
fn machine(n: usize) -> Gibbs {
    let mut factors: Vec<Factor> = (0..n).map(|i| alone(i, i)).collect();
    for a in 0..n {
        for b in a + 1..n {
            let weight = factors.len();
            factors.push(product(a, b, weight));
        }
    }
    Gibbs::new(vec![2; n], factors).unwrap()
}

/// All states, in order.
fn states(sizes: &[usize]) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for &k in sizes {
        all = all
            .into_iter()
            .flat_map(|s: Vec<usize>| (0..k).map(move |v| [&s[..], &[v]].concat()))
            .collect();
    }
    all
}

fn features(n: usize, x: &[usize]) -> Vec<f64> {
    let mut all: Vec<f64> = x.iter().map(|v| *v as f64).collect();
    for a in 0..n {
        for b in a + 1..n {
            all.push((x[a] * x[b]) as f64);
        }
    }
    all
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn random(count: usize, scale: f64, rng: &mut Stream) -> Vec<f64> {
    (0..count)
        .map(|_| scale * (2.0 * rng.random::<f64>() - 1.0))
        .collect()
}

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

/// Draws from a random machine by enumeration.
fn data(n: usize, weights: &[f64], count: usize, rng: &mut Stream) -> Vec<Vec<usize>> {
    let all = states(&vec![2; n]);
    let p: Vec<f64> = all
        .iter()
        .map(|x| dot(weights, &features(n, x)).exp())
        .collect();
    (0..count)
        .map(|_| all[edifice_base::rng::categorical(&p, rng)].clone())
        .collect()
}

#[test]
fn defaults_reach_the_maximum_likelihood_of_random_machines() {
    let n = 8;
    let graph = machine(n);
    let mut worst: f64 = 0.0;
    for round in 0..20 {
        let mut rng = stream(2, "machines", round);
        let truth = random(n + n * (n - 1) / 2, 1.0, &mut rng);
        let data = data(n, &truth, 1000, &mut rng);
        let best = fit_exact(&graph, &data, 1e-4).unwrap();
        assert!(best.gradient < 1e-6, "{}", best.gradient);
        let fitted = fit(&graph, &data, &Settings::default(), round, &unwatched).unwrap();
        let (log, _) = exact_gradient(&graph, &data, &fitted.weights).unwrap();
        let short = best.log_likelihood - log;
        worst = worst.max(short);
        println!(
            "{round}: {short:.6} nats below, says {:.6}, {:?}",
            fitted.shortfall, fitted.outcome
        );
        assert!(short < 1e-3, "{round}: {short}");
        assert_eq!(fitted.outcome, Outcome::Settled);
    }
    println!("worst {worst:.6}");
}

#[test]
fn standard_errors_are_those_of_the_information() {
    let graph = machine(3);
    let mut rng = stream(3, "errors", 0);
    let data = data(3, &random(6, 0.5, &mut rng), 2000, &mut rng);
    let fitted = fit(&graph, &data, &Settings::default(), 1, &unwatched).unwrap();
    // The covariance of the features under the fit, by enumeration; its inverse by Gauss-Jordan.
    let all = states(&[2; 3]);
    let p: Vec<f64> = all
        .iter()
        .map(|x| dot(&fitted.weights, &features(3, x)).exp())
        .collect();
    let z: f64 = p.iter().sum();
    let mean = |f: &dyn Fn(&[f64]) -> f64| {
        all.iter()
            .zip(&p)
            .map(|(x, p)| p / z * f(&features(3, x)))
            .sum::<f64>()
    };
    let k = 6;
    let mut m = vec![vec![0.0; 2 * k]; k];
    for i in 0..k {
        for j in 0..k {
            m[i][j] = mean(&|f| f[i] * f[j]) - mean(&|f| f[i]) * mean(&|f| f[j]);
        }
        m[i][k + i] = 1.0;
    }
    for i in 0..k {
        let pivot = m[i][i];
        m[i].iter_mut().for_each(|v| *v /= pivot);
        for r in 0..k {
            if r != i {
                let factor = m[r][i];
                let row = m[i].clone();
                m[r].iter_mut().zip(row).for_each(|(v, w)| *v -= factor * w);
            }
        }
    }
    for (i, found) in fitted.standard_errors.iter().enumerate() {
        let expected = (m[i][k + i] / 2000.0).sqrt();
        assert!(
            (found / expected - 1.0).abs() < 0.25,
            "{i}: {found} is not {expected}"
        );
    }
}

/// A restricted machine: visible bits 0..v, hidden ones after them.
fn restricted(v: usize, h: usize) -> Gibbs {
    let mut factors: Vec<Factor> = (0..v + h).map(|i| alone(i, i)).collect();
    for a in 0..v {
        for b in v..v + h {
            let weight = factors.len();
            factors.push(product(a, b, weight));
        }
    }
    let hidden: Vec<usize> = (v..v + h).collect();
    Gibbs::new(vec![2; v + h], factors)
        .unwrap()
        .hidden(&hidden)
        .unwrap()
}

#[test]
fn the_gradient_of_a_restricted_machine_equals_enumeration() {
    let (v, h) = (4, 3);
    let graph = restricted(v, h);
    let mut rng = stream(4, "restricted", 0);
    let weights = random(v + h + v * h, 1.0, &mut rng);
    let data: Vec<Vec<usize>> = (0..10)
        .map(|_| (0..v + h).map(|_| rng.random_range(0..2)).collect())
        .collect();
    let energy = |w: &[f64], x: &[usize]| {
        let mut sum = x.iter().zip(w).map(|(x, w)| *x as f64 * w).sum::<f64>();
        let mut at = v + h;
        for a in 0..v {
            for b in v..v + h {
                sum += w[at] * (x[a] * x[b]) as f64;
                at += 1;
            }
        }
        sum
    };
    let all = states(&vec![2; v + h]);
    let log = |w: &[f64]| {
        let z: f64 = all.iter().map(|x| energy(w, x).exp()).sum();
        let of = |seen: &Vec<usize>| {
            let own = all.iter().filter(|x| x[..v] == seen[..v]);
            own.map(|x| energy(w, x).exp()).sum::<f64>().ln() - z.ln()
        };
        data.iter().map(of).sum::<f64>() / data.len() as f64
    };
    let (value, slope) = exact_gradient(&graph, &data, &weights).unwrap();
    assert!((value - log(&weights)).abs() < 1e-10);
    for (i, s) in slope.iter().enumerate() {
        let at = |d: f64| {
            let mut w = weights.clone();
            w[i] += d;
            log(&w)
        };
        let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
        assert!(
            (s - difference).abs() < 1e-8,
            "{i}: {s} is not {difference}"
        );
    }
    // A fit by chains climbs the same likelihood.
    let long: Vec<Vec<usize>> = data.iter().cycle().take(2000).cloned().collect();
    let before = log(&vec![0.0; weights.len()]);
    let fitted = fit(
        &graph,
        &long,
        &Settings {
            rounds: 200,
            ..Settings::default()
        },
        1,
        &unwatched,
    )
    .unwrap();
    let best = fit_exact(&graph, &data, 1e-4).unwrap();
    println!(
        "zero {before:.4}, chains {:.4}, exact {:.4}",
        log(&fitted.weights),
        best.log_likelihood
    );
    assert!(log(&fitted.weights) > before + 0.1 && best.log_likelihood > before + 0.1);
}

#[test]
fn a_conditional_field_is_fitted_given_its_inputs() {
    // Labels 0..4 in a chain, inputs 4..8, one under each label.
    let mut factors: Vec<Factor> = (0..3).map(|i| product(i, i + 1, 0)).collect();
    factors.extend((0..4).map(|i| product(i, i + 4, 1)));
    factors.extend((0..4).map(|i| alone(i, 2)));
    let field = Gibbs::new(vec![2; 8], factors)
        .unwrap()
        .inputs(&[4, 5, 6, 7])
        .unwrap();
    let truth = [1.0, 1.5, -1.0];
    let mut rng = stream(5, "field", 0);
    let mut data = Vec::new();
    for _ in 0..1500 {
        let mut start = vec![0; 8];
        // Inputs of a distribution that the field does not model.
        start[4..]
            .iter_mut()
            .for_each(|x| *x = usize::from(rng.random::<f64>() < 0.7));
        data.extend(sample(&field, &start, &truth, 1, 20, &mut rng));
    }
    let exact = fit_exact(&field, &data, 0.0).unwrap();
    let fitted = fit(
        &field,
        &data,
        &Settings {
            moves: 3,
            ..Settings::default()
        },
        1,
        &unwatched,
    )
    .unwrap();
    println!(
        "exact {:?}, chains {:?} +- {:?}",
        exact.weights, fitted.weights, fitted.standard_errors
    );
    for ((w, e), (t, s)) in exact
        .weights
        .iter()
        .zip(&fitted.weights)
        .zip(truth.iter().zip(&fitted.standard_errors))
    {
        assert!((w - t).abs() < 4.0 * s && (w - e).abs() < *s);
    }
    let slope = gradient(&field, &data, &exact.weights, 20, 3).unwrap();
    assert!(slope.iter().all(|s| s.abs() < 0.1), "{slope:?}");
}

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
    let runs = 100;
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
    assert!((90..=98).contains(&covered), "{covered}");
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
