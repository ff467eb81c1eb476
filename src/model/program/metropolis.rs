//! Metropolis-Hastings, one choice at a time, for any program.
//!
//! A choice i of the run x is picked uniformly, changed, and the program run again with all other choices kept where it still comes to
//! them. With `F` the log density of choices that only the new run x' makes, drawn from their distributions, and `S` that of
//! those that only x made, x' is accepted with probability
//!
//! ```text
//! min(1, exp(log p(x', data) - log p(x, data) + log q(x_i | x_i') - log q(x_i' | x_i) + S - F) n(x) / n(x'))
//! ```
//! with n the number of choices. Real choices walk by normal steps in free coordinates (logarithms of positive ones, log odds of
//! bounded ones), counts by whole steps, finite ones to any other value; one change in ten is a draw of the prior.
//!
//! # Deviations and readings
//! - The width of steps is adapted for each address, towards 44 % of accepted walks, during the warm-up only (Roberts and Rosenthal 2009).
//! - A draw is as many changes as the run had choices at the end of the warm-up.
//!
//! Sources: Wingate, Stuhlmüller and Goodman 2011; Hastings 1970; Green 1995.

use rand::RngExt;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::Program;
use super::address::Address;
use super::error::ProgramError;
use super::posterior::{Draw, Kind, Posterior};
use super::run::{Change, Done, Old, run};
use super::trace::Trace;
use edifice_base::rng::{Stream, stream};

/// Share of accepted walks that the width is adapted to.
const ACCEPTED: f64 = 0.44;
/// Share of changes that are draws of the prior.
const FRESH: f64 = 0.1;
/// Runs of the prior that are tried for a start of positive weight.
const STARTS: usize = 1000;

/// Chains, and how long they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chains {
    /// Number of chains; R-hat needs 2.
    pub chains: usize,
    /// Draws of each chain that are used to adapt and then dropped.
    pub warmup: usize,
    /// Draws of each chain that are kept.
    pub draws: usize,
    /// Names all randomness.
    pub seed: u64,
}

impl Default for Chains {
    fn default() -> Self {
        Self {
            chains: 4,
            warmup: 1000,
            draws: 1000,
            seed: 1,
        }
    }
}

impl Chains {
    pub(super) fn check(&self) -> Result<(), ProgramError> {
        let wrong = |name, must| Err(ProgramError::Setting { name, must });
        match (self.chains, self.draws) {
            (0, _) => wrong("chains", "at least 1"),
            (_, 0) => wrong("draws", "at least 1"),
            _ => Ok(()),
        }
    }
}

/// Chains of single changes, in parallel, the same for any number of threads; each begins with a run of the prior.
///
/// A draw costs as many runs of the program as it has choices.
///
/// # Errors
/// [`ProgramError::Impossible`] where no start has a weight, [`ProgramError::Setting`]; those of running the program.
///
/// # Examples
/// A number of terms that is itself chosen:
/// ```
/// use edifice_model::program::{Chains, Handler, Program, dist::{binomial, normal, poisson}, exact, metropolis};
/// struct Dice;
/// impl Program for Dice {
///     type Out = u64;
///     fn run<H: Handler>(&self, h: &mut H) -> u64 {
///         let count = h.sample("count", binomial(4, 0.5));
///         let sum: u64 = (0..count as usize).map(|i| h.sample(("die", i), binomial(2, 0.5))).sum();
///         h.observe(normal(sum as f64, 0.5), &4.0.into());
///         count
///     }
/// }
/// let chains = metropolis(&Dice, &Chains { draws: 4000, ..Chains::default() })?;
/// let truth = exact(&Dice)?;
/// for value in 0..=4 {
///     let (found, known) = (chains.probability("count", value), truth.probability("count", value));
///     assert!((found.mean - known.mean).abs() < 0.03, "{value}: {found:?} {known:?}");
/// }
/// # Ok::<(), edifice_model::program::ProgramError>(())
/// ```
pub fn metropolis<P>(program: &P, settings: &Chains) -> Result<Posterior<P::Out>, ProgramError>
where
    P: Program + Sync,
    P::Out: Clone + Send,
{
    settings.check()?;
    let chains: Result<Vec<_>, ProgramError> = (0..settings.chains)
        .into_par_iter()
        .map(|i| {
            let mut rng = stream(settings.seed, "program/metropolis", i as u64);
            chain(program, settings, &mut rng)
        })
        .collect();
    let chains = chains?;
    let accepted: f64 = chains.iter().map(|(_, share)| share).sum();
    let draws: Vec<Draw<P::Out>> = chains.into_iter().flat_map(|(draws, _)| draws).collect();
    let mut posterior = Posterior::weighted(draws, 1);
    posterior.kind = Kind::Chains(settings.chains);
    posterior.acceptance = Some(accepted / settings.chains as f64);
    Ok(posterior)
}

