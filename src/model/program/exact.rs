//! Every way through a program whose choices are finite.

use super::address::Address;
use super::dist::Dist;
use super::error::ProgramError;
use super::posterior::{Draw, Evidence, Kind, Posterior};
use super::trace::{Choice, Support, Trace, Value};
use super::{Handler, Program};
use crate::linalg::log_sum_exp;
use edifice_base::rng::stream;

/// Most ways through a program that are tried.
const MOST: usize = 1 << 20;

/// The posterior and the evidence by trying every way through the program: exact up to rounding.
///
/// The ways are walked depth first, values of probability 0 left out; those of weight 0 are not among the draws. One run of the
/// program for each. Choices may differ from way to way.
///
/// # Errors
/// [`ProgramError::NotFinite`] for a choice of infinitely many values, [`ProgramError::TooMany`] above 2²⁰ ways,
/// [`ProgramError::Impossible`] where none has a weight; those of running the program.
///
/// # Examples
/// Two dice of which the sum is known:
/// ```
/// use edifice_model::program::{Handler, Program, dist::categorical, exact};
/// struct Dice;
/// impl Program for Dice {
///     type Out = usize;
///     fn run<H: Handler>(&self, h: &mut H) -> usize {
///         let dice = h.plate(2, |h, i| h.sample(("die", i), categorical(&[1.0; 6])));
///         let sum = dice[0] + dice[1];
///         h.factor(if sum == 3 { 0.0 } else { f64::NEG_INFINITY }.into());
///         dice[0]
///     }
/// }
/// let posterior = exact(&Dice)?;
/// assert!((posterior.evidence.unwrap().log - (4.0 / 36.0_f64).ln()).abs() < 1e-12);
/// assert!((posterior.probability(("die", 0), 3).mean - 0.25).abs() < 1e-12);
/// # Ok::<(), edifice_model::program::ProgramError>(())
/// ```
pub fn exact<P: Program>(program: &P) -> Result<Posterior<P::Out>, ProgramError> {
    let mut draws: Vec<Draw<P::Out>> = Vec::new();
    let mut taken: Vec<Branch> = Vec::new();
    let mut tried = 0;
    loop {
        if tried == MOST {
            return Err(ProgramError::TooMany { most: MOST });
        }
        tried += 1;
        let mut handler = Walk {
            taken,
            at: 0,
            trace: Trace::default(),
            error: None,
        };
        let out = program.run(&mut handler);
        if let Some(error) = handler.error {
            return Err(error);
        }
        let log_weight = handler.trace.log_joint();
        if log_weight > f64::NEG_INFINITY {
            draws.push(Draw {
                trace: handler.trace,
                out,
                log_weight,
            });
        }
        taken = handler.taken;
        // The last choice that has another value left takes it.
        while taken.last_mut().is_some_and(|b| !b.next()) {
            taken.pop();
        }
        if taken.is_empty() {
            break;
        }
    }
    let logs: Vec<f64> = draws.iter().map(|d| d.log_weight).collect();
    let log = log_sum_exp(&logs);
    if log == f64::NEG_INFINITY {
        return Err(ProgramError::Impossible { tried });
    }
    let mut posterior = Posterior::weighted(draws, 1);
    posterior.kind = Kind::Exact;
    posterior.evidence = Some(Evidence { log, error: 0.0 });
    Ok(posterior)
}

/// The state of a choice: log probabilities of its values, and which of them is taken.
struct Branch {
    logs: Vec<f64>,
    value: usize,
}

impl Branch {
    /// Goes to the next value of positive probability; false where there is none.
    fn next(&mut self) -> bool {
        let rest = self.logs.iter().enumerate().skip(self.value + 1);
        let mut possible = rest.filter(|(_, log)| **log > f64::NEG_INFINITY);
        match possible.next() {
            Some((value, _)) => {
                self.value = value;
                true
            }
            None => false,
        }
    }
}

struct Walk {
    taken: Vec<Branch>,
    at: usize,
    trace: Trace,
    error: Option<ProgramError>,
}

impl Walk {
    fn fail(&mut self, error: ProgramError) {
        self.error.get_or_insert(error);
    }
}

/// Log probabilities of all values of a finite choice.
///
/// # Errors
/// [`ProgramError::NotFinite`], [`ProgramError::NotANumber`].
pub(super) fn logs<D: Dist<f64>>(at: &Address, d: &D) -> Result<Vec<f64>, ProgramError> {
    let Support::Finite(k) = d.support() else {
        return Err(ProgramError::NotFinite { at: at.to_string() });
    };
    let one = |x: u64| match d.load(&Value::Whole(x)).map(|v| d.log_density(&v)) {
        Some(log) if !log.is_nan() => Ok(log),
        _ => Err(ProgramError::NotANumber { at: at.to_string() }),
    };
    (0..k as u64).map(one).collect()
}

/// Some value, for a run that has failed.
pub(super) fn any<D: Dist<f64>>(d: &D) -> D::Value {
    d.draw(&mut stream(0, "program/failed", 0))
}

impl Handler for Walk {
    type Real = f64;

    fn sample<D: Dist<f64>>(&mut self, at: impl Into<Address>, d: D) -> D::Value {
        let address = at.into();
        if self.error.is_some() {
            return any(&d);
        }
        if self.at == self.taken.len() {
            let mut branch = match logs(&address, &d) {
                Ok(logs) => Branch { logs, value: 0 },
                Err(error) => {
                    self.fail(error);
                    return any(&d);
                }
            };
            let impossible = branch.logs.first().is_none_or(|l| *l == f64::NEG_INFINITY);
            if impossible && !branch.next() {
                self.fail(ProgramError::NotANumber {
                    at: address.to_string(),
                });
                return any(&d);
            }
            self.taken.push(branch);
        }
        let branch = &self.taken[self.at];
        let (value, log_density) = (branch.value as u64, branch.logs[branch.value]);
        self.at += 1;
        let choice = Choice {
            address: address.clone(),
            value: Value::Whole(value),
            log_density,
            support: d.support(),
        };
        if !self.trace.push(choice) {
            let at = address.to_string();
            self.fail(ProgramError::Duplicate { at });
        }
        d.load(&Value::Whole(value)).unwrap_or_else(|| any(&d))
    }

    fn observe<D: Dist<f64>>(&mut self, d: D, x: &D::Value) {
        let log = d.log_density(x);
        self.factor(log);
    }

    fn factor(&mut self, log: f64) {
        if log.is_nan() || log == f64::INFINITY {
            let at = format!("observation {}", self.trace.stages.len() + 1);
            self.fail(ProgramError::NotANumber { at });
        }
        self.trace.weigh(log);
    }
}
