//! The handler of all engines that need no derivatives: it keeps the choices of an earlier run, and draws the others from their
//! distributions.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::address::Address;
use super::dist::Dist;
use super::error::ProgramError;
use super::trace::{Choice, Support, Trace, Value};
use super::{Handler, Program};

/// The earlier run from which a run starts.
#[derive(Clone, Copy, Default)]
pub(super) struct Old<'a> {
    /// Choices to keep.
    pub trace: Option<&'a Trace>,
    /// Observations and factors after which nothing is kept any more.
    pub until: Option<usize>,
    /// One choice that is to differ from the trace's.
    pub change: Option<(&'a Address, Change)>,
}

/// The manner in which a choice is changed.
#[derive(Clone, Copy)]
pub(super) enum Change {
    /// By a normal step of this deviation in each free coordinate, a symmetric one of about this size of counts, or to any
    /// other one of finitely many values.
    Walk(f64),
    /// To a draw of its distribution.
    Fresh,
}

/// The result of a run.
pub(super) struct Done<T> {
    pub trace: Trace,
    pub out: T,
    /// Log density of the choices that were drawn anew.
    pub fresh: f64,
    /// Log density that the kept choices had before.
    pub kept: f64,
    /// `log q(old | new) - log q(new | old)` of the one change.
    pub ratio: f64,
}

/// Runs a program once.
///
/// # Errors
/// [`ProgramError::Duplicate`], [`ProgramError::NotANumber`].
pub(super) fn run<P: Program, G: Rng>(
    program: &P,
    old: Old<'_>,
    rng: &mut G,
) -> Result<Done<P::Out>, ProgramError> {
    let mut handler = Keep {
        old,
        rng,
        trace: Trace::default(),
        fresh: 0.0,
        kept: 0.0,
        ratio: 0.0,
        error: None,
    };
    let out = program.run(&mut handler);
    match handler.error {
        Some(error) => Err(error),
        None => Ok(Done {
            trace: handler.trace,
            out,
            fresh: handler.fresh,
            kept: handler.kept,
            ratio: handler.ratio,
        }),
    }
}

struct Keep<'a, G> {
    old: Old<'a>,
    rng: &'a mut G,
    trace: Trace,
    fresh: f64,
    kept: f64,
    ratio: f64,
    error: Option<ProgramError>,
}

impl<G: Rng> Keep<'_, G> {
    /// The choice of the earlier run.
    fn old(&self, at: &Address) -> Option<&Choice> {
        let stage = self.trace.stages.len();
        if self.old.until.is_some_and(|until| stage >= until) {
            return None;
        }
        let place = self.trace.choices.len();
        self.old.trace.and_then(|t| t.find(at, place))
    }

    /// Another value than x, and adds to the ratio of the proposals; x itself where there is no other.
    fn changed<D: Dist<f64>>(&mut self, d: &D, x: D::Value, how: Change) -> D::Value {
        let scale = match how {
            Change::Walk(scale) => scale,
            Change::Fresh => {
                let new = d.draw(self.rng);
                self.ratio += d.log_density(&x) - d.log_density(&new);
                return new;
            }
        };
        let Value::Whole(whole) = d.store(&x) else {
            let mut step = |u: f64| u + scale * self.rng.sample::<f64, _>(StandardNormal);
            let free = d.release(&x);
            let moved: Vec<f64> = free.iter().map(|&u| step(u)).collect();
            return match (d.constrain(&free), d.constrain(&moved)) {
                (Some((_, before)), Some((new, after))) => {
                    self.ratio += after - before;
                    new
                }
                _ => x,
            };
        };
        let other = match d.support() {
            Support::Finite(k) if k > 1 => {
                let other = self.rng.random_range(0..k as u64 - 1);
                other + u64::from(other >= whole)
            }
            Support::Counts => {
                let size = 1.0 + (scale * self.rng.sample::<f64, _>(StandardNormal)).abs();
                let size = size.min(1e15) as u64;
                match self.rng.random::<bool>() {
                    true => whole.saturating_add(size),
                    // Below zero nothing is: the proposal is refused.
                    false => match whole.checked_sub(size) {
                        Some(less) => less,
                        None => {
                            self.ratio = f64::NEG_INFINITY;
                            whole
                        }
                    },
                }
            }
            _ => whole,
        };
        d.load(&Value::Whole(other)).unwrap_or(x)
    }

    fn fail(&mut self, error: ProgramError) {
        self.error.get_or_insert(error);
    }
}

impl<G: Rng> Handler for Keep<'_, G> {
    type Real = f64;

    fn sample<D: Dist<f64>>(&mut self, at: impl Into<Address>, d: D) -> D::Value {
        let at = at.into();
        let old = self.old(&at).map(|c| (d.load(&c.value), c.log_density));
        let (value, anew) = match old {
            Some((Some(value), before)) => {
                self.kept += before;
                let change = self.old.change.filter(|(place, _)| **place == at);
                match change {
                    Some((_, how)) => (self.changed(&d, value, how), false),
                    None => (value, false),
                }
            }
            _ => (d.draw(self.rng), true),
        };
        let log_density = d.log_density(&value);
        if anew {
            self.fresh += log_density;
        }
        let choice = Choice {
            value: d.store(&value),
            log_density,
            support: d.support(),
            address: at.clone(),
        };
        if log_density.is_nan() || !choice.value.is_finite() {
            self.fail(ProgramError::NotANumber { at: at.to_string() });
        }
        if !self.trace.push(choice) {
            self.fail(ProgramError::Duplicate { at: at.to_string() });
        }
        value
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

/// Replays a trace: the same choices, and what is not among them drawn anew. Its densities are computed again, so that a trace of
/// one program scores another one that makes the same choices.
///
/// # Errors
/// [`ProgramError::Duplicate`], [`ProgramError::NotANumber`].
///
/// # Examples
/// ```
/// use edifice_model::program::{Handler, Program, dist::normal, prior, replay};
/// use edifice_base::rng::stream;
/// struct Sum;
/// impl Program for Sum {
///     type Out = f64;
///     fn run<H: Handler>(&self, h: &mut H) -> f64 {
///         let a = h.sample("a", normal(0.0, 1.0));
///         let b = h.sample("b", normal(a, 1.0));
///         edifice_model::program::Real::value(a + b)
///     }
/// }
/// let mut rng = stream(1, "replay", 0);
/// let (trace, out) = prior(&Sum, &mut rng)?;
/// assert_eq!(replay(&Sum, &trace, &mut rng)?, (trace, out));
/// # Ok::<(), edifice_model::program::ProgramError>(())
/// ```
pub fn replay<P: Program, G: Rng>(
    program: &P,
    trace: &Trace,
    rng: &mut G,
) -> Result<(Trace, P::Out), ProgramError> {
    let old = Old {
        trace: Some(trace),
        ..Old::default()
    };
    run(program, old, rng).map(|done| (done.trace, done.out))
}

/// A run with every choice drawn from its distribution, whatever the data: a prior predictive draw. Its weight is in
/// [`Trace::log_likelihood`].
///
/// # Errors
/// [`ProgramError::Duplicate`], [`ProgramError::NotANumber`].
pub fn prior<P: Program, G: Rng>(
    program: &P,
    rng: &mut G,
) -> Result<(Trace, P::Out), ProgramError> {
    run(program, Old::default(), rng).map(|done| (done.trace, done.out))
}
