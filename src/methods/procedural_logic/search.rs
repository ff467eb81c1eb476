//! The search for the fewest rules (Sec. 4.2, Eq. 12).

use super::model::{FitError, Model};
use super::parameters::Parameters;
use edifice_optim::Run;
use edifice_optim::grid::{GridError, minimize};
use edifice_shape::LabelGrid;

/// The values of `alpha`, `b_p` and `b_h` that the search tries; they span the ranges of Sec. 5.3.
pub fn search_axes() -> [Vec<f64>; 3] {
    let bias = vec![0.0625, 0.125, 0.25, 0.5, 1.0];
    let alpha = vec![0.0, 0.25, 0.5, 0.6, 0.75, 1.0];
    [alpha, bias.clone(), bias]
}

/// Minimizes `|R|` over `alpha`, `b_p` and `b_h` (Eq. 12), with the generic grid search.
///
/// The points are `[alpha, b_p, b_h]`.
///
/// # Errors
/// [`GridError`] for an axis without values, no facades, or a value out of range.
pub fn fewest_rules(grids: &[LabelGrid], axes: &[Vec<f64>; 3]) -> Result<Run<Vec<f64>>, GridError> {
    minimize(axes, |point| {
        let parameters = Parameters::new(point[0], point[1], point[2])?;
        let model = Model::fit(grids, parameters)?;
        Ok::<_, FitError>(model.inference.rules.len() as f64)
    })
}
