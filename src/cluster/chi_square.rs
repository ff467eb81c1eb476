//! Histograms over any keys, and the chi-square distance between them.

use std::collections::BTreeMap;
use std::fmt::Debug;

/// Counts by key, sorted by key; keys that are absent count zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram<K> {
    bins: Vec<(K, f64)>,
}

impl<K: Ord + Clone + Debug> Histogram<K> {
    /// Counts the occurrences of each key.
    pub fn count(keys: impl IntoIterator<Item = K>) -> Self {
        let mut bins: BTreeMap<K, f64> = BTreeMap::new();
        for key in keys {
            *bins.entry(key).or_default() += 1.0;
        }
        Self {
            bins: bins.into_iter().collect(),
        }
    }

    /// The histogram scaled to sum to one; empty stays empty.
    #[must_use]
    pub fn normalized(mut self) -> Self {
        let total: f64 = self.bins.iter().map(|bin| bin.1).sum();
        for bin in &mut self.bins {
            bin.1 /= total;
        }
        self
    }

    /// The count of one key. Logarithmic in the number of keys.
    pub fn get(&self, key: &K) -> f64 {
        let place = self.bins.binary_search_by(|bin| bin.0.cmp(key));
        place.map_or(0.0, |place| self.bins[place].1)
    }

    /// The bins whose key is wanted.
    #[must_use]
    pub fn filtered(&self, wanted: impl Fn(&K) -> bool) -> Self {
        Self {
            bins: self
                .bins
                .iter()
                .filter(|bin| wanted(&bin.0))
                .cloned()
                .collect(),
        }
    }

    /// Key and count, in key order; counts are above zero.
    pub fn bins(&self) -> &[(K, f64)] {
        &self.bins
    }
}

/// `1/2 sum_k (a_k - b_k)^2 / (a_k + b_k)`, zero for equal histograms.
///
/// Lies in 0..=1 for histograms that sum to one. Linear in the number of keys of both.
///
/// # Examples
/// ```
/// use edifice_cluster::{Histogram, chi_square};
/// let a = Histogram::count(["wall", "wall", "door"]);
/// let b = Histogram::count(["wall", "window"]);
/// assert_eq!(chi_square(&a, &b), 0.5 * (1.0 / 3.0 + 1.0 + 1.0));
/// ```
pub fn chi_square<K: Ord>(a: &Histogram<K>, b: &Histogram<K>) -> f64 {
    let (mut i, mut j) = (0, 0);
    let mut sum = 0.0;
    while i < a.bins.len() || j < b.bins.len() {
        let (left, right) = match (a.bins.get(i), b.bins.get(j)) {
            (Some(x), Some(y)) if x.0 == y.0 => {
                i += 1;
                j += 1;
                (x.1, y.1)
            }
            (Some(x), Some(y)) if x.0 < y.0 => {
                i += 1;
                (x.1, 0.0)
            }
            (Some(x), None) => {
                i += 1;
                (x.1, 0.0)
            }
            (_, Some(y)) => {
                j += 1;
                (0.0, y.1)
            }
            (None, None) => break,
        };
        sum += (left - right) * (left - right) / (left + right);
    }
    0.5 * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn histogram() -> impl Strategy<Value = Histogram<u8>> {
        proptest::collection::vec(0_u8..6, 0..20).prop_map(Histogram::count)
    }

    proptest! {
        #[test]
        fn agrees_with_the_dense_formula(a in histogram(), b in histogram()) {
            let of = |h: &Histogram<u8>, key| {
                h.bins().iter().find(|bin| bin.0 == key).map_or(0.0, |bin| bin.1)
            };
            let dense: f64 = (0..6)
                .map(|key| (of(&a, key), of(&b, key)))
                .filter(|(x, y)| x + y > 0.0)
                .map(|(x, y)| 0.5 * (x - y) * (x - y) / (x + y))
                .sum();
            prop_assert!((chi_square(&a, &b) - dense).abs() < 1e-12);
            prop_assert_eq!(chi_square(&a, &b), chi_square(&b, &a));
            prop_assert_eq!(chi_square(&a, &a), 0.0);
        }

        #[test]
        fn normalized_stays_within_one(a in histogram(), b in histogram()) {
            let distance = chi_square(&a.normalized(), &b.normalized());
            prop_assert!((0.0..=1.0 + 1e-12).contains(&distance));
        }
    }
}
