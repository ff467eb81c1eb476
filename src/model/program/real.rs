//! Numbers that a program computes with: plain ones, or ones that remember how they were made ([`super::reverse`]).

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number of a program: `f64`, or [`Var`](super::reverse::Var) where derivatives are wanted.
///
/// A program that is generic over it runs under every engine. Constants become numbers by `R::from(1.0)`; a number on the left may
/// be combined with an `f64` on the right. Functions are those of `f64` of the same name.
///
/// # Examples
/// ```
/// use edifice_model::program::Real;
/// fn softplus<R: Real>(x: R) -> R { x.exp().ln_1p() }
/// assert!((softplus(0.0) - 2.0_f64.ln()).abs() < 1e-15);
/// ```
pub trait Real:
    Copy
    + Debug
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// The number itself.
    fn value(self) -> f64;
    /// A function of the number, from its value and derivative there: how every other function is made.
    fn through(self, value: f64, derivative: f64) -> Self;

    /// e to the power x.
    fn exp(self) -> Self {
        let y = self.value().exp();
        self.through(y, y)
    }
    /// Natural logarithm.
    fn ln(self) -> Self {
        self.through(self.value().ln(), 1.0 / self.value())
    }
    /// `ln(1 + x)`.
    fn ln_1p(self) -> Self {
        self.through(self.value().ln_1p(), 1.0 / (1.0 + self.value()))
    }
    /// Square root.
    fn sqrt(self) -> Self {
        let y = self.value().sqrt();
        self.through(y, 0.5 / y)
    }
    /// x to a constant power.
    fn powf(self, power: f64) -> Self {
        let x = self.value();
        self.through(x.powf(power), power * x.powf(power - 1.0))
    }
    /// Sine.
    fn sin(self) -> Self {
        self.through(self.value().sin(), self.value().cos())
    }
    /// Cosine.
    fn cos(self) -> Self {
        self.through(self.value().cos(), -self.value().sin())
    }
    /// Hyperbolic tangent.
    fn tanh(self) -> Self {
        let y = self.value().tanh();
        self.through(y, 1.0 - y * y)
    }
    /// Absolute value; its derivative at 0 is taken to be 1.
    fn abs(self) -> Self {
        self.through(self.value().abs(), 1_f64.copysign(self.value()))
    }
    /// `1 / (1 + exp(-x))`.
    fn logistic(self) -> Self {
        let y = logistic(self.value());
        self.through(y, y * (1.0 - y))
    }
    /// `ln(1 / (1 + exp(-x)))`, without overflow.
    fn ln_logistic(self) -> Self {
        let x = self.value();
        let y = x.min(0.0) - (-x.abs()).exp().ln_1p();
        self.through(y, logistic(-x))
    }
    /// Logarithm of the gamma function, x > 0; not a number elsewhere.
    fn ln_gamma(self) -> Self {
        let x = self.value();
        if x > 0.0 {
            let derivative = statrs::function::gamma::digamma(x);
            return self.through(statrs::function::gamma::ln_gamma(x), derivative);
        }
        self.through(f64::NAN, f64::NAN)
    }
}

impl Real for f64 {
    fn value(self) -> f64 {
        self
    }

    fn through(self, value: f64, _: f64) -> f64 {
        value
    }
}

fn logistic(x: f64) -> f64 {
    if x >= 0.0 {
        return 1.0 / (1.0 + (-x).exp());
    }
    let e = x.exp();
    e / (1.0 + e)
}
