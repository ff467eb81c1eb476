//! One round of EM for a Gaussian mixture, row by row with whole matrices and their inverses (Ghahramani and Jordan 1994, Sec. 3):
//! against the blocks, factors and sums of squares of the library, with and without missing values.

use edifice_base::rng::stream;
use edifice_model::em::Stopping;
use edifice_model::gmm::{Covariance, Mixture, Points, Settings, fit_from};
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Weights, means and covariances after one round, and the log-likelihood before it.
struct Round {
    weights: Vec<f64>,
    means: Vec<DVector<f64>>,
    covariances: Vec<DMatrix<f64>>,
    log_likelihood: f64,
}

/// A row under one component: the log density of what is observed, the expectation of the whole row, and the covariance of what
/// is missing, zero elsewhere.
fn expected(
    x: &[f64],
    mean: &DVector<f64>,
    covariance: &DMatrix<f64>,
) -> (f64, DVector<f64>, DMatrix<f64>) {
    let d = x.len();
    let (missing, seen): (Vec<usize>, Vec<usize>) = (0..d).partition(|&i| x[i].is_nan());
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |a, b| {
            covariance[(rows[a], columns[b])]
        })
    };
    let own = part(&seen, &seen);
    let inverse = own.clone().try_inverse().expect("regular");
    let residual = DVector::from_fn(seen.len(), |a, _| x[seen[a]] - mean[seen[a]]);
    let quadratic = (residual.transpose() * &inverse * &residual)[(0, 0)];
    let norm = seen.len() as f64 * (2.0 * std::f64::consts::PI).ln() + own.determinant().ln();
    let gain = part(&missing, &seen) * &inverse;
    let shift = &gain * &residual;
    let left = part(&missing, &missing) - &gain * part(&seen, &missing);
    let mut row = DVector::from_fn(d, |i, _| if x[i].is_nan() { mean[i] } else { x[i] });
    let mut rest = DMatrix::zeros(d, d);
    for (a, &i) in missing.iter().enumerate() {
        row[i] += shift[a];
        for (b, &j) in missing.iter().enumerate() {
            rest[(i, j)] = left[(a, b)];
        }
    }
    (-0.5 * (norm + quadratic), row, rest)
}

fn round(values: &[f64], weights: &[f64], model: &Mixture, kind: Covariance) -> Round {
    let (d, count) = (model.dimension(), model.components());
    let mean = |k: usize| DVector::from_column_slice(model.mean(k));
    let covariance = |k: usize| DMatrix::from_row_slice(d, d, model.covariance(k));
    let mut totals = vec![0.0; count];
    let mut firsts = vec![DVector::zeros(d); count];
    let mut seconds = vec![DMatrix::zeros(d, d); count];
    let mut log_likelihood = 0.0;
    for (x, &weight) in values.chunks(d).zip(weights) {
        let each: Vec<_> = (0..count)
            .map(|k| expected(x, &mean(k), &covariance(k)))
            .collect();
        let joint = |k: usize| model.weights()[k] * each[k].0.exp();
        let sum: f64 = (0..count).map(joint).sum();
        log_likelihood += weight * sum.ln();
        for k in 0..count {
            let r = weight * joint(k) / sum;
            let (_, row, rest) = &each[k];
            totals[k] += r;
            firsts[k] += r * row;
            seconds[k] += r * (row * row.transpose() + rest);
        }
    }
    let total: f64 = totals.iter().sum();
    let means: Vec<DVector<f64>> = (0..count).map(|k| &firsts[k] / totals[k]).collect();
    let scatter = |k: usize| &seconds[k] - totals[k] * &means[k] * means[k].transpose();
    let covariances = match kind {
        Covariance::Full => (0..count).map(|k| scatter(k) / totals[k]).collect(),
        Covariance::Diagonal => (0..count)
            .map(|k| DMatrix::from_diagonal(&(scatter(k) / totals[k]).diagonal()))
            .collect(),
        Covariance::Tied => {
            let all = (0..count).map(scatter).sum::<DMatrix<f64>>() / total;
            vec![all; count]
        }
    };
    Round {
        weights: totals.iter().map(|t| t / total).collect(),
        means,
        covariances,
        log_likelihood,
    }
}

