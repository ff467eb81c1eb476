//! This project's own configuration: cost shares, walks by shortest paths, annealing.

use std::rc::Rc;

use super::choice::Router;
use super::infer::{InferError, Settings};
use super::members::Members;
use super::operations::Operations;
use super::search::Search;
use super::shares::{BoundLimits, Incumbent, Program, solve};
use super::walk::{AddRule, ShortestRoutes};
use crate::optim::Step;
use crate::optim::adp::Epsilon;
use crate::optim::annealing::{Annealing, Cooling};
use crate::shape::Facade;

impl Search<'_> {
    /// The optimum, where cost shares find and prove it. Else walks that exploit by shortest paths, then
    /// annealing over the set of types from the cheapest grammar found. Where cost shares cannot be tried, all
    /// walks of `paper` come first. Several facades start from the union of their own grammars. Also a bound below
    /// which no grammar costs, when there is one.
    pub fn best(
        &self,
        facades: &[Facade],
        mut observer: impl FnMut(Step) + Clone + 'static,
    ) -> Result<(Vec<AddRule>, Option<f64>), InferError> {
        let Settings {
            iterations,
            seed,
            readings,
            ..
        } = *self.settings;
        let union = match facades {
            [_] => None,
            _ => self.union(facades)?,
        };
        let (first, lower, learnt, steps) = match self.shared(facades, union.as_deref()) {
            Some(Shared { rules, cost, lower }) => {
                observer(Step {
                    iteration: 0,
                    cost,
                    best: cost,
                });
                if lower.is_some_and(|lower| cost <= lower + NOISE) {
                    return Ok((rules, lower));
                }
                (rules, lower, Vec::new(), 1)
            }
            None => {
                let (rules, learnt) = self.paper(observer.clone())?;
                (rules, None, learnt, iterations)
            }
        };
        let router = || Router::new(self.settings.costs, self.settings.operations);
        let share = share(iterations);
        let (by_routes, routes) = self.walks(
            self.explore(readings.protection.anew()),
            ShortestRoutes::new(router()),
            Epsilon::default(),
            share,
            later(steps, observer.clone()),
        )?;
        let start = self.cheapest([first, by_routes].into_iter().chain(union));
        let mut values = routes.into_values();
        for (value, learnt) in values.iter_mut().zip(learnt) {
            *value = value.min(learnt);
        }
        let members = Members::new(
            Rc::clone(&self.types),
            router(),
            Rc::clone(&self.exploration),
            values,
            &start,
        );
        let annealing = Annealing::new(COOLING, share, MOVES_PER_ROUND, seed)?
            .until(lower.map_or(f64::NEG_INFINITY, |cost| cost + NOISE));
        let (rules, ..) = annealing.run(members, later(steps + share, observer))?;
        Ok((rules, lower))
    }

    /// Cost shares from the rules of a known grammar, with work in proportion to the iterations and facades; `None` where
    /// the facades have too many places.
    fn shared(&self, facades: &[Facade], known: Option<&[AddRule]>) -> Option<Shared> {
        let Settings {
            iterations,
            costs,
            operations,
            ..
        } = self.settings;
        let work = usize::try_from(*iterations).unwrap_or(usize::MAX);
        let work = work.saturating_mul(ITEMS_PER_ITERATION);
        let without_grids = Operations {
            grid_split: false,
            ..*operations
        };
        let program = Program::new(facades, costs, without_grids, work / FEWEST_STEPS)?;
        let steps = (work.saturating_mul(facades.len()) / program.items.max(1)) as u64;
        let limits = BoundLimits {
            items: program.items,
            root_steps: ROOT_STEPS.min(steps),
            branch_steps: BRANCH_STEPS,
            nodes: 1 + MOST_BRANCHES.min(steps.saturating_sub(ROOT_STEPS) / BRANCH_STEPS),
        };
        let cost = known.map_or(f64::INFINITY, |rules| self.cost(rules));
        let mut incumbent = Incumbent::new(cost, costs);
        let (lower, _) = solve(&program, &mut incumbent, &limits);
        let rules = match known {
            Some(rules) if incumbent.cost >= cost => rules.to_vec(),
            _ => incumbent.rules(&program, &mut self.types.borrow_mut()),
        };
        Some(Shared {
            rules,
            cost: incumbent.cost,
            lower: (*operations == without_grids).then(|| incumbent.attainable(lower)),
        })
    }

    /// Eq. 1.
    fn cost(&self, rules: &[AddRule]) -> f64 {
        let costs = &self.settings.costs;
        rules.iter().map(|r| r.choice.cost(costs)).sum()
    }

    /// The cheapest of what was found and of what the deterministic baselines find; of several, the first.
    fn cheapest(&self, found: impl Iterator<Item = Vec<AddRule>>) -> Vec<AddRule> {
        let cheaper = |best: Vec<AddRule>, other: Vec<AddRule>| {
            if self.cost(&other) < self.cost(&best) {
                other
            } else {
                best
            }
        };
        let deterministic = cheaper(self.all_lines(), self.greedy());
        found.fold(deterministic, cheaper)
    }
}

/// What cost shares found.
struct Shared {
    rules: Vec<AddRule>,
    cost: f64,
    /// No grammar costs less; unknown when grids are allowed.
    lower: Option<f64>,
}

/// Walks by shortest paths, and rounds of annealing, in the second stage of `best`.
fn share(iterations: u64) -> u64 {
    (iterations / SECOND_STAGE_SHARE).max(1)
}

/// Steps of `best` at most, besides so many iterations: cost shares count as one, then come the walks and rounds of the
/// second stage.
pub(super) fn further_steps(iterations: u64) -> u64 {
    1 + 2 * share(iterations)
}

/// An observer of a stage before which so many steps were made.
fn later(before: u64, mut observer: impl FnMut(Step) + 'static) -> impl FnMut(Step) + 'static {
    move |step| {
        observer(Step {
            iteration: before + step.iteration,
            ..step
        })
    }
}

/// Items of rules that cost shares may look at for each iteration and facade: a tenth of a second or two for 10,000.
const ITEMS_PER_ITERATION: usize = 2_000;
/// Steps below which cost shares are not worth a start.
const FEWEST_STEPS: usize = 10;
/// Most steps before cost shares branch, and in each branch.
const ROOT_STEPS: u64 = 300;
const BRANCH_STEPS: u64 = 60;
/// Most branches of cost shares.
const MOST_BRANCHES: u64 = 30;
/// Noise of sums of costs.
const NOISE: f64 = 1e-6;
/// The second stage of `best` has one walk and one round of annealing for so many iterations.
const SECOND_STAGE_SHARE: u64 = 8;
/// Moves of a round of annealing.
const MOVES_PER_ROUND: u32 = 100;
/// Temperatures in units of cost: a move that adds a symbol is likely at first, unlikely at last.
const COOLING: Cooling = Cooling {
    start: 0.3,
    end: 0.05,
};
