//! What is known of the least cost of a facade's grammars.

use rustc_hash::FxHashSet;

use super::infer::{InferError, Method, Settings, infer};
use super::operations::Operations;
use super::shares::{BoundLimits, Incumbent, Program, solve};
use crate::grammar::Costs;
use crate::shape::Facade;

/// What is known of the least cost of a facade's grammars.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// No grammar costs less.
    pub lower: f64,
    /// Cost of the best grammar known.
    pub upper: f64,
    /// Whether the two meet: the best grammar known is optimal.
    pub proven: bool,
    /// Branches examined.
    pub nodes: u64,
    /// Non-terminal types that full lines can make of the facade; 0 when they were not counted.
    pub types: usize,
    /// Whether there were too many, so that `lower` only counts labels.
    pub weak: bool,
}

/// Bounds the cost of the grammars of a facade from below, by cost shares (see [`super`]) as [`infer`] does, but with as much
/// work as `limits` allow; the upper bound starts from what [`Method::AdpBest`] finds with the other `settings`. Where grid
/// splits are allowed, and where the rules of a facade have more items than [`BoundLimits::items`], the bound is
/// the weak one that every label is written once, and [`Bound::weak`] says so. The same limits give the same bound.
///
/// # Errors
/// [`InferError`], as of [`infer`].
pub fn lower_bound(
    facade: &Facade,
    settings: &Settings,
    limits: &BoundLimits,
) -> Result<Bound, InferError> {
    let settings = Settings {
        method: Method::AdpBest,
        ..settings.clone()
    };
    let facades = std::slice::from_ref(facade);
    let upper = settings.costs.grammar(&infer(facades, &settings)?.grammar);
    let mut incumbent = Incumbent::new(upper, &settings.costs);
    if facade.regions.len() == 1 {
        return Ok(known(&incumbent, upper, 0, 0));
    }
    let (costs, operations) = (&settings.costs, settings.operations);
    let Some(program) = Program::new(facades, costs, operations, limits.items) else {
        let labels: FxHashSet<&str> = facade.regions.iter().map(|r| r.label.as_str()).collect();
        let lower = labels_once(costs, operations, labels.len());
        return Ok(Bound {
            weak: true,
            ..known(&incumbent, lower, 0, 0)
        });
    };
    let (lower, nodes) = solve(&program, &mut incumbent, limits);
    Ok(known(&incumbent, lower, nodes, program.kinds.len()))
}

fn known(incumbent: &Incumbent, lower: f64, nodes: u64, types: usize) -> Bound {
    Bound {
        lower: lower.min(incumbent.cost),
        upper: incumbent.cost,
        proven: incumbent.is_optimal(lower),
        nodes,
        types,
        weak: false,
    }
}

/// One rule at least, and every label written once.
fn labels_once(costs: &Costs, operations: Operations, labels: usize) -> f64 {
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
