//! Closed-form evidence against numerical integration, and the Cheeseman-Stutz score by hand.

use edifice_model::Table;
use edifice_model::conjugate::{LinearPrior, dirichlet_evidence, dirichlet_mode};
use edifice_model::hierarchy::{Group, Settings, Variant, learn};

const PRIOR: LinearPrior = LinearPrior {
    intercept: 0.5,
    slope: 0.7,
    scatter: 0.4,
    freedom: 3.0,
};

fn gamma_ln(x: f64) -> f64 {
    statrs::function::gamma::ln_gamma(x)
}

/// Lower triangle of Σ u uᵀ.
fn scatter(rows: &[Vec<f64>]) -> Vec<f64> {
    let q = rows[0].len();
    let mut m = vec![0.0; q * q];
    for u in rows {
        for i in 0..q {
            for j in 0..=i {
                m[i * q + j] += u[i] * u[j];
            }
        }
    }
    m
}

#[test]
fn dirichlet_evidence_is_the_integral() {
    // ∫ p^2 (1-p)^3 Beta(p; 1.5, 1.5) dp by the midpoint rule.
    let n = 200_000;
    let log_beta = 2.0 * gamma_ln(1.5) - gamma_ln(3.0);
    let sum: f64 = (0..n)
        .map(|i| {
            let p = (f64::from(i) + 0.5) / f64::from(n);
            p.powi(2) * (1.0 - p).powi(3) * (p * (1.0 - p)).powf(0.5) / f64::from(n)
        })
        .sum();
    let slow = sum.ln() - log_beta;
    assert!((dirichlet_evidence(&[2.0, 3.0], 1.5) - slow).abs() < 1e-8);
    assert_eq!(dirichlet_mode(&[2.0, 3.0], 1.0), vec![0.4, 0.6]);
}

#[test]
fn normal_inverse_wishart_evidence_is_the_integral() {
    // d = 1: σ² ~ inverse gamma(ν/2, ψ/2), μ | σ² ~ N(0, σ²/κ); integrate over (μ, log σ).
    let y = [0.3, -0.8, 1.4];
    let (nu, psi, kappa) = (PRIOR.freedom, PRIOR.scatter, PRIOR.intercept);
    let mut sum = 0.0;
    let (steps, ds) = (1200, 0.01);
    for i in 0..steps {
        let log_s = -5.0 + f64::from(i) * ds;
        let v = (2.0 * log_s).exp();
        let log_prior_v = 0.5 * nu * (0.5 * psi).ln()
            - gamma_ln(0.5 * nu)
            - (0.5 * nu + 1.0) * v.ln()
            - 0.5 * psi / v;
        let sigma = v.sqrt();
        let dm = sigma / 40.0;
        for j in -800..=800 {
            let m = f64::from(j) * dm;
            let gauss =
                |x: f64, var: f64| -0.5 * (x * x / var + (2.0 * std::f64::consts::PI * var).ln());
            let log =
                log_prior_v + gauss(m, v / kappa) + y.iter().map(|y| gauss(y - m, v)).sum::<f64>();
            // dv = 2 v d(log s)
            sum += log.exp() * 2.0 * v * ds * dm;
        }
    }
    let rows: Vec<Vec<f64>> = y.iter().map(|&y| vec![1.0, y]).collect();
    let fast = PRIOR.evidence(&scatter(&rows), 1, 1).unwrap();
    assert!((fast - sum.ln()).abs() < 1e-3, "{fast} {}", sum.ln());
}

#[test]
fn evidence_is_the_product_of_predictions() {
    // log p(y) = Σ log p(y_n | y_<n): with two outputs and a regressor, adding rows one by one.
    // Each prediction is a ratio of evidences; exchangeability makes every order agree.
    let rows: Vec<Vec<f64>> = (0..6)
        .map(|i| {
            let x = f64::from(i) * 0.7 - 1.5;
            vec![
                1.0,
                x,
                0.5 * x + 0.1 * f64::from(i % 3),
                -x + 0.2 * f64::from(i % 2),
            ]
        })
        .collect();
    let mut reversed = rows.clone();
    reversed.reverse();
    let a = PRIOR.evidence(&scatter(&rows), 2, 2).unwrap();
    let b = PRIOR.evidence(&scatter(&reversed), 2, 2).unwrap();
    assert!((a - b).abs() < 1e-10);
    // One row, d = 1, p = 1: Student t with ν degrees, scale ψ (κ + 1) / (κ ν).
    let y = 0.9;
    let (nu, psi, k) = (PRIOR.freedom, PRIOR.scatter, PRIOR.intercept);
    let s2 = psi * (k + 1.0) / (k * nu);
    let t = gamma_ln((nu + 1.0) / 2.0)
        - gamma_ln(nu / 2.0)
        - 0.5 * (nu * std::f64::consts::PI * s2).ln()
        - (nu + 1.0) / 2.0 * (1.0 + y * y / (nu * s2)).ln();
    let fast = PRIOR.evidence(&scatter(&[vec![1.0, y]]), 1, 1).unwrap();
    assert!((fast - t).abs() < 1e-10, "{fast} {t}");
    assert!((PRIOR.evidence(&[0.0; 4], 1, 1).unwrap()).abs() < 1e-12);
}

