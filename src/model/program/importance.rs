//! Importance sampling: runs by the prior, weighted by what the data say of them.
//!
//! `Z = E[w]` over runs with `w = Π_j w_j`, and posterior means are `Σ w f / Σ w`. The standard error of `log Z` is
//! `sqrt(1 / ESS - 1 / N)`, with `ESS = (Σ w)² / Σ w²`, to first order.

use std::ops::ControlFlow;

use rand::Rng;
use rayon::prelude::*;

use super::Program;
use super::error::ProgramError;
use super::pareto::pareto_k;
use super::posterior::{Draw, Evidence, Posterior};
use super::run::{Old, run};
use crate::linalg::log_sum_exp;
use edifice_base::rng::stream;

/// `count` weighted runs, in parallel, each with its own stream of `seed`: the same for any number of threads.
///
/// Unbiased in Z; good where the prior is not far from the posterior, which [`Posterior::pareto_k`] below 0.7 says. `count` runs of
/// the program. Source: Robert and Casella 2004, Ch. 3.
///
/// # Errors
/// [`ProgramError::Impossible`] where no run has a weight; those of running the program.
///
/// # Examples
/// [`given`](super::given) and [`Posterior::predictive`] have some.
pub fn importance<P>(
    program: &P,
    count: usize,
    seed: u64,
) -> Result<Posterior<P::Out>, ProgramError>
where
    P: Program + Sync,
    P::Out: Send,
{
    let one = |i: usize| {
        let mut rng = stream(seed, "program/importance", i as u64);
        let done = run(program, Old::default(), &mut rng)?;
        Ok(Draw {
            log_weight: done.trace.log_likelihood(),
            trace: done.trace,
            out: done.out,
        })
    };
    let draws: Result<Vec<Draw<P::Out>>, ProgramError> =
        (0..count).into_par_iter().map(one).collect();
    judged(draws?)
}

/// As [`importance`], one run after the other with the numbers of one generator: for programs that threads cannot share.
///
/// `observer` is told of every draw, its weight not yet divided by their sum, and ends the runs with [`ControlFlow::Break`].
///
/// # Errors
/// As [`importance`].
///
/// # Examples
/// Until three heads have been seen:
/// ```
/// use std::ops::ControlFlow;
/// use edifice_base::rng::stream;
/// use edifice_model::program::{Handler, Program, dist::bernoulli, importance_in_turn};
/// struct Coin;
/// impl Program for Coin {
///     type Out = bool;
///     fn run<H: Handler>(&self, h: &mut H) -> bool {
///         h.sample("coin", bernoulli(0.5))
///     }
/// }
/// let mut heads = 0;
/// let found = importance_in_turn(&Coin, 1000, &mut stream(1, "coins", 0), |draw| {
///     heads += u32::from(draw.out);
///     if heads < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
/// })?;
/// assert_eq!(found.draws.iter().filter(|d| d.out).count(), 3);
/// assert!((found.ess() - found.draws.len() as f64).abs() < 1e-9);
/// # Ok::<(), edifice_model::program::ProgramError>(())
/// ```
pub fn importance_in_turn<P: Program, G: Rng>(
    program: &P,
    count: usize,
    rng: &mut G,
    mut observer: impl FnMut(&Draw<P::Out>) -> ControlFlow<()>,
) -> Result<Posterior<P::Out>, ProgramError> {
    let mut draws = Vec::new();
    for _ in 0..count {
        let done = run(program, Old::default(), rng)?;
        let draw = Draw {
            log_weight: done.trace.log_likelihood(),
            trace: done.trace,
            out: done.out,
        };
        let answer = observer(&draw);
        draws.push(draw);
        if answer.is_break() {
            break;
        }
    }
    judged(draws)
}

/// The posterior of draws whose weights are not yet divided by their sum.
fn judged<T>(draws: Vec<Draw<T>>) -> Result<Posterior<T>, ProgramError> {
    let count = draws.len();
    let logs: Vec<f64> = draws.iter().map(|d| d.log_weight).collect();
    let total = log_sum_exp(&logs);
    if total == f64::NEG_INFINITY {
        return Err(ProgramError::Impossible { tried: count });
    }
    let mut posterior = Posterior::weighted(draws, count);
    let n = count as f64;
    posterior.evidence = Some(Evidence {
        log: total - n.ln(),
        error: (1.0 / posterior.ess() - 1.0 / n).max(0.0).sqrt(),
    });
    posterior.pareto_k = Some(pareto_k(&logs));
    Ok(posterior)
}
