//! Gaussian mixtures of rows with missing values: the marginal density by definition, a maximum that no small move of any
//! parameter improves, and the complete rows' mixture from incomplete ones.

use edifice_base::rng::stream;
use edifice_model::ModelError;
use edifice_model::em::Stopping;
use edifice_model::gmm::{Covariance, Fitted, Mixture, Points, Settings, fit, fit_from};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

const D: usize = 3;

/// Rows of two correlated clusters; a share of the values is missing, never all of a row's.
fn rows(n: usize, share: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut rng = stream(seed, "rows", 0);
    let mut complete = Vec::new();
    for i in 0..n {
        let z: Vec<f64> = (0..D).map(|_| rng.sample(StandardNormal)).collect();
        let at = if i % 3 == 0 { 5.0 } else { 0.0 };
        complete.extend([at + z[0], 0.8 * z[0] + 0.6 * z[1] - at, z[2] + 0.5 * z[1]]);
    }
    let mut missing = complete.clone();
    for row in missing.chunks_mut(D) {
        let kept = rng.random_range(0..D);
        for (j, v) in row.iter_mut().enumerate() {
            if j != kept && rng.random::<f64>() < share {
                *v = f64::NAN;
            }
        }
    }
    (complete, missing)
}

fn settings(covariance: Covariance) -> Settings {
    Settings {
        covariance,
        restarts: 3,
        stopping: Stopping {
            movement: 1e-10,
            gain: 0.0,
            max_rounds: 20_000,
        },
        gain: 0.0,
        ..Settings::default()
    }
}

fn fitted(values: &[f64], covariance: Covariance) -> Fitted {
    let points = Points::with_missing(D, values).unwrap();
    fit(&points, 2, &settings(covariance), &mut stream(1, "fit", 0)).unwrap()
}

/// Weights, means and covariances.
fn parts(m: &Mixture) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let k = m.components();
    let means = (0..k).flat_map(|k| m.mean(k).to_vec()).collect();
    let covariances = (0..k).flat_map(|k| m.covariance(k).to_vec()).collect();
    (m.weights().to_vec(), means, covariances)
}

#[test]
fn the_density_of_what_is_observed_is_the_marginal() {
    for covariance in [Covariance::Full, Covariance::Diagonal, Covariance::Tied] {
        let (_, values) = rows(80, 0.5, 2);
        let mixture = fitted(&values, covariance).mixture;
        let points = Points::with_missing(D, &values).unwrap();
        let posteriors = mixture.posterior(&points).unwrap();
        let logs = mixture.log_density(&points).unwrap();
        assert_eq!(posteriors.len() * D, values.len());
        for posterior in &posteriors {
            assert!((posterior.iter().sum::<f64>() - 1.0).abs() < 1e-12 && posterior.len() == 2);
        }
        let (weights, means, covariances) = parts(&mixture);
        for ((x, log), posterior) in values.chunks(D).zip(logs).zip(posteriors) {
            // The mixture over the observed coordinates alone.
            let seen: Vec<usize> = (0..D).filter(|&i| !x[i].is_nan()).collect();
            let mean = |k: usize| seen.iter().map(move |&i| (k, i));
            let sub_means = (0..2).flat_map(mean).map(|(k, i)| means[k * D + i]);
            let mut sub = Vec::new();
            for k in 0..2 {
                for &i in &seen {
                    sub.extend(seen.iter().map(|&j| covariances[(k * D + i) * D + j]));
                }
            }
            let (o, sub_means) = (seen.len(), sub_means.collect());
            let marginal =
                Mixture::new(o, Covariance::Full, weights.clone(), sub_means, sub).unwrap();
            let observed: Vec<f64> = seen.iter().map(|&i| x[i]).collect();
            let one = Points::new(o, &observed).unwrap();
            let expected = marginal.log_density(&one).unwrap()[0];
            assert!((log - expected).abs() < 1e-9, "{log} {expected}");
            let expected = &marginal.posterior(&one).unwrap()[0];
            assert!((posterior[0] - expected[0]).abs() < 1e-9);
        }
    }
}

