//! Sequential Monte Carlo over the observations and factors of a program.
//!
//! Particles are runs. At the j-th observation each is weighted by `w_j`; when the effective number of particles falls below half,
//! they are drawn anew by their weights, and what they choose after the observation is chosen anew. With `W_i` the normalised
//! weights before, Z is estimated by `Π_j Σ_i W_i w_j(x_i)`, without bias.
//!
//! # Deviations and readings
//! - A particle is always a whole run, so that its weights at all later observations are known at once; only those copies that share an ancestor run again
//!   after resampling (the first one may keep its future, which the weights so far do not depend on).
//! - A run with fewer observations than others has the weight 1 at those that it lacks.
//! - The particles are [`ISLANDS`] independent groups; the spread of their estimates gives the errors of Z and of means.
//! - Resampling is systematic.
//!
//! Sources: Doucet, de Freitas and Gordon 2001; Wood, van de Meent and Mansinghka 2014; Whiteley, Lee and Heine 2016 (adaptive resampling).

use rand::{Rng, RngExt};
use rayon::prelude::*;

use super::Program;
use super::error::ProgramError;
use super::posterior::{Draw, Evidence, Posterior};
use super::run::{Done, Old, run};
use super::trace::Trace;
use crate::linalg::log_sum_exp;
use edifice_base::rng::{Stream, stream};

/// Independent groups of particles.
pub(super) const ISLANDS: usize = 32;
/// Share of the particles below which they are resampled.
const LEAST_SHARE: f64 = 0.5;

/// `count` particles, rounded up to a multiple of `ISLANDS`; the same for any number of threads.
///
/// Runs of the program: one a particle, and one for each copy after a resampling. Good where observations come one after the other,
/// and each says something of the choices just before it.
///
/// # Errors
/// [`ProgramError::Impossible`] where no run has a weight; those of running the program.
///
/// # Examples
/// A hidden Markov chain; Z is known from the forward recursion.
/// ```
/// use edifice_model::program::{Handler, Program, dist::{bernoulli, normal}, exact, smc};
/// struct Chain;
/// impl Program for Chain {
///     type Out = bool;
///     fn run<H: Handler>(&self, h: &mut H) -> bool {
///         let mut state = false;
///         for (i, seen) in [0.1, 0.8, 1.2, 0.9, -0.2, 1.1].into_iter().enumerate() {
///             state = h.sample(("state", i), bernoulli(if state { 0.8 } else { 0.2 }));
///             h.observe(normal(if state { 1.0 } else { 0.0 }, 0.5), &seen.into());
///         }
///         state
///     }
/// }
/// let (sampled, truth) = (smc(&Chain, 3200, 1)?, exact(&Chain)?);
/// let (z, known) = (sampled.evidence.unwrap(), truth.evidence.unwrap());
/// assert!((z.log - known.log).abs() < 4.0 * z.error);
/// for b in sampled.beside(&truth) {
///     assert!(b.error().abs() < 0.05, "{b:?}");
/// }
/// # Ok::<(), edifice_model::program::ProgramError>(())
/// ```
pub fn smc<P>(program: &P, count: usize, seed: u64) -> Result<Posterior<P::Out>, ProgramError>
where
    P: Program + Sync,
    P::Out: Clone + Send,
{
    let size = count.div_ceil(ISLANDS).max(1);
    let islands: Result<Vec<Island<P::Out>>, ProgramError> = (0..ISLANDS)
        .into_par_iter()
        .map(|i| island(program, size, &mut stream(seed, "program/smc", i as u64)))
        .collect();
    let islands = islands?;
    let logs: Vec<f64> = islands.iter().map(|i| i.log_evidence).collect();
    let (total, m) = (log_sum_exp(&logs), ISLANDS as f64);
    if total == f64::NEG_INFINITY {
        let tried = size * ISLANDS;
        return Err(ProgramError::Impossible { tried });
    }
    // Relative deviations of the islands' estimates from their mean.
    let mean = total - m.ln();
    let off = logs.iter().map(|l| ((l - mean).exp() - 1.0).powi(2));
    let error = (off.sum::<f64>() / (m * (m - 1.0))).sqrt();
    let draws = islands.into_iter().flat_map(|i| i.draws).collect();
    let mut posterior = Posterior::weighted(draws, ISLANDS);
    posterior.evidence = Some(Evidence { log: mean, error });
    Ok(posterior)
}

