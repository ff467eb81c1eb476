//! Wilcoxon's signed-rank test, Holm's correction.

use statrs::distribution::{ContinuousCDF, Normal};

/// Result of a signed-rank test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signed {
    /// Pairs that differ.
    pub pairs: usize,
    /// The smaller sum of ranks, `T`.
    pub statistic: f64,
    /// Two-sided.
    pub p: f64,
    /// Matched-pairs rank biserial correlation, -1 to 1: positive when differences are.
    pub effect: f64,
}

/// Most pairs for which the distribution of the statistic is counted out.
const EXACT: usize = 50;

/// Tests whether differences are symmetric about 0; pairs without a difference are left out. `None` when none differs.
pub fn signed_rank(differences: &[f64]) -> Option<Signed> {
    let mut sizes: Vec<(f64, bool)> = differences
        .iter()
        .filter(|d| **d != 0.0)
        .map(|d| (d.abs(), *d > 0.0))
        .collect();
    let n = sizes.len();
    if n == 0 {
        return None;
    }
    sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut positive, mut ties, mut at) = (0.0, 0.0, 0);
    while at < n {
        let end = at + sizes[at..].partition_point(|(size, _)| *size == sizes[at].0);
        let rank = (at + 1 + end) as f64 / 2.0;
        let above = sizes[at..end].iter().filter(|(_, sign)| *sign).count();
        positive += rank * above as f64;
        let equal = (end - at) as f64;
        ties += equal.powi(3) - equal;
        at = end;
    }
    let total = (n * (n + 1)) as f64 / 2.0;
    let negative = total - positive;
    let statistic = positive.min(negative);
    let whole = n == differences.len();
    let p = match ties == 0.0 && whole && n <= EXACT {
        true => exact(n, statistic as usize),
        false => {
            let count = n as f64;
            let variance = count * (count + 1.0) * (2.0 * count + 1.0) / 24.0 - ties / 48.0;
            let z = (statistic - total / 2.0) / variance.sqrt();
            2.0 * Normal::standard().cdf(z)
        }
    };
    Some(Signed {
        pairs: n,
        statistic,
        p: p.min(1.0),
        effect: (positive - negative) / total,
    })
}

/// Two-sided probability of a sum of ranks of at most `statistic`, by counting subsets of `1..=n` with each sum.
fn exact(n: usize, statistic: usize) -> f64 {
    let total = n * (n + 1) / 2;
    let mut counts = vec![0.0f64; total + 1];
    counts[0] = 1.0;
    for rank in 1..=n {
        for sum in (rank..=total).rev() {
            counts[sum] += counts[sum - rank];
        }
    }
    let below: f64 = counts[..=statistic.min(total)].iter().sum();
    2.0 * below / (n as f64).exp2()
}

/// Holm's step-down correction: adjusted p-values in the order given.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let mut adjusted = vec![0.0; p.len()];
    let mut least: f64 = 0.0;
    for (place, &index) in order.iter().enumerate() {
        least = least.max(((p.len() - place) as f64 * p[index]).min(1.0));
        adjusted[index] = least;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holm_by_hand() {
        let adjusted = holm(&[0.01, 0.04, 0.03]);
        let expected = [0.03, 0.06, 0.06];
        assert!(
            adjusted
                .iter()
                .zip(expected)
                .all(|(a, e)| (a - e).abs() < 1e-12)
        );
        assert_eq!(holm(&[]), [0.0; 0]);
        assert_eq!(holm(&[0.7, 0.8]), [1.0, 1.0]);
    }

    #[test]
    fn small_cases_by_counting_signs() {
        // All sign patterns of five differences of distinct sizes.
        for signs in 0..32u32 {
            let values: Vec<f64> = (0..5)
                .map(|i| {
                    if signs >> i & 1 == 1 {
                        1.0 + f64::from(i)
                    } else {
                        -1.0 - f64::from(i)
                    }
                })
                .collect();
            let found = signed_rank(&values).unwrap();
            let sum = |s: u32| {
                (0..5)
                    .filter(|i| s >> i & 1 == 1)
                    .map(|i| i + 1)
                    .sum::<u32>()
            };
            let t = sum(signs).min(15 - sum(signs));
            let as_small = (0..32).filter(|s| sum(*s).min(15 - sum(*s)) <= t).count();
            assert!((found.p - as_small as f64 / 32.0).abs() < 1e-12);
            assert_eq!(found.statistic, f64::from(t));
        }
        assert_eq!(signed_rank(&[0.0, 0.0]), None);
        assert_eq!(signed_rank(&[1.0, 2.0, 3.0]).unwrap().effect, 1.0);
    }
}
