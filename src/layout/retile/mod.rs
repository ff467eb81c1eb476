//! Retiling: a label picture with short grammar, within a share of its area that may become wrong.
//!
//! Lines that carry a label edge are merged: a strip between two lines at most 4 % of the side apart takes the
//! labels of a neighbour. Two paths of merges are made, one that always takes the merge that makes the least area wrong,
//! one that weighs the area against the label edges that go. Every picture on a path is a tiling
//! ([`decompose`]), whose own parse tree with equal regions written once says about how long its grammar is
//! ([`parse_cost`]).
//!
//! For each *budget* `0, 1/16 %, 1/8 %, 1/4 %, ...` up to the tolerance, both paths are made within the budget (a merge that
//! a larger one allows may lead the path elsewhere), and their picture of least estimate is
//! priced by the caller (Wu's cost, as far as it can be proven); the cheapest picture of all is the result; of equally
//! cheap ones that with the least area wrong. Budgets of a smaller tolerance are among those of a larger one, and so are their
//! pictures, so that *the cost never rises with the tolerance*. A tolerance of 0 gives the input back as it is.
//!
//! The result depends on the picture alone, not on the format that it was read from. A price that is proven is proven for
//! the picture that was chosen, not over all pictures within the tolerance.

mod path;

use edifice_grammar::Costs;
use edifice_grammar::parametric::parse_cost;
use edifice_shape::{Facade, GridError, LabelGrid, decompose};

use path::{Order, merges};

/// Smallest budget above 0, as a share of the area: a sixteenth of a per cent.
const SMALLEST: f64 = 1.0 / 1600.0;

/// A retiled picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Retiled {
    /// The tiling.
    pub facade: Facade,
    /// Share of the area whose label differs from that of the input.
    pub wrong: f64,
    /// Its price.
    pub price: f64,
    /// Price of the input.
    pub before: f64,
    /// Number of pictures that were priced.
    pub priced: usize,
}

/// Why a picture was not retiled.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RetileError<E: std::error::Error + 'static> {
    /// The tolerance is no share.
    #[error("the tolerance is {value}, expected a share of the area from 0 to below 1")]
    Tolerance {
        /// The value found.
        value: f64,
    },
    /// The grid is not a label picture.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A picture could not be priced.
    #[error(transparent)]
    Price(E),
}

/// The cheapest picture on the paths of merges of `grid`, of whose area at most the share `tolerance` becomes wrong. `own` is
/// the tiling of the picture that the caller has, if any; `price` is what is to become small.
///
/// # Errors
/// [`RetileError`] for a tolerance below 0 or not below 1, a grid that is not valid, or where pricing fails.
pub fn retile<E: std::error::Error + 'static>(
    grid: &LabelGrid,
    own: Option<Facade>,
    tolerance: f64,
    mut price: impl FnMut(&Facade) -> Result<f64, E>,
) -> Result<Retiled, RetileError<E>> {
    if !(0.0..1.0).contains(&tolerance) {
        return Err(RetileError::Tolerance { value: tolerance });
    }
    let facade = match own {
        Some(facade) => facade,
        None => decompose(grid)?.facade,
    };
    let before = price(&facade).map_err(RetileError::Price)?;
    let mut best = Retiled {
        facade,
        wrong: 0.0,
        price: before,
        before,
        priced: 1,
    };
    if tolerance == 0.0 {
        return Ok(best);
    }
    let mut budget = SMALLEST;
    let mut last: Option<Facade> = None;
    while budget <= tolerance * (1.0 + 1e-9) {
        let within = estimated(grid, budget * (1.0 + 1e-9))?.into_iter();
        let least = within.min_by(|a, b| a.rank().total_cmp(&b.rank()));
        if let Some(least) = least.filter(|l| last.as_ref() != Some(&l.facade)) {
            let cost = price(&least.facade).map_err(RetileError::Price)?;
            best.priced += 1;
            if cost < best.price - 1e-9 {
                best.facade = least.facade.clone();
                (best.price, best.wrong) = (cost, least.wrong);
            }
            last = Some(least.facade);
        }
        budget *= 2.0;
    }
    Ok(best)
}

/// The tilings on the path that always takes the merge that makes the least area wrong, up to the share `tolerance` of the area,
/// with the share that is wrong: what [`retile`] is measured against.
///
/// # Errors
/// [`GridError`] for a grid that is not valid.
pub fn least_wrong_path(grid: &LabelGrid, tolerance: f64) -> Result<Vec<(Facade, f64)>, GridError> {
    grid.check()?;
    let area = grid.xs[grid.columns()] * grid.ys[grid.rows()];
    let states = merges(grid, tolerance * area, Order::Area).into_iter();
    let tiling = |state: path::State| Ok((decompose(&state.grid)?.facade, state.wrong / area));
    states.map(tiling).collect()
}

