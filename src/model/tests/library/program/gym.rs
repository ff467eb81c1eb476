//! Hamiltonian chains against ground truths of `inference_gym`: means within four standard errors, of theirs and ours together, and R-hat
//! below 1.01.

use edifice_model::program::diagnostics::r_hat;
use edifice_model::program::dist::*;
use edifice_model::program::{Chains, Handler, Posterior, Program, Real, nuts};

/// The numbers of a line of the data.
fn data(name: &str) -> Vec<f64> {
    let lines = include_str!("gym.txt").lines();
    let mut own = lines.filter_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    let numbers = own.next().unwrap_or_else(|| panic!("no {name}"));
    let numbers = numbers.split(' ').map(|n| n.parse().unwrap());
    numbers.collect()
}

fn chains(draws: usize) -> Chains {
    Chains {
        draws,
        ..Chains::default()
    }
}

/// Means of all numbers of a name, in order, beside the truth.
fn check<T>(posterior: &Posterior<T>, name: &str, truth: &str) {
    let (means, errors) = (
        data(&format!("{truth}_mean")),
        data(&format!("{truth}_error")),
    );
    let all = posterior.summary();
    let own = |s: &&edifice_model::program::Summary| {
        s.name == name
            || s.name
                .strip_prefix(name)
                .is_some_and(|rest| rest.starts_with('['))
    };
    let found: Vec<_> = all.iter().filter(own).collect();
    assert_eq!(found.len(), means.len(), "{name}");
    for ((s, mean), error) in found.iter().zip(means).zip(errors) {
        let z = (s.mean - mean).abs() / s.mcse.hypot(error);
        assert!(
            z < 4.0,
            "{}: {} is not {mean}, {z:.1} errors",
            s.name,
            s.mean
        );
        assert!(s.r_hat < 1.01, "{}: R-hat {}", s.name, s.r_hat);
    }
}

/// As [`check`], of numbers that follow from choices.
fn check_of<T>(posterior: &Posterior<T>, of: impl Fn(&T, usize) -> f64, truth: &str) {
    let (means, errors) = (
        data(&format!("{truth}_mean")),
        data(&format!("{truth}_error")),
    );
    let length = posterior.draws.len() / chains(1).chains;
    for (i, (mean, error)) in means.into_iter().zip(errors).enumerate() {
        let found = posterior.estimate(|d| of(&d.out, i));
        let z = (found.mean - mean).abs() / found.error.hypot(error);
        assert!(
            z < 4.0,
            "{truth} {i}: {found:?} is not {mean}, {z:.1} errors"
        );
        let values: Vec<f64> = posterior.draws.iter().map(|d| of(&d.out, i)).collect();
        let by_chain: Vec<Vec<f64>> = values.chunks(length).map(<[f64]>::to_vec).collect();
        let r_hat = r_hat(&by_chain);
        assert!(r_hat < 1.01, "{truth} {i}: R-hat {r_hat}");
    }
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
    check(&posterior, "average", "schools_average");
    check(&posterior, "log_sd", "schools_log_sd");
    check_of(&posterior, |out, i| out[i], "schools_effects");
}

/// Uncentred: steps follow from standard normal choices.
struct Brownian {
    seen: Vec<f64>,
}
impl Program for Brownian {
    type Out = Vec<f64>;
    fn run<H: Handler>(&self, h: &mut H) -> Vec<f64> {
        let mut at = H::Real::from(0.0);
        let mut all = Vec::new();
        for (t, seen) in self.seen.iter().enumerate() {
            at = at + h.sample(("z", t), normal(0.0, 1.0)) * 0.1;
            all.push(at.value());
            if !seen.is_nan() {
                h.observe(normal(at, 0.15), &(*seen).into());
            }
        }
        all
    }
}

