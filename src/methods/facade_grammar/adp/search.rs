//! The methods of inference, as far as they share what they start from.

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::rc::Rc;

use super::exploitation::{AllRules, Remembered};
use super::exploration::{Exploration, Lambdas};
use super::readings::{Exploit, Protect};
use super::symmetry;
use super::walk::{Explore, Inference, SharedTypes};
use crate::baselines;
use crate::regions::Types;
use crate::rules::AddRule;
use crate::rules::extract;
use crate::settings::{InferError, Settings};
use edifice_base::{Progress, Watched};
use edifice_grammar::Grammar;
use edifice_optim::adp::{Adp, Approximation, Epsilon};
use edifice_optim::tell;
use edifice_shape::Facade;

/// The common start of all methods: settings, facades, region types and the splitting heuristic; each method is a function of it.
pub(crate) struct Setup<'a> {
    pub settings: &'a Settings,
    /// The facades before symmetry detection.
    pub fresh: Types,
    pub types: SharedTypes,
    pub exploration: Rc<RefCell<Exploration>>,
    /// Told of every step, and asked inside long ones whether to go on.
    pub watched: &'a Watched<'a>,
}

impl<'a> Setup<'a> {
    pub(crate) fn new(
        facades: &[Facade],
        settings: &'a Settings,
        watched: &'a Watched<'a>,
    ) -> Result<Self, InferError> {
        let fresh = Types::new(facades).map_err(|(index, source)| InferError::NotATiling {
            name: facades[index].name.clone(),
            source,
        })?;
        let mut types = fresh.clone();
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
        Ok(Self {
            settings,
            fresh,
            types: Rc::new(RefCell::new(types)),
            exploration: Rc::new(RefCell::new(exploration)),
            watched,
        })
    }

    pub(crate) fn process(&self) -> Inference {
        Inference {
            types: Rc::clone(&self.types),
            costs: self.settings.costs,
        }
    }

    pub(crate) fn explore(&self, protect: Protect) -> Explore {
        Explore::new(
            Rc::clone(&self.types),
            Rc::clone(&self.exploration),
            protect,
        )
    }

    /// The text's algorithm (Sec. 4.2), and the `V(R)` that it learnt, by type.
    pub(crate) fn paper(&self, iterations: u64) -> Result<(Vec<AddRule>, Vec<f64>), InferError> {
        let readings = self.settings.readings;
        let epsilon = Epsilon {
            end: readings.last_epsilon,
            ..Epsilon::default()
        };
        let explore = self.explore(readings.protection);
        Ok(match readings.exploitation {
            Exploit::AllRules => {
                let values = AllRules::new(Rc::clone(&self.exploration));
                let (rules, known) = self.walks(explore, values, epsilon, iterations, 0)?;
                (rules, known.into_values())
            }
            Exploit::Remembered(most) => {
                let values = Remembered::new(most, Rc::clone(&self.exploration));
                let (rules, known) = self.walks(explore, values, epsilon, iterations, 0)?;
                (rules, known.into_values())
            }
        })
    }

    /// The cheapest of many walks, before which so many steps were made, and what they taught.
    pub(crate) fn walks<V: Approximation<Inference>>(
        &self,
        explore: Explore,
        mut values: V,
        epsilon: Epsilon,
        iterations: u64,
        before: u64,
    ) -> Result<(Vec<AddRule>, V), InferError> {
        let adp = Adp::new(
            explore,
            &mut values,
            epsilon,
            iterations,
            self.settings.seed,
        );
        let watch = self.watch("walks", before);
        let run = adp.run(&mut self.process(), tell(&watch, None))?;
        Ok((run.best, values))
    }

    /// A watch of a stage before which so many steps were made.
    pub(crate) fn watch(
        &self,
        stage: &'static str,
        before: u64,
    ) -> impl Fn(Progress) -> ControlFlow<()> + Sync + use<'a> {
        let (watched, most) = (self.watched, Some(self.settings.steps()));
        move |progress| {
            let done = before + progress.done;
            watched.tell(Progress {
                stage,
                done,
                most,
                ..progress
            })
        }
    }

    /// Always the best rule by the splitting heuristic.
    pub(crate) fn greedy(&self) -> Vec<AddRule> {
        let exploration = &mut self.exploration.borrow_mut();
        baselines::greedy::greedy(&mut self.types.borrow_mut(), exploration)
    }

    /// Initial step of Martinovic and Van Gool 2013.
    pub(crate) fn all_lines(&self) -> Vec<AddRule> {
        baselines::bayesian::all_lines(&mut self.types.borrow_mut())
    }

    /// Splitting heuristic of Zhang et al. 2013.
    pub(crate) fn symmetry_maximization(&self) -> Vec<AddRule> {
        baselines::symmetry::symmetry_maximization(&mut self.types.borrow_mut())
    }

    /// The grammar of some rules.
    pub(crate) fn grammar(&self, facades: &[Facade], rules: &[AddRule]) -> Grammar {
        extract::grammar(&mut self.types.borrow_mut(), facades, rules)
    }
}
