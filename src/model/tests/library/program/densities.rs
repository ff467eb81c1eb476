//! Densities against statrs, their integrals, and gradients against differences.

use edifice_base::rng::stream;
use edifice_model::program::dist::*;
use edifice_model::program::reverse::{Tape, Var};
use edifice_model::program::{Dist, Real, Support};
use statrs::distribution::{Continuous as _, Discrete as _};

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-10 * (1.0 + b.abs())
}

#[test]
fn continuous_ones_equal_those_of_statrs() {
    use statrs::distribution as s;
    for x in [0.01, 0.3, 0.77, 1.4, 5.0] {
        let pairs = [
            (
                Dist::<f64>::log_density(&normal(0.4, 1.7), &x),
                s::Normal::new(0.4, 1.7).unwrap().ln_pdf(x),
            ),
            (
                Dist::<f64>::log_density(&log_normal(0.4, 1.7), &x),
                s::LogNormal::new(0.4, 1.7).unwrap().ln_pdf(x),
            ),
            (
                Dist::<f64>::log_density(&student_t(3.5, 0.4, 1.7), &x),
                s::StudentsT::new(0.4, 1.7, 3.5).unwrap().ln_pdf(x),
            ),
            (
                Dist::<f64>::log_density(&cauchy(0.4, 1.7), &x),
                s::Cauchy::new(0.4, 1.7).unwrap().ln_pdf(x),
            ),
            (
                Dist::<f64>::log_density(&gamma(2.5, 1.7), &x),
                s::Gamma::new(2.5, 1.7).unwrap().ln_pdf(x),
            ),
            (
                Dist::<f64>::log_density(&exponential(1.7), &x),
                s::Exp::new(1.7).unwrap().ln_pdf(x),
            ),
            (
                Dist::<f64>::log_density(&inverse_gamma(2.5, 1.7), &x),
                s::InverseGamma::new(2.5, 1.7).unwrap().ln_pdf(x),
            ),
        ];
        for (i, (ours, theirs)) in pairs.into_iter().enumerate() {
            assert!(close(ours, theirs), "{i} at {x}: {ours} is not {theirs}");
        }
        if x < 1.0 {
            let theirs = s::Beta::new(2.5, 1.7).unwrap().ln_pdf(x);
            assert!(close(Dist::<f64>::log_density(&beta(2.5, 1.7), &x), theirs));
        }
        let half = Dist::<f64>::log_density(&half_normal(1.7), &x);
        assert!(close(
            half,
            s::Normal::new(0.0, 1.7).unwrap().ln_pdf(x) + 2_f64.ln()
        ));
        let half = Dist::<f64>::log_density(&half_cauchy(1.7), &x);
        assert!(close(
            half,
            s::Cauchy::new(0.0, 1.7).unwrap().ln_pdf(x) + 2_f64.ln()
        ));
    }
}

#[test]
fn discrete_ones_equal_those_of_statrs() {
    use statrs::distribution as s;
    for x in 0..6_u64 {
        let ours = Dist::<f64>::log_density(&poisson(2.3), &x);
        assert!(close(ours, s::Poisson::new(2.3).unwrap().ln_pmf(x)));
        assert!(close(
            Dist::<f64>::log_density(&poisson_log(2.3_f64.ln()), &x),
            ours
        ));
        let ours = Dist::<f64>::log_density(&binomial(5, 0.3), &x);
        assert!(close(ours, s::Binomial::new(0.3, 5).unwrap().ln_pmf(x)));
    }
    let sure: f64 = binomial::<f64>(5, 1.0).log_density(&5);
    assert_eq!(sure, 0.0);
    let p: f64 = categorical::<f64, _>(&[1.0, 2.0, 1.0]).log_density(&1);
    assert!(close(p, 0.5_f64.ln()));
    let p: f64 = categorical_logit::<f64, _>(&[0.0, 2_f64.ln(), 0.0]).log_density(&1);
    assert!(close(p, 0.5_f64.ln()));
    let p: f64 = bernoulli_logit::<f64>(3_f64.ln()).log_density(&true);
    assert!(close(p, 0.75_f64.ln()));
}

#[test]
fn parameters_out_of_range_are_not_a_number() {
    assert!(Dist::<f64>::log_density(&normal(0.0, -1.0), &0.0).is_nan());
    assert!(Dist::<f64>::log_density(&gamma(0.0, 1.0), &1.0).is_nan());
    assert!(
        Dist::<f64>::log_density(&uniform(2.0, 1.0), &1.5).is_nan()
            || Dist::<f64>::log_density(&uniform(2.0, 1.0), &1.5) == f64::NEG_INFINITY
    );
    assert!(Dist::<f64>::log_density(&bernoulli(1.5), &true).is_nan());
    assert!(Dist::<f64>::log_density(&poisson(-1.0), &1).is_nan());
}