/// The draws of a chain, and the share of changes that were accepted.
type Chain<T> = (Vec<Draw<T>>, f64);

/// Runs a chain.
fn chain<P: Program>(
    program: &P,
    settings: &Chains,
    rng: &mut Stream,
) -> Result<Chain<P::Out>, ProgramError>
where
    P::Out: Clone,
{
    let (mut trace, mut out) = start(program, rng)?;
    let mut widths: FxHashMap<Address, (f64, u32)> = FxHashMap::default();
    let mut draws = Vec::with_capacity(settings.draws);
    let (mut accepted, mut tried) = (0_usize, 0_usize);
    let mut changes = trace.choices.len().max(1);
    for n in 0..settings.warmup + settings.draws {
        let adapting = n < settings.warmup;
        if adapting {
            changes = trace.choices.len().max(1);
        }
        for _ in 0..changes {
            let Some(next) = change(program, &trace, &mut widths, adapting, rng)? else {
                tried += usize::from(!adapting);
                continue;
            };
            (trace, out) = next;
            tried += usize::from(!adapting);
            accepted += usize::from(!adapting);
        }
        if !adapting {
            draws.push(Draw {
                trace: trace.clone(),
                out: out.clone(),
                log_weight: 0.0,
            });
        }
    }
    Ok((draws, accepted as f64 / tried.max(1) as f64))
}

/// A run of positive weight.
fn start<P: Program>(program: &P, rng: &mut Stream) -> Result<(Trace, P::Out), ProgramError> {
    for _ in 0..STARTS {
        let Done { trace, out, .. } = run(program, Old::default(), rng)?;
        if trace.log_joint() > f64::NEG_INFINITY {
            return Ok((trace, out));
        }
    }
    Err(ProgramError::Impossible { tried: STARTS })
}

/// One change; nothing where it is refused.
fn change<P: Program>(
    program: &P,
    trace: &Trace,
    widths: &mut FxHashMap<Address, (f64, u32)>,
    adapting: bool,
    rng: &mut Stream,
) -> Result<Option<(Trace, P::Out)>, ProgramError> {
    if trace.choices.is_empty() {
        return Ok(None);
    }
    let at = &trace.choices[rng.random_range(0..trace.choices.len())].address;
    let fresh = rng.random::<f64>() < FRESH;
    let (width, count) = *widths.entry(at.clone()).or_insert((0.0, 0));
    let how = match fresh {
        true => Change::Fresh,
        false => Change::Walk(width.exp()),
    };
    let old = Old {
        trace: Some(trace),
        until: None,
        change: Some((at, how)),
    };
    let probability = |done: &Done<P::Out>| {
        let (old, new) = (trace.choices.len() as f64, done.trace.choices.len() as f64);
        let stale = trace.log_prior() - done.kept;
        let gain = done.trace.log_joint() - trace.log_joint();
        (gain + done.ratio + stale - done.fresh + (old / new).ln())
            .min(0.0)
            .exp()
    };
    // A walk may lead to parameters out of range for a later choice that is kept: such a run has no weight.
    let (done, p) = match run(program, old, rng) {
        Ok(done) => {
            let p = probability(&done);
            (Some(done), if p.is_nan() { 0.0 } else { p })
        }
        Err(ProgramError::NotANumber { .. }) if !fresh => (None, 0.0),
        Err(error) => return Err(error),
    };
    if adapting && !fresh {
        let pace = (f64::from(count) + 1.0).powf(-0.6);
        widths.insert(at.clone(), (width + pace * (p - ACCEPTED), count + 1));
    }
    let taken = rng.random::<f64>() < p;
    Ok(done.filter(|_| taken).map(|d| (d.trace, d.out)))
}
