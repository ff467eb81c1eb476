//! Parameters that agree in the facades that have both share a name.

use std::collections::BTreeMap;

use super::Spread;
use crate::parametric::rules::Symbol;
use edifice_shape::Axis;

/// Sizes share a name when they are equal in this share of the facades that have both.
pub const AGREED: f64 = 0.95;

/// The value of a parameter in each facade that has it.
pub(super) type Values = BTreeMap<usize, f64>;

/// The direction of a parameter, and the symbol that it is the size of; none of a count.
pub(super) type Of = (Axis, Option<Symbol>);

/// Parameters in groups that share a name.
pub(super) struct Ties<K> {
    groups: Vec<(Of, Values)>,
    of: BTreeMap<K, usize>,
    /// The share of common facades in which the values of a group are equal.
    share: f64,
    /// The fewest common facades, where symbols differ; else one is enough.
    least: usize,
}

impl<K: Ord> Ties<K> {
    pub(super) fn new(share: f64, least: usize) -> Self {
        Self {
            groups: Vec::new(),
            of: BTreeMap::new(),
            share,
            least,
        }
    }

    /// Puts a parameter into the first group that agrees with it, else into a new one, whose number is returned.
    pub(super) fn add(&mut self, key: K, of: Of, values: Values) -> Option<usize> {
        let agrees = |(other, known): &(Of, Values)| {
            let both: Vec<(&f64, &f64)> = values
                .iter()
                .filter_map(|(facade, value)| Some((value, known.get(facade)?)))
                .collect();
            let equal = both.iter().filter(|(a, b)| (*a - *b).abs() < 1e-9).count();
            let least = if *other == of {
                self.least.min(1)
            } else {
                self.least
            };
            other.0 == of.0 && both.len() >= least && equal as f64 >= self.share * both.len() as f64
        };
        let found = self.groups.iter().position(agrees);
        let group = found.unwrap_or(self.groups.len());
        self.of.insert(key, group);
        match found {
            Some(group) => {
                let known = &mut self.groups[group].1;
                for (facade, value) in values {
                    known.entry(facade).or_insert(value);
                }
                None
            }
            None => {
                self.groups.push((of, values));
                Some(group)
            }
        }
    }

    pub(super) fn group(&self, key: &K) -> Option<usize> {
        self.of.get(key).copied()
    }

    pub(super) fn values(&self, group: usize) -> &Values {
        &self.groups[group].1
    }
}

/// Mean and spread of a parameter.
pub(super) fn spread(values: &Values) -> (f64, Spread) {
    let count = values.len().max(1) as f64;
    let mean = values.values().sum::<f64>() / count;
    let squares: f64 = values.values().map(|v| (v - mean).powi(2)).sum();
    let least = values.values().copied().fold(f64::INFINITY, f64::min);
    let greatest = values.values().copied().fold(0.0, f64::max);
    let spread = Spread {
        facades: values.len(),
        deviation: (squares / count).sqrt(),
        range: (least, greatest),
    };
    (mean, spread)
}
