//! Bounds on the least cost of a facade's grammars.

use std::fmt;

use rustc_hash::FxHashSet;

use super::infer::{InferError, Method, Settings, infer};
use super::lagrangian::{BoundLimits, Incumbent, Program, solve};
use super::operations::Operations;
use super::regions::Types;
use edifice_base::{Watch, Watched};
use edifice_grammar::Costs;
use edifice_shape::Facade;

/// Bounds from below and above on the least cost of a facade's grammars (Eq. 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// Lower bound: no grammar costs less.
    pub lower: f64,
    /// Upper bound: cost of the best grammar known.
    pub upper: f64,
    /// True if the two bounds meet, so that the best grammar known is optimal.
    pub proven: bool,
    /// Number of branches examined; 0 where branch and bound was not run.
    pub nodes: u64,
    /// Non-terminal types that full lines can make of the facade; 0 when they were not counted.
    pub types: usize,
    /// Why `lower` is far from what branch and bound would give, if it is.
    pub weak: Option<Weakness>,
}

/// Why a bound is weak.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weakness {
    /// Grid splits are allowed: their rules are no shortest paths. The bound is that of grammars without grids, times what
    /// a grid can save at most (see [`lower_bound`]).
    Grids,
    /// The rules of the facade have more items than [`BoundLimits::items`], or the search was stopped before it had them all:
    /// every label is written once.
    Items,
}

impl fmt::Display for Weakness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Weakness::Grids => {
                "grid splits are no shortest paths; bounded by what they can save at most"
            }
            Weakness::Items => "too many rules; bounded by the number of labels",
        })
    }
}

/// Bounds the cost of the grammars of a facade from below, as [`infer`] does (see [`super`]), but with as much
/// work as `limits` allow; the upper bound starts from what [`Method::AdpBest`] finds with the other `settings`.
/// The same limits give the same bound, unless `watch` stops the search: then it is the greatest until then.
///
/// Where the rules of a facade have more items than [`BoundLimits::items`], the bound is the weak one that every label is
/// written once. Where grid splits are allowed, it comes from that without them: a grid of `m` by `n` cells can be
/// written as one split into `m` strips and `m` splits into `n` cells, a grid of one row as one split, so that
///
/// ```text
/// least cost with grids >= rho * least cost without,
/// rho = min over 2 <= m <= n of (c_grid + m n c_1) / (c_split + m c_1 + m (c_split + n c_1))
///       and of (c_grid + 2 c_1) / (c_split + 2 c_1),
/// ```
///
/// `c_1` being the cost of a successor; 0.65 with the costs of the paper. [`Bound::weak`] names either case.
///
/// # Errors
/// [`InferError`], as of [`infer`].
pub fn lower_bound(
    facade: &Facade,
    settings: &Settings,
    limits: &BoundLimits,
    watch: &Watch,
) -> Result<Bound, InferError> {
    let watched = &Watched::new(watch);
    let settings = Settings {
        method: Method::AdpBest,
        ..settings.clone()
    };
    let (costs, operations) = (&settings.costs, settings.operations);
    let facades = std::slice::from_ref(facade);
    let upper = costs.grammar(&infer(facades, &settings, &watched.inner())?.grammar);
    let known = |incumbent: &Incumbent, lower: f64, weak| Bound {
        lower: lower.min(incumbent.cost),
        upper: incumbent.cost,
        proven: incumbent.is_optimal(lower),
        nodes: 0,
        types: 0,
        weak,
    };
    let mut incumbent = Incumbent::new(upper, costs, operations);
    incumbent.watched = Some(watched);
    if facade.regions.len() == 1 {
        return Ok(known(&incumbent, upper, None));
    }
    let labels: FxHashSet<&str> = facade.regions.iter().map(|r| r.label.as_str()).collect();
    let labels = labels_once(costs, operations, labels.len());
    let without_grids = operations.without_grids();
    let types = Types::new(facades).map_err(|(_, source)| InferError::NotATiling {
        name: facade.name.clone(),
        source,
    })?;
    let lines = types.extents()[0];
    let Some(program) = Program::new(types, costs, without_grids, limits.items, watched) else {
        return Ok(known(&incumbent, labels, Some(Weakness::Items)));
    };
    if !operations.grid_split {
        let types = program.region_types.len();
        let (lower, nodes) = solve(program, &mut incumbent, limits);
        return Ok(Bound {
            nodes,
            types,
            ..known(&incumbent, lower, None)
        });
    }
    let mut without = Incumbent::new(f64::INFINITY, costs, without_grids);
    without.watched = Some(watched);
    let types = program.region_types.len();
    let (lower, nodes) = solve(program, &mut without, limits);
    let lower = without.round_up(lower) * saved_by_grids(costs, lines.0.max(lines.1));
    Ok(Bound {
        nodes,
        types,
        ..known(&incumbent, lower.max(labels), Some(Weakness::Grids))
    })
}

/// `rho` of [`lower_bound`] for grids of so many columns and rows at most. For given `m` the fraction grows with `n` as long
/// as it is below 1, so that square grids, and rows of two cells, are the worst.
pub(super) fn saved_by_grids(costs: &Costs, most: usize) -> f64 {
    let fraction = |grid: f64, splits: f64| match splits > 0.0 {
        true => grid / splits,
        false => 1.0,
    };
    let row = costs.split + 2.0 * costs.successor;
    let row = fraction(costs.grid_split + 2.0 * costs.successor, row);
    let square = |m: f64| {
        let strip = costs.split + m * costs.successor;
        let grid = costs.grid_split + m * m * costs.successor;
        fraction(grid, strip + m * strip)
    };
    let squares = (2..=most).map(|m| square(m as f64));
    squares.fold(row.min(1.0), f64::min)
}

/// One rule at least, and every label written once.
pub(super) fn labels_once(costs: &Costs, operations: Operations, labels: usize) -> f64 {
    let mut operation = costs.split;
    for (allowed, cost) in [
        (operations.repeat, costs.repeat),
        (operations.repeat_aba, costs.repeat_aba),
        (operations.sym_split, costs.sym_split),
        (operations.grid_split, costs.grid_split),
    ] {
        if allowed {
            operation = operation.min(cost);
        }
    }
    operation + costs.successor * labels as f64
}