/// The same with unknown scales, which may come near zero: given them the motion is filtered forwards, which weighs the run by what the data say
/// of the scales alone, and drawn backwards from standard normal choices.
struct Filtered {
    seen: Vec<f64>,
}
impl Program for Filtered {
    type Out = Vec<f64>;
    fn run<H: Handler>(&self, h: &mut H) -> Vec<f64> {
        let innovation = h.sample("innovation", log_normal(0.0, 2.0));
        let observation = h.sample("observation", log_normal(0.0, 2.0));
        let (step, noise) = (innovation * innovation, observation * observation);
        // Mean and variance of each place given what was seen until then.
        let mut now = (H::Real::from(0.0), H::Real::from(0.0));
        let mut filtered = Vec::new();
        for seen in &self.seen {
            let (mean, variance) = (now.0, now.1 + step);
            now = (mean, variance);
            if !seen.is_nan() {
                let total = variance + noise;
                h.observe(normal(mean, total.sqrt()), &(*seen).into());
                let gain = variance / total;
                now = (
                    mean + gain * (H::Real::from(*seen) - mean),
                    variance * (noise / total),
                );
            }
            filtered.push(now);
        }
        let mut all = vec![0.0; filtered.len()];
        let mut next: Option<H::Real> = None;
        for (t, (mean, variance)) in filtered.into_iter().enumerate().rev() {
            let (mean, variance) = match next {
                None => (mean, variance),
                Some(next) => {
                    let gain = variance / (variance + step);
                    (mean + gain * (next - mean), step * gain)
                }
            };
            let at = mean + variance.sqrt() * h.sample(("z", t), normal(0.0, 1.0));
            all[t] = at.value();
            next = Some(at);
        }
        all
    }
}

#[test]
fn brownian_motion() {
    let program = Brownian {
        seen: data("brownian"),
    };
    let posterior = nuts(&program, &chains(2000)).unwrap();
    check_of(&posterior, |out, t| out[t], "brownian_locs");
}

#[test]
fn brownian_motion_of_unknown_scales() {
    let program = Filtered {
        seen: data("brownian"),
    };
    let posterior = nuts(&program, &chains(2000)).unwrap();
    // The shipped truth has a first place of 0.1027 +- 0.0009, the integral says 0.0931: long chains of the centred model do not come
    // near an observation scale of zero often enough.
    check_of(&posterior, |out, t| out[t], "exact_locs");
    check(&posterior, "innovation", "exact_innovation");
    check(&posterior, "observation", "exact_observation");
}

struct Volatility {
    seen: Vec<f64>,
}
impl Program for Volatility {
    type Out = (f64, Vec<f64>);
    fn run<H: Handler>(&self, h: &mut H) -> (f64, Vec<f64>) {
        let share = h.sample("share", beta(20.0, 1.5));
        let persistence = share * 2.0 - 1.0;
        let mean = h.sample("mean", cauchy(0.0, 5.0));
        let shock = h.sample("shock", half_cauchy(2.0));
        let start = shock / (-(persistence * persistence) + 1.0).sqrt();
        let mut log = h.sample(("log", 0), normal(mean, start));
        let mut all = Vec::new();
        for (t, seen) in self.seen.iter().enumerate() {
            if t > 0 {
                let next = mean + persistence * (log - mean);
                log = h.sample(("log", t), normal(next, shock));
            }
            all.push(log.value());
            h.observe(normal(0.0, (log * 0.5).exp()), &(*seen).into());
        }
        (persistence.value(), all)
    }
}

// After 2,000 draws R-hat of the shock is 1.024: it takes minutes.
#[test]
#[ignore = "half a minute"]
fn stochastic_volatility() {
    let posterior = nuts(
        &Volatility {
            seen: data("returns"),
        },
        &chains(5000),
    )
    .unwrap();
    check(&posterior, "mean", "volatility_mean_log");
    check(&posterior, "shock", "volatility_shock");
    check_of(&posterior, |out, _| out.0, "volatility_persistence");
    check_of(&posterior, |out, t| out.1[t], "volatility_log");
}

/// Convection of Lorenz's system, of which the first coordinate is seen at the ends.
struct Lorenz {
    seen: Vec<f64>,
}
impl Program for Lorenz {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let (step, noise) = (0.02, 0.02_f64.sqrt() * 0.1);
        let mut at = [0, 1, 2].map(|c| h.sample(("at", 0, c), normal(0.0, 1.0)));
        for (t, seen) in self.seen.iter().enumerate() {
            if t > 0 {
                let [x, y, z] = at;
                let drift = [(y - x) * 10.0, x * (-z + 28.0) - y, x * y - z * (8.0 / 3.0)];
                at = [0, 1, 2]
                    .map(|c| h.sample(("at", t, c), normal(at[c] + drift[c] * step, noise)));
            }
            if !seen.is_nan() {
                h.observe(normal(at[0], 1.0), &(*seen).into());
            }
        }
    }
}

#[test]
fn lorenz_bridge() {
    let posterior = nuts(
        &Lorenz {
            seen: data("lorenz"),
        },
        &chains(1000),
    )
    .unwrap();
    check(&posterior, "at", "lorenz_state");
}
