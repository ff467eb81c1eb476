//! Fits by chains beside exact ones, with hidden variables and with inputs.

use std::ops::ControlFlow;

use edifice_base::rng::stream;
use edifice_base::{Progress, unwatched};
use edifice_model::factor_graph::{
    Factor, Gibbs, Outcome, Settings, exact_gradient, fit, fit_exact, gradient, sample,
};
use rand::RngExt;

use super::{alone, data, dot, features, machine, product, random, restricted, states};

#[test]
fn defaults_reach_the_maximum_likelihood_of_random_machines() {
    let n = 8;
    let graph = machine(n);
    let mut worst: f64 = 0.0;
    // A few of them, or all where `EDIFICE_ALL_CASES` is set, as in `.ci/full`.
    let rounds = std::env::var_os("EDIFICE_ALL_CASES").map_or(2, |_| 20);
    for round in 0..rounds {
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

#[test]
fn tempered_chains_fit_machines_of_separate_modes() {
    // Couplings that single moves of a bit hardly overcome: all bits agree, one way or the other.
    let n = 6;
    let graph = machine(n);
    let mut truth = vec![0.0; n + n * (n - 1) / 2];
    truth[..n].iter_mut().for_each(|w| *w = -4.5);
    truth[n..].iter_mut().for_each(|w| *w = 1.8);
    let data = data(n, &truth, 1000, &mut stream(6, "modes", 0));
    let best = fit_exact(&graph, &data, 1e-4).unwrap();
    let short = |temperatures| {
        let settings = Settings {
            temperatures,
            ..Settings::default()
        };
        let fitted = fit(&graph, &data, &settings, 1, &unwatched).unwrap();
        let (log, _) = exact_gradient(&graph, &data, &fitted.weights).unwrap();
        best.log_likelihood - log
    };
    let (plain, tempered) = (short(1), short(4));
    println!("{plain:.6} nats below with one temperature, {tempered:.6} with four");
    assert!(tempered < 1e-3, "{tempered}");
}

#[test]
fn a_stopped_fit_has_its_last_weights_or_their_mean() {
    let graph = machine(4);
    let mut rng = stream(9, "stopped", 0);
    let data = data(4, &random(10, 1.0, &mut rng), 500, &mut rng);
    let settings = Settings::default();
    let whole = fit(&graph, &data, &settings, 1, &unwatched).unwrap();
    let length = dot(&whole.weights, &whole.weights).sqrt();
    // Before the second half, whose mean is the answer, and in it.
    for (rounds, near) in [(50, 0.5), (300, 0.2)] {
        let enough = |p: Progress| match p.done < rounds {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        };
        let stopped = fit(&graph, &data, &settings, 1, &enough).unwrap();
        assert_eq!(stopped.outcome, Outcome::Interrupted);
        let off: Vec<f64> = (stopped.weights.iter().zip(&whole.weights))
            .map(|(a, b)| a - b)
            .collect();
        assert!(dot(&off, &off).sqrt() < near * length, "{rounds}: {off:?}");
    }
}
