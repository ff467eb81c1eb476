//! Inference: from facades to one grammar.

use std::cell::RefCell;
use std::fmt;
use std::rc::Rc;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::baselines;
use super::choice::Router;
use super::exploration::{Exploration, Lambdas};
use super::extract;
use super::members::Members;
use super::operations::Operations;
use super::regions::Types;
use super::symmetry;
use super::walk::{AddRule, BestKnown, Explore, Inference, SharedTypes, ShortestRoutes};
use crate::grammar::{Costs, Grammar};
use crate::optim::Step;
use crate::optim::adp::{Adp, AdpError, Epsilon};
use crate::optim::annealing::{Annealing, AnnealingError, Cooling};
use crate::shape::{Facade, LayoutError, splittable};

/// How to search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Approximate dynamic programming, then annealing over the set of non-terminal types.
    AdpBest,
    /// Approximate dynamic programming as the text describes it.
    AdpPaper,
    /// Only the splitting heuristic, the best of many walks.
    Importance,
    /// Always the best rule by the splitting heuristic.
    Greedy,
    /// Initial step of Martinovic and Van Gool 2013.
    Bayesian,
    /// Splitting heuristic of Zhang et al. 2013.
    Symmetry,
}

/// What to do.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// How to search.
    pub method: Method,
    /// Walks, of the methods that repeat them.
    pub iterations: u64,
    /// Seed of all randomness.
    pub seed: u64,
    /// Costs of rules.
    pub costs: Costs,
    /// Operations that rules may use.
    pub operations: Operations,
    /// Whether important regions are protected (Sec. 4.7).
    pub protect: bool,
    /// `lambda_1` of Eq. 5.
    pub lambda_rule: f64,
    /// `lambda_2` of Eq. 5.
    pub lambda_lines: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::AdpBest,
            iterations: 10_000,
            seed: 0,
            costs: Costs::default(),
            operations: Operations::default(),
            protect: true,
            lambda_rule: 1.0,
            lambda_lines: 1.0,
        }
    }
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The grammar; its cost is for [`crate::grammar`] to say.
    pub grammar: Grammar,
    /// Iterations run.
    pub iterations: u64,
}

/// Why no grammar was found.
#[derive(Debug, thiserror::Error)]
pub enum InferError {
    /// No facade was given.
    #[error("there is no facade to explain")]
    NoFacade,
    /// A facade is no tiling.
    #[error("facade `{name}` is not a tiling: {source}")]
    NotATiling {
        /// Name of the facade.
        name: String,
        /// What stands in its way.
        source: LayoutError,
    },
    /// A part of a facade cannot be split by full lines (Sec. 6.3).
    #[error("facade `{name}` cannot be split by full lines: {source}")]
    Unsplittable {
        /// Name of the facade.
        name: String,
        /// The part.
        source: LayoutError,
    },
    /// A facade has too many distinct edge coordinates.
    #[error("facade `{name}` has edges on a grid of {columns} x {rows}, too many to search")]
    TooLarge {
        /// Name of the facade.
        name: String,
        /// Columns of the grid of edges.
        columns: usize,
        /// Rows of the grid of edges.
        rows: usize,
    },
    /// Dynamic programming failed.
    #[error(transparent)]
    Adp(#[from] AdpError),
    /// Annealing failed.
    #[error(transparent)]
    Annealing(#[from] AnnealingError),
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Method::AdpBest => "adp",
            Method::AdpPaper => "adp-paper",
            Method::Importance => "importance",
            Method::Greedy => "greedy",
            Method::Bayesian => "bayesian",
            Method::Symmetry => "symmetry",
        })
    }
}

/// A method's name that is none.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown method `{name}`")]
pub struct UnknownMethod {
    /// The name.
    pub name: String,
}

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Ok(match name {
            "adp" => Method::AdpBest,
            "adp-paper" => Method::AdpPaper,
            "importance" => Method::Importance,
            "greedy" => Method::Greedy,
            "bayesian" => Method::Bayesian,
            "symmetry" => Method::Symmetry,
            _ => {
                return Err(UnknownMethod {
                    name: name.to_owned(),
                });
            }
        })
    }
}

/// Infers one grammar that derives all facades.
///
/// # Errors
/// [`InferError`].
pub fn infer(facades: &[Facade], settings: &Settings) -> Result<Outcome, InferError> {
    infer_observed(facades, settings, |_| {})
}

/// As [`infer`], telling `observer` of every iteration.
///
/// # Errors
/// [`InferError`].
pub fn infer_observed(
    facades: &[Facade],
    settings: &Settings,
    observer: impl FnMut(Step) + Clone + 'static,
) -> Result<Outcome, InferError> {
    check(facades)?;
    let search = Search::new(facades, settings);
    let (iterations, rules) = match settings.method {
        Method::AdpBest => (settings.iterations, search.best(observer)?),
        Method::AdpPaper => (
            settings.iterations,
            search.paper(Epsilon::default(), observer)?,
        ),
        Method::Importance => (
            settings.iterations,
            search.paper(Epsilon::ALWAYS_EXPLORE, observer)?,
        ),
        Method::Greedy => (
            1,
            baselines::greedy(
                &mut search.types.borrow_mut(),
                &mut search.exploration.borrow_mut(),
            ),
        ),
        Method::Bayesian => (1, baselines::all_lines(&mut search.types.borrow_mut())),
        Method::Symmetry => (
            1,
            baselines::symmetry_maximization(&mut search.types.borrow_mut()),
        ),
    };
    let grammar = extract::grammar(&mut search.types.borrow_mut(), facades, &rules);
    Ok(Outcome {
        grammar,
        iterations,
    })
}

