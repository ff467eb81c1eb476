//! The length of which all lengths of a library are multiples.

use super::error::LibraryError;
use edifice_shape::Facade;

/// Steps that are tried when facades do not give one: all their lengths must be multiples of it.
const STEPS: [f64; 7] = [1.0, 0.5, 0.1, 0.05, 0.01, 0.005, 0.001];

/// The largest step that all edges are multiples of; the smallest one where none fits, so that the error of
/// parsing names the coordinate.
pub(super) fn step(facades: &[Facade]) -> Result<f64, LibraryError> {
    let fits = |step: f64| {
        facades.iter().all(|facade| {
            let tolerance = facade.tolerance().min(step / 4.0);
            let on = |value: f64| (value - (value / step).round() * step).abs() <= tolerance;
            let edges = facade.regions.iter().map(|region| region.rect);
            on(facade.width)
                && on(facade.height)
                && edges
                    .into_iter()
                    .all(|r| on(r.x) && on(r.y) && on(r.right()) && on(r.top()))
        })
    };
    if facades.is_empty() {
        return Err(LibraryError::NoFacades);
    }
    Ok(STEPS
        .into_iter()
        .find(|&step| fits(step))
        .unwrap_or(STEPS[STEPS.len() - 1]))
}
