//! The No-U-turn sampler for programs of real choices: the mathematics are those of the crate `nuts-rs`.
//!
//! Choices are freed of their bounds ([`Dist::constrain`]), so that the posterior is a density over all of `R^n`,
//! `log p(x(u), data) + Σ log |dx_i / du_i|`; its gradient is computed in reverse mode ([`super::reverse`]). Trajectories, the choice of
//! the next point and the adaptation of step and masses are `nuts-rs`'s.
//!
//! # Deviations and readings
//! - Chains start at uniform points of `[-2, 2]^n`, as Stan's do.
//! - Masses are a diagonal and the few directions in which draws and gradients are far from it, so that choices which the data tie to
//!   each other (a walk seen at its steps) do not slow the chains.
//!
//! Sources: Hoffman and Gelman 2014; Betancourt 2017; Seyboldt, Carlson and Carpenter 2025 (the adaptation of masses).

use std::collections::HashMap;

use nuts_rs::{
    Chain as _, CpuLogpFunc, CpuMath, CpuMathError, HasDims, LogpError, LowRankNutsSettings,
    Settings as _,
};
use rand::{Rng, RngExt};
use rayon::prelude::*;

use super::address::Address;
use super::dist::Dist;
use super::error::ProgramError;
use super::metropolis::Chains;
use super::posterior::{Draw, Kind, Posterior};
use super::real::Real;
use super::reverse::Tape;
use super::run::prior;
use super::trace::{Choice, Support, Trace};
use super::{Handler, Program};
use edifice_base::rng::{Stream, stream};

/// Starts that are tried for one of finite density and gradient.
const STARTS: usize = 1000;

/// Hamiltonian chains, in parallel, the same for any number of threads.
///
/// For programs that make the same real choices in every run. A draw costs up to 1024 runs of the program, with their gradients;
/// [`Posterior::diverging`] tells where trajectories went astray, which more than a few draws must not.
///
/// # Errors
/// [`ProgramError::NotReal`], [`ProgramError::Changing`], [`ProgramError::Impossible`] where no start has a density,
/// [`ProgramError::Setting`]; those of running the program.
///
/// # Examples
/// ```
/// use edifice_model::program::{Chains, Handler, Program, dist::{half_normal, normal}, nuts};
/// struct Line;
/// impl Program for Line {
///     type Out = ();
///     fn run<H: Handler>(&self, h: &mut H) {
///         let slope = h.sample("slope", normal(0.0, 10.0));
///         let noise = h.sample("noise", half_normal(1.0));
///         for (x, y) in [(1.0, 2.1), (2.0, 3.9), (3.0, 6.1), (4.0, 8.0)] {
///             h.observe(normal(slope * x, noise), &y.into());
///         }
///     }
/// }
/// let posterior = nuts(&Line, &Chains::default())?;
/// assert!((posterior.mean("slope").unwrap() - 2.0).abs() < 0.02);
/// assert!(posterior.summary().iter().all(|s| s.r_hat < 1.02));
/// # Ok::<(), edifice_model::program::ProgramError>(())
/// ```
pub fn nuts<P>(program: &P, settings: &Chains) -> Result<Posterior<P::Out>, ProgramError>
where
    P: Program + Sync,
    P::Out: Send,
{
    settings.check()?;
    let shape = Shape::of(program, settings.seed)?;
    let chains: Result<Vec<_>, ProgramError> = (0..settings.chains)
        .into_par_iter()
        .map(|i| {
            let mut rng = stream(settings.seed, "program/nuts", i as u64);
            chain(program, &shape, settings, i, &mut rng)
        })
        .collect();
    let (draws, diverging): (Vec<_>, Vec<_>) = chains?.into_iter().flatten().unzip();
    let mut posterior = Posterior::weighted(draws, 1);
    posterior.kind = Kind::Chains(settings.chains);
    posterior.diverging = diverging;
    Ok(posterior)
}

/// The choices of every run, and their free coordinates.
struct Shape {
    choices: Vec<(Address, usize)>,
    dimension: usize,
}

impl Shape {
    fn of<P: Program>(program: &P, seed: u64) -> Result<Self, ProgramError> {
        let (trace, _) = prior(program, &mut stream(seed, "program/nuts/shape", 0))?;
        let mut choices = Vec::with_capacity(trace.choices.len());
        for choice in trace.choices {
            match choice.support {
                Support::Real(n) => choices.push((choice.address, n)),
                _ => {
                    let at = choice.address.to_string();
                    return Err(ProgramError::NotReal { at });
                }
            }
        }
        let dimension = choices.iter().map(|(_, n)| n).sum();
        Ok(Self { choices, dimension })
    }
}

