//! Hamiltonian chains against ground truths of `inference_gym`: means within four standard errors, of theirs and ours together, and R-hat
//! below 1.01.

use edifice_model::program::dist::*;
use edifice_model::program::{Chains, Handler, Posterior, Program, Real, nuts};

use super::gym_data as data;

fn chains(draws: usize) -> Chains {
    Chains {
        draws,
        ..Chains::default()
    }
}

/// Means of all numbers of a name, in order, beside the truth.
fn check<T>(posterior: &Posterior<T>, name: &str, means: &[f64], errors: &[f64]) -> f64 {
    let all = posterior.summary();
    let own = |s: &&edifice_model::program::Summary| {
        s.name == name
            || s.name
                .strip_prefix(name)
                .is_some_and(|rest| rest.starts_with('['))
    };
    let found: Vec<_> = all.iter().filter(own).collect();
    assert_eq!(found.len(), means.len(), "{name}");
    let mut worst: f64 = 0.0;
    for ((s, mean), error) in found.iter().zip(means).zip(errors) {
        let z = (s.mean - mean).abs() / s.mcse.hypot(*error);
        worst = worst.max(z);
        assert!(
            z < 4.0,
            "{}: {} is not {mean}, {z:.1} errors",
            s.name,
            s.mean
        );
        assert!(s.r_hat < 1.01, "{}: R-hat {}", s.name, s.r_hat);
    }
    worst
}

/// Uncentred: the effects follow from standard normal choices.
struct Schools;
impl Program for Schools {
    type Out = [f64; 8];
    fn run<H: Handler>(&self, h: &mut H) -> [f64; 8] {
        let effects = [28.0, 8.0, -3.0, 7.0, -1.0, 1.0, 18.0, 12.0];
        let errors = [15.0, 10.0, 16.0, 11.0, 9.0, 11.0, 10.0, 18.0];
        let average = h.sample("average", normal(0.0, 10.0));
        let log_sd = h.sample("log_sd", normal(5.0, 1.0));
        let mut own = [0.0; 8];
        for i in 0..8 {
            let z = h.sample(("z", i), normal(0.0, 1.0));
            let effect = average + log_sd.exp() * z;
            h.observe(normal(effect, errors[i]), &effects[i].into());
            own[i] = effect.value();
        }
        own
    }
}

#[test]
fn eight_schools() {
    let posterior = nuts(&Schools, &chains(4000)).unwrap();
    check(
        &posterior,
        "average",
        &data::SCHOOLS_AVERAGE_MEAN,
        &data::SCHOOLS_AVERAGE_ERROR,
    );
    check(
        &posterior,
        "log_sd",
        &data::SCHOOLS_LOG_SD_MEAN,
        &data::SCHOOLS_LOG_SD_ERROR,
    );
    for i in 0..8 {
        let found = posterior.estimate(|d| d.out[i]);
        let error = found.error.hypot(data::SCHOOLS_EFFECTS_ERROR[i]);
        assert!(
            (found.mean - data::SCHOOLS_EFFECTS_MEAN[i]).abs() < 4.0 * error,
            "{i}: {found:?}"
        );
    }
}

struct Brownian {
    scales: Option<[f64; 2]>,
}
impl Program for Brownian {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let [innovation, observation] = match self.scales {
            Some(known) => known.map(H::Real::from),
            None => [
                h.sample("innovation", log_normal(0.0, 2.0)),
                h.sample("observation", log_normal(0.0, 2.0)),
            ],
        };
        let mut at = H::Real::from(0.0);
        for (t, seen) in data::BROWNIAN.into_iter().enumerate() {
            at = h.sample(("at", t), normal(at, innovation));
            if !seen.is_nan() {
                h.observe(normal(at, observation), &seen.into());
            }
        }
    }
}

#[test]
fn brownian_motion() {
    let program = Brownian {
        scales: Some([0.1, 0.15]),
    };
    let posterior = nuts(&program, &chains(4000)).unwrap();
    check(
        &posterior,
        "at",
        &data::BROWNIAN_LOCS_MEAN,
        &data::BROWNIAN_LOCS_ERROR,
    );
}

