//! The result of every engine: draws or weighted draws, and the estimates that follow from them.

use rand::Rng;
use std::collections::BTreeSet;

use super::address::Address;
use super::diagnostics;
use super::error::ProgramError;
use super::run::replay;
use super::trace::{Trace, Value};
use super::{Program, Support};
use crate::linalg::{categorical_of_logs, log_sum_exp};

/// One run of a program, with its weight.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw<T> {
    /// Its choices.
    pub trace: Trace,
    /// The value that it returned.
    pub out: T,
    /// Logarithm of its share; the shares of all draws sum to 1.
    pub log_weight: f64,
}

/// `log Z`, the logarithm of the evidence, in nats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// The estimate.
    pub log: f64,
    /// Its standard error; 0 where it is exact.
    pub error: f64,
}

/// The dependence of draws on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Every way through the program, with its probability.
    Exact,
    /// Weighted, in so many groups of equal size that are independent of each other.
    Weighted(usize),
    /// So many chains of equal length, one after the other.
    Chains(usize),
}

/// The posterior distribution of a program as an engine found it.
#[derive(Clone, Debug, PartialEq)]
pub struct Posterior<T> {
    /// The draws; of chains one after the other.
    pub draws: Vec<Draw<T>>,
    /// The evidence; `None` from chains, which do not know it.
    pub evidence: Option<Evidence>,
    /// Pareto's k of importance weights ([`super::pareto_k`]).
    pub pareto_k: Option<f64>,
    /// Share of proposals that chains accepted.
    pub acceptance: Option<f64>,
    /// Steps of a Hamiltonian trajectory that went astray, by draw; empty of other engines.
    pub diverging: Vec<bool>,
    pub(super) kind: Kind,
}

/// An estimate and its Monte Carlo standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Mean over the posterior.
    pub mean: f64,
    /// Its standard error; 0 where it is exact.
    pub error: f64,
}

/// One number of the posterior: a choice, or a coordinate of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// The address, with the coordinate in brackets where there are several.
    pub name: String,
    /// Mean, over the draws that have it.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Monte Carlo standard error of the mean.
    pub mcse: f64,
    /// Effective sample size of the bulk; of weighted draws `1 / Σ w²`.
    pub ess_bulk: f64,
    /// Effective sample size of the tails; not a number of weighted draws.
    pub ess_tail: f64,
    /// R-hat; not a number of weighted draws or of one chain.
    pub r_hat: f64,
}

/// An estimate beside the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// The choice and, of a whole number, the value whose probability is meant: `rain=1`; of a real one its mean.
    pub name: String,
    /// The estimate and its own standard error.
    pub estimate: Estimate,
    /// The exact number.
    pub truth: f64,
}

impl Beside {
    /// The true error: estimate less truth.
    pub fn error(&self) -> f64 {
        self.estimate.mean - self.truth
    }
}

impl<T> Posterior<T> {
    /// Weighted draws of unnormalised log weights, which are normalised here.
    pub(super) fn weighted(mut draws: Vec<Draw<T>>, groups: usize) -> Self {
        let logs: Vec<f64> = draws.iter().map(|d| d.log_weight).collect();
        let total = log_sum_exp(&logs);
        draws.iter_mut().for_each(|d| d.log_weight -= total);
        Self {
            draws,
            evidence: None,
            pareto_k: None,
            acceptance: None,
            diverging: Vec::new(),
            kind: Kind::Weighted(groups),
        }
    }

    /// Number of chains; 1 of weighted draws.
    pub fn chains(&self) -> usize {
        match self.kind {
            Kind::Chains(n) => n,
            _ => 1,
        }
    }

    /// Mean of a function of draws, and its standard error: of independent groups of weighted draws by the differences of their
    /// means, of chains by their effective sample size.
    pub fn estimate(&self, f: impl Fn(&Draw<T>) -> f64) -> Estimate {
        let values: Vec<f64> = self.draws.iter().map(f).collect();
        let weights = self.draws.iter().map(|d| d.log_weight.exp());
        let pairs = weights.zip(&values);
        // A value that is not a number has a weight of 0, or the mean is none either.
        let used = pairs.clone().filter(|(w, _)| *w > 0.0);
        let mean: f64 = used.map(|(w, v)| w * v).sum();
        let error = match self.kind {
            Kind::Exact => 0.0,
            Kind::Weighted(groups) => {
                let size = (self.draws.len() / groups.max(1)).max(1);
                let pairs: Vec<(f64, f64)> = pairs.map(|(w, v)| (w, *v)).collect();
                let group = |g: &[(f64, f64)]| {
                    let off = g.iter().filter(|(w, _)| *w > 0.0);
                    off.map(|(w, v)| w * (v - mean)).sum::<f64>().powi(2)
                };
                let n = groups as f64;
                (pairs.chunks(size).map(group).sum::<f64>() * n / (n - 1.0)).sqrt()
            }
            Kind::Chains(_) => diagnostics::mcse_mean(&self.by_chain(&values)),
        };
        Estimate { mean, error }
    }

