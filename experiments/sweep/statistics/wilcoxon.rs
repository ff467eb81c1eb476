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

/// Most pairs for which the distribution of the statistic is counted out: without ties, and with them.
const EXACT: usize = 50;
const EXACT_TIED: usize = 13;

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
    let mut doubled = Vec::with_capacity(n);
    while at < n {
        let end = at + sizes[at..].partition_point(|(size, _)| *size == sizes[at].0);
        let rank = (at + 1 + end) as f64 / 2.0;
        let above = sizes[at..end].iter().filter(|(_, sign)| *sign).count();
        positive += rank * above as f64;
        doubled.extend(std::iter::repeat_n(at + 1 + end, end - at));
        let equal = (end - at) as f64;
        ties += equal.powi(3) - equal;
        at = end;
    }
    let total = (n * (n + 1)) as f64 / 2.0;
    let negative = total - positive;
    let statistic = positive.min(negative);
    let whole = n == differences.len();
    let untied = ties == 0.0 && whole && n <= EXACT;
    let p = match untied || differences.len() <= EXACT_TIED {
        true => exact(&doubled, (2.0 * statistic) as usize),
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

/// Two-sided probability of a sum of ranks of at most `statistic`, by counting the sets of ranks with each sum; ranks and statistic
/// are doubled, so that those of ties are whole.
fn exact(ranks: &[usize], statistic: usize) -> f64 {
    let total = ranks.iter().sum();
    let mut counts = vec![0.0f64; total + 1];
    counts[0] = 1.0;
    for &rank in ranks {
        for sum in (rank..=total).rev() {
            counts[sum] += counts[sum - rank];
        }
    }
    let below: f64 = counts[..=statistic.min(total)].iter().sum();
    2.0 * below / (ranks.len() as f64).exp2()
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

    /// Numbers in [-0.45, 0.55), on a grid where one is given.
    fn data(n: usize, seed: u64, grid: Option<f64>) -> Vec<f64> {
        let mut x = seed;
        (0..n)
            .map(|_| {
                x = (1_103_515_245 * x + 12_345) % (1 << 31);
                let value = x as f64 / f64::from(1u32 << 31) - 0.45;
                grid.map_or(value, |grid| (value * grid).round_ties_even() / grid)
            })
            .collect()
    }

    /// SciPy 1.17.1, `scipy.stats.wilcoxon(d)`.
    #[test]
    fn as_scipy_says() {
        let printed = [
            (8, 1, None, 16.0, 0.84375),
            (20, 2, None, 76.0, 0.2942523956298828),
            (50, 3, None, 573.0, 0.5398998476772991),
            (60, 4, None, 905.0, 0.9413159156405683),
            (20, 5, Some(10.0), 37.0, 0.01056626393180698),
            (40, 6, Some(20.0), 214.0, 0.02300903643250819),
            (12, 7, Some(5.0), 28.5, 0.43701171875),
        ];
        for (n, seed, grid, statistic, p) in printed {
            let found = signed_rank(&data(n, seed, grid)).unwrap();
            assert_eq!(found.statistic, statistic, "{n} {seed}");
            assert!(
                (found.p - p).abs() < 1e-12,
                "{n} {seed}: {} for {p}",
                found.p
            );
        }
    }

    /// statsmodels 0.14, `multipletests(p, method="holm")`.
    #[test]
    fn holm_as_statsmodels_says() {
        let adjusted = holm(&[0.01, 0.04, 0.03, 0.2, 0.005]);
        let printed = [0.04, 0.09, 0.09, 0.2, 0.025];
        assert!(
            adjusted
                .iter()
                .zip(printed)
                .all(|(a, p)| (a - p).abs() < 1e-12)
        );
    }

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
