//! The skill of a classifier that tells completions from true facades (area under its curve, 0.5 for chance), by
//! statistics that no method optimizes.

use rand::seq::SliceRandom;

use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_frame::roc::area_under_curve;
use edifice_model::boosting::{Boosting, BoostingError, Settings};
use edifice_shape::{Axis, Rect};
use edifice_structure_completion::layout::lines::lines;
use edifice_structure_completion::layout::{Class, Element};

/// Folds of the classifier.
const FOLDS: usize = 5;

/// Statistics of a whole layout: counts, sizes, gaps, borders, symmetry.
pub(crate) fn statistics(width: f64, height: f64, elements: &[Element]) -> Vec<f64> {
    let mut all = Vec::new();
    for class in Class::ALL {
        let rects: Vec<Rect> = elements
            .iter()
            .filter(|e| e.class == class)
            .map(|e| e.rect)
            .collect();
        let n = rects.len().max(1) as f64;
        all.extend([
            rects.len() as f64,
            rects.iter().map(|r| r.area()).sum::<f64>() / (width * height),
            rects.iter().map(|r| r.y).fold(height, f64::min) / height,
            rects.iter().map(|r| r.x).fold(width, f64::min) / width,
        ]);
        if class != Class::Window {
            continue;
        }
        for axis in Axis::BOTH {
            let (found, _) = lines(&rects, axis);
            let gaps: Vec<f64> = found.windows(2).map(|w| w[1].at - w[0].at).collect();
            let sizes: Vec<f64> = rects.iter().map(|r| r.extent(axis)).collect();
            let length = if axis == Axis::X { width } else { height };
            let last = rects.iter().map(|r| r.end(axis)).fold(0.0, f64::max);
            all.extend([
                found.len() as f64,
                variation(&gaps),
                variation(&sizes),
                (length - last) / length,
                n / found.len().max(1) as f64,
            ]);
        }
        let image = |r: &Rect| Rect {
            x: width - r.right(),
            ..*r
        };
        let mirrored = rects
            .iter()
            .filter(|r| rects.iter().any(|o| o.iou(&image(r)) > 0.5));
        all.push(mirrored.count() as f64 / n);
    }
    all
}

/// Standard deviation in units of the mean; 0 of fewer than two.
fn variation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
    if values.len() > 1 && mean > 0.0 {
        variance.sqrt() / mean
    } else {
        0.0
    }
}

/// Area under the ROC curve of a cross-validated classifier of pairs (truth, completion); both of a pair are in one
/// fold. 0.5: it cannot tell them apart.
///
/// # Errors
/// [`BoostingError`] for fewer pairs than folds.
pub(crate) fn auc(pairs: &[(Vec<f64>, Vec<f64>)], seed: u64) -> Result<f64, BoostingError> {
    let mut order: Vec<usize> = (0..pairs.len()).collect();
    order.shuffle(&mut stream(seed, "structure completion: plausibility", 0));
    let settings = Settings {
        trees: 40,
        levels: 3,
        rate: 0.1,
        ..Settings::default()
    };
    let (mut truth, mut made) = (Vec::new(), Vec::new());
    for fold in 0..FOLDS {
        let (mut rows, mut targets) = (Vec::new(), Vec::new());
        for (_, &pair) in order.iter().enumerate().filter(|(k, _)| k % FOLDS != fold) {
            rows.extend([pairs[pair].0.clone(), pairs[pair].1.clone()]);
            targets.extend([0.0, 1.0]);
        }
        let learnt = Boosting::learn(&rows, &targets, settings, &unwatched)?;
        for (_, &pair) in order.iter().enumerate().filter(|(k, _)| k % FOLDS == fold) {
            truth.push(learnt.probability(&pairs[pair].0));
            made.push(learnt.probability(&pairs[pair].1));
        }
    }
    Ok(area_under_curve(&made, &truth))
}