    /// Numbers of all draws as chains.
    fn by_chain(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let length = values.len() / self.chains().max(1);
        values.chunks(length.max(1)).map(<[f64]>::to_vec).collect()
    }

    /// The number chosen at an address in each draw, the first coordinate of several; `None` where a draw has none.
    pub fn numbers(&self, at: impl Into<Address>) -> Option<Vec<f64>> {
        let at = at.into();
        let one = |d: &Draw<T>| {
            let found = d.trace.find(&at, 0)?;
            found.value.numbers().first().copied()
        };
        self.draws.iter().map(one).collect()
    }

    /// Posterior mean of the number at an address; `None` where a draw has none.
    pub fn mean(&self, at: impl Into<Address>) -> Option<f64> {
        let numbers = self.numbers(at)?;
        let weights = self.draws.iter().map(|d| d.log_weight.exp());
        Some(weights.zip(numbers).map(|(w, x)| w * x).sum())
    }

    /// Posterior probability that the choice at an address is this whole number; draws that have no such choice count against it.
    pub fn probability(&self, at: impl Into<Address>, value: u64) -> Estimate {
        let at = at.into();
        self.estimate(|d| {
            let found = d.trace.find(&at, 0).map(|c| &c.value);
            f64::from(u8::from(found == Some(&Value::Whole(value))))
        })
    }

    /// Effective number of draws by their weights, `1 / Σ w²`.
    pub fn ess(&self) -> f64 {
        let squares = self.draws.iter().map(|d| (2.0 * d.log_weight).exp());
        1.0 / squares.sum::<f64>()
    }

    /// Every address that occurs, in the order of first use.
    pub fn addresses(&self) -> Vec<Address> {
        let mut seen = BTreeSet::new();
        let mut all = Vec::new();
        for choice in self.draws.iter().flat_map(|d| d.trace.choices()) {
            if !seen.contains(&choice.address) {
                seen.insert(choice.address.clone());
                all.push(choice.address.clone());
            }
        }
        all
    }

    /// Names and numbers of all choices, coordinate by coordinate; not a number where a draw has none.
    pub(super) fn columns(&self) -> Vec<(Address, Option<usize>, Vec<f64>)> {
        let mut columns = Vec::new();
        for (place, at) in self.addresses().into_iter().enumerate() {
            let found = |d: &Draw<T>| d.trace.find(&at, place).map(|c| c.value.numbers());
            let numbers: Vec<Option<Vec<f64>>> = self.draws.iter().map(found).collect();
            let width = numbers.iter().flatten().map(Vec::len).max().unwrap_or(1);
            let several = self.draws.iter().any(|d| {
                let value = d.trace.find(&at, place).map(|c| &c.value);
                matches!(value, Some(Value::Reals(_)))
            });
            for i in 0..width {
                let one = |n: &Option<Vec<f64>>| {
                    n.as_ref()
                        .and_then(|n| n.get(i).copied())
                        .unwrap_or(f64::NAN)
                };
                let column = numbers.iter().map(one).collect();
                columns.push((at.clone(), several.then_some(i), column));
            }
        }
        columns
    }

    /// Every choice, in the order of first use. O(draws) a number, and for chains the cost of [`diagnostics`].
    pub fn summary(&self) -> Vec<Summary> {
        let weights: Vec<f64> = self.draws.iter().map(|d| d.log_weight.exp()).collect();
        let columns = self.columns().into_iter();
        let one = |(at, coordinate, values): (Address, Option<usize>, Vec<f64>)| {
            let pairs = || {
                let all = weights.iter().zip(&values);
                all.filter(|(w, v)| **w > 0.0 && !v.is_nan())
            };
            let total: f64 = pairs().map(|(w, _)| w).sum();
            let mean = pairs().map(|(w, v)| w * v).sum::<f64>() / total;
            let square = pairs().map(|(w, v)| w * (v - mean).powi(2)).sum::<f64>() / total;
            let (mut bulk, mut tail, mut r_hat) = (self.ess(), f64::NAN, f64::NAN);
            let mut mcse = self.estimate_of(&values, mean, total);
            if let Kind::Chains(_) = self.kind {
                let chains = self.by_chain(&values);
                bulk = diagnostics::ess_bulk(&chains);
                tail = diagnostics::ess_tail(&chains);
                r_hat = diagnostics::r_hat(&chains);
                mcse = diagnostics::mcse_mean(&chains);
            }
            Summary {
                name: name(&at, coordinate),
                mean,
                sd: square.sqrt(),
                mcse,
                ess_bulk: bulk,
                ess_tail: tail,
                r_hat,
            }
        };
        columns.map(one).collect()
    }

