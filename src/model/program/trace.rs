//! The choices of one run of a program.

use rustc_hash::FxHashMap;

use super::address::Address;

/// The set of values of a distribution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// The whole numbers below this one (`false` is 0, `true` is 1).
    Finite(usize),
    /// All whole numbers from 0.
    Counts,
    /// Real values of so many free coordinates.
    Real(usize),
}

/// The value of a choice as plain data.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A real number.
    Real(f64),
    /// A whole number; `false` is 0, `true` is 1.
    Whole(u64),
    /// Several real numbers.
    Reals(Vec<f64>),
}

impl Value {
    /// The numbers, one or several.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Real(x) => vec![*x],
            Self::Whole(x) => vec![*x as f64],
            Self::Reals(x) => x.clone(),
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        match self {
            Self::Real(x) => x.is_finite(),
            Self::Whole(x) => *x < u64::MAX,
            Self::Reals(x) => x.iter().all(|x| x.is_finite()),
        }
    }
}

/// A choice that a run made.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The address of the choice.
    pub address: Address,
    /// The value.
    pub value: Value,
    /// Logarithm of the density or probability of the value, given the choices before it; natural.
    pub log_density: f64,
    /// The values that were possible.
    pub support: Support,
}

/// All choices of one run, in order, and what the data say of them.
///
/// `log p(choices)` is [`Trace::log_prior`], `log p(data | choices)`, with the factors, [`Trace::log_likelihood`]; their sum is the
/// logarithm of the unnormalised posterior density.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    pub(super) choices: Vec<Choice>,
    places: FxHashMap<Address, usize>,
    /// Log-likelihood after each observation and factor, cumulative.
    pub(super) stages: Vec<f64>,
}

impl Trace {
    /// The choices in the order in which they were made.
    pub fn choices(&self) -> &[Choice] {
        &self.choices
    }

    /// The value at an address; `None` where this run made no such choice.
    pub fn get(&self, at: impl Into<Address>) -> Option<&Value> {
        self.find(&at.into(), 0).map(|c| &c.value)
    }

    /// The choice at an address; `hint` is where it is likely to be.
    pub(super) fn find(&self, at: &Address, hint: usize) -> Option<&Choice> {
        match self.choices.get(hint).filter(|c| c.address == *at) {
            Some(found) => Some(found),
            None => self.places.get(at).map(|&i| &self.choices[i]),
        }
    }

    /// Adds a choice; false where the address is taken.
    pub(super) fn push(&mut self, choice: Choice) -> bool {
        let place = self.choices.len();
        let before = self.places.insert(choice.address.clone(), place);
        self.choices.push(choice);
        before.is_none()
    }

    /// Adds what an observation or a factor says.
    pub(super) fn weigh(&mut self, log: f64) {
        let sum = self.log_likelihood() + log;
        self.stages.push(sum);
    }

    /// Sum of the log densities of the choices, nats.
    pub fn log_prior(&self) -> f64 {
        self.choices.iter().map(|c| c.log_density).sum()
    }

    /// Sum of the log densities of observations and of the factors, nats.
    pub fn log_likelihood(&self) -> f64 {
        self.stages.last().copied().unwrap_or(0.0)
    }

    /// [`Trace::log_prior`] and [`Trace::log_likelihood`] together.
    pub fn log_joint(&self) -> f64 {
        self.log_prior() + self.log_likelihood()
    }
}
