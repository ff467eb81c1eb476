//! The walks of importance sampling (Sec. 6.1) as a probabilistic program.
//!
//! The paper takes the cheapest of many walks. The walks are draws as well: with q(g) the probability that a walk, its protection drawn
//! first, ends in the grammar g, and each draw weighted by `exp(-cost(g))`, they are draws of
//!
//! ```text
//! p(g) = q(g) exp(-cost(g)) / Z,    Z = Σ_g q(g) exp(-cost(g))
//! ```
//! with the cost (Eq. 1) read as nats. Few of them count: [`Posterior::ess`](edifice_model::program::Posterior::ess) says how many.
//!
//! # Deviations and readings
//! - The paper has no weights; without them nothing is said of the walks but which is the cheapest.
//! - The walks are those of approximate dynamic programming that always explores, number by number of its generator.

use std::ops::ControlFlow;

use edifice_base::Progress;
use edifice_base::rng::stream;
use edifice_model::program::{
    Dist, Draw, Handler, Posterior, Program, Real, Support, Value, importance_in_turn,
};
use edifice_optim::adp::{AdpError, Process};
use rand::{Rng, RngExt};

use crate::adp::feasible_candidates::draw;
use crate::adp::readings::Protect;
use crate::adp::search::Setup;
use crate::rules::AddRule;
use crate::settings::InferError;

/// The rules of a walk and their cost (Eq. 1).
pub(crate) type Walked = (Vec<AddRule>, f64);

/// A walk: which regions are protected (Sec. 4.7), then a rule for each type that needs one (Eq. 5).
pub(crate) struct Walk<'a> {
    search: &'a Setup<'a>,
    protect: Protect,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(search: &'a Setup<'a>) -> Self {
        let protect = search.settings.readings.protection.anew();
        Self { search, protect }
    }

    /// Draws what the walk protects.
    fn protect<H: Handler>(&self, h: &mut H) {
        let mut exploration = self.search.exploration.borrow_mut();
        let protection = exploration.protection();
        protection.restart();
        let Protect::Walk { draws } = self.protect else {
            return protection.lift();
        };
        if protection.total().is_none() {
            return;
        }
        for i in 0..h.sample("protections", Even(draws + 1)) {
            let scores = Sums(protection.scores(), false);
            let drawn = h.sample(("protected", i), scores);
            protection.keep(drawn);
        }
    }
}

impl Program for Walk<'_> {
    type Out = Walked;

    fn run<H: Handler>(&self, h: &mut H) -> Walked {
        self.protect(h);
        let process = self.search.process();
        let mut state = process.initial();
        let (mut rules, mut cost) = (Vec::new(), 0.0);
        while !process.is_final(&state) {
            let id = state.next();
            let step = rules.len();
            let candidate = self.search.exploration.borrow_mut().choose(
                &mut self.search.types.borrow_mut(),
                id,
                |sums| h.sample(("rule", step), Sums(sums, true)),
            );
            let rule = AddRule { id, candidate };
            let own = process.cost(&state, &rule);
            h.factor(H::Real::from(-own));
            cost += own;
            process.apply(&mut state, &rule);
            rules.push(rule);
        }
        (rules, cost)
    }
}

/// A place in a list of weights, of which the sums up to each are given; the last sum is above 0.
struct Sums<'a>(
    &'a [f64],
    /// True for the choice of a rule: a walk of approximate dynamic programming asks its generator first whether to explore.
    bool,
);

impl<R: Real> Dist<R> for Sums<'_> {
    type Value = usize;

    fn support(&self) -> Support {
        Support::Finite(self.0.len())
    }

    fn log_density(&self, x: &usize) -> R {
        let at = |i: usize| self.0.get(i).copied();
        let before = x.checked_sub(1).and_then(at).unwrap_or(0.0);
        let weight = at(*x).map_or(0.0, |sum| sum - before);
        R::from((weight / self.0[self.0.len() - 1]).ln())
    }

    fn draw<G: Rng>(&self, rng: &mut G) -> usize {
        if self.1 {
            let _explore: f64 = rng.random();
        }
        draw(self.0, rng)
    }

    fn store(&self, x: &usize) -> Value {
        Value::Whole(*x as u64)
    }

    fn load(&self, stored: &Value) -> Option<usize> {
        whole(stored, self.0.len())
    }

    fn constrain(&self, _: &[R]) -> Option<(usize, R)> {
        None
    }

    fn release(&self, _: &usize) -> Vec<f64> {
        Vec::new()
    }
}

/// The whole numbers below this one, all equally likely.
struct Even(usize);

impl<R: Real> Dist<R> for Even {
    type Value = usize;

    fn support(&self) -> Support {
        Support::Finite(self.0)
    }

    fn log_density(&self, x: &usize) -> R {
        R::from(match *x < self.0 {
            true => -(self.0 as f64).ln(),
            false => f64::NEG_INFINITY,
        })
    }

    fn draw<G: Rng>(&self, rng: &mut G) -> usize {
        rng.random_range(0..self.0)
    }

    fn store(&self, x: &usize) -> Value {
        Value::Whole(*x as u64)
    }

