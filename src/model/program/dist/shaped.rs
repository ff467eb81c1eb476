//! Distributions of positive and of bounded numbers, by their shape.

use rand::{Rng, RngExt};

use super::continuous::{Bounds, Continuous, Scalar, drawn, positive, valid};
use crate::program::real::Real;

/// See [`gamma`] and [`exponential`].
#[derive(Clone, Copy, Debug)]
pub struct Gamma<R> {
    shape: R,
    rate: R,
}

/// Density `∝ x^(shape - 1) exp(-rate x)`.
pub fn gamma<R: Real>(shape: impl Into<R>, rate: impl Into<R>) -> Scalar<Gamma<R>> {
    let (shape, rate) = (shape.into(), rate.into());
    Scalar(Gamma { shape, rate })
}

/// Density `rate exp(-rate x)`.
pub fn exponential<R: Real>(rate: impl Into<R>) -> Scalar<Gamma<R>> {
    gamma(1.0, rate)
}

impl<R: Real> Continuous<R> for Gamma<R> {
    fn bounds(&self) -> Bounds<R> {
        positive()
    }

    fn log_pdf(&self, x: R) -> R {
        let (a, b) = (self.shape, self.rate);
        let fine = a.value() > 0.0 && b.value() > 0.0;
        // With a constant shape of 1 the power is 1, at 0 as well.
        let power = match a.value() == 1.0 && x.value() == 0.0 {
            true => R::from(0.0),
            false => (a - 1.0) * x.ln(),
        };
        valid(fine, a * b.ln() - a.ln_gamma() + power - b * x)
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        let gamma = rand_distr::Gamma::new(self.shape.value(), 1.0 / self.rate.value());
        drawn(gamma, rng)
    }
}

/// See [`inverse_gamma`].
#[derive(Clone, Copy, Debug)]
pub struct InverseGamma<R> {
    inverse: Gamma<R>,
}

/// Density `∝ x^(-shape - 1) exp(-scale / x)`.
pub fn inverse_gamma<R: Real>(shape: impl Into<R>, scale: impl Into<R>) -> Scalar<InverseGamma<R>> {
    let Scalar(inverse) = gamma(shape, scale);
    Scalar(InverseGamma { inverse })
}

impl<R: Real> Continuous<R> for InverseGamma<R> {
    fn bounds(&self) -> Bounds<R> {
        positive()
    }

    fn log_pdf(&self, x: R) -> R {
        if x.value() <= 0.0 {
            return R::from(f64::NEG_INFINITY);
        }
        self.inverse.log_pdf(R::from(1.0) / x) - x.ln() * 2.0
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        1.0 / self.inverse.draw_one(rng)
    }
}

/// See [`beta`].
#[derive(Clone, Copy, Debug)]
pub struct Beta<R> {
    a: R,
    b: R,
}

/// Density `∝ x^(a - 1) (1 - x)^(b - 1)`.
pub fn beta<R: Real>(a: impl Into<R>, b: impl Into<R>) -> Scalar<Beta<R>> {
    let (a, b) = (a.into(), b.into());
    Scalar(Beta { a, b })
}

impl<R: Real> Continuous<R> for Beta<R> {
    fn bounds(&self) -> Bounds<R> {
        Bounds {
            lower: Some(R::from(0.0)),
            upper: Some(R::from(1.0)),
        }
    }

    fn log_pdf(&self, x: R) -> R {
        let (a, b) = (self.a, self.b);
        let constant = (a + b).ln_gamma() - a.ln_gamma() - b.ln_gamma();
        let power = |p: R, log: R| match p.value() == 1.0 && !log.value().is_finite() {
            true => R::from(0.0),
            false => (p - 1.0) * log,
        };
        let log = constant + power(a, x.ln()) + power(b, (-x).ln_1p());
        valid(a.value() > 0.0 && b.value() > 0.0, log)
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        drawn(rand_distr::Beta::new(self.a.value(), self.b.value()), rng)
    }
}

/// See [`uniform`].
#[derive(Clone, Copy, Debug)]
pub struct Uniform<R> {
    lower: R,
    upper: R,
}

/// Uniform between two bounds.
pub fn uniform<R: Real>(lower: impl Into<R>, upper: impl Into<R>) -> Scalar<Uniform<R>> {
    let (lower, upper) = (lower.into(), upper.into());
    Scalar(Uniform { lower, upper })
}

impl<R: Real> Continuous<R> for Uniform<R> {
    fn bounds(&self) -> Bounds<R> {
        Bounds {
            lower: Some(self.lower),
            upper: Some(self.upper),
        }
    }

    fn log_pdf(&self, _: R) -> R {
        let width = self.upper - self.lower;
        valid(width.value() > 0.0, -width.ln())
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        let (a, b) = (self.lower.value(), self.upper.value());
        match a < b && (b - a).is_finite() {
            true => a + (b - a) * rng.random::<f64>(),
            false => f64::NAN,
        }
    }
}
