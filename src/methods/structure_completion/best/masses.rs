//! The probability that a facade has so many columns and so many rows.
//!
//! The pool gives each pair of numbers `(c, r)` a share `s(c, r)`, the sum of the weights of the draws whose windows and the
//! seen ones stand on so many lines. Shares are no probabilities: the draws know nothing of an annotation's errors, and
//! of lines that no rule foresees. So boosted trees give `p(c, r)` from `s(c, r)`, its margins, its rank and what is seen,
//! learnt on whole layouts with parts hidden; the probabilities of all pairs are scaled down where they sum to more than 1.
//! They may sum to less: of the rest, half goes to the answers in equal parts ([`super::modes`]).

use std::collections::BTreeMap;

use super::observation::Observation;
use super::pool::Draw;
use edifice_model::boosting::Boosting;

/// Number of features of a pair of numbers.
pub const FEATURES: usize = 17;
/// Pairs of a smaller share are not asked about.
const LEAST: f64 = 0.004;

/// Numbers of columns and of rows.
pub type Lattice = (usize, usize);

/// The share of each pair of numbers among the draws of whole completions, by the weight of each draw.
pub fn shares(draws: &[Draw], weights: &[f64]) -> BTreeMap<Lattice, f64> {
    let mut shares = BTreeMap::new();
    let whole = draws
        .iter()
        .zip(weights)
        .filter(|(d, _)| d.origin.is_whole());
    for (draw, weight) in whole {
        *shares.entry(draw.numbers).or_default() += weight;
    }
    shares
}

/// The features of each pair that has more than the least share.
pub fn features(
    observation: &Observation,
    shares: &BTreeMap<Lattice, f64>,
) -> Vec<(Lattice, Vec<f64>)> {
    let margin = |own: &dyn Fn(&Lattice) -> bool| -> f64 {
        shares.iter().filter(|(l, _)| own(l)).map(|(_, s)| s).sum()
    };
    let total: f64 = shares.values().sum::<f64>().max(1e-12);
    let most = shares.values().copied().fold(0.0, f64::max) / total;
    let spread: f64 = shares.values().map(|s| (s / total).powi(2)).sum();
    let area = observation.partial.width * observation.partial.height;
    let unknown = observation.partial.unknown.as_ref();
    let hidden = unknown.map(|u| u.iter().map(|r| r.area()).sum::<f64>() / area);
    let (columns, rows) = (
        observation.columns.len() as f64,
        observation.rows.len() as f64,
    );
    let each = shares.iter().filter(|(_, s)| **s >= LEAST * total);
    let features = each.map(|(&lattice, share)| {
        let rank = shares.values().filter(|s| *s > share).count();
        let features = vec![
            share / total,
            margin(&|l| l.0 == lattice.0) / total,
            margin(&|l| l.1 == lattice.1) / total,
            rank as f64,
            most,
            spread,
            shares.len() as f64,
            lattice.0 as f64 - columns,
            lattice.1 as f64 - rows,
            lattice.0 as f64,
            lattice.1 as f64,
            hidden.unwrap_or(1.0),
            f64::from(u8::from(hidden.is_some())),
            observation.seen,
            columns,
            rows,
            observation.elements.len() as f64,
        ];
        debug_assert_eq!(features.len(), FEATURES);
        (lattice, features)
    });
    features.collect()
}

/// The learnt probability of each pair; pairs of next to no share have none.
pub fn probabilities(
    learnt: &Boosting,
    observation: &Observation,
    shares: &BTreeMap<Lattice, f64>,
) -> BTreeMap<Lattice, f64> {
    let all = features(observation, shares).into_iter();
    let mut each: BTreeMap<Lattice, f64> = all
        .map(|(l, features)| (l, learnt.probability(&features)))
        .collect();
    let total: f64 = each.values().sum();
    if total > 1.0 {
        each.values_mut().for_each(|p| *p /= total);
    }
    each
}
