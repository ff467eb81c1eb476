//! Inference: from facades to one grammar.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::adp::readings::Readings;
use super::adp::search::Search;
use super::best::further_steps;
use super::lagrangian::NOISE;
use super::operations::Operations;
use edifice_base::{Ended, Watch, Watched};
use edifice_grammar::{CostError, Costs, Grammar};
use edifice_optim::adp::AdpError;
use edifice_optim::annealing::AnnealingError;
use edifice_shape::{Facade, LayoutError, splittable};

/// The method of inference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The Lagrangian bound; where it does not prove a grammar optimal, approximate dynamic programming, then annealing over the
    /// set of non-terminal types.
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

/// Settings of [`infer`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The method of inference.
    pub method: Method,
    /// Walks, of the methods that repeat them. Of [`Method::AdpBest`] a measure of the work that it may do (see
    /// [`super`]): it stops once its grammar is proven optimal.
    pub iterations: u64,
    /// Seed of all randomness.
    pub seed: u64,
    /// Costs of operations and successors (Eq. 2).
    pub costs: Costs,
    /// Operations that rules may use.
    pub operations: Operations,
    /// `lambda_1` of Eq. 5.
    pub lambda_rule: f64,
    /// `lambda_2` of Eq. 5.
    pub lambda_lines: f64,
    /// Readings of the passages that the text leaves open.
    pub readings: Readings,
}

impl Settings {
    /// Steps that a watch is told of at most: the iterations, and of `best` what comes before and after.
    pub fn steps(&self) -> u64 {
        match self.method {
            Method::AdpBest => self.iterations + further_steps(self.iterations),
            Method::AdpPaper | Method::Importance => self.iterations,
            Method::Greedy | Method::Bayesian | Method::Symmetry => 1,
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::AdpBest,
            iterations: 10_000,
            seed: 0,
            costs: Costs::default(),
            operations: Operations::default(),
            lambda_rule: 1.0,
            lambda_lines: 1.0,
            readings: Readings::default(),
        }
    }
}

/// Result of [`infer`].
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The grammar; its cost is for [`edifice_grammar`] to say.
    pub grammar: Grammar,
    /// Iterations that the method was given; [`Method::AdpBest`] stops sooner once its grammar is proven optimal.
    pub iterations: u64,
    /// No grammar of these facades costs less, as far as [`Method::AdpBest`] found out (see [`super::lower_bound`]).
    pub lower_bound: Option<f64>,
    /// The way in which the search ended; that it was proven optimal says [`Outcome::proves`].
    pub ended: Ended,
}

impl Outcome {
    /// True if the lower bound shows that no grammar is cheaper than one of this cost.
    pub fn proves(&self, cost: f64) -> bool {
        self.lower_bound.is_some_and(|lower| cost <= lower + NOISE)
    }
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
        /// The gap, overlap or other fault that stands in its way.
        source: LayoutError,
    },
    /// A part of a facade cannot be split by full lines (Sec. 6.3).
    #[error("facade `{name}` cannot be split by full lines: {source}")]
    Unsplittable {
        /// Name of the facade.
        name: String,
        /// The part that cannot be split.
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
    /// A cost is out of range.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// Approximate dynamic programming failed.
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
    /// The name that was given.
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

/// Infers one grammar that derives all facades, telling `watch` of every step, of which there are at most [`Settings::steps`].
///
/// Steps are told of with their costs; between them, inside the Lagrangian bound above all, the watch is asked without. A
/// search that it stops returns the cheapest grammar met, and the greatest lower bound, with [`Ended::Interrupted`].
///
/// # Errors
/// [`InferError`].
pub fn infer(
    facades: &[Facade],
    settings: &Settings,
    watch: &Watch,
) -> Result<Outcome, InferError> {
    settings.costs.check()?;
    check(facades)?;
    let watched = Watched::new(watch);
    let search = Search::new(facades, settings, &watched)?;
    let (rules, lower_bound) = match settings.method {
        Method::AdpBest => {
            let (rules, lower) = search.best(facades)?;
            (rules, Some(lower))
        }
        Method::AdpPaper => (search.paper(settings.iterations)?.0, None),
        Method::Importance => (search.importance()?, None),
        Method::Greedy => (search.greedy(), None),
        Method::Bayesian => (search.all_lines(), None),
        Method::Symmetry => (search.symmetry_maximization(), None),
    };
    let iterations = match settings.method {
        Method::AdpBest | Method::AdpPaper | Method::Importance => settings.iterations,
        Method::Greedy | Method::Bayesian | Method::Symmetry => 1,
    };
    Ok(Outcome {
        grammar: search.grammar(facades, &rules),
        iterations,
        lower_bound,
        ended: watched.ended(),
    })
}

/// Grid lines that a layout may have along one axis, and cells in all: what fits in memory.
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