/// Rows about three centres two deviations apart, so that every component shares every row.
fn rows(n: usize, d: usize, share: f64, seed: u64) -> Vec<f64> {
    let mut rng = stream(seed, "one round", d as u64);
    let mut values = Vec::new();
    for i in 0..n {
        let common: f64 = rng.sample(StandardNormal);
        let kept = rng.random_range(0..d);
        for j in 0..d {
            let own: f64 = rng.sample(StandardNormal);
            let missing = rng.random::<f64>() < share && j != kept;
            let value = 7.0 + 2.0 * (i % 3) as f64 / (1.0 + j as f64) + 0.5 * common + own;
            values.push(if missing { f64::NAN } else { value });
        }
    }
    values
}

/// A mixture about the first rows, of positive definite covariances that differ.
fn start(d: usize, kind: Covariance, seed: u64) -> Mixture {
    let mut rng = stream(seed, "one round: start", d as u64);
    let means = (0..3 * d).map(|i| 6.5 + (i / d) as f64 + 0.2 * rng.random::<f64>());
    let means: Vec<f64> = means.collect();
    let one = |k: usize| {
        DMatrix::from_fn(d, d, |a, b| match (a == b, kind) {
            (true, _) => 1.5 + 0.3 * ((a + k) % 4) as f64,
            (false, Covariance::Diagonal) => 0.0,
            _ => 0.4 / (1.0 + (a.abs_diff(b) + k) as f64),
        })
    };
    let matrices = if kind == Covariance::Tied { 1 } else { 3 };
    let covariances = (0..matrices).flat_map(|k| one(k).as_slice().to_vec());
    let covariances: Vec<f64> = covariances.collect();
    Mixture::new(d, kind, vec![0.5, 0.3, 0.2], means, covariances).expect("a mixture")
}

#[test]
fn one_round_is_the_textbook_s() {
    let kinds = [Covariance::Full, Covariance::Diagonal, Covariance::Tied];
    // 26 values a row: the products of triangles are cut in two. 600 rows: more than two blocks.
    for (n, d, share) in [
        (600, 3, 0.0),
        (600, 3, 0.3),
        (600, 26, 0.0),
        (300, 5, 0.6),
        (7, 2, 0.4),
    ] {
        for kind in kinds {
            let values = rows(n, d, share, 3);
            let weights: Vec<f64> = (0..n).map(|i| 0.5 + (i % 4) as f64).collect();
            let model = start(d, kind, 5);
            let points = Points::with_missing(d, &values).expect("points");
            let points = points.weighted(&weights).expect("weights");
            let settings = Settings {
                covariance: kind,
                stopping: Stopping {
                    max_rounds: 1,
                    ..Stopping::default()
                },
                ..Settings::default()
            };
            let fitted = fit_from(&points, &model, &settings).expect("a fit");
            let wanted = round(&values, &weights, &model, kind);
            let case = format!("{n} x {d}, {share} missing, {kind:?}");
            let near = |a: f64, b: f64, what: &str| {
                assert!(
                    (a - b).abs() <= 2e-5 * (1.0 + b.abs()),
                    "{case}: {what} {a} for {b}"
                );
            };
            near(fitted.trace[0], wanted.log_likelihood, "log-likelihood");
            for k in 0..3 {
                near(fitted.mixture.weights()[k], wanted.weights[k], "weight");
                for i in 0..d {
                    near(fitted.mixture.mean(k)[i], wanted.means[k][i], "mean");
                    for j in 0..d {
                        let found = fitted.mixture.covariance(k)[i * d + j];
                        near(found, wanted.covariances[k][(i, j)], "covariance");
                    }
                }
            }
        }
    }
}
