//! Probabilities as values.

use rand::Rng;
use rand_distr::Distribution;

use super::{Dist, Support};
use crate::program::real::Real;
use crate::program::trace::Value;

/// See [`dirichlet`].
#[derive(Clone, Debug)]
pub struct Dirichlet<R> {
    alpha: Vec<R>,
}

/// Density `∝ Π x_i^(alpha_i - 1)` over k probabilities that sum to 1, by their first k - 1.
///
/// Freed by breaking a stick: the share of what is left that x_i takes is `logistic(u_i - ln(k - i))`, i from 1 (Stan's
/// reference manual, *Unit simplex*).
pub fn dirichlet<R: Real, A: Into<R> + Copy>(alpha: &[A]) -> Dirichlet<R> {
    Dirichlet {
        alpha: alpha.iter().map(|&a| a.into()).collect(),
    }
}

impl<R: Real> Dist<R> for Dirichlet<R> {
    type Value = Vec<R>;

    fn support(&self) -> Support {
        Support::Real(self.alpha.len().saturating_sub(1))
    }

    fn log_density(&self, x: &Vec<R>) -> R {
        let sum: f64 = x.iter().map(|x| x.value()).sum();
        let inside = x.len() == self.alpha.len() && x.iter().all(|x| x.value() >= 0.0);
        if !inside || (sum - 1.0).abs() > 1e-9 {
            return R::from(f64::NEG_INFINITY);
        }
        let (mut total, mut log) = (R::from(0.0), R::from(0.0));
        for (&a, &x) in self.alpha.iter().zip(x) {
            if a.value() <= 0.0 {
                return R::from(f64::NAN);
            }
            total = total + a;
            log = log - a.ln_gamma();
            if a.value() != 1.0 || x.value() > 0.0 {
                log = log + (a - 1.0) * x.ln();
            }
        }
        log + total.ln_gamma()
    }

    fn draw<G: Rng>(&self, rng: &mut G) -> Vec<R> {
        let gamma = |a: &R| {
            let gamma = rand_distr::Gamma::new(a.value(), 1.0);
            gamma.map_or(f64::NAN, |g| g.sample(rng))
        };
        let drawn: Vec<f64> = self.alpha.iter().map(gamma).collect();
        let sum: f64 = drawn.iter().sum();
        drawn.into_iter().map(|x| R::from(x / sum)).collect()
    }

    fn store(&self, x: &Vec<R>) -> Value {
        Value::Reals(x.iter().map(|x| x.value()).collect())
    }

    fn load(&self, stored: &Value) -> Option<Vec<R>> {
        match stored {
            Value::Reals(x) if x.len() == self.alpha.len() => {
                Some(x.iter().map(|&x| R::from(x)).collect())
            }
            _ => None,
        }
    }

    fn constrain(&self, free: &[R]) -> Option<(Vec<R>, R)> {
        let k = self.alpha.len();
        if free.len() + 1 != k {
            return None;
        }
        let (mut log_left, mut volume) = (R::from(0.0), R::from(0.0));
        let mut x = Vec::with_capacity(k);
        for (i, &u) in free.iter().enumerate() {
            let v = u - ((k - 1 - i) as f64).ln();
            let (taken, kept) = (v.ln_logistic(), (-v).ln_logistic());
            x.push((log_left + taken).exp());
            volume = volume + log_left + taken + kept;
            log_left = log_left + kept;
        }
        x.push(log_left.exp());
        Some((x, volume))
    }

    fn release(&self, x: &Vec<R>) -> Vec<f64> {
        let k = x.len();
        let mut left = 1.0;
        let free = x
            .iter()
            .take(k.saturating_sub(1))
            .enumerate()
            .map(|(i, x)| {
                let share = x.value() / left;
                left -= x.value();
                (share / (1.0 - share)).ln() + ((k - 1 - i) as f64).ln()
            });
        free.collect()
    }
}