/// A picture on a path with about what it costs.
struct Estimated {
    facade: Facade,
    /// Share of the area that is wrong.
    wrong: f64,
    estimate: f64,
}

impl Estimated {
    /// The estimate; of equal ones the least wrong comes first.
    fn rank(&self) -> f64 {
        self.estimate + self.wrong
    }
}

/// All pictures of both paths.
fn estimated(grid: &LabelGrid, tolerance: f64) -> Result<Vec<Estimated>, GridError> {
    grid.check()?;
    let area = grid.xs[grid.columns()] * grid.ys[grid.rows()];
    let mut all = Vec::new();
    for order in [Order::Area, Order::AreaPerEdge] {
        for state in merges(grid, tolerance * area, order) {
            let facade = decompose(&state.grid)?.facade;
            let step = facade.width.max(facade.height) / 60_000.0;
            // Lengths are compared up to the step here: an estimate needs no more.
            let mut steps = [1.0, step].into_iter();
            let estimate = steps.find_map(|step| parse_cost(&facade, step, &Costs::default()).ok());
            let estimate = estimate.unwrap_or(facade.regions.len() as f64);
            all.push(Estimated {
                facade,
                wrong: state.wrong / area,
                estimate,
            });
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use proptest::prelude::*;

    use super::*;

    /// Windows on a grid, some edges up to three pixels off.
    fn noisy(offsets: &[u8]) -> LabelGrid {
        let (columns, rows) = (60, 60);
        let mut cells = vec![0; columns * rows];
        for (k, offset) in offsets.iter().enumerate() {
            let (i, j) = (k % 3, k / 3 % 3);
            let (left, bottom) = (
                5 + i * 18 + usize::from(offset % 4),
                5 + j * 18 + usize::from(offset / 4 % 4),
            );
            for y in bottom..bottom + 10 {
                for x in left..left + 8 {
                    cells[y * columns + x] = 1;
                }
            }
        }
        LabelGrid {
            name: "noisy".into(),
            unit: "px".into(),
            xs: (0..=columns).map(|k| k as f64).collect(),
            ys: (0..=rows).map(|k| k as f64).collect(),
            labels: vec!["wall".into(), "window".into()],
            cells,
        }
    }

    /// The share of the area whose label is another one, counted pixel by pixel.
    fn counted(grid: &LabelGrid, facade: &Facade) -> f64 {
        let mut differ = 0;
        for region in &facade.regions {
            let label = u16::from(region.label == "window");
            for y in region.rect.y as usize..region.rect.top() as usize {
                for x in region.rect.x as usize..region.rect.right() as usize {
                    differ += usize::from(grid.cells[y * 60 + x] != label);
                }
            }
        }
        f64::from(u32::try_from(differ).unwrap()) / 3600.0
    }

    fn price(facade: &Facade) -> Result<f64, Infallible> {
        Ok(parse_cost(facade, 1.0, &Costs::default()).unwrap())
    }

    #[test]
    fn an_exact_grid_stays() {
        let grid = noisy(&[0; 9]);
        let exact = retile(&grid, None, 0.0, price).unwrap();
        let tolerant = retile(&grid, None, 0.01, price).unwrap();
        assert_eq!(tolerant.facade, exact.facade);
        assert_eq!(tolerant.wrong, 0.0);
    }

    #[test]
    fn a_tolerance_that_is_no_share_is_refused() {
        let grid = noisy(&[0; 9]);
        for value in [-0.1, 1.0, f64::NAN] {
            assert!(matches!(
                retile(&grid, None, value, price),
                Err(RetileError::Tolerance { .. })
            ));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(96))]
        #[test]
        fn prices_fall_and_what_is_wrong_is_counted(offsets in prop::collection::vec(0u8..16, 9)) {
            let grid = noisy(&offsets);
            let mut least = f64::INFINITY;
            let path = least_wrong_path(&grid, 0.04).unwrap();
            for (facade, wrong) in &path {
                prop_assert!(*wrong <= 0.04 + 1e-12);
                prop_assert!((counted(&grid, facade) - wrong).abs() < 1e-9);
            }
            for tolerance in [0.0, 0.0025, 0.005, 0.01, 0.02, 0.04] {
                let made = retile(&grid, None, tolerance, price).unwrap();
                prop_assert!(made.price <= least);
                prop_assert!(made.wrong <= tolerance + 1e-12);
                least = made.price;
                prop_assert!((counted(&grid, &made.facade) - made.wrong).abs() < 1e-9);
            }
        }
    }
}