#[test]
fn mode_is_a_maximum_of_the_posterior() {
    let rows: Vec<Vec<f64>> = (0..8)
        .map(|i| {
            let x = f64::from(i) * 0.5 - 2.0;
            vec![1.0, x, 0.8 * x + 0.3 * f64::from(i % 3)]
        })
        .collect();
    let m = scatter(&rows);
    let mode = PRIOR.mode(&m, 2, 1).unwrap();
    let at =
        |l: &edifice_model::conjugate::Linear| l.expected_log_likelihood(&m) + PRIOR.log_density(l);
    let best = at(&mode);
    let (b, s) = (mode.coefficients().to_vec(), mode.covariance().to_vec());
    for (i, delta) in [
        (0, 1e-3),
        (0, -1e-3),
        (1, 1e-3),
        (1, -1e-3),
        (2, 1e-3),
        (2, -1e-3),
    ] {
        let (mut b, mut s) = (b.clone(), s.clone());
        if i < 2 {
            b[i] += delta;
        } else {
            s[0] += delta;
        }
        let moved = edifice_model::conjugate::Linear::new(2, 1, b, s).unwrap();
        assert!(at(&moved) < best);
    }
}

#[test]
fn cheeseman_stutz_without_hidden_variables_is_the_marginal_likelihood() {
    // With nothing hidden O* = O, so Eq. 2 leaves log P(O | G): by hand, two conjugate terms.
    let n = 12;
    let x: Vec<f64> = (0..n).map(|i| f64::from(i % 5) - 1.3).collect();
    let bits: Vec<bool> = (0..n).map(|i| i % 3 == 0).collect();
    let table = Table::new()
        .real("x", x.iter().map(|v| Some(*v)))
        .unwrap()
        .binary("b", bits.iter().map(|b| Some(*b)))
        .unwrap();
    let settings = Settings {
        variant: Variant::NoSecondLevel,
        styles: 1..=1,
        ..Settings::default()
    };
    let groups = [Group::new("x", &["x"]), Group::new("b", &["b"])];
    let learned = learn(&table, &groups, &settings, 1).unwrap();
    let mean = x.iter().sum::<f64>() / f64::from(n);
    let scale = (x.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / f64::from(n)).sqrt();
    let rows: Vec<Vec<f64>> = x.iter().map(|v| vec![1.0, (v - mean) / scale]).collect();
    let by_hand = settings
        .priors
        .linear
        .evidence(&scatter(&rows), 1, 1)
        .unwrap()
        + dirichlet_evidence(&[8.0, 4.0], settings.priors.dirichlet);
    assert!(
        (learned.score - by_hand).abs() < 1e-9,
        "{} {by_hand}",
        learned.score
    );
}

#[test]
fn cheeseman_stutz_with_a_hidden_variable_by_hand() {
    // Two well separated clusters of one value each: responsibilities are 0 or 1, so that O* is
    // the data with their clusters, log P(O | Θ) = log P(O* | Θ), and the score is
    // log P(O* | G) exactly.
    let x: Vec<f64> = (0..40)
        .map(|i| if i % 2 == 0 { -50.0 } else { 50.0 } + f64::from(i % 5) * 0.1)
        .collect();
    let table = Table::new().real("x", x.iter().map(|v| Some(*v))).unwrap();
    let mut settings = Settings {
        variant: Variant::NoSecondLevel,
        styles: 2..=2,
        ..Settings::default()
    };
    settings.priors.linear.scatter = 1e-4;
    let learned = learn(&table, &[Group::new("x", &["x"])], &settings, 1).unwrap();
    let mean = x.iter().sum::<f64>() / 40.0;
    let scale = (x.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 40.0).sqrt();
    let cluster = |c: usize| -> Vec<Vec<f64>> {
        let own = x.iter().enumerate().filter(|(i, _)| i % 2 == c);
        own.map(|(_, v)| vec![1.0, (v - mean) / scale]).collect()
    };
    let by_hand = dirichlet_evidence(&[20.0, 20.0], settings.priors.dirichlet)
        + (0..2)
            .map(|c| {
                settings
                    .priors
                    .linear
                    .evidence(&scatter(&cluster(c)), 1, 1)
                    .unwrap()
            })
            .sum::<f64>();
    assert!(
        (learned.score - by_hand).abs() < 1e-6,
        "{} {by_hand}",
        learned.score
    );
}
