//! `edifice.program.Distribution`: the distributions of `edifice_model::program::dist`, chosen at run time.

use edifice_model::program::dist::{self, Dist};
use edifice_model::program::{Real, Value};
use pyo3::prelude::*;
use pyo3::types::PyBool;

use super::errors::failed;

/// A distribution and its parameters.
#[derive(Clone, Debug, PartialEq)]
enum Form {
    Normal(f64, f64),
    HalfNormal(f64),
    LogNormal(f64, f64),
    StudentT(f64, f64, f64),
    Cauchy(f64, f64),
    HalfCauchy(f64),
    Exponential(f64),
    Gamma(f64, f64),
    InverseGamma(f64, f64),
    Beta(f64, f64),
    Uniform(f64, f64),
    Dirichlet(Vec<f64>),
    Bernoulli(f64),
    BernoulliLogit(f64),
    Categorical(Vec<f64>),
    CategoricalLogit(Vec<f64>),
    Binomial(u64, f64),
    Poisson(f64),
    PoissonLog(f64),
}

/// The work that is done with a distribution whose type is known only where the form is looked at.
pub trait Use<R: Real> {
    type Out;

    /// Uses the distribution, which is made anew as often as it is asked for.
    fn with<D: Dist<R>>(self, make: impl Fn() -> D) -> Self::Out;
}

/// A distribution of choices or data. A parameter out of its range is an error of the run that uses it, with the address.
#[pyclass(module = "edifice.program", frozen, eq, from_py_object)]
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution(Form);

impl Distribution {
    pub fn apply<R: Real, U: Use<R>>(&self, with: U) -> U::Out {
        use Form::*;
        match &self.0 {
            &Normal(mean, sd) => with.with(|| dist::normal::<R>(mean, sd)),
            &HalfNormal(sd) => with.with(|| dist::half_normal::<R>(sd)),
            &LogNormal(mean, sd) => with.with(|| dist::log_normal::<R>(mean, sd)),
            &StudentT(freedom, location, scale) => {
                with.with(|| dist::student_t::<R>(freedom, location, scale))
            }
            &Cauchy(location, scale) => with.with(|| dist::cauchy::<R>(location, scale)),
            &HalfCauchy(scale) => with.with(|| dist::half_cauchy::<R>(scale)),
            &Exponential(rate) => with.with(|| dist::exponential::<R>(rate)),
            &Gamma(shape, rate) => with.with(|| dist::gamma::<R>(shape, rate)),
            &InverseGamma(shape, scale) => with.with(|| dist::inverse_gamma::<R>(shape, scale)),
            &Beta(a, b) => with.with(|| dist::beta::<R>(a, b)),
            &Uniform(lower, upper) => with.with(|| dist::uniform::<R>(lower, upper)),
            Dirichlet(alpha) => with.with(|| dist::dirichlet::<R, f64>(alpha)),
            &Bernoulli(p) => with.with(|| dist::bernoulli::<R>(p)),
            &BernoulliLogit(odds) => with.with(|| dist::bernoulli_logit::<R>(odds)),
            Categorical(p) => with.with(|| dist::categorical::<R, f64>(p)),
            CategoricalLogit(logits) => with.with(|| dist::categorical_logit::<R, f64>(logits)),
            &Binomial(trials, p) => with.with(|| dist::binomial::<R>(trials, p)),
            &Poisson(rate) => with.with(|| dist::poisson::<R>(rate)),
            &PoissonLog(log) => with.with(|| dist::poisson_log::<R>(log)),
        }
    }

    /// Plain data of a Python value; `TypeError` where it is none of the kind that the distribution has.
    pub fn stored(&self, value: &Bound<'_, PyAny>) -> PyResult<Value> {
        use Form::*;
        Ok(match &self.0 {
            Dirichlet(_) => Value::Reals(value.extract()?),
            Bernoulli(_) | BernoulliLogit(_) => Value::Whole(
                value
                    .extract::<bool>()
                    .map(u64::from)
                    .or_else(|_| value.extract())?,
            ),
            Categorical(_) | CategoricalLogit(_) | Binomial(..) | Poisson(_) | PoissonLog(_) => {
                Value::Whole(value.extract()?)
            }
            _ => Value::Real(value.extract()?),
        })
    }

    /// A value of the distribution for Python: a `bool`, an `int`, a `float` or a list of floats.
    pub fn given<'py>(&self, py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
        let flag = matches!(self.0, Form::Bernoulli(_) | Form::BernoulliLogit(_));
        Ok(match value {
            Value::Whole(x) if flag => PyBool::new(py, *x > 0).to_owned().into_any(),
            Value::Whole(x) => x.into_pyobject(py)?.into_any(),
            Value::Real(x) => x.into_pyobject(py)?.into_any(),
            Value::Reals(x) => x.clone().into_pyobject(py)?.into_any(),
        })
    }
}

