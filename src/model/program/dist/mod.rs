//! Distributions of choices and of data.
//!
//! Densities are written for any [`Real`], so that they can be differentiated; draws are `rand_distr`'s. A parameter out of its range
//! makes the log density not a number, which every engine reports with the address.
//!
//! | function | support | parameters |
//! | --- | --- | --- |
//! | [`normal`], [`student_t`], [`cauchy`] | all reals | location, scale (and first, degrees of freedom) |
//! | [`half_normal`], [`half_cauchy`] | x > 0 | scale |
//! | [`log_normal`] | x > 0 | mean and deviation of the logarithm |
//! | [`exponential`], [`gamma`], [`inverse_gamma`] | x > 0 | rate; shape and rate; shape and scale |
//! | [`beta`] | 0 < x < 1 | a, b |
//! | [`uniform`] | lower < x < upper | lower, upper |
//! | [`dirichlet`] | probabilities | concentrations |
//! | [`bernoulli`], [`bernoulli_logit`] | false, true | probability; log odds |
//! | [`categorical`], [`categorical_logit`] | 0 .. k | probabilities; logarithms of weights |
//! | [`binomial`] | 0 .. n | trials, probability |
//! | [`poisson`], [`poisson_log`] | 0, 1, .. | rate; its logarithm |

mod continuous;
mod discrete;
mod scaled;
mod shaped;
mod simplex;

use rand::Rng;

use super::real::Real;
use super::trace::{Support, Value};
pub use continuous::{Bounds, Continuous, Scalar};
pub use discrete::{
    Bernoulli, Binomial, Categorical, Poisson, bernoulli, bernoulli_logit, binomial, categorical,
    categorical_logit, poisson, poisson_log,
};
pub use scaled::{
    Cauchy, HalfCauchy, HalfNormal, LogNormal, Normal, StudentT, cauchy, half_cauchy, half_normal,
    log_normal, normal, student_t,
};
pub use shaped::{
    Beta, Gamma, InverseGamma, Uniform, beta, exponential, gamma, inverse_gamma, uniform,
};
pub use simplex::{Dirichlet, dirichlet};

/// A distribution over values of one type, with parameters that are numbers of the kind R.
///
/// To state one of one's own that is continuous and scalar, [`Continuous`] within [`Scalar`] is less work.
pub trait Dist<R: Real> {
    /// The type of its values.
    type Value: Clone;

    /// The set of its values.
    fn support(&self) -> Support;

    /// Logarithm of the density or probability of a value, natural; minus infinity outside of the support.
    fn log_density(&self, x: &Self::Value) -> R;

    /// A draw.
    fn draw<G: Rng>(&self, rng: &mut G) -> Self::Value;

    /// The value as plain data.
    fn store(&self, x: &Self::Value) -> Value;

    /// The value of plain data; `None` where it is of another kind or another number of coordinates.
    fn load(&self, stored: &Value) -> Option<Self::Value>;

    /// The value at free coordinates, and the logarithm of the volume that a unit of free volume has there; `None` where the values
    /// are whole numbers. As many coordinates as [`Support::Real`] says.
    fn constrain(&self, free: &[R]) -> Option<(Self::Value, R)>;

    /// The free coordinates of a value; none where the values are whole numbers.
    fn release(&self, x: &Self::Value) -> Vec<f64>;
}