    /// Standard error of a mean over those draws that have the number.
    fn estimate_of(&self, values: &[f64], mean: f64, total: f64) -> f64 {
        let Kind::Weighted(groups) = self.kind else {
            return 0.0;
        };
        let weights = self.draws.iter().map(|d| d.log_weight.exp());
        let off = weights
            .zip(values)
            .map(|(w, v)| match v.is_nan() || w == 0.0 {
                true => 0.0,
                false => w * (v - mean) / total,
            });
        let off: Vec<f64> = off.collect();
        let size = (off.len() / groups.max(1)).max(1);
        let sums = off.chunks(size).map(|g| g.iter().sum::<f64>().powi(2));
        let n = groups as f64;
        (sums.sum::<f64>() * n / (n - 1.0)).sqrt()
    }

    /// The estimates beside the truth of an exact posterior of the same program: the probability of every value of every finite choice, the mean
    /// of every other one.
    pub fn beside<U>(&self, truth: &Posterior<U>) -> Vec<Beside> {
        let mut all = Vec::new();
        for at in truth.addresses() {
            let support = truth
                .draws
                .iter()
                .find_map(|d| d.trace.find(&at, 0))
                .map(|c| c.support);
            if let Some(Support::Finite(k)) = support {
                for value in 0..k as u64 {
                    all.push(Beside {
                        name: format!("{at}={value}"),
                        estimate: self.probability(at.clone(), value),
                        truth: truth.probability(at.clone(), value).mean,
                    });
                }
                continue;
            }
            if let (Some(mean), Some(_)) = (truth.mean(at.clone()), self.mean(at.clone())) {
                let first = |d: &Draw<T>| {
                    let found = d.trace.find(&at, 0).map(|c| c.value.numbers());
                    found.and_then(|n| n.first().copied()).unwrap_or(f64::NAN)
                };
                all.push(Beside {
                    name: at.to_string(),
                    estimate: self.estimate(first),
                    truth: mean,
                });
            }
        }
        all
    }

    /// A draw of the posterior: one of the draws by its weight.
    pub fn pick<R: Rng>(&self, rng: &mut R) -> &Draw<T> {
        let logs: Vec<f64> = self.draws.iter().map(|d| d.log_weight).collect();
        &self.draws[categorical_of_logs(&logs, rng)]
    }

    /// Posterior predictive draws: `count` runs of a program whose choices are those of draws of the posterior where both have
    /// them, and are drawn anew elsewhere: the data, in a program that chooses what this one observed.
    ///
    /// # Errors
    /// As [`replay`].
    ///
    /// # Examples
    /// ```
    /// use edifice_model::program::{Handler, Program, dist, importance};
    /// use edifice_base::rng::stream;
    /// struct Coin { seen: Option<bool> }
    /// impl Program for Coin {
    ///     type Out = bool;
    ///     fn run<H: Handler>(&self, h: &mut H) -> bool {
    ///         let bias = h.sample("bias", dist::beta(1.0, 1.0));
    ///         match self.seen {
    ///             Some(side) => { h.observe(dist::bernoulli(bias), &side); side }
    ///             None => h.sample("next", dist::bernoulli(bias)),
    ///         }
    ///     }
    /// }
    /// let posterior = importance(&Coin { seen: Some(true) }, 2000, 1)?;
    /// let next = posterior.predictive(&Coin { seen: None }, 2000, &mut stream(1, "predict", 0))?;
    /// let share = next.iter().filter(|(_, side)| *side).count() as f64 / 2000.0;
    /// assert!((share - 2.0 / 3.0).abs() < 0.05);
    /// # Ok::<(), edifice_model::program::ProgramError>(())
    /// ```
    pub fn predictive<P: Program, R: Rng>(
        &self,
        program: &P,
        count: usize,
        rng: &mut R,
    ) -> Result<Vec<(Trace, P::Out)>, ProgramError> {
        let logs: Vec<f64> = self.draws.iter().map(|d| d.log_weight).collect();
        let each = (0..count).map(|_| {
            let draw = &self.draws[categorical_of_logs(&logs, rng)];
            replay(program, &draw.trace, rng)
        });
        each.collect()
    }
}

/// An address and a coordinate as one name.
pub(super) fn name(at: &Address, coordinate: Option<usize>) -> String {
    match coordinate {
        Some(i) => format!("{at}[{i}]"),
        None => at.to_string(),
    }
}
