//! Inference: from facades to one grammar.

use super::adp::search::Setup;
use super::lagrangian::NOISE;
use super::operations::Operations;
use super::settings::{InferError, Method, Settings};
use edifice_base::{Ended, Progress, Watch, Watched};
use edifice_grammar::Grammar;
use edifice_shape::{Facade, splittable};

/// Result of [`infer`].
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The grammar; its cost is for [`edifice_grammar`] to say.
    pub grammar: Grammar,
    /// Iterations that the method was given; [`Method::Lagrangian`] stops sooner once its grammar is proven optimal.
    pub iterations: u64,
    /// No grammar of these facades costs less, as far as [`Method::Lagrangian`] found out (see [`super::lower_bound`]).
    pub lower_bound: Option<f64>,
    /// Effective number of walks of [`Method::Importance`], weighted by `exp(-cost)` ([`super::weighted`]); `None` of other methods.
    pub effective: Option<f64>,
    /// The way in which the search ended; that it was proven optimal says [`Outcome::proves`].
    pub ended: Ended,
}

impl Outcome {
    /// True if the lower bound shows that no grammar is cheaper than one of this cost.
    pub fn proves(&self, cost: f64) -> bool {
        self.lower_bound.is_some_and(|lower| cost <= lower + NOISE)
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
    let search = Setup::new(facades, settings, &watched)?;
    let (mut lower_bound, mut effective, mut splits) = (None, None, None);
    let rules = match settings.method {
        Method::Lagrangian => {
            let (rules, lower) = search.best(facades)?;
            lower_bound = Some(lower);
            let unproven = search.cost(&rules) > lower + NOISE && !watched.is_stopped();
            if unproven && settings.operations != Operations::split_only() {
                splits = splits_alone(facades, settings, &watched, search.cost(&rules))?;
            }
            rules
        }
        Method::AdpPaper => search.paper(settings.iterations)?.0,
        Method::Importance => {
            let (rules, count) = search.importance()?;
            effective = Some(count);
            rules
        }
        Method::Greedy => search.greedy(),
        Method::Bayesian => search.all_lines(),
        Method::Symmetry => search.symmetry_maximization(),
    };
    let iterations = match settings.method {
        Method::Lagrangian | Method::AdpPaper | Method::Importance => settings.iterations,
        Method::Greedy | Method::Bayesian | Method::Symmetry => 1,
    };
    Ok(Outcome {
        grammar: splits.unwrap_or_else(|| search.grammar(facades, &rules)),
        iterations,
        lower_bound,
        effective,
        ended: watched.ended(),
    })
}

/// The grammar of the default method with splits alone, which more operations allow as well, if it costs less than `cost`. The
/// fewer rules of splits can be searched where those of all operations are too many. Of this search the watch is told of
/// stages without a count of steps.
fn splits_alone(
    facades: &[Facade],
    settings: &Settings,
    watched: &Watched,
    cost: f64,
) -> Result<Option<Grammar>, InferError> {
    let settings = Settings {
        operations: Operations::split_only(),
        ..settings.clone()
    };
    let stages = |progress: Progress| watched.tell(Progress::stage(progress.stage));
    let inner = Watched::new(&stages);
    let search = Setup::new(facades, &settings, &inner)?;
    let (rules, _) = search.best(facades)?;
    let cheaper = search.cost(&rules) < cost - NOISE;
    Ok(cheaper.then(|| search.grammar(facades, &rules)))
}

/// Grid lines that a layout may have along one axis, and cells in all: what fits in memory.
const MAX_LINES: usize = 20_000;
const MAX_CELLS: usize = 60_000_000;

pub(crate) fn check(facades: &[Facade]) -> Result<(), InferError> {
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