#[test]
fn em_ends_where_no_small_move_gains() {
    let (_, values) = rows(120, 0.4, 3);
    let points = Points::with_missing(D, &values).unwrap();
    for covariance in [Covariance::Full, Covariance::Diagonal] {
        let fitted = fitted(&values, covariance);
        assert!(fitted.trace.windows(2).all(|w| w[1] >= w[0]));
        let total = |m: &Mixture| m.log_density(&points).unwrap().iter().sum::<f64>();
        let best = total(&fitted.mixture);
        assert!((best - fitted.log_likelihood).abs() < 1e-6);
        let (weights, means, covariances) = parts(&fitted.mixture);
        let mut rng = stream(4, "moves", 0);
        for _ in 0..200 {
            let mut move_by = |size: f64| size * rng.sample::<f64, _>(StandardNormal);
            let tilt = move_by(1e-3);
            let weights = vec![weights[0] + tilt, weights[1] - tilt];
            let means = means.iter().map(|m| m + move_by(1e-3)).collect();
            let mut moved = covariances.clone();
            for k in 0..2 {
                for i in 0..D {
                    for j in 0..=i {
                        if covariance == Covariance::Full || i == j {
                            let by = move_by(1e-3);
                            moved[(k * D + i) * D + j] += by;
                            moved[(k * D + j) * D + i] = moved[(k * D + i) * D + j];
                        }
                    }
                }
            }
            let moved = Mixture::new(D, covariance, weights, means, moved).unwrap();
            // The prior, worth a millionth of a row, may hold back as much.
            assert!(total(&moved) < best + 1e-5, "{} {best}", total(&moved));
        }
    }
}

#[test]
fn incomplete_rows_tell_what_complete_ones_do() {
    let (complete, missing) = rows(6000, 0.3, 5);
    for covariance in [Covariance::Full, Covariance::Diagonal, Covariance::Tied] {
        let order = |m: Mixture| match m.mean(0)[0] < m.mean(1)[0] {
            true => [m.mean(0).to_vec(), m.mean(1).to_vec()],
            false => [m.mean(1).to_vec(), m.mean(0).to_vec()],
        };
        let whole = order(fitted(&complete, covariance).mixture);
        let part = order(fitted(&missing, covariance).mixture);
        for (a, b) in whole.iter().flatten().zip(part.iter().flatten()) {
            assert!((a - b).abs() < 0.1, "{whole:?} {part:?}");
        }
    }
}

#[test]
fn nothing_missing_changes_nothing_and_rows_without_values_neither() {
    let (complete, missing) = rows(90, 0.3, 6);
    let settings = settings(Covariance::Full);
    let plain = Points::new(D, &complete).unwrap();
    let allowed = Points::with_missing(D, &complete).unwrap();
    let fit_with = |points: &Points, rng: &mut dyn Rng| fit(points, 2, &settings, &mut &mut *rng);
    let a = fit_with(&plain, &mut stream(1, "same", 0)).unwrap();
    let b = fit_with(&allowed, &mut stream(1, "same", 0)).unwrap();
    assert_eq!(a.mixture, b.mixture);
    // A row of which nothing is known says nothing: the same maximum from the same start.
    let start = fitted(&missing, Covariance::Full).mixture;
    let mut more = missing.clone();
    more.extend([f64::NAN; D]);
    let same = fit_from(&Points::with_missing(D, &more).unwrap(), &start, &settings).unwrap();
    let points = Points::with_missing(D, &missing).unwrap();
    let total = |m: &Mixture| m.log_density(&points).unwrap().iter().sum::<f64>();
    assert!((total(&same.mixture) - total(&start)).abs() < 1e-4);
}

#[test]
fn a_coordinate_without_values_is_named() {
    let values = [1.0, f64::NAN, 2.0, f64::NAN, 3.0, f64::NAN];
    let points = Points::with_missing(2, &values).unwrap();
    let error = fit(&points, 1, &Settings::default(), &mut stream(1, "fit", 0)).unwrap_err();
    assert_eq!(error, ModelError::AllMissing { column: "1".into() });
    assert!(Points::new(2, &values).is_err());
    assert!(Points::with_missing(2, &[f64::INFINITY, 1.0]).is_err());
}