    fn load(&self, stored: &Value) -> Option<usize> {
        whole(stored, self.0)
    }

    fn constrain(&self, _: &[R]) -> Option<(usize, R)> {
        None
    }

    fn release(&self, _: &usize) -> Vec<f64> {
        Vec::new()
    }
}

/// A whole number below a count.
fn whole(stored: &Value, count: usize) -> Option<usize> {
    match stored {
        Value::Whole(x) => usize::try_from(*x).ok().filter(|x| *x < count),
        _ => None,
    }
}

impl Setup<'_> {
    /// Weighted walks, as many as the settings ask for iterations, unless the watch ends them or memory is used up.
    pub(crate) fn weighted_walks(&self) -> Result<Posterior<Walked>, InferError> {
        let (watch, process) = (self.watch("walks", 0), self.process());
        let mut rng = stream(self.settings.seed, "adp", 0);
        let mut best = f64::INFINITY;
        let mut done = 0;
        let told = |draw: &Draw<Walked>| {
            done += 1;
            best = best.min(draw.out.1);
            let progress = Progress {
                done,
                ..Progress::stage("walks")
            };
            match process.is_exhausted() {
                true => ControlFlow::Break(()),
                false => watch(progress.costs(draw.out.1, best)),
            }
        };
        let count = self.settings.iterations as usize;
        if count == 0 {
            return Err(AdpError::NoIterations.into());
        }
        Ok(importance_in_turn(&Walk::new(self), count, &mut rng, told)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::baselines::importance_sampling::NothingKnown;
    use crate::settings::Settings;
    use crate::{Method, Readings};
    use edifice_base::{Watched, unwatched};
    use edifice_model::program::exact;
    use edifice_optim::adp::{Adp, Epsilon};
    use edifice_shape::{Facade, Rect, Region};

    /// Cells of one metre with labels drawn from two.
    fn facade(columns: usize, rows: usize, seed: u64) -> Facade {
        let mut rng = stream(seed, "cells", 0);
        let cells = (0..columns * rows).map(|i| Region {
            label: ["wall", "window"][rng.random_range(0..2)].into(),
            rect: Rect::new((i % columns) as f64, (i / columns) as f64, 1.0, 1.0),
        });
        let cells = cells.collect();
        Facade::new("cells", "m", columns as f64, rows as f64, cells).unwrap()
    }

    fn settings(draws: usize, iterations: u64, seed: u64) -> Settings {
        Settings {
            method: Method::Importance,
            iterations,
            seed,
            readings: Readings {
                protection: Protect::Walk { draws },
                ..Readings::default()
            },
            ..Settings::default()
        }
    }

    #[test]
    fn walks_are_those_of_dynamic_programming_that_always_explores() {
        for seed in 0..5 {
            let facade = facade(5, 4, seed);
            let settings = settings(Protect::DRAWS, 200, seed);
            let watched = Watched::new(&unwatched);
            let new = || Setup::new(std::slice::from_ref(&facade), &settings, &watched).unwrap();
            let (search, other) = (new(), new());
            let own = search.weighted_walks().unwrap();
            let (rules, effective) = new().importance().unwrap();
            assert!((own.ess() - effective).abs() < 1e-9 * effective);
            let cheapest = own.draws.iter().map(|d| &d.out);
            let cheapest = cheapest.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
            assert_eq!(cheapest.0.len(), rules.len());
            let mut pairs = cheapest.0.iter().zip(&rules);
            assert!(
                pairs
                    .all(|(a, b)| a.id == b.id && a.candidate.successors == b.candidate.successors)
            );
            let own: Vec<f64> = own.draws.iter().map(|d| d.out.1).collect();
            let explore = other.explore(settings.readings.protection);
            let always = Epsilon::ALWAYS_EXPLORE;
            let adp = Adp::new(explore, NothingKnown, always, 200, seed);
            let run = adp.run(&mut other.process(), |_| {}).unwrap();
            let theirs: Vec<f64> = run.trace.iter().map(|step| step.cost).collect();
            assert_eq!(own, theirs);
        }
    }

    #[test]
    fn weighted_means_and_evidence_are_those_of_all_walks() {
        let mut covered = 0;
        for seed in 0..20 {
            let facade = facade(3, 2, seed);
            let settings = settings(2, 3000, seed);
            let watched = Watched::new(&unwatched);
            let search = Setup::new(&[facade], &settings, &watched).unwrap();
            let truth = exact(&Walk::new(&search)).unwrap();
            let found = search.weighted_walks().unwrap();
            let (z, known) = (found.evidence.unwrap(), truth.evidence.unwrap());
            assert!((z.log - known.log).abs() < 5.0 * z.error + 1e-9, "{seed}");
            let known = truth.estimate(|d| d.out.1).mean;
            let mean = found.estimate(|d| d.out.1);
            assert!(
                (mean.mean - known).abs() < 5.0 * mean.error + 1e-9,
                "{seed}"
            );
            covered +=
                u32::from((z.log - truth.evidence.unwrap().log).abs() <= 2.0 * z.error + 1e-9);
        }
        // An error bar of two deviations covers 95 of 100.
        assert!(covered >= 16, "{covered}");
    }
}
