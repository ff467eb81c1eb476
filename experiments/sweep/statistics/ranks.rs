//! Mean ranks of arms over instances, Friedman's test and Nemenyi's critical difference.

use statrs::distribution::{ChiSquared, Continuous, ContinuousCDF, Normal};

/// Mean ranks and what they say.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranks {
    /// Mean rank of each arm, 1 the best.
    pub means: Vec<f64>,
    /// Instances that were ranked.
    pub instances: usize,
    /// Friedman's p-value, ties corrected; 1 where nothing differs.
    pub p: f64,
    /// Mean ranks that differ by more differ at the level 0.05.
    pub critical: f64,
    /// Largest groups of arms, by mean rank, within the critical difference: first and last position in the order of mean ranks.
    pub groups: Vec<(usize, usize)>,
}

/// Ranks arms on each instance by their values (`values[instance][arm]`, smaller is better); `None` for fewer than two
/// arms or without instances.
pub fn ranks(values: &[Vec<f64>]) -> Option<Ranks> {
    let arms = values.first()?.len();
    if arms < 2 {
        return None;
    }
    let (n, k) = (values.len() as f64, arms as f64);
    let mut sums = vec![0.0; arms];
    let mut ties = 0.0;
    for row in values {
        let mut order: Vec<usize> = (0..arms).collect();
        order.sort_by(|a, b| row[*a].total_cmp(&row[*b]));
        let mut at = 0;
        while at < arms {
            let end = at + order[at..].partition_point(|arm| row[*arm] == row[order[at]]);
            let rank = (at + 1 + end) as f64 / 2.0;
            order[at..end].iter().for_each(|arm| sums[*arm] += rank);
            let equal = (end - at) as f64;
            ties += equal.powi(3) - equal;
            at = end;
        }
    }
    let squares: f64 = sums.iter().map(|sum| sum * sum).sum();
    let corrected = 1.0 - ties / (n * k * (k * k - 1.0));
    let statistic = (12.0 / (n * k * (k + 1.0)) * squares - 3.0 * n * (k + 1.0)) / corrected;
    let p = match ChiSquared::new(k - 1.0) {
        Ok(distribution) if corrected > 0.0 => 1.0 - distribution.cdf(statistic.max(0.0)),
        _ => 1.0,
    };
    let means: Vec<f64> = sums.iter().map(|sum| sum / n).collect();
    let critical = studentized_range(arms, 0.95) / 2f64.sqrt() * (k * (k + 1.0) / (6.0 * n)).sqrt();
    Some(Ranks {
        groups: groups(&means, critical),
        means,
        instances: values.len(),
        p,
        critical,
    })
}

/// Largest runs of neighbours in the order of means that lie within `critical`; single arms are none.
fn groups(means: &[f64], critical: f64) -> Vec<(usize, usize)> {
    let mut sorted = means.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut groups: Vec<(usize, usize)> = Vec::new();
    for first in 0..sorted.len() {
        let last = sorted.partition_point(|mean| *mean <= sorted[first] + critical) - 1;
        if last > first && groups.last().is_none_or(|(_, before)| *before < last) {
            groups.push((first, last));
        }
    }
    groups
}

/// Quantile of the studentized range of `k` standard normal variables with infinitely many degrees of freedom.
fn studentized_range(k: usize, level: f64) -> f64 {
    let normal = Normal::standard();
    // P(range <= q) = k * integral of phi(z) (Phi(z) - Phi(z - q))^(k - 1), by Simpson's rule.
    let below = |q: f64| {
        const STEPS: usize = 400;
        let (from, to) = (-8.0, 8.0 + q);
        let width = (to - from) / STEPS as f64;
        let value = |i: usize| {
            let z = from + i as f64 * width;
            normal.pdf(z) * (normal.cdf(z) - normal.cdf(z - q)).powi(k as i32 - 1)
        };
        let weight = |i: usize| match i {
            0 | STEPS => 1.0,
            odd if odd % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let sum: f64 = (0..=STEPS).map(|i| weight(i) * value(i)).sum();
        k as f64 * sum * width / 3.0
    };
    let (mut low, mut high) = (0.0, 20.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        match below(middle) < level {
            true => low = middle,
            false => high = middle,
        }
    }
    (low + high) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Demsar 2006, Table 5(a).
    #[test]
    fn critical_values_are_those_of_the_table() {
        let table = [
            (2, 1.960),
            (3, 2.343),
            (4, 2.569),
            (5, 2.728),
            (6, 2.850),
            (7, 2.949),
            (8, 3.031),
            (9, 3.102),
            (10, 3.164),
        ];
        for (k, printed) in table {
            let ours = studentized_range(k, 0.95) / 2f64.sqrt();
            assert!((ours - printed).abs() < 1.5e-3, "{k}: {ours} for {printed}");
        }
    }

    /// SciPy 1.17.1, `scipy.stats.friedmanchisquare`, without and with ties.
    #[test]
    fn as_scipy_says() {
        let rows = |grid: Option<f64>| -> Vec<Vec<f64>> {
            let row = |seed: u64| {
                let mut x = seed;
                let next = |_| {
                    x = (1_103_515_245 * x + 12_345) % (1 << 31);
                    let value = x as f64 / f64::from(1u32 << 31) - 0.45;
                    grid.map_or(value, |grid| (value * grid).round_ties_even() / grid)
                };
                (0..4).map(next).collect()
            };
            (100..130).map(row).collect()
        };
        let exact = ranks(&rows(None)).unwrap();
        assert!(
            (exact.p - 0.0003568663041609603).abs() < 1e-12,
            "{}",
            exact.p
        );
        let tied = ranks(&rows(Some(4.0))).unwrap();
        assert!((tied.p - 0.004477600368337768).abs() < 1e-12, "{}", tied.p);
        // scikit-posthocs 0.17.1, `posthoc_nemenyi_friedman`: p below 0.05 for arm 2 with 0, 1 and 3 alone.
        let differ = |a: usize, b: usize| (exact.means[a] - exact.means[b]).abs() > exact.critical;
        for (a, b, expected) in [
            (0, 1, false),
            (0, 2, true),
            (0, 3, false),
            (1, 2, true),
            (1, 3, false),
            (2, 3, true),
        ] {
            assert_eq!(differ(a, b), expected, "{a} {b}");
        }
    }

    #[test]
    fn ranks_of_a_clear_order() {
        let values: Vec<Vec<f64>> = (0..20)
            .map(|i| vec![f64::from(i), f64::from(i) + 2.0, f64::from(i) + 1.0])
            .collect();
        let found = ranks(&values).unwrap();
        assert_eq!(found.means, [1.0, 3.0, 2.0]);
        assert!(found.p < 1e-8 && found.groups.is_empty());
        let equal = ranks(&vec![vec![1.0, 1.0]; 5]).unwrap();
        assert_eq!(
            (equal.p, equal.means.as_slice()),
            (1.0, [1.5, 1.5].as_slice())
        );
        assert_eq!(equal.groups, [(0, 1)]);
        assert_eq!(ranks(&[]), None);
    }
}
