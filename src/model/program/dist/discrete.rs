//! Distributions of whole numbers.

use rand::{Rng, RngExt};
use rand_distr::Distribution;

use super::{Dist, Support};
use crate::program::real::Real;
use crate::program::trace::Value;

/// The functions that all distributions of whole numbers share.
macro_rules! whole {
    ($value:ty, $to:expr, $from:expr) => {
        type Value = $value;

        fn store(&self, x: &$value) -> Value {
            let to: fn(&$value) -> u64 = $to;
            Value::Whole(to(x))
        }

        fn load(&self, stored: &Value) -> Option<$value> {
            let from: fn(u64) -> Option<$value> = $from;
            match stored {
                Value::Whole(x) => from(*x),
                _ => None,
            }
        }

        fn constrain(&self, _: &[R]) -> Option<($value, R)> {
            None
        }

        fn release(&self, _: &$value) -> Vec<f64> {
            Vec::new()
        }
    };
}

/// See [`bernoulli`] and [`bernoulli_logit`].
#[derive(Clone, Copy, Debug)]
pub struct Bernoulli<R> {
    /// Logarithms of the probabilities of `false` and `true`.
    logs: [R; 2],
}

/// True with this probability.
pub fn bernoulli<R: Real>(probability: impl Into<R>) -> Bernoulli<R> {
    let p = probability.into();
    let fine = (0.0..=1.0).contains(&p.value());
    let log = |p: R| if fine { p } else { R::from(f64::NAN) };
    Bernoulli {
        logs: [log((-p).ln_1p()), log(p.ln())],
    }
}

/// True with the probability `logistic(odds)`.
pub fn bernoulli_logit<R: Real>(odds: impl Into<R>) -> Bernoulli<R> {
    let odds = odds.into();
    Bernoulli {
        logs: [(-odds).ln_logistic(), odds.ln_logistic()],
    }
}

impl<R: Real> Dist<R> for Bernoulli<R> {
    whole!(bool, |x| u64::from(*x), |x| match x {
        0 => Some(false),
        1 => Some(true),
        _ => None,
    });

    fn support(&self) -> Support {
        Support::Finite(2)
    }

    fn log_density(&self, x: &bool) -> R {
        self.logs[usize::from(*x)]
    }

    fn draw<G: Rng>(&self, rng: &mut G) -> bool {
        rng.random::<f64>() < self.logs[1].value().exp()
    }
}

/// See [`categorical`] and [`categorical_logit`].
#[derive(Clone, Debug)]
pub struct Categorical<R> {
    logs: Vec<R>,
}

/// 0 to k - 1 with these probabilities; they are divided by their sum.
pub fn categorical<R: Real, P: Into<R> + Copy>(probabilities: &[P]) -> Categorical<R> {
    let p: Vec<R> = probabilities.iter().map(|&p| p.into()).collect();
    let sum = p.iter().fold(R::from(0.0), |sum, &p| sum + p);
    let fine = p.iter().all(|p| p.value() >= 0.0) && sum.value() > 0.0;
    let log = |p: R| match (fine, p.value() > 0.0) {
        (false, _) => R::from(f64::NAN),
        (true, true) => p.ln() - sum.ln(),
        (true, false) => R::from(f64::NEG_INFINITY),
    };
    Categorical {
        logs: p.into_iter().map(log).collect(),
    }
}

/// 0 to k - 1 in proportion to the exponentials of these numbers.
pub fn categorical_logit<R: Real, P: Into<R> + Copy>(logits: &[P]) -> Categorical<R> {
    let x: Vec<R> = logits.iter().map(|&x| x.into()).collect();
    let top = x
        .iter()
        .map(|x| x.value())
        .fold(f64::NEG_INFINITY, f64::max);
    let sum = x.iter().fold(R::from(0.0), |sum, &x| sum + (x - top).exp());
    let total = sum.ln() + top;
    Categorical {
        logs: x.into_iter().map(|x| x - total).collect(),
    }
}

impl<R: Real> Dist<R> for Categorical<R> {
    whole!(usize, |x| *x as u64, |x| usize::try_from(x).ok());

    fn support(&self) -> Support {
        Support::Finite(self.logs.len())
    }

    fn log_density(&self, x: &usize) -> R {
        let log = self.logs.get(*x).copied();
        log.unwrap_or_else(|| R::from(f64::NEG_INFINITY))
    }

    fn draw<G: Rng>(&self, rng: &mut G) -> usize {
        let logs: Vec<f64> = self.logs.iter().map(|l| l.value()).collect();
        crate::linalg::categorical_of_logs(&logs, rng)
    }
}

/// See [`binomial`].
#[derive(Clone, Copy, Debug)]
pub struct Binomial<R> {
    trials: u64,
    one: Bernoulli<R>,
}

/// Successes among so many trials of this probability.
pub fn binomial<R: Real>(trials: u64, probability: impl Into<R>) -> Binomial<R> {
    Binomial {
        trials,
        one: bernoulli(probability),
    }
}

/// `ln x!`.
fn ln_factorial(x: u64) -> f64 {
    statrs::function::factorial::ln_factorial(x)
}

impl<R: Real> Dist<R> for Binomial<R> {
    whole!(u64, |x| *x, Some);

    fn support(&self) -> Support {
        Support::Finite(self.trials as usize + 1)
    }

    fn log_density(&self, &x: &u64) -> R {
        let Some(failures) = self.trials.checked_sub(x) else {
            return R::from(f64::NEG_INFINITY);
        };
        let ways = ln_factorial(self.trials) - ln_factorial(x) - ln_factorial(failures);
        let power = |count: u64, log: R| match count {
            0 if !log.value().is_nan() => R::from(0.0),
            n => log * n as f64,
        };
        let [no, yes] = self.one.logs;
        power(x, yes) + power(failures, no) + ways
    }

    fn draw<G: Rng>(&self, rng: &mut G) -> u64 {
        let p = self.one.logs[1].value().exp();
        rand_distr::Binomial::new(self.trials, p).map_or(u64::MAX, |b| b.sample(rng))
    }
}

/// See [`poisson`] and [`poisson_log`].
#[derive(Clone, Copy, Debug)]
pub struct Poisson<R> {
    rate: R,
    log: R,
}

/// Counts of this mean.
pub fn poisson<R: Real>(rate: impl Into<R>) -> Poisson<R> {
    let rate = rate.into();
    Poisson {
        rate,
        log: rate.ln(),
    }
}

/// Counts whose mean has this logarithm.
pub fn poisson_log<R: Real>(log: impl Into<R>) -> Poisson<R> {
    let log = log.into();
    Poisson {
        rate: log.exp(),
        log,
    }
}

impl<R: Real> Dist<R> for Poisson<R> {
    whole!(u64, |x| *x, Some);

    fn support(&self) -> Support {
        Support::Counts
    }

    fn log_density(&self, &x: &u64) -> R {
        let rate = self.rate.value();
        if rate.is_nan() || rate < 0.0 {
            return R::from(f64::NAN);
        }
        // At a rate of 0 the probability of 0 is 1.
        let power = match x {
            0 => R::from(0.0),
            n => self.log * n as f64,
        };
        power - self.rate - ln_factorial(x)
    }

    fn draw<G: Rng>(&self, rng: &mut G) -> u64 {
        let rate = self.rate.value();
        if rate == 0.0 {
            return 0;
        }
        let drawn = rand_distr::Poisson::new(rate).map(|p| p.sample(rng));
        drawn.map_or(u64::MAX, |x: f64| x as u64)
    }
}