struct Island<T> {
    /// With weights that sum to the island's evidence.
    draws: Vec<Draw<T>>,
    log_evidence: f64,
}

fn island<P: Program>(
    program: &P,
    size: usize,
    rng: &mut Stream,
) -> Result<Island<P::Out>, ProgramError>
where
    P::Out: Clone,
{
    let mut particles = Vec::with_capacity(size);
    for _ in 0..size {
        let Done { trace, out, .. } = run(program, Old::default(), rng)?;
        particles.push((trace, out));
    }
    // Log weights up to the last resampling are in `evidence`; since then each particle has gained from `from` on.
    let (mut evidence, mut from) = (0.0, 0);
    let mut stage = 0;
    while particles.iter().any(|(t, _)| t.stages.len() > stage) {
        stage += 1;
        let gains: Vec<f64> = particles
            .iter()
            .map(|(t, _)| gain(t, from, stage))
            .collect();
        let total = log_sum_exp(&gains);
        if total == f64::NEG_INFINITY {
            break;
        }
        let squares: f64 = gains.iter().map(|g| (2.0 * (g - total)).exp()).sum();
        let more = particles.iter().any(|(t, _)| t.stages.len() > stage);
        if !more || 1.0 / squares >= LEAST_SHARE * size as f64 {
            continue;
        }
        evidence += total - (size as f64).ln();
        from = stage;
        let parents = systematic(&gains, total, rng);
        let mut next = Vec::with_capacity(size);
        for (i, &parent) in parents.iter().enumerate() {
            if i == 0 || parents[i - 1] != parent {
                next.push(particles[parent].clone());
                continue;
            }
            let old = Old {
                trace: Some(&particles[parent].0),
                until: Some(stage),
                change: None,
            };
            let Done { trace, out, .. } = run(program, old, rng)?;
            next.push((trace, out));
        }
        particles = next;
    }
    let gains: Vec<f64> = particles
        .iter()
        .map(|(t, _)| gain(t, from, stage.max(from)))
        .collect();
    let base = evidence - (size as f64).ln();
    let log_evidence = base + log_sum_exp(&gains);
    let draws = particles
        .into_iter()
        .zip(gains)
        .map(|((trace, out), g)| Draw {
            trace,
            out,
            log_weight: base + g,
        });
    Ok(Island {
        draws: draws.collect(),
        log_evidence,
    })
}

/// Log weight that a run gains from observation `from` to `to`.
fn gain(trace: &Trace, from: usize, to: usize) -> f64 {
    let at = |stage: usize| match stage.min(trace.stages.len()) {
        0 => 0.0,
        n => trace.stages[n - 1],
    };
    match at(to) {
        f64::NEG_INFINITY => f64::NEG_INFINITY,
        log => log - at(from),
    }
}

/// Parents of the next particles, rising.
fn systematic<R: Rng>(gains: &[f64], total: f64, rng: &mut R) -> Vec<usize> {
    let n = gains.len();
    let start = rng.random::<f64>();
    let (mut parents, mut sum, mut last) = (Vec::with_capacity(n), 0.0, 0);
    for (i, g) in gains.iter().enumerate() {
        let share = (g - total).exp();
        if share > 0.0 {
            last = i;
        }
        sum += share * n as f64;
        while parents.len() < n && parents.len() as f64 + start < sum {
            parents.push(i);
        }
    }
    parents.resize(n, last);
    parents
}
