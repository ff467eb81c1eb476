//! The ease with which a classifier tells drawn facades from real ones.

use edifice_base::{Error, Result, unwatched};
use edifice_frame::roc::area_under_curve;
use edifice_model::boosting::{Boosting, Settings};
use edifice_shape::{Axis, Facade};

/// Facades of one fold: those a classifier learns from, and those that it judges.
pub(crate) struct Fold {
    /// Real facades to learn from.
    pub known: Vec<Facade>,
    /// Drawn ones to learn from.
    pub drawn: Vec<Facade>,
    /// Real facades that neither the classifier nor the library has seen.
    pub held_out: Vec<Facade>,
    /// As many drawn ones, drawn for the test alone.
    pub fresh: Vec<Facade>,
}

/// The area under the curve of boosted trees over all folds: the chance that a drawn facade is held for drawn rather than a
/// real one; 1/2 where nothing tells them apart.
///
/// # Errors
/// [`Error::Method`] where features are not finite.
pub(crate) fn area(folds: &[Fold], labels: &[&str]) -> Result<f64> {
    let (mut real, mut drawn) = (Vec::new(), Vec::new());
    for fold in folds {
        let rows = |facades: &[Facade]| -> Vec<Vec<f64>> {
            facades.iter().map(|f| features(f, labels)).collect()
        };
        let mut all = rows(&fold.known);
        let mut targets = vec![0.0; all.len()];
        all.extend(rows(&fold.drawn));
        targets.resize(all.len(), 1.0);
        let learnt = Boosting::learn(&all, &targets, Settings::default(), &unwatched)
            .map_err(Error::method)?;
        let judged = |facades: &[Facade]| -> Vec<f64> {
            rows(facades)
                .iter()
                .map(|row| learnt.probability(row))
                .collect()
        };
        real.extend(judged(&fold.held_out));
        drawn.extend(judged(&fold.fresh));
    }
    Ok(area_under_curve(&drawn, &real))
}

/// Counts, shares, sizes and gaps of a facade.
fn features(facade: &Facade, labels: &[&str]) -> Vec<f64> {
    let mut row = vec![
        facade.width,
        facade.height,
        facade.width / facade.height,
        facade.regions.len() as f64,
    ];
    for label in labels {
        let own = facade.regions.iter().filter(|r| r.label == *label);
        let own: Vec<_> = own.map(|r| r.rect).collect();
        let area: f64 = own.iter().map(|r| r.width * r.height).sum();
        row.extend([own.len() as f64, area / (facade.width * facade.height)]);
        for axis in Axis::BOTH {
            let sizes: Vec<f64> = own.iter().map(|r| r.extent(axis)).collect();
            row.extend(spread(&sizes));
            let side = match axis {
                Axis::X => facade.width,
                Axis::Y => facade.height,
            };
            let mut spans: Vec<(f64, f64)> =
                own.iter().map(|r| (r.start(axis), r.end(axis))).collect();
            spans.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut joined: Vec<(f64, f64)> = Vec::new();
            for span in spans {
                match joined.last_mut() {
                    Some(last) if span.0 < last.1 => last.1 = last.1.max(span.1),
                    _ => joined.push(span),
                }
            }
            let gaps: Vec<f64> = joined
                .windows(2)
                .map(|p| (p[1].0 - p[0].1) / side)
                .collect();
            row.push(joined.len() as f64);
            row.extend(spread(&gaps));
            row.push(joined.first().map_or(1.0, |first| first.0 / side));
            row.push(joined.last().map_or(1.0, |last| 1.0 - last.1 / side));
        }
    }
    row
}

/// Mean, standard deviation, least and largest value; zeros for none.
fn spread(values: &[f64]) -> [f64; 4] {
    if values.is_empty() {
        return [0.0; 4];
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    [
        mean,
        square.sqrt(),
        least,
        values.iter().copied().fold(least, f64::max),
    ]
}
