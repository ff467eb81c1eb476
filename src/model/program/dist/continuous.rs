//! The form of all continuous distributions of one number.

use rand::Rng;
use rand_distr::Distribution;

use super::{Dist, Support};
use crate::program::real::Real;
use crate::program::trace::Value;

/// An open interval, or a half-line, or the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<R> {
    /// Values are above.
    pub lower: Option<R>,
    /// Values are below.
    pub upper: Option<R>,
}

impl<R> Bounds<R> {
    /// All reals.
    pub const LINE: Self = Self {
        lower: None,
        upper: None,
    };
}

/// A distribution that is [`Continuous`], as a [`Dist`].
#[derive(Clone, Copy, Debug)]
pub struct Scalar<C>(pub C);

/// A continuous distribution of one number; within [`Scalar`] it is a [`Dist`].
///
/// Bounded values are freed by logarithms: `u = ln(x - a)`, `u = ln(b - x)` or `u = ln((x - a) / (b - x))`.
///
/// # Examples
/// ```
/// use edifice_model::program::{Real, dist::{Bounds, Continuous, Dist, Scalar}};
/// use rand::{Rng, RngExt};
/// /// Density 2x on (0, 1).
/// struct Rising;
/// impl<R: Real> Continuous<R> for Rising {
///     fn bounds(&self) -> Bounds<R> { Bounds { lower: Some(R::from(0.0)), upper: Some(R::from(1.0)) } }
///     fn log_pdf(&self, x: R) -> R { (x * 2.0).ln() }
///     fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 { rng.random::<f64>().sqrt() }
/// }
/// assert_eq!(Dist::<f64>::log_density(&Scalar(Rising), &0.5), 0.0);
/// assert_eq!(Dist::<f64>::log_density(&Scalar(Rising), &1.5), f64::NEG_INFINITY);
/// ```
pub trait Continuous<R: Real> {
    /// The interval on which the density is positive.
    fn bounds(&self) -> Bounds<R>;
    /// Logarithm of the density within the bounds; not a number where a parameter is out of range.
    fn log_pdf(&self, x: R) -> R;
    /// A draw; not a number where a parameter is out of range.
    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64;
}

impl<R: Real, C: Continuous<R>> Dist<R> for Scalar<C> {
    type Value = R;

    fn support(&self) -> Support {
        Support::Real(1)
    }

    fn log_density(&self, x: &R) -> R {
        let bounds = self.0.bounds();
        let below = bounds.lower.is_some_and(|a| x.value() < a.value());
        let above = bounds.upper.is_some_and(|b| x.value() > b.value());
        match below || above {
            true => R::from(f64::NEG_INFINITY),
            false => self.0.log_pdf(*x),
        }
    }

    fn draw<G: Rng>(&self, rng: &mut G) -> R {
        R::from(self.0.draw_one(rng))
    }

    fn store(&self, x: &R) -> Value {
        Value::Real(x.value())
    }

    fn load(&self, stored: &Value) -> Option<R> {
        match stored {
            Value::Real(x) => Some(R::from(*x)),
            _ => None,
        }
    }

    fn constrain(&self, free: &[R]) -> Option<(R, R)> {
        let &[u] = free else {
            return None;
        };
        let Bounds { lower, upper } = self.0.bounds();
        Some(match (lower, upper) {
            (None, None) => (u, R::from(0.0)),
            (Some(a), None) => (a + u.exp(), u),
            (None, Some(b)) => (b - u.exp(), u),
            (Some(a), Some(b)) => {
                let width = b - a;
                let slope = u.ln_logistic() + (-u).ln_logistic();
                (a + width * u.logistic(), width.ln() + slope)
            }
        })
    }

    fn release(&self, x: &R) -> Vec<f64> {
        let Bounds { lower, upper } = self.0.bounds();
        let x = x.value();
        let u = match (lower.map(R::value), upper.map(R::value)) {
            (None, None) => x,
            (Some(a), None) => (x - a).ln(),
            (None, Some(b)) => (b - x).ln(),
            (Some(a), Some(b)) => ((x - a) / (b - x)).ln(),
        };
        vec![u]
    }
}

/// A draw of a distribution of `rand_distr`, or not a number.
pub(super) fn drawn<D: Distribution<f64>, E, G: Rng>(d: Result<D, E>, rng: &mut G) -> f64 {
    d.map_or(f64::NAN, |d| d.sample(rng))
}

/// x where the condition on parameters holds, else not a number.
pub(super) fn valid<R: Real>(fine: bool, x: R) -> R {
    if fine { x } else { R::from(f64::NAN) }
}

pub(super) fn positive<R: Real>() -> Bounds<R> {
    Bounds {
        lower: Some(R::from(0.0)),
        upper: None,
    }
}
