//! Measures of retrieval and of clusters against a gold standard.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

/// The part of the query itself among the items to be ranked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Query {
    /// Ranked are all other items.
    LeftOut,
    /// Ranked are all items, the query, at distance zero, among them.
    Included,
}

/// The order of items at equal distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ties {
    /// Random: the rates are exact expectations over it.
    Random,
    /// Relevant items come last.
    Against,
}

/// The treatment of a query without any relevant item.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unmatched {
    /// It does not count as a query.
    LeftOut,
    /// It counts as never found.
    Missed,
}

/// The conventions of a cumulative match characteristic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Protocol {
    /// The part of the query itself in the ranking.
    pub query: Query,
    /// The order of equal distances.
    pub ties: Ties,
    /// Queries without any relevant item.
    pub unmatched: Unmatched,
}

/// A cumulative match characteristic.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchCurve {
    /// `rates[k - 1]`: mean over the queries of the expectation that a relevant item is among the
    /// first `k`, 0..=1, never falling.
    pub rates: Vec<f64>,
    /// Each query that counts, with its own expectation per rank.
    pub queries: Vec<(usize, Vec<f64>)>,
}

/// Ranks all items by distance from each query and tells how soon a relevant one is found.
///
/// Items at equal distance (up to a relative 1e-9) come in random order; the rates are exact
/// expectations over that order. Queries without any relevant item are left out.
///
/// Complexity: `O(n^2 (log n + ranks))`.
pub fn cumulative_match(
    distances: &DMatrix<f64>,
    relevant: impl Fn(usize, usize) -> bool,
    ranks: usize,
    query: Query,
) -> MatchCurve {
    let protocol = Protocol {
        query,
        ties: Ties::Random,
        unmatched: Unmatched::LeftOut,
    };
    match_curve(distances, relevant, ranks, protocol)
}

