//! The methods of inference, as far as they share what they start from.

use std::cell::RefCell;
use std::rc::Rc;

use super::baselines;
use super::choice::Router;
use super::exploitation::{AllRules, Remembered};
use super::exploration::{Exploration, Lambdas};
use super::extract;
use super::infer::{InferError, Settings};
use super::members::Members;
use super::readings::{Exploit, Protect};
use super::regions::Types;
use super::symmetry;
use super::walk::{AddRule, Explore, Inference, NothingKnown, SharedTypes, ShortestRoutes};
use crate::grammar::Grammar;
use crate::optim::Step;
use crate::optim::adp::{Adp, Approximation, Epsilon};
use crate::optim::annealing::{Annealing, Cooling};
use crate::shape::Facade;

/// What every method starts from, and the methods.
pub(super) struct Search<'a> {
    settings: &'a Settings,
    types: SharedTypes,
    exploration: Rc<RefCell<Exploration>>,
}

impl<'a> Search<'a> {
    pub fn new(facades: &[Facade], settings: &'a Settings) -> Self {
        let mut types = Types::new(facades);
        let repeated = symmetry::detect(&mut types);
        let lambdas = Lambdas {
            rule: settings.lambda_rule,
            lines: settings.lambda_lines,
        };
        let exploration = Exploration::new(
            &types,
            repeated,
            settings.costs,
            settings.operations,
            lambdas,
        );
        Self {
            settings,
            types: Rc::new(RefCell::new(types)),
            exploration: Rc::new(RefCell::new(exploration)),
        }
    }

    fn process(&self) -> Inference {
        Inference {
            types: Rc::clone(&self.types),
            costs: self.settings.costs,
        }
    }

    fn explore(&self, protect: Protect) -> Explore {
        Explore::new(
            Rc::clone(&self.types),
            Rc::clone(&self.exploration),
            protect,
        )
    }

    /// The text's algorithm (Sec. 4.2), and the `V(R)` that it learnt, by type.
    pub fn paper(
        &self,
        observer: impl FnMut(Step) + 'static,
    ) -> Result<(Vec<AddRule>, Vec<f64>), InferError> {
        let Settings {
            iterations,
            readings,
            ..
        } = *self.settings;
        let epsilon = Epsilon {
            end: readings.last_epsilon,
            ..Epsilon::default()
        };
        let explore = self.explore(readings.protection);
        Ok(match readings.exploitation {
            Exploit::AllRules => {
                let values = AllRules::new(Rc::clone(&self.exploration));
                let (rules, known) = self.walks(explore, values, epsilon, iterations, observer)?;
                (rules, known.into_values())
            }
            Exploit::Remembered(most) => {
                let values = Remembered::new(most, Rc::clone(&self.exploration));
                let (rules, known) = self.walks(explore, values, epsilon, iterations, observer)?;
                (rules, known.into_values())
            }
        })
    }

    /// Importance sampling: walks that always explore.
    pub fn importance(
        &self,
        observer: impl FnMut(Step) + 'static,
    ) -> Result<Vec<AddRule>, InferError> {
        let iterations = self.settings.iterations;
        let explore = self.explore(self.settings.readings.protection.anew());
        let always = Epsilon::ALWAYS_EXPLORE;
        let (rules, _) = self.walks(explore, NothingKnown, always, iterations, observer)?;
        Ok(rules)
    }

    /// The cheapest of many walks, and what they taught.
    fn walks<V: Approximation<Inference>>(
        &self,
        explore: Explore,
        values: V,
        epsilon: Epsilon,
        iterations: u64,
        observer: impl FnMut(Step) + 'static,
    ) -> Result<(Vec<AddRule>, V), InferError> {
        let adp = Adp::new(explore, values, epsilon, iterations, self.settings.seed);
        let (walk, _, values) = adp.run_observed(self.process(), observer)?;
        Ok((walk.actions, values))
    }

    /// All the walks of `paper`, some that exploit by shortest paths, then annealing over the set of types
    /// from the cheapest grammar found: never dearer than `paper` with the same seed.
    pub fn best(
        &self,
        observer: impl FnMut(Step) + Clone + 'static,
    ) -> Result<Vec<AddRule>, InferError> {
        let Settings {
            iterations,
            seed,
            readings,
            ..
        } = *self.settings;
        let router = || Router::new(self.settings.costs, self.settings.operations);
        let (by_text, known) = self.paper(observer.clone())?;
        let share = share(iterations);
        let (by_routes, routes) = self.walks(
            self.explore(readings.protection.anew()),
            ShortestRoutes::new(router()),
            Epsilon::default(),
            share,
            later(iterations, observer.clone()),
        )?;
        let start = self.cheapest([by_text, by_routes]);
        let mut values = routes.into_values();
        for (value, known) in values.iter_mut().zip(known) {
            *value = value.min(known);
        }
        let members = Members::new(
            Rc::clone(&self.types),
            router(),
            Rc::clone(&self.exploration),
            values,
            &start,
        );
        let annealing = Annealing::new(COOLING, share, MOVES_PER_ROUND, seed)?;
        Ok(annealing
            .run(members, later(iterations + share, observer))?
            .0)
    }

    /// Always the best rule by the splitting heuristic.
    pub fn greedy(&self) -> Vec<AddRule> {
        let exploration = &mut self.exploration.borrow_mut();
        baselines::greedy(&mut self.types.borrow_mut(), exploration)
    }

    /// Initial step of Martinovic and Van Gool 2013.
    pub fn all_lines(&self) -> Vec<AddRule> {
        baselines::all_lines(&mut self.types.borrow_mut())
    }

    /// Splitting heuristic of Zhang et al. 2013.
    pub fn symmetry_maximization(&self) -> Vec<AddRule> {
        baselines::symmetry_maximization(&mut self.types.borrow_mut())
    }

    /// The grammar of some rules.
    pub fn grammar(&self, facades: &[Facade], rules: &[AddRule]) -> Grammar {
        extract::grammar(&mut self.types.borrow_mut(), facades, rules)
    }

    /// The cheapest of the walks and of what the deterministic methods find; of several, the first.
    fn cheapest(&self, walks: [Vec<AddRule>; 2]) -> Vec<AddRule> {
        let cost = |rules: &[AddRule]| -> f64 {
            let costs = &self.settings.costs;
            rules.iter().map(|r| r.choice.cost(costs)).sum()
        };
        let cheaper = |best: Vec<AddRule>, other: Vec<AddRule>| {
            if cost(&other) < cost(&best) {
                other
            } else {
                best
            }
        };
        let deterministic = cheaper(self.all_lines(), self.greedy());
        walks.into_iter().fold(deterministic, cheaper)
    }
}

/// Walks by shortest paths, and rounds of annealing, in the second stage of `best`.
fn share(iterations: u64) -> u64 {
    (iterations / SECOND_STAGE_SHARE).max(1)
}

/// Walks and rounds of the second stage of `best` after so many iterations.
pub(super) fn second_stage_steps(iterations: u64) -> u64 {
    2 * share(iterations)
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

/// The second stage of `best` has one walk and one round of annealing for so many iterations.
const SECOND_STAGE_SHARE: u64 = 10;
/// Moves of a round of annealing.
const MOVES_PER_ROUND: u32 = 100;
/// Temperatures in units of cost: a move that adds a symbol is likely at first, unlikely at last.
const COOLING: Cooling = Cooling {
    start: 1.0,
    end: 0.05,
};
