//! This project's own configuration: the Lagrangian bound, walks by shortest paths, annealing.

use std::rc::Rc;

use super::adp::search::Setup;
use super::adp::walk::ShortestPathRules;
use super::annealing::NonterminalSet;
use super::bound::{few_rules, saved_by_grids};
use super::lagrangian::{BoundLimits, Incumbent, NOISE, Program, solve};
use super::rules::RulePricer;
use super::settings::{InferError, Settings, second_stage_steps};
use crate::rules::AddRule;
use edifice_base::Progress;
use edifice_optim::adp::Epsilon;
use edifice_optim::annealing::{Annealing, Cooling};
use edifice_optim::tell;
use edifice_shape::Facade;

/// Rules found, and a bound below which no grammar costs.
type Found = (Vec<AddRule>, f64);

impl Setup<'_> {
    /// The default method, in stages:
    ///
    /// 1. several facades start from the union of their own grammars;
    /// 2. the Lagrangian bound, which ends the search when it proves its grammar optimal; where there are too many
    ///    items for it, walks of `paper`;
    /// 3. walks that exploit by shortest paths;
    /// 4. annealing over the set of non-terminal types, from the cheapest grammar so far.
    ///
    /// Everything ends when a limit of memory is reached, or when the search is stopped.
    pub(crate) fn best(&self, facades: &[Facade]) -> Result<Found, InferError> {
        if !self.watched.goes_on(Progress::stage("Lagrangian bound")) {
            return Ok((self.cheapest(std::iter::empty()), self.few_rules(facades)));
        }
        let union = match facades {
            [_] => None,
            _ => self.union(facades)?,
        };
        let Some(found) = self.bounded(facades, union.as_deref()) else {
            return self.best_unbounded(facades, union);
        };
        let Bounded { rules, cost, lower } = found;
        let first = Progress::of("Lagrangian bound", 1, self.settings.steps());
        let goes_on = self.watched.goes_on(first.costs(cost, cost));
        if cost <= lower + NOISE {
            return Ok((rules, lower));
        }
        let start = [rules].into_iter().chain(union);
        if !goes_on {
            return Ok((self.cheapest(start), lower));
        }
        let iterations = self.settings.iterations;
        self.second_stage(start, lower, Vec::new(), iterations, 1)
    }

    /// [`Setup::best`] where there are too many items for the Lagrangian bound.
    fn best_unbounded(
        &self,
        facades: &[Facade],
        union: Option<Vec<AddRule>>,
    ) -> Result<Found, InferError> {
        let terminals: usize = facades.iter().map(|f| f.regions.len()).sum();
        let most = MOST_WALKED / terminals as u64;
        let iterations = self.settings.iterations.min(most).max(1);
        self.types.borrow_mut().limit = MOST_STRIPS;
        if self.watched.is_stopped() {
            return Ok((self.cheapest(union.into_iter()), self.few_rules(facades)));
        }
        let (walked, learnt) = self.paper(iterations)?;
        let start = [walked].into_iter().chain(union);
        self.second_stage(
            start,
            self.few_rules(facades),
            learnt,
            iterations,
            iterations,
        )
    }

    /// Walks by shortest paths, then annealing, before which so many steps were made. `learnt` estimates `V(R)` by type.
    fn second_stage(
        &self,
        found: impl Iterator<Item = Vec<AddRule>>,
        lower: f64,
        learnt: Vec<f64>,
        iterations: u64,
        before: u64,
    ) -> Result<Found, InferError> {
        let over = || self.types.borrow().is_full() || self.watched.is_stopped();
        if over() {
            return Ok((self.cheapest(found), lower));
        }
        let Settings { costs, seed, .. } = *self.settings;
        let pricer = || RulePricer::new(costs, self.settings.operations);
        let rounds = second_stage_steps(iterations);
        let (walked, paths) = self.walks(
            self.explore(self.settings.readings.protection.anew()),
            ShortestPathRules::new(pricer()),
            Epsilon::default(),
            rounds,
            before,
        )?;
        // Of equally cheap grammars the first stays: those found before come first.
        let mut found: Vec<Vec<AddRule>> = found.collect();
        found.insert(found.len().min(1), walked);
        let start = self.cheapest(found.into_iter());
        if over() {
            return Ok((start, lower));
        }
        let mut values = paths.into_values();
        for (value, learnt) in values.iter_mut().zip(learnt) {
            *value = value.min(learnt);
        }
        let mut set = NonterminalSet::new(
            Rc::clone(&self.types),
            pricer(),
            Rc::clone(&self.exploration),
            values,
            &start,
        );
        let annealing =
            Annealing::new(COOLING, rounds, MOVES_PER_ROUND, seed)?.until(lower + NOISE);
        let before = before + rounds;
        let watch = self.watch("annealing", before);
        let run = annealing.run(&mut set, tell(&watch, None))?;
        Ok((run.best, lower))
    }

    /// The Lagrangian bound from the rules of a known grammar, with work in proportion to the iterations and facades; `None`
    /// where there are too many rules.
    fn bounded(&self, facades: &[Facade], known: Option<&[AddRule]>) -> Option<Bounded> {
        let Settings {
            iterations,
            costs,
            operations,
            ..
        } = self.settings;
        let work = usize::try_from(*iterations).unwrap_or(usize::MAX);
        let work = work.saturating_mul(ITEMS_PER_ITERATION);
        let program = Program::new(
            self.fresh.clone(),
            costs,
            operations.without_grids(),
            MOST_ITEMS.min(work / FEWEST_STEPS),
            self.watched,
        )?;
        let limits = BoundLimits {
            items: program.items,
            root_steps: ROOT_STEPS,
            branch_steps: BRANCH_STEPS,
            nodes: MOST_BRANCHES,
            work: work.saturating_mul(facades.len()) as u64,
        };
        let cost = known.map_or(f64::INFINITY, |rules| self.cost(rules));
        let mut incumbent = Incumbent::new(cost, costs, operations.without_grids());
        incumbent.watched = Some(self.watched);
        let (lower, _) = solve(program, &mut incumbent, &limits);
        let rules = match known {
            Some(rules) if incumbent.cost >= cost => rules.to_vec(),
            _ => incumbent.rules(&mut self.types.borrow_mut()),
        };
        let lower = incumbent.round_up(lower);
        Some(Bounded {
            rules,
            cost: incumbent.cost,
            lower: match operations.grid_split {
                false => lower,
                true => {
                    let extents = self.fresh.extents().into_iter();
                    let most = extents.map(|(x, y)| x.max(y)).max().unwrap_or(0);
                    (lower * saved_by_grids(costs, most)).max(self.few_rules(facades))
                }
            },
        })
    }

    /// The bound of labels and of regions in a row.
    fn few_rules(&self, facades: &[Facade]) -> f64 {
        few_rules(facades, &self.settings.costs, self.settings.operations)
    }

    /// Cost of the grammar of some rules (Eq. 1).
    pub(crate) fn cost(&self, rules: &[AddRule]) -> f64 {
        let costs = &self.settings.costs;
        rules.iter().map(|r| r.candidate.cost(costs)).sum()
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

/// Result of the Lagrangian bound: the best rules, their cost, and the lower bound.
struct Bounded {
    rules: Vec<AddRule>,
    cost: f64,
    /// No grammar costs less.
    lower: f64,
}

/// Items of rules that the Lagrangian bound may look at for each iteration and facade: a second or two for 10,000.
const ITEMS_PER_ITERATION: usize = 9_000;
/// Items of rules, some 30 bytes each, beyond which the Lagrangian bound is not tried.
const MOST_ITEMS: usize = 2_000_000;
/// Steps below which the Lagrangian bound is not worth a start.
const FEWEST_STEPS: usize = 10;
/// Most steps before branching, and in each branch.
const ROOT_STEPS: u64 = 2_000;
const BRANCH_STEPS: u64 = 100;
/// Maximum number of branches examined.
const MOST_BRANCHES: u64 = 1_000;
/// Strips of all types, some 50 bytes each with what exploration knows of them, beyond which layouts without a Lagrangian
/// bound are searched no further. Only layouts of a thousand regions and more without any structure have so many.
const MOST_STRIPS: usize = 8_000_000;
/// Regions that the walks over layouts without a Lagrangian bound may derive, all walks together.
const MOST_WALKED: u64 = 3_000_000;
/// Moves of a round of annealing.
const MOVES_PER_ROUND: u32 = 100;
/// Temperatures in units of cost: a move that adds a symbol is likely at first, unlikely at last.
const COOLING: Cooling = Cooling {
    start: 0.3,
    end: 0.05,
};
