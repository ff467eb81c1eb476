//! Probabilistic programs: models as code, and engines that find what data say of their choices.
//!
//! A [`Program`] is a function that makes choices ([`Handler::sample`], each at an [`Address`]) and weighs what it has chosen by
//! data ([`Handler::observe`]) or by any number ([`Handler::factor`]). With the choices `x = (x_1, .., x_n)` of a run, n and the
//! kinds of choices depending on those before, and the weights `w_j` of its observations and factors,
//!
//! ```text
//! p(x, data) = Π_i p(x_i | x_1, .., x_(i-1))  Π_j w_j(x)        Z = p(data) = Σ_x p(x, data)
//! ```
//! and wanted are draws of `p(x | data) = p(x, data) / Z`, and Z, the evidence.
//!
//! | engine | serves | gives |
//! | --- | --- | --- |
//! | [`exact`] | choices of finitely many values, up to a million ways through | probabilities and Z, exactly |
//! | [`compile`] | the same choices in every run, finite, each depending on few others | a [`Network`](super::network::Network) and evidence, to be asked exactly |
//! | [`importance`] | all programs | weighted draws, Z with its error, effective sample size, Pareto's k |
//! | [`smc`] | all programs; best where data come one after the other | the same |
//! | [`metropolis`] | all programs | chains |
//! | `nuts` (feature `nuts`) | the same real choices in every run | chains |
//!
//! *Which when.* Finite choices: [`exact`] or [`compile`], always; they also judge the others ([`Posterior::beside`]). Up to about
//! five choices or weak data: [`importance`], as long as Pareto's k is below 0.7. Series of data: [`smc`]. Real choices of one number or a
//! thousand: `nuts`. Whole and real ones mixed, or choices that come and go: [`metropolis`], with more than one chain, and
//! R-hat below 1.01 before its numbers are believed ([`diagnostics`]).
//!
//! ```
//! use edifice_model::program::{Handler, Program, Real, dist::{half_cauchy, normal}, smc};
//! /// Eight schools (Rubin 1981): effects of coaching, and their standard errors.
//! struct Schools;
//! const EFFECTS: [(f64, f64); 8] =
//!     [(28., 15.), (8., 10.), (-3., 16.), (7., 11.), (-1., 9.), (1., 11.), (18., 10.), (12., 18.)];
//! impl Program for Schools {
//!     type Out = f64;
//!     fn run<H: Handler>(&self, h: &mut H) -> f64 {
//!         let mean = h.sample("mean", normal(0.0, 5.0));
//!         let spread = h.sample("spread", half_cauchy(5.0));
//!         for (i, (effect, error)) in EFFECTS.into_iter().enumerate() {
//!             let own = h.sample(("own", i), normal(0.0, 1.0));
//!             h.observe(normal(mean + spread * own, error), &effect.into());
//!         }
//!         mean.value()
//!     }
//! }
//! let posterior = smc(&Schools, 8000, 1)?;
//! assert!((posterior.mean("mean").unwrap() - 4.4).abs() < 1.0);
//! # Ok::<(), edifice_model::program::ProgramError>(())
//! ```
//!
//! # Deviations and readings
//! - A program is run whole; sequential Monte Carlo keeps choices up to an observation and draws those after it anew, so that what
//!   has been chosen and not yet weighed costs a run and no coroutines are needed. The draws ahead follow the prior, and change nothing.
//! - There is no variational inference.
//!
//! Sources: van de Meent, Paige, Yang and Wood 2018, *An introduction to probabilistic programming*; and those of each engine.

mod address;
mod compile;
mod condition;
pub mod diagnostics;
pub mod dist;
mod error;
mod exact;
mod export;
mod importance;
mod metropolis;
#[cfg(feature = "nuts")]
mod nuts;
mod pareto;
mod posterior;
mod real;
pub mod reverse;
mod run;
mod smc;
mod trace;

pub use address::Address;
pub use compile::{Compiled, compile};
pub use condition::{Given, given};
pub use dist::Dist;
pub use error::ProgramError;
pub use exact::exact;
pub use importance::{importance, importance_in_turn};
pub use metropolis::{Chains, metropolis};
#[cfg(feature = "nuts")]
pub use nuts::nuts;
pub use pareto::pareto_k;
pub use posterior::{Beside, Draw, Evidence, Posterior, Summary};
pub use real::Real;
pub use run::{prior, replay};
pub use smc::smc;
pub use trace::{Choice, Support, Trace, Value};

/// A model as code: choices, and what data say of them. [The module](self) has an example.
pub trait Program {
    /// The value that a run returns, any function of its choices.
    type Out;

    /// Runs once. The same answers of the handler have to lead to the same run: a program has no randomness of its own.
    fn run<H: Handler>(&self, h: &mut H) -> Self::Out;
}

impl<P: Program> Program for &P {
    type Out = P::Out;

    fn run<H: Handler>(&self, h: &mut H) -> P::Out {
        (*self).run(h)
    }
}

/// The party that makes a program's choices; each engine has its own.
pub trait Handler {
    /// Numbers that the program computes with.
    type Real: Real;

    /// A choice: a value of the distribution. An address is used once in a run.
    fn sample<D: Dist<Self::Real>>(&mut self, at: impl Into<Address>, d: D) -> D::Value;

    /// Data: weighs the run by the density of x.
    fn observe<D: Dist<Self::Real>>(&mut self, d: D, x: &D::Value);

    /// Weighs the run by `exp(log)`; `log` is below infinity, and minus infinity makes the run impossible.
    fn factor(&mut self, log: Self::Real);

    /// The same for each i below n: a plate. Addresses within it take i as an index.
    fn plate<T>(&mut self, n: usize, mut each: impl FnMut(&mut Self, usize) -> T) -> Vec<T>
    where
        Self: Sized,
    {
        (0..n).map(|i| each(self, i)).collect()
    }
}
