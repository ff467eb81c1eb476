//! Continuous distributions of one number.

use rand::{Rng, RngExt};
use rand_distr::Distribution;

use super::{Dist, Support};
use crate::linalg::LN_2PI;
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
fn drawn<D: Distribution<f64>, E, G: Rng>(d: Result<D, E>, rng: &mut G) -> f64 {
    d.map_or(f64::NAN, |d| d.sample(rng))
}

/// x where the condition on parameters holds, else not a number.
fn valid<R: Real>(fine: bool, x: R) -> R {
    if fine { x } else { R::from(f64::NAN) }
}

fn positive<R: Real>() -> Bounds<R> {
    Bounds {
        lower: Some(R::from(0.0)),
        upper: None,
    }
}

/// See [`normal`].
#[derive(Clone, Copy, Debug)]
pub struct Normal<R> {
    mean: R,
    sd: R,
}

/// `N(mean, sd²)`.
pub fn normal<R: Real>(mean: impl Into<R>, sd: impl Into<R>) -> Scalar<Normal<R>> {
    let (mean, sd) = (mean.into(), sd.into());
    Scalar(Normal { mean, sd })
}

impl<R: Real> Continuous<R> for Normal<R> {
    fn bounds(&self) -> Bounds<R> {
        Bounds::LINE
    }

    fn log_pdf(&self, x: R) -> R {
        let z = (x - self.mean) / self.sd;
        let log = -(z * z) * 0.5 - self.sd.ln() - 0.5 * LN_2PI;
        valid(self.sd.value() > 0.0, log)
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        let normal = rand_distr::Normal::new(self.mean.value(), self.sd.value());
        drawn(normal, rng)
    }
}

/// See [`half_normal`].
#[derive(Clone, Copy, Debug)]
pub struct HalfNormal<R> {
    sd: R,
}

/// |x| for x of `N(0, sd²)`.
pub fn half_normal<R: Real>(sd: impl Into<R>) -> Scalar<HalfNormal<R>> {
    Scalar(HalfNormal { sd: sd.into() })
}

impl<R: Real> Continuous<R> for HalfNormal<R> {
    fn bounds(&self) -> Bounds<R> {
        positive()
    }

    fn log_pdf(&self, x: R) -> R {
        normal(0.0, self.sd).0.log_pdf(x) + std::f64::consts::LN_2
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        normal::<R>(0.0, self.sd).0.draw_one(rng).abs()
    }
}

/// See [`log_normal`].
#[derive(Clone, Copy, Debug)]
pub struct LogNormal<R> {
    log: Normal<R>,
}

/// exp(x) for x of `N(mean, sd²)`.
pub fn log_normal<R: Real>(mean: impl Into<R>, sd: impl Into<R>) -> Scalar<LogNormal<R>> {
    let Scalar(log) = normal(mean, sd);
    Scalar(LogNormal { log })
}

impl<R: Real> Continuous<R> for LogNormal<R> {
    fn bounds(&self) -> Bounds<R> {
        positive()
    }

    fn log_pdf(&self, x: R) -> R {
        // No mass at 0, where the logarithm is not finite.
        if x.value() <= 0.0 {
            return R::from(f64::NEG_INFINITY);
        }
        let log = x.ln();
        self.log.log_pdf(log) - log
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        self.log.draw_one(rng).exp()
    }
}

/// See [`student_t`].
#[derive(Clone, Copy, Debug)]
pub struct StudentT<R> {
    freedom: R,
    location: R,
    scale: R,
}

/// Student's t of `freedom` degrees of freedom, moved and scaled.
pub fn student_t<R: Real>(
    freedom: impl Into<R>,
    location: impl Into<R>,
    scale: impl Into<R>,
) -> Scalar<StudentT<R>> {
    Scalar(StudentT {
        freedom: freedom.into(),
        location: location.into(),
        scale: scale.into(),
    })
}

impl<R: Real> Continuous<R> for StudentT<R> {
    fn bounds(&self) -> Bounds<R> {
        Bounds::LINE
    }

    fn log_pdf(&self, x: R) -> R {
        let (n, z) = (self.freedom, (x - self.location) / self.scale);
        let above = (n + 1.0) * 0.5;
        let constant = above.ln_gamma() - (n * 0.5).ln_gamma() - (n * std::f64::consts::PI).ln() * 0.5;
        let log = constant - self.scale.ln() - above * (z * z / n).ln_1p();
        valid(n.value() > 0.0 && self.scale.value() > 0.0, log)
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        let t = drawn(rand_distr::StudentT::new(self.freedom.value()), rng);
        self.location.value() + self.scale.value() * t
    }
}

/// See [`cauchy`].
#[derive(Clone, Copy, Debug)]
pub struct Cauchy<R> {
    location: R,
    scale: R,
}

/// Cauchy's distribution, moved and scaled.
pub fn cauchy<R: Real>(location: impl Into<R>, scale: impl Into<R>) -> Scalar<Cauchy<R>> {
    let (location, scale) = (location.into(), scale.into());
    Scalar(Cauchy { location, scale })
}

impl<R: Real> Continuous<R> for Cauchy<R> {
    fn bounds(&self) -> Bounds<R> {
        Bounds::LINE
    }

    fn log_pdf(&self, x: R) -> R {
        let z = (x - self.location) / self.scale;
        let log = -(z * z).ln_1p() - (self.scale * std::f64::consts::PI).ln();
        valid(self.scale.value() > 0.0, log)
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        let (location, scale) = (self.location.value(), self.scale.value());
        drawn(rand_distr::Cauchy::new(location, scale), rng)
    }
}

/// See [`half_cauchy`].
#[derive(Clone, Copy, Debug)]
pub struct HalfCauchy<R> {
    scale: R,
}

/// |x| for x of Cauchy's distribution around 0.
pub fn half_cauchy<R: Real>(scale: impl Into<R>) -> Scalar<HalfCauchy<R>> {
    Scalar(HalfCauchy {
        scale: scale.into(),
    })
}

impl<R: Real> Continuous<R> for HalfCauchy<R> {
    fn bounds(&self) -> Bounds<R> {
        positive()
    }

    fn log_pdf(&self, x: R) -> R {
        cauchy(0.0, self.scale).0.log_pdf(x) + std::f64::consts::LN_2
    }

    fn draw_one<G: Rng>(&self, rng: &mut G) -> f64 {
        cauchy::<R>(0.0, self.scale).0.draw_one(rng).abs()
    }
}

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