/// The logarithm of the density of a value, and whether the distribution can have such a value.
struct Density<'a>(&'a Value);

impl Use<f64> for Density<'_> {
    type Out = Option<f64>;

    fn with<D: Dist<f64>>(self, make: impl Fn() -> D) -> Option<f64> {
        let d = make();
        d.load(self.0).map(|x| d.log_density(&x))
    }
}

#[pymethods]
impl Distribution {
    /// N(mean, sd²).
    #[staticmethod]
    fn normal(mean: f64, sd: f64) -> Self {
        Self(Form::Normal(mean, sd))
    }

    /// |x| for x of N(0, sd²).
    #[staticmethod]
    fn half_normal(sd: f64) -> Self {
        Self(Form::HalfNormal(sd))
    }

    /// exp(x) for x of N(mean, sd²).
    #[staticmethod]
    fn log_normal(mean: f64, sd: f64) -> Self {
        Self(Form::LogNormal(mean, sd))
    }

    /// Student's t, moved and scaled.
    #[staticmethod]
    fn student_t(freedom: f64, location: f64, scale: f64) -> Self {
        Self(Form::StudentT(freedom, location, scale))
    }

    /// Cauchy's distribution.
    #[staticmethod]
    fn cauchy(location: f64, scale: f64) -> Self {
        Self(Form::Cauchy(location, scale))
    }

    /// |x| for x of Cauchy's distribution around 0.
    #[staticmethod]
    fn half_cauchy(scale: f64) -> Self {
        Self(Form::HalfCauchy(scale))
    }

    /// Density rate exp(-rate x).
    #[staticmethod]
    fn exponential(rate: f64) -> Self {
        Self(Form::Exponential(rate))
    }

    /// Gamma distribution of mean shape / rate.
    #[staticmethod]
    fn gamma(shape: f64, rate: f64) -> Self {
        Self(Form::Gamma(shape, rate))
    }

    /// 1 / x for x of the gamma distribution of this shape and the rate `scale`.
    #[staticmethod]
    fn inverse_gamma(shape: f64, scale: f64) -> Self {
        Self(Form::InverseGamma(shape, scale))
    }

    /// Density proportional to x^(a - 1) (1 - x)^(b - 1) on 0 to 1.
    #[staticmethod]
    fn beta(a: f64, b: f64) -> Self {
        Self(Form::Beta(a, b))
    }

    /// Equal density from lower to upper.
    #[staticmethod]
    fn uniform(lower: f64, upper: f64) -> Self {
        Self(Form::Uniform(lower, upper))
    }

    /// Probabilities that sum to 1, of these concentrations.
    #[staticmethod]
    fn dirichlet(alpha: Vec<f64>) -> Self {
        Self(Form::Dirichlet(alpha))
    }

    /// True with this probability.
    #[staticmethod]
    fn bernoulli(probability: f64) -> Self {
        Self(Form::Bernoulli(probability))
    }

    /// True with the probability logistic(odds).
    #[staticmethod]
    fn bernoulli_logit(odds: f64) -> Self {
        Self(Form::BernoulliLogit(odds))
    }

    /// 0 to k - 1 with these probabilities; they are divided by their sum.
    #[staticmethod]
    fn categorical(probabilities: Vec<f64>) -> Self {
        Self(Form::Categorical(probabilities))
    }

    /// 0 to k - 1 in proportion to the exponentials of these numbers.
    #[staticmethod]
    fn categorical_logit(logits: Vec<f64>) -> Self {
        Self(Form::CategoricalLogit(logits))
    }

    /// Successes among so many trials of this probability.
    #[staticmethod]
    fn binomial(trials: u64, probability: f64) -> Self {
        Self(Form::Binomial(trials, probability))
    }

    /// Counts of this mean.
    #[staticmethod]
    fn poisson(rate: f64) -> Self {
        Self(Form::Poisson(rate))
    }

    /// Counts whose mean has this logarithm.
    #[staticmethod]
    fn poisson_log(log: f64) -> Self {
        Self(Form::PoissonLog(log))
    }

    /// Logarithm of the density or probability of a value, nats; minus infinity outside of the support.
    fn log_density(&self, value: &Bound<'_, PyAny>) -> PyResult<f64> {
        let stored = self.stored(value)?;
        let found = self.apply(Density(&stored));
        let log =
            found.ok_or_else(|| failed(format!("{value} is no value of {}", self.__repr__())))?;
        match log.is_nan() {
            true => Err(failed(format!(
                "a parameter of {} is out of its range",
                self.__repr__()
            ))),
            false => Ok(log),
        }
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0)
    }
}