/// The draws of a chain, and whether each diverged.
#[allow(clippy::type_complexity)]
fn chain<P: Program>(
    program: &P,
    shape: &Shape,
    settings: &Chains,
    number: usize,
    rng: &mut Stream,
) -> Result<Vec<(Draw<P::Out>, bool)>, ProgramError> {
    let mut density = Density {
        program,
        shape,
        tape: Tape::default(),
    };
    let mut gradient = vec![0.0; shape.dimension];
    let mut start = vec![0.0; shape.dimension];
    let mut found = false;
    for _ in 0..STARTS {
        start
            .iter_mut()
            .for_each(|u| *u = rng.random_range(-2.0..2.0));
        match density.logp(&start, &mut gradient) {
            Ok(_) => {
                found = true;
                break;
            }
            Err(Astray(ProgramError::NotANumber { .. })) => {}
            Err(Astray(error)) => return Err(error),
        }
    }
    if !found {
        return Err(ProgramError::Impossible { tried: STARTS });
    }
    let mut draws = Vec::with_capacity(settings.draws);
    if shape.dimension == 0 {
        for _ in 0..settings.draws {
            draws.push((rebuild(program, shape, &[])?, false));
        }
        return Ok(draws);
    }
    let nuts = LowRankNutsSettings {
        num_tune: settings.warmup as u64,
        num_draws: settings.draws as u64,
        ..LowRankNutsSettings::default()
    };
    let stopped = |e: &dyn std::fmt::Display| ProgramError::Engine(format!("{e:#}"));
    let math = CpuMath::new(density);
    let mut sampler = nuts
        .new_chain(number as u64, math, rng)
        .map_err(|e| stopped(&e))?;
    sampler.set_position(&start).map_err(|e| stopped(&e))?;
    for n in 0..settings.warmup + settings.draws {
        let (position, progress) = sampler.draw().map_err(|e| stopped(&e))?;
        if n >= settings.warmup {
            draws.push((rebuild(program, shape, &position)?, progress.diverging));
        }
    }
    Ok(draws)
}

/// The run at free coordinates.
fn rebuild<P: Program>(
    program: &P,
    shape: &Shape,
    position: &[f64],
) -> Result<Draw<P::Out>, ProgramError> {
    let mut handler = Free::new(shape, position);
    let out = program.run(&mut handler);
    match handler.error {
        Some(error) => Err(error),
        None => Ok(Draw {
            trace: handler.trace,
            out,
            log_weight: 0.0,
        }),
    }
}

/// The log density over free coordinates.
struct Density<'p, P> {
    program: &'p P,
    shape: &'p Shape,
    tape: Tape,
}

/// A point without a density.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
struct Astray(ProgramError);

impl LogpError for Astray {
    fn is_recoverable(&self) -> bool {
        matches!(self.0, ProgramError::NotANumber { .. })
    }
}

impl<P> HasDims for Density<'_, P> {
    fn dim_sizes(&self) -> HashMap<String, u64> {
        let size = self.shape.dimension as u64;
        HashMap::from([("unconstrained_parameter".to_owned(), size)])
    }
}

impl<P: Program> CpuLogpFunc for Density<'_, P> {
    type LogpError = Astray;
    type FlowParameters = ();
    type ExpandedVector = Vec<f64>;

    fn dim(&self) -> usize {
        self.shape.dimension
    }

    fn logp(&mut self, position: &[f64], gradient: &mut [f64]) -> Result<f64, Astray> {
        self.tape.clear();
        let variables: Vec<_> = position.iter().map(|&u| self.tape.variable(u)).collect();
        let mut handler = Free::new(self.shape, &variables);
        self.program.run(&mut handler);
        if let Some(error) = handler.error {
            return Err(Astray(error));
        }
        let log = handler.log;
        gradient.copy_from_slice(&self.tape.gradient(log, position.len()));
        match log.value().is_finite() && gradient.iter().all(|g| g.is_finite()) {
            true => Ok(log.value()),
            false => Err(Astray(ProgramError::NotANumber {
                at: "the gradient".to_owned(),
            })),
        }
    }

    fn expand_vector<R: Rng + ?Sized>(
        &mut self,
        _: &mut R,
        position: &[f64],
    ) -> Result<Vec<f64>, CpuMathError> {
        Ok(position.to_vec())
    }
}

/// Runs at free coordinates.
struct Free<'a, R> {
    shape: &'a Shape,
    free: &'a [R],
    /// Choices made, and coordinates used.
    at: (usize, usize),
    log: R,
    trace: Trace,
    error: Option<ProgramError>,
}

impl<'a, R: Real> Free<'a, R> {
    fn new(shape: &'a Shape, free: &'a [R]) -> Self {
        Self {
            shape,
            free,
            at: (0, 0),
            log: R::from(0.0),
            trace: Trace::default(),
            error: None,
        }
    }

    fn fail(&mut self, error: ProgramError) {
        self.error.get_or_insert(error);
    }
}

impl<R: Real> Handler for Free<'_, R> {
    type Real = R;

    fn sample<D: Dist<R>>(&mut self, at: impl Into<Address>, d: D) -> D::Value {
        let address = at.into();
        let (choice, start) = self.at;
        let expected = self.shape.choices.get(choice);
        let width = match expected {
            Some((a, n)) if *a == address && d.support() == Support::Real(*n) => *n,
            _ => {
                let at = address.to_string();
                self.fail(ProgramError::Changing { at });
                return d.draw(&mut stream(0, "program/failed", 0));
            }
        };
        self.at = (choice + 1, start + width);
        let Some((value, volume)) = d.constrain(&self.free[start..start + width]) else {
            let at = address.to_string();
            self.fail(ProgramError::NotReal { at });
            return d.draw(&mut stream(0, "program/failed", 0));
        };
        let log_density = d.log_density(&value);
        if log_density.value().is_nan() || volume.value().is_nan() {
            let at = address.to_string();
            self.fail(ProgramError::NotANumber { at });
        }
        self.log = self.log + log_density + volume;
        self.trace.push(Choice {
            value: d.store(&value),
            log_density: log_density.value(),
            support: d.support(),
            address,
        });
        value
    }

    fn observe<D: Dist<R>>(&mut self, d: D, x: &D::Value) {
        let log = d.log_density(x);
        self.factor(log);
    }

    fn factor(&mut self, log: R) {
        if log.value().is_nan() || log.value() == f64::INFINITY {
            let at = format!("observation {}", self.trace.stages.len() + 1);
            self.fail(ProgramError::NotANumber { at });
        }
        self.trace.weigh(log.value());
        self.log = self.log + log;
    }
}
