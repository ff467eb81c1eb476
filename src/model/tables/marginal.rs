//! The transform of one column, chosen by the score of a small mixture.

use super::transform::{Bounds, Tails, Transform};
use crate::ModelError;
use crate::conjugate::LinearPrior;
use crate::gmm::{Covariance, Criterion, Points, Prior, Settings, select};

/// Most values that a choice is made on; of more, this number is taken, spread over the ranks.
const LOOKED_AT: usize = 400;
/// Components of the mixture at most.
const COMPONENTS: usize = 3;
/// Offsets of soft bounds tried, in medians of the column.
const OFFSETS: [f64; 3] = [0.01, 0.1, 1.0];
/// Offsets tried for shares.
const SHARES: [f64; 2] = [0.01, 0.1];
/// The distances from the centre at which tails begin, in robust standard deviations.
const TAILS: [f64; 2] = [1.0, 3.0];

/// The transform of `values` under which a mixture of at most four Gaussians has the least BIC, as a density of the values
/// themselves.
///
/// # Errors
/// As [`select`].
pub(super) fn choose(
    values: &[f64],
    prior: &LinearPrior,
    seed: u64,
) -> Result<Transform, ModelError> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let step = sorted.len().div_ceil(LOOKED_AT).max(1);
    let values: Vec<f64> = sorted
        .iter()
        .skip(step / 2)
        .step_by(step)
        .copied()
        .collect();
    if values.first() == values.last() {
        return Ok(Transform::IDENTITY);
    }
    let mut best: Option<(f64, Transform)> = None;
    for transform in candidates(&sorted) {
        let Some(length) = length(&values, transform, prior, seed)? else {
            continue;
        };
        if best.as_ref().is_none_or(|(least, _)| length < *least) {
            best = Some((length, transform));
        }
    }
    Ok(best.map_or(Transform::IDENTITY, |(_, transform)| transform))
}

/// All transforms that suit sorted values, the identity first.
fn candidates(sorted: &[f64]) -> Vec<Transform> {
    let (least, most) = (sorted[0], sorted[sorted.len() - 1]);
    let mut bounds = vec![Bounds::None];
    if least >= 0.0 {
        let median = quantile(sorted, 0.5);
        let unit = if median > 0.0 { median } else { most };
        bounds.extend(OFFSETS.map(|offset| Bounds::Positive {
            offset: offset * unit,
        }));
        if most <= 1.0 {
            bounds.extend(SHARES.map(|offset| Bounds::Share { offset }));
        }
    }
    let mut all = Vec::new();
    for bounds in bounds {
        let plain = Transform {
            bounds,
            tails: None,
        };
        let image = |q: f64| plain.forward(quantile(sorted, q)).0;
        let spread = (image(0.75) - image(0.25)) / 1.349;
        all.push(plain);
        if spread > 0.0 {
            all.extend(TAILS.map(|scale| Transform {
                bounds,
                tails: Some(Tails {
                    centre: image(0.5),
                    scale: scale * spread,
                }),
            }));
        }
    }
    all
}

fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

/// BIC in nats of the best mixture over the transformed values, as a density of the values; `None` where the transformed
/// values have no spread in floating point.
fn length(
    values: &[f64],
    transform: Transform,
    prior: &LinearPrior,
    seed: u64,
) -> Result<Option<f64>, ModelError> {
    let n = values.len() as f64;
    let images: Vec<(f64, f64)> = values.iter().map(|&x| transform.forward(x)).collect();
    let mean = images.iter().map(|(z, _)| z / n).sum::<f64>();
    let variance = images
        .iter()
        .map(|(z, _)| (z - mean).powi(2) / n)
        .sum::<f64>();
    let scale = variance.sqrt();
    if !(scale > 1e-12 * mean.abs() && scale.is_finite() && scale > 0.0) {
        return Ok(None);
    }
    let points: Vec<f64> = images.iter().map(|(z, _)| (z - mean) / scale).collect();
    let settings = Settings {
        prior: Prior::of_linear(prior, 1),
        // Of one coordinate the same as full ones, without products of matrices.
        covariance: Covariance::Diagonal,
        restarts: 1,
        gain: 1e-4,
        ..Settings::default()
    };
    let points = Points::new(1, &points)?;
    let selected = select(&points, COMPONENTS, Criterion::Bic, &settings, seed)?;
    let bic = Criterion::Bic.value(&selected.fitted, &points);
    let slopes: f64 = images.iter().map(|(_, slope)| slope).sum();
    let own = 0.5 * transform.parameters() as f64 * n.ln();
    Ok(Some(bic + own + n * scale.ln() - slopes))
}