#[test]
fn brownian_motion_of_unknown_scales() {
    let posterior = nuts(&Brownian { scales: None }, &chains(20_000)).unwrap();
    check(
        &posterior,
        "at",
        &data::UNKNOWN_LOCS_MEAN,
        &data::UNKNOWN_LOCS_ERROR,
    );
    check(
        &posterior,
        "innovation",
        &data::UNKNOWN_INNOVATION_MEAN,
        &data::UNKNOWN_INNOVATION_ERROR,
    );
    check(
        &posterior,
        "observation",
        &data::UNKNOWN_OBSERVATION_MEAN,
        &data::UNKNOWN_OBSERVATION_ERROR,
    );
}

struct Volatility;
impl Program for Volatility {
    type Out = (f64, Vec<f64>);
    fn run<H: Handler>(&self, h: &mut H) -> (f64, Vec<f64>) {
        let share = h.sample("share", beta(20.0, 1.5));
        let persistence = share * 2.0 - 1.0;
        let mean = h.sample("mean", cauchy(0.0, 5.0));
        let shock = h.sample("shock", half_cauchy(2.0));
        let start = shock / (-(persistence * persistence) + 1.0).sqrt();
        let mut off = h.sample(("z", 0), normal(0.0, 1.0)) * start;
        let mut all = Vec::new();
        for (t, seen) in data::RETURNS.into_iter().enumerate() {
            if t > 0 {
                off = persistence * off + h.sample(("z", t), normal(0.0, 1.0)) * shock;
            }
            let log = mean + off;
            all.push(log.value());
            h.observe(normal(0.0, (log * 0.5).exp()), &seen.into());
        }
        (persistence.value(), all)
    }
}

#[test]
fn stochastic_volatility() {
    let posterior = nuts(&Volatility, &chains(4000)).unwrap();
    check(
        &posterior,
        "mean",
        &data::VOLATILITY_MEAN_LOG_MEAN,
        &data::VOLATILITY_MEAN_LOG_ERROR,
    );
    check(
        &posterior,
        "shock",
        &data::VOLATILITY_SHOCK_MEAN,
        &data::VOLATILITY_SHOCK_ERROR,
    );
    let found = posterior.estimate(|d| d.out.0);
    let error = found.error.hypot(data::VOLATILITY_PERSISTENCE_ERROR[0]);
    assert!((found.mean - data::VOLATILITY_PERSISTENCE_MEAN[0]).abs() < 4.0 * error);
    for t in 0..100 {
        let found = posterior.estimate(|d| d.out.1[t]);
        let error = found.error.hypot(data::VOLATILITY_LOG_ERROR[t]);
        assert!(
            (found.mean - data::VOLATILITY_LOG_MEAN[t]).abs() < 4.0 * error,
            "{t}: {found:?}"
        );
    }
}

/// Convection of Lorenz's system, of which the first coordinate is seen at the ends.
struct Lorenz;
impl Program for Lorenz {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let (step, noise) = (0.02, 0.02_f64.sqrt() * 0.1);
        let mut at = [0, 1, 2].map(|c| h.sample(("at", 0, c), normal(0.0, 1.0)));
        for (t, seen) in data::LORENZ.into_iter().enumerate() {
            if t > 0 {
                let [x, y, z] = at;
                let drift = [(y - x) * 10.0, x * (-z + 28.0) - y, x * y - z * (8.0 / 3.0)];
                at = [0, 1, 2]
                    .map(|c| h.sample(("at", t, c), normal(at[c] + drift[c] * step, noise)));
            }
            if !seen.is_nan() {
                h.observe(normal(at[0], 1.0), &seen.into());
            }
        }
    }
}

#[test]
fn lorenz_bridge() {
    let posterior = nuts(&Lorenz, &chains(4000)).unwrap();
    check(
        &posterior,
        "at",
        &data::LORENZ_STATE_MEAN,
        &data::LORENZ_STATE_ERROR,
    );
}