/// As [`cumulative_match`], under any protocol.
///
/// Complexity: `O(n^2 (log n + ranks))`.
pub fn match_curve(
    distances: &DMatrix<f64>,
    relevant: impl Fn(usize, usize) -> bool,
    ranks: usize,
    protocol: Protocol,
) -> MatchCurve {
    let n = distances.nrows();
    let mut queries = Vec::new();
    for q in 0..n {
        let ranked_too = |item: &usize| protocol.query == Query::Included || *item != q;
        let candidates = (0..n).filter(ranked_too);
        let mut ranked: Vec<(f64, bool)> = candidates
            .map(|item| (distances[(q, item)], relevant(q, item)))
            .collect();
        if !ranked.iter().any(|item| item.1) {
            if protocol.unmatched == Unmatched::Missed {
                queries.push((q, vec![0.0; ranks]));
            }
            continue;
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        queries.push((q, matches(&ranked, ranks, protocol.ties)));
    }
    let mean = |rank: usize| {
        let total: f64 = queries.iter().map(|query| query.1[rank]).sum();
        total / queries.len() as f64
    };
    let rates = if queries.is_empty() {
        Vec::new()
    } else {
        (0..ranks).map(mean).collect()
    };
    MatchCurve { rates, queries }
}

/// Expectation, per rank, that a relevant item was met.
fn matches(ranked: &[(f64, bool)], ranks: usize, ties: Ties) -> Vec<f64> {
    let mut found = Vec::with_capacity(ranks);
    let mut start = 0;
    while start < ranked.len() && found.len() < ranks {
        let limit = ranked[start].0 * (1.0 + 1e-9) + 1e-15;
        let tied = ranked[start..].partition_point(|item| item.0 <= limit);
        let relevant = ranked[start..start + tied].iter().filter(|i| i.1).count();
        // Probability that the first m of the tied items hold no relevant one.
        let mut none = 1.0;
        for m in 0..tied {
            let misses = (tied - relevant) as f64 - m as f64;
            none *= match ties {
                Ties::Random => (misses / (tied - m) as f64).max(0.0),
                Ties::Against => f64::from(u8::from(misses > 0.0)),
            };
            found.push(1.0 - none);
            if found.len() == ranks {
                return found;
            }
        }
        if relevant > 0 {
            break;
        }
        start += tied;
    }
    let last = found.last().copied().unwrap_or(0.0);
    found.resize(ranks, last);
    found
}

/// Share of the items that bear the most frequent class of their cluster; 1 for no items.
///
/// # Examples
/// ```
/// assert_eq!(edifice_cluster::purity(&[0, 0, 1, 1], &['a', 'a', 'a', 'b']), 0.75);
/// ```
pub fn purity<C: Ord>(clusters: &[usize], classes: &[C]) -> f64 {
    let mut counts: BTreeMap<usize, BTreeMap<&C, usize>> = BTreeMap::new();
    for (&cluster, class) in clusters.iter().zip(classes) {
        *counts.entry(cluster).or_default().entry(class).or_default() += 1;
    }
    let largest = |classes: &BTreeMap<&C, usize>| classes.values().copied().max().unwrap_or(0);
    let total: usize = counts.values().map(largest).sum();
    if clusters.is_empty() {
        1.0
    } else {
        total as f64 / clusters.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use rand::RngExt;
    use rand::seq::SliceRandom;

    /// Integer distances, so that there are ties, and three classes.
    fn example(index: u64) -> (DMatrix<f64>, Vec<usize>) {
        let mut rng = stream(3, "retrieval", index);
        let n = 8;
        let mut distances = DMatrix::zeros(n, n);
        for i in 0..n {
            for j in 0..i {
                distances[(i, j)] = f64::from(rng.random_range(1..4));
                distances[(j, i)] = distances[(i, j)];
            }
        }
        (distances, (0..n).map(|_| rng.random_range(0..3)).collect())
    }

    #[test]
    fn agrees_with_shuffled_ranking() {
        for index in 0..10 {
            let (distances, class) = example(index);
            let curve =
                cumulative_match(&distances, |a, b| class[a] == class[b], 5, Query::LeftOut);
            let mut rng = stream(4, "retrieval", index);
            for (query, expected) in &curve.queries {
                let mut hits = [0.0; 5];
                let rounds = 4000;
                for _ in 0..rounds {
                    let mut items: Vec<usize> = (0..class.len()).filter(|i| i != query).collect();
                    items.shuffle(&mut rng);
                    items.sort_by(|&a, &b| {
                        distances[(*query, a)].total_cmp(&distances[(*query, b)])
                    });
                    let first = items.iter().position(|&i| class[i] == class[*query]);
                    for (rank, hit) in hits.iter_mut().enumerate() {
                        *hit += f64::from(first.is_some_and(|place| place <= rank));
                    }
                }
                for (hit, expected) in hits.iter().zip(expected) {
                    assert!((hit / f64::from(rounds) - expected).abs() < 0.04);
                }
            }
        }
    }

    #[test]
    fn protocols_differ_as_they_say() {
        // Query 0: items 1 and 2 tie, 2 is relevant; query 3 has nothing relevant.
        let rows = [
            [0.0, 1.0, 1.0, 2.0],
            [1.0, 0.0, 3.0, 2.0],
            [1.0, 3.0, 0.0, 2.0],
            [2.0, 2.0, 2.0, 0.0],
        ];
        let distances = DMatrix::from_fn(4, 4, |i, j| rows[i][j]);
        let relevant = |a: usize, b: usize| a == b || (a, b) == (0, 2) || (a, b) == (2, 0);
        let curve = |query, ties, unmatched| {
            let protocol = Protocol {
                query,
                ties,
                unmatched,
            };
            match_curve(&distances, relevant, 2, protocol)
        };
        let plain = curve(Query::LeftOut, Ties::Random, Unmatched::LeftOut);
        assert_eq!(plain.queries, [(0, vec![0.5, 1.0]), (2, vec![1.0, 1.0])]);
        let against = curve(Query::LeftOut, Ties::Against, Unmatched::LeftOut);
        assert_eq!(against.queries[0].1, [0.0, 1.0]);
        let all = curve(Query::LeftOut, Ties::Random, Unmatched::Missed);
        assert_eq!((all.queries.len(), all.rates[1]), (4, 0.5));
        let included = curve(Query::Included, Ties::Against, Unmatched::Missed);
        assert_eq!(included.rates, [1.0, 1.0]);
    }

    #[test]
    fn rates_never_fall_and_the_query_itself_is_a_match() {
        let (distances, class) = example(0);
        let relevant = |a: usize, b: usize| class[a] == class[b];
        let out = cumulative_match(&distances, relevant, 7, Query::LeftOut);
        assert!(out.rates.windows(2).all(|pair| pair[0] <= pair[1]));
        assert!((out.rates[6] - 1.0).abs() < 1e-12);
        let included = cumulative_match(&distances, relevant, 1, Query::Included);
        assert!((included.rates[0] - 1.0).abs() < 1e-12);
        let nothing = cumulative_match(&distances, |_, _| false, 3, Query::LeftOut);
        assert!(nothing.rates.is_empty() && nothing.queries.is_empty());
    }
}
