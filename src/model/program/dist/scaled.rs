//! Distributions of a location and a scale, and those made of them.

use rand::Rng;

use super::continuous::{Bounds, Continuous, Scalar, drawn, positive, valid};
use crate::linalg::LN_2PI;
use crate::program::real::Real;

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
        let constant =
            above.ln_gamma() - (n * 0.5).ln_gamma() - (n * std::f64::consts::PI).ln() * 0.5;
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
