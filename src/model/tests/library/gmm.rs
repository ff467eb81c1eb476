//! Gaussian mixtures against slow, obvious code and against what made the data.

use edifice_base::rng::stream;
use edifice_model::ModelError;
use edifice_model::em::{Outcome, Stopping};
use edifice_model::gmm::{Covariance, Criterion, Mixture, Points, Settings, fit, fit_from, select};
use rand::RngExt;
use rand_distr::StandardNormal;

/// `n` rows of `d` values in three clusters, one of them stretched.
fn blobs(n: usize, d: usize, seed: u64) -> Vec<f64> {
    let mut rng = stream(seed, "blobs", 0);
    let mut values = Vec::new();
    for i in 0..n {
        let shared: f64 = rng.sample(StandardNormal);
        for j in 0..d {
            let z: f64 = rng.sample(StandardNormal);
            let c = i % 3;
            let stretch = if c == 2 { shared } else { 0.0 };
            values.push(6.0 * c as f64 * if j % 2 == 0 { 1.0 } else { -1.0 } + z + stretch);
        }
    }
    values
}

/// log Σ w N(x; μ, Σ) by Gauss-Jordan elimination, without factors or log-sum-exp.
fn plain_log_density(m: &Mixture, x: &[f64]) -> f64 {
    let d = m.dimension();
    let mut density = 0.0;
    for k in 0..m.components() {
        let mut a = m.covariance(k).to_vec();
        let mut b: Vec<f64> = x.iter().zip(m.mean(k)).map(|(x, m)| x - m).collect();
        let residual = b.clone();
        let mut det = 1.0;
        for i in 0..d {
            let pivot = a[i * d + i];
            det *= pivot;
            for r in 0..d {
                if r != i {
                    let f = a[r * d + i] / pivot;
                    for c in 0..d {
                        a[r * d + c] -= f * a[i * d + c];
                    }
                    b[r] -= f * b[i];
                }
            }
        }
        let quad: f64 = (0..d).map(|i| residual[i] * b[i] / a[i * d + i]).sum();
        let norm = (2.0 * std::f64::consts::PI).powi(d as i32) * det;
        density += m.weights()[k] * (-0.5 * quad).exp() / norm.sqrt();
    }
    density.ln()
}

#[test]
fn density_is_that_of_the_definition() {
    let values = blobs(60, 3, 1);
    let points = Points::new(3, &values).unwrap();
    for covariance in [Covariance::Full, Covariance::Diagonal, Covariance::Tied] {
        let settings = Settings {
            covariance,
            ..Settings::default()
        };
        let fitted = fit(&points, 3, &settings, &mut stream(1, "fit", 0)).unwrap();
        let fast = fitted.mixture.log_density(&points).unwrap();
        for (x, l) in values.chunks(3).zip(&fast) {
            assert!((plain_log_density(&fitted.mixture, x) - l).abs() < 1e-9);
        }
        assert!((fast.iter().sum::<f64>() - fitted.log_likelihood).abs() < 1e-6);
    }
}

#[test]
fn em_never_loses_log_posterior_and_converges() {
    let values = blobs(300, 4, 2);
    let points = Points::new(4, &values).unwrap();
    for covariance in [Covariance::Full, Covariance::Diagonal, Covariance::Tied] {
        let settings = Settings {
            covariance,
            restarts: 2,
            gain: 0.0,
            ..Settings::default()
        };
        let fitted = fit(&points, 4, &settings, &mut stream(1, "fit", 0)).unwrap();
        assert!(fitted.trace.windows(2).all(|w| w[1] >= w[0]));
        assert!(matches!(
            fitted.outcome,
            Outcome::Converged | Outcome::Stalled
        ));
    }
}

#[test]
fn both_criteria_find_three_components() {
    let values = blobs(300, 2, 3);
    let points = Points::new(2, &values).unwrap();
    for criterion in [Criterion::Mdl, Criterion::Bic] {
        let selected = select(&points, 6, criterion, &Settings::default(), 1).unwrap();
        assert_eq!(selected.fitted.mixture.components(), 3);
        assert_eq!(selected.trace.len(), 6);
    }
}

#[test]
fn weights_count_as_copies() {
    let values = blobs(30, 2, 4);
    let mut copied = values.clone();
    copied.extend(&values[..20]);
    let weights: Vec<f64> = (0..30).map(|i| if i < 10 { 2.0 } else { 1.0 }).collect();
    let settings = Settings::default();
    let start = fit(
        &Points::new(2, &values).unwrap(),
        2,
        &Settings {
            stopping: Stopping {
                max_rounds: 1,
                ..Stopping::default()
            },
            ..settings
        },
        &mut stream(1, "fit", 0),
    )
    .unwrap()
    .mixture;
    let a = Points::new(2, &values).unwrap().weighted(&weights).unwrap();
    let b = Points::new(2, &copied).unwrap();
    let a = fit_from(&a, &start, &settings).unwrap();
    let b = fit_from(&b, &start, &settings).unwrap();
    assert!((a.log_likelihood - b.log_likelihood).abs() < 1e-6);
}

#[test]
fn one_point_equal_points_and_single_values_answer() {
    for values in [vec![3.0], vec![3.0; 5], vec![1.0, 1.0, 1.0, 9.0]] {
        let points = Points::new(1, &values).unwrap();
        let selected = select(&points, 3, Criterion::Mdl, &Settings::default(), 1).unwrap();
        let l = selected.fitted.mixture.log_density(&points).unwrap();
        assert!(l.iter().all(|l| l.is_finite()));
    }
}

#[test]
fn conditional_samples_follow_the_conditional_mixture() {
    let mixture = Mixture::new(
        2,
        Covariance::Full,
        vec![0.5, 0.5],
        vec![0.0, 0.0, 10.0, 5.0],
        vec![1.0, 0.8, 0.8, 1.0, 1.0, 0.0, 0.0, 1.0],
    )
    .unwrap();
    let rows = mixture.sample_given(&[Some(1.0), None], 20_000, &mut stream(1, "draw", 0));
    let mean = rows.chunks(2).map(|r| r[1]).sum::<f64>() / 20_000.0;
    let var = rows.chunks(2).map(|r| (r[1] - mean).powi(2)).sum::<f64>() / 20_000.0;
    assert!(
        (mean - 0.8).abs() < 0.02 && (var - 0.36).abs() < 0.02,
        "{mean} {var}"
    );
}

#[test]
fn bad_input_is_named() {
    assert!(matches!(
        Points::new(2, &[1.0, 2.0, 3.0, f64::NAN]),
        Err(ModelError::NotFinite { row: 1, .. })
    ));
    assert!(matches!(
        Points::new(2, &[1.0]),
        Err(ModelError::Rows { .. })
    ));
    assert!(matches!(Points::new(2, &[]), Err(ModelError::Empty { .. })));
    let points = Points::new(1, &[1.0, 2.0]).unwrap();
    assert!(matches!(
        points.clone().weighted(&[1.0, -1.0]),
        Err(ModelError::Parameter { .. })
    ));
    assert!(matches!(
        fit(&points, 3, &Settings::default(), &mut stream(1, "fit", 0)),
        Err(ModelError::TooFewRows { rows: 2, .. })
    ));
}
