//! Bounds on the least cost of a facade's grammars.

use std::fmt;

use rustc_hash::FxHashSet;

use super::infer::infer;
use super::lagrangian::{BoundLimits, Incumbent, Program, solve};
use super::operations::Operations;
use super::regions::Types;
use super::settings::{InferError, Method, Settings};
use edifice_base::{Watch, Watched};
use edifice_grammar::Costs;
use edifice_shape::{Axis, Facade};

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
    /// every label is written once, and rules make the regions that lie in a row.
    Items,
}

impl fmt::Display for Weakness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Weakness::Grids => {
                "grid splits are no shortest paths; bounded by what they can save at most"
            }
            Weakness::Items => "too many rules; bounded by the labels and the regions in a row",
        })
    }
}

/// Bounds the cost of the grammars of a facade from below, as [`infer`] does (see [`super`]), but with as much
/// work as `limits` allow; the upper bound starts from what [`Method::Lagrangian`] finds with the other `settings`.
/// The same limits give the same bound, unless `watch` stops the search: then it is the greatest until then.
///
/// Where the rules of a facade have more items than [`BoundLimits::items`], the bound is the weak one that every label is
/// written once and that rules make the regions that lie in a row. Where grid splits are allowed, it comes from that without them: a grid of `m` by `n` cells can be
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
        method: Method::Lagrangian,
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
    let labels = few_rules(facades, costs, operations);
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

/// Least cost of any grammar of some facades, from their labels and from how many regions lie in a row; 0 where every facade
/// is one region.
///
/// Every label of a facade of several regions is written once at least. Where `n > 1` regions lie side by side on some
/// line along an axis, rules of that axis make them: one that repeats, or splits alone, whose written successors number at
/// least `s(n)`, the least `s` that is a sum of numbers with a product of at least `n` (a mirrored split counts twice). On a line along x
/// a rule of y passes on one part; a rule of x, each of its parts, and symbols do not lead back to themselves, so that splits
/// alone give at most the product of their numbers of parts. Successors of x and of y are written in different rules:
///
/// ```text
/// cost >= min over the kinds of rules of x and y of c_op(x) + c_op(y) + c_1 max(labels, s_x + s_y)
/// ```
///
/// Grids split both axes at once: where they are allowed, only the labels count.
pub(super) fn few_rules(facades: &[Facade], costs: &Costs, operations: Operations) -> f64 {
    let compound = || facades.iter().filter(|f| f.regions.len() > 1);
    let labels: FxHashSet<&str> = compound()
        .flat_map(|f| f.regions.iter().map(|r| r.label.as_str()))
        .collect();
    if labels.is_empty() {
        return 0.0;
    }
    let once = labels_once(costs, operations, labels.len());
    if operations.grid_split {
        return once;
    }
    let kinds = Axis::BOTH.map(|axis| {
        let most = compound().map(|f| side_by_side(f, axis)).max().unwrap_or(1);
        kinds_of_rules(most, costs, operations)
    });
    let mut least = f64::INFINITY;
    for &(first, along) in &kinds[0] {
        for &(second, across) in &kinds[1] {
            let successors = (along + across).max(labels.len()) as f64;
            least = least.min(first + second + costs.successor * successors);
        }
    }
    once.max(least)
}

/// The ways to make `n` regions in a row: least cost of operations, and least number of successors written.
fn kinds_of_rules(n: usize, costs: &Costs, operations: Operations) -> Vec<(f64, usize)> {
    if n < 2 {
        return vec![(0.0, 0)];
    }
    let mirrored = if operations.sym_split { 2 } else { 1 };
    // product[s]: most parts that splits with s successors written make.
    let mut product = vec![1];
    while product[product.len() - 1] < n {
        let s = product.len();
        let parts = (1..=s).map(|k| (mirrored * k).saturating_mul(product[s - k]));
        product.push(parts.max().unwrap_or(1));
    }
    let split = if operations.sym_split {
        costs.split.min(costs.sym_split)
    } else {
        costs.split
    };
    let mut kinds = vec![(split, product.len() - 1)];
    if operations.repeat {
        kinds.push((costs.repeat, 1));
    }
    if operations.repeat_aba {
        kinds.push((costs.repeat_aba, 2));
    }
    kinds
}

/// Most regions that one line along an axis crosses.
fn side_by_side(facade: &Facade, axis: Axis) -> usize {
    let Ok(layout) = facade.indexed() else {
        return 1;
    };
    let spans = layout.spans.iter().map(|span| span.along(axis.other()));
    let mut ends: Vec<(usize, i32)> = spans.flat_map(|(from, to)| [(from, 1), (to, -1)]).collect();
    ends.sort_unstable();
    let mut open = 0;
    let counts = ends.into_iter().map(|(_, change)| {
        open += change;
        open
    });
    counts.max().unwrap_or(1).max(1) as usize
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

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::unwatched;
    use edifice_shape::{Rect, Region};

    /// `columns` by `rows` cells, whose labels follow one another in turn.
    fn cells(columns: usize, rows: usize, labels: &[&str]) -> Facade {
        let region = |k: usize| {
            let (i, j) = (k % columns, k / columns);
            Region {
                label: labels[k % labels.len()].to_owned(),
                rect: Rect::new(i as f64, j as f64, 1.0, 1.0),
            }
        };
        let regions = (0..columns * rows).map(region).collect();
        Facade::new("cells", "m", columns as f64, rows as f64, regions).unwrap()
    }

    #[test]
    fn what_a_person_sees_is_proven() {
        let settings = Settings {
            iterations: 8,
            ..Settings::default()
        };
        for (facade, cost) in [
            (cells(200, 1, &["a", "b"]), 2.5),
            (cells(60, 60, &["a"]), 3.0),
            (cells(40, 50, &["a"]), 3.0),
        ] {
            let found = infer(std::slice::from_ref(&facade), &settings, &unwatched).unwrap();
            assert!((settings.costs.grammar(&found.grammar) - cost).abs() < 1e-9);
            assert!(found.proves(cost), "{:?}", found.lower_bound);
        }
    }

    #[test]
    fn the_bound_is_below_what_small_facades_cost() {
        let settings = Settings {
            iterations: 8,
            ..Settings::default()
        };
        for operations in ["split", "split,repeat", "split,repeat,repeat_aba,sym_split"] {
            let operations: Operations = operations.parse().unwrap();
            let settings = Settings {
                operations,
                ..settings.clone()
            };
            for columns in 1..7 {
                for (rows, labels) in [(1, &["a", "b", "c"][..]), (2, &["a", "b"]), (3, &["a"])] {
                    let facade = cells(columns, rows, labels);
                    let found =
                        infer(std::slice::from_ref(&facade), &settings, &unwatched).unwrap();
                    let bound =
                        few_rules(std::slice::from_ref(&facade), &settings.costs, operations);
                    assert!(bound <= settings.costs.grammar(&found.grammar) + 1e-9);
                }
            }
        }
    }
}