/// Grid lines that a sheet may have along one axis, and cells in all: what fits in memory.
const MAX_LINES: usize = 20_000;
const MAX_CELLS: usize = 60_000_000;

fn check(facades: &[Facade]) -> Result<(), InferError> {
    if facades.is_empty() {
        return Err(InferError::NoFacade);
    }
    for facade in facades {
        let name = || facade.name.clone();
        facade
            .check_tiling()
            .map_err(|source| InferError::NotATiling {
                name: name(),
                source,
            })?;
        let layout = facade.indexed().map_err(|source| InferError::NotATiling {
            name: name(),
            source,
        })?;
        let (columns, rows) = (layout.xs.values().len() - 1, layout.ys.values().len() - 1);
        if columns.max(rows) > MAX_LINES || columns * rows > MAX_CELLS {
            return Err(InferError::TooLarge {
                name: name(),
                columns,
                rows,
            });
        }
        splittable(facade).map_err(|source| InferError::Unsplittable {
            name: name(),
            source,
        })?;
    }
    Ok(())
}

/// What every method starts from.
struct Search<'a> {
    settings: &'a Settings,
    types: SharedTypes,
    exploration: Rc<RefCell<Exploration>>,
}

impl<'a> Search<'a> {
    fn new(facades: &[Facade], settings: &'a Settings) -> Self {
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
            settings.protect,
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

    fn explore(&self) -> Explore {
        Explore {
            types: Rc::clone(&self.types),
            exploration: Rc::clone(&self.exploration),
        }
    }

    /// The text's algorithm (Sec. 4.2); importance sampling when it always explores.
    fn paper(
        &self,
        epsilon: Epsilon,
        observer: impl FnMut(Step) + 'static,
    ) -> Result<Vec<AddRule>, InferError> {
        let values = BestKnown::default();
        let adp = Adp::new(
            self.explore(),
            values,
            epsilon,
            self.settings.iterations,
            self.settings.seed,
        );
        Ok(adp.run_observed(self.process(), observer)?.0.actions)
    }

    /// Dynamic programming, by shortest paths and by the paper's approximation, then annealing over
    /// the set of types from the cheapest grammar found.
    fn best(
        &self,
        observer: impl FnMut(Step) + Clone + 'static,
    ) -> Result<Vec<AddRule>, InferError> {
        let Settings {
            iterations, seed, ..
        } = *self.settings;
        let router = || Router::new(self.settings.costs, self.settings.operations);
        let (routed, remembered) = (
            (iterations / ROUTED_SHARE).max(1),
            (iterations / REMEMBERED_SHARE).max(1),
        );
        let adp = Adp::new(
            self.explore(),
            ShortestRoutes::new(router()),
            Epsilon::default(),
            routed,
            seed,
        );
        let (by_routes, _, routes) = adp.run_observed(self.process(), observer.clone())?;
        let adp = Adp::new(
            self.explore(),
            BestKnown::default(),
            Epsilon::default(),
            remembered,
            seed,
        );
        let (by_memory, _, known) = adp.run_observed(self.process(), observer.clone())?;
        let start = self.cheapest([by_routes.actions, by_memory.actions]);
        let values = known.at_most(routes.into_values());
        let members = Members::new(
            Rc::clone(&self.types),
            router(),
            Rc::clone(&self.exploration),
            values,
            &start,
        );
        let rounds = iterations.saturating_sub(routed + remembered);
        let annealing = Annealing::new(COOLING, rounds, MOVES_PER_ROUND, seed)?;
        Ok(annealing.run(members, observer)?.0)
    }

    /// The cheapest of the walks and of what the deterministic methods find.
    fn cheapest(&self, walks: [Vec<AddRule>; 2]) -> Vec<AddRule> {
        let types = &mut self.types.borrow_mut();
        let cost = |rules: &[AddRule]| {
            rules
                .iter()
                .map(|r| r.choice.cost(&self.settings.costs))
                .sum::<f64>()
        };
        let lines = baselines::all_lines(types);
        let greedy = baselines::greedy(types, &mut self.exploration.borrow_mut());
        walks.into_iter().fold(
            if cost(&greedy) < cost(&lines) {
                greedy
            } else {
                lines
            },
            |best, walk| {
                if cost(&walk) < cost(&best) {
                    walk
                } else {
                    best
                }
            },
        )
    }
}

/// One in this many iterations of `best` is a walk that exploits by shortest paths.
const ROUTED_SHARE: u64 = 10;
/// One in this many is a walk that exploits as `paper` does; the others are rounds of annealing.
const REMEMBERED_SHARE: u64 = 5;
/// Moves of a round of annealing.
const MOVES_PER_ROUND: u32 = 24;
/// Temperatures in units of cost: a move that adds a symbol is likely at first, unlikely at last.
const COOLING: Cooling = Cooling {
    start: 1.0,
    end: 0.05,
};