/// Moments of draws against those of the density over free coordinates, by quadrature: draws, densities and volumes agree.
#[test]
fn draws_follow_densities_and_volumes() {
    fn one<D: Dist<f64, Value = f64>>(name: &str, d: D) {
        assert_eq!(d.support(), Support::Real(1));
        // A bounded function of the value, so that heavy tails do no harm.
        let f = |x: f64| (x / (1.0 + x.abs())).clamp(-1.0, 1.0);
        let (mut mass, mut mean) = (0.0, 0.0);
        let (low, high, n) = (-60.0, 60.0, 240_000);
        let step = (high - low) / f64::from(n);
        for i in 0..n {
            let u = low + (f64::from(i) + 0.5) * step;
            let (x, volume) = d.constrain(&[u]).unwrap();
            let p = (d.log_density(&x) + volume).exp() * step;
            if p.is_finite() {
                mass += p;
                mean += p * f(x);
            }
            let back = d.release(&x)[0];
            if u.abs() < 10.0 {
                assert!(
                    (back - u).abs() < 1e-4 * (1.0 + u.abs()),
                    "{name}: {u} became {back}"
                );
            }
        }
        // Heavy tails reach beyond the grid.
        assert!((mass - 1.0).abs() < 0.03, "{name}: mass {mass}");
        let mut rng = stream(1, name, 0);
        let count = 40_000;
        let draws = (0..count).map(|_| f(d.draw(&mut rng)));
        let drawn = draws.sum::<f64>() / f64::from(count);
        assert!((drawn - mean).abs() < 0.03, "{name}: {drawn} is not {mean}");
    }
    one("normal", normal(0.4, 1.7));
    one("half normal", half_normal(1.7));
    one("log normal", log_normal(0.4, 0.7));
    one("student", student_t(3.5, 0.4, 1.7));
    one("cauchy", cauchy(0.4, 1.0));
    one("half cauchy", half_cauchy(1.7));
    one("gamma", gamma(2.5, 1.7));
    one("exponential", exponential(0.7));
    one("inverse gamma", inverse_gamma(2.5, 1.7));
    one("beta", beta(2.5, 0.7));
    one("uniform", uniform(-1.0, 3.0));
}

/// A function of three parameters and a value, for every distribution, by name.
fn log_density<R: Real>(which: usize, p: &[R]) -> R {
    let (a, b, c, x) = (p[0], p[1], p[2], p[3]);
    match which {
        0 => normal(a, b).log_density(&x),
        1 => log_normal(a, b).log_density(&x),
        2 => student_t(c, a, b).log_density(&x),
        3 => cauchy(a, b).log_density(&x),
        4 => gamma(b, c).log_density(&x),
        5 => inverse_gamma(b, c).log_density(&x),
        6 => beta(b, c).log_density(&(x * 0.3)),
        7 => poisson(b).log_density(&3),
        8 => binomial(7, (a * 0.5).logistic()).log_density(&3),
        9 => bernoulli_logit(a).log_density(&true),
        10 => categorical_logit(&[a, b, c]).log_density(&1),
        11 => categorical(&[x, b, c]).log_density(&2),
        12 => dirichlet(&[b, c, x]).log_density(&vec![R::from(0.2), R::from(0.5), R::from(0.3)]),
        13 => {
            let (value, volume) = uniform(a, b + 3.0).constrain(&[x]).unwrap();
            value.sin() + volume
        }
        14 => {
            let (value, volume) = dirichlet(&[b, c, x]).constrain(&[a, c]).unwrap();
            value[0] * 3.0 + value[1].ln() * value[2] + volume
        }
        15 => a.tanh() + b.powf(2.5) + c.cos() - x.abs() / b,
        _ => poisson_log(a).log_density(&2),
    }
}

#[test]
fn gradients_equal_differences() {
    let mut tape = Tape::default();
    for which in 0..17 {
        for point in [[0.3, 1.2, 2.5, 0.9], [-0.7, 0.4, 1.1, 2.3]] {
            tape.clear();
            let p: Vec<Var<'_>> = point.iter().map(|&x| tape.variable(x)).collect();
            let out = log_density(which, &p);
            let plain = log_density::<f64>(which, &point);
            assert!(close(out.value(), plain), "{which}");
            let gradient = tape.gradient(out, 4);
            for (i, g) in gradient.iter().enumerate() {
                let h = 1e-5;
                let at = |h: f64| {
                    let mut q = point;
                    q[i] += h;
                    log_density::<f64>(which, &q)
                };
                let difference = (at(h) - at(-h)) / (2.0 * h);
                assert!(
                    (g - difference).abs() < 1e-6 * (1.0 + g.abs()),
                    "{which}, {i}: {g} is not {difference}"
                );
            }
        }
    }
}
