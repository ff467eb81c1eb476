//! Diagnostics of chains: R-hat, effective sample sizes, and Monte Carlo errors.
//!
//! Draws of M chains of N each, of one number. Each chain is split into halves, so that one that drifts disagrees with itself. With B
//! the variance between and W within the halves,
//!
//! ```text
//! R-hat = sqrt(((N - 1) / N W + B / N) / W)
//! ```
//! of the draws' normal scores `Φ⁻¹((rank - 3/8) / (n + 1/4))`, and of the scores of their distances from the median; the larger one counts.
//! The effective sample size is `M N / τ`, `τ = -1 + 2 Σ_t ρ_t` with the autocorrelations summed in pairs up to the first
//! negative pair, made monotone (Geyer 1992): *bulk* of the normal scores, *tail* the smaller one of the indicators below the 5 % and
//! 95 % quantiles. The Monte Carlo error of a mean is the deviation over the root of its effective sample size.
//!
//! Every function takes chains of equal length, at least 4 draws each; the result is not a number where a draw is none, or
//! where there are fewer. They are equal to those of ArviZ 0.23 of the same names, which a test holds them to.
//!
//! Source: Vehtari, Gelman, Simpson, Carpenter and Bürkner 2021, *Rank-normalization, folding, and localization*.
//!
//! # Examples
//! ```
//! use edifice_model::program::diagnostics::{ess_bulk, mcse_mean, r_hat};
//! use edifice_base::rng::stream;
//! use rand::RngExt;
//! let chain = |i| { let mut rng = stream(1, "chain", i); (0..1000).map(|_| rng.random::<f64>()).collect() };
//! let mut chains: Vec<Vec<f64>> = (0..4).map(chain).collect();
//! assert!(r_hat(&chains) < 1.01 && ess_bulk(&chains) > 3000.0);
//! assert!((mcse_mean(&chains) - (1.0 / 12.0_f64 / 4000.0).sqrt()).abs() < 1e-3);
//! chains[0].iter_mut().for_each(|x| *x += 1.0);
//! assert!(r_hat(&chains) > 1.5);
//! ```

use statrs::distribution::{ContinuousCDF, Normal};

/// R-hat, rank-normalised and folded; not a number for one chain. Below 1.01 where chains agree.
pub fn r_hat(chains: &[Vec<f64>]) -> f64 {
    if chains.len() < 2 || !valid(chains) {
        return f64::NAN;
    }
    let split = split(chains);
    let middle = median(&split.concat());
    let folded = map(&split, |x| (x - middle).abs());
    // As `max` of Python, which keeps the first of what cannot be compared.
    let (bulk, tail) = (plain_r_hat(&scores(&split)), plain_r_hat(&scores(&folded)));
    if tail > bulk { tail } else { bulk }
}

/// Effective sample size of the bulk: of the normal scores.
pub fn ess_bulk(chains: &[Vec<f64>]) -> f64 {
    match valid(chains) {
        true => ess(&scores(&split(chains))),
        false => f64::NAN,
    }
}

/// Effective sample size of the tails: the smaller one of those of the 5 % and 95 % quantiles.
pub fn ess_tail(chains: &[Vec<f64>]) -> f64 {
    ess_quantile(chains, 0.05).min(ess_quantile(chains, 0.95))
}

/// Effective sample size of a quantile.
pub fn ess_quantile(chains: &[Vec<f64>], probability: f64) -> f64 {
    if !valid(chains) {
        return f64::NAN;
    }
    let at = quantile(&chains.concat(), probability);
    ess(&split(&map(chains, |x| f64::from(u8::from(x <= at)))))
}

/// Effective sample size of the mean.
pub fn ess_mean(chains: &[Vec<f64>]) -> f64 {
    match valid(chains) {
        true => ess(&split(chains)),
        false => f64::NAN,
    }
}

/// Monte Carlo standard error of the mean, in the unit of the draws.
pub fn mcse_mean(chains: &[Vec<f64>]) -> f64 {
    let all = chains.concat();
    let n = all.len() as f64;
    (variance(&all) * n / (n - 1.0)).sqrt() / ess_mean(chains).sqrt()
}

/// Monte Carlo standard error of the standard deviation, in the unit of the draws.
pub fn mcse_sd(chains: &[Vec<f64>]) -> f64 {
    let middle = mean(&chains.concat());
    let squares = map(chains, |x| (x - middle).powi(2));
    let all = squares.concat();
    let second = mean(&all);
    let fourth = mean(&all.iter().map(|s| s * s).collect::<Vec<_>>());
    let error = (fourth - second * second) / ess_mean(&squares);
    (error / second / 4.0).sqrt()
}

/// A quantile between the order statistics (type 7); not a number of nothing.
pub fn quantile(draws: &[f64], probability: f64) -> f64 {
    let mut sorted = draws.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let at = probability.clamp(0.0, 1.0) * last as f64;
    let (low, share) = (at.floor() as usize, at.fract());
    let high = (low + 1).min(last);
    (1.0 - share) * sorted[low] + share * sorted[high]
}

fn valid(chains: &[Vec<f64>]) -> bool {
    let n = chains.first().map_or(0, Vec::len);
    n >= 4
        && chains
            .iter()
            .all(|c| c.len() == n && c.iter().all(|x| x.is_finite()))
}

fn map(chains: &[Vec<f64>], f: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
    let each = chains.iter().map(|c| c.iter().map(|&x| f(x)).collect());
    each.collect()
}

/// First halves, then second halves; the middle draw of an odd number is left out.
fn split(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let first = chains.iter().map(|c| c[..c.len() / 2].to_vec());
    let second = chains.iter().map(|c| c[c.len().div_ceil(2)..].to_vec());
    first.chain(second).collect()
}

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

/// Mean square distance from the mean.
fn variance(x: &[f64]) -> f64 {
    let m = mean(x);
    x.iter().map(|x| (x - m).powi(2)).sum::<f64>() / x.len() as f64
}

fn median(x: &[f64]) -> f64 {
    quantile(x, 0.5)
}

/// Normal scores of the ranks; equal draws share their mean rank.
fn scores(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n: usize = chains.iter().map(Vec::len).sum();
    let mut order: Vec<(f64, usize)> = chains.concat().into_iter().zip(0..n).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut all = vec![0.0; n];
    let mut before = 0;
    for equal in order.chunk_by(|a, b| a.0 == b.0) {
        // Ranks count from 1.
        let rank = before as f64 + (equal.len() as f64 + 1.0) / 2.0;
        before += equal.len();
        let score = Normal::standard().inverse_cdf((rank - 0.375) / (n as f64 + 0.25));
        equal.iter().for_each(|&(_, i)| all[i] = score);
    }
    let length = chains.first().map_or(1, Vec::len);
    all.chunks(length).map(<[f64]>::to_vec).collect()
}

fn plain_r_hat(chains: &[Vec<f64>]) -> f64 {
    let (m, n) = (chains.len() as f64, chains[0].len() as f64);
    let means: Vec<f64> = chains.iter().map(|c| mean(c)).collect();
    let between = n * variance(&means) * m / (m - 1.0);
    let within: Vec<f64> = chains.iter().map(|c| variance(c) * n / (n - 1.0)).collect();
    ((between / mean(&within) + n - 1.0) / n).sqrt()
}

/// Mean autocovariance of the chains at a lag.
fn autocovariance(centred: &[Vec<f64>], lag: usize) -> f64 {
    let one = |c: &Vec<f64>| {
        let products = c.iter().zip(&c[lag..]).map(|(a, b)| a * b);
        products.sum::<f64>() / c.len() as f64
    };
    centred.iter().map(one).sum::<f64>() / centred.len() as f64
}

/// Effective sample size of chains as they are. O(draws x lags until the first negative pair).
fn ess(chains: &[Vec<f64>]) -> f64 {
    let (m, n) = (chains.len(), chains[0].len());
    let all = chains.concat();
    let range = all.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - all.iter().copied().fold(f64::INFINITY, f64::min);
    if range < 1e-15 {
        return all.len() as f64;
    }
    let means: Vec<f64> = chains.iter().map(|c| mean(c)).collect();
    let centred = chains.iter().zip(&means);
    let centred: Vec<Vec<f64>> = centred
        .map(|(c, m)| c.iter().map(|x| x - m).collect())
        .collect();
    let own = autocovariance(&centred, 0) * n as f64 / (n as f64 - 1.0);
    let mut plus = own * (n as f64 - 1.0) / n as f64;
    if m > 1 {
        plus += variance(&means) * m as f64 / (m as f64 - 1.0);
    }
    let correlation = |lag: usize| 1.0 - (own - autocovariance(&centred, lag)) / plus;
    let mut rho = vec![0.0; n.max(2)];
    let (mut even, mut odd) = (1.0, correlation(1));
    (rho[0], rho[1]) = (even, odd);
    // Geyer's initial positive sequence.
    let mut t = 1;
    while t + 3 < n && even + odd > 0.0 {
        (even, odd) = (correlation(t + 1), correlation(t + 2));
        if even + odd >= 0.0 {
            (rho[t + 1], rho[t + 2]) = (even, odd);
        }
        t += 2;
    }
    // The last lag of a pair that counts, plus one: t - 2 may be below zero.
    let end = (t + 1).saturating_sub(2);
    if even > 0.0 && end < rho.len() {
        rho[end] = even;
    }
    // Geyer's initial monotone sequence.
    let mut t = 1;
    while t + 3 <= end {
        let before = rho[t - 1] + rho[t];
        if rho[t + 1] + rho[t + 2] > before {
            rho[t + 1] = before / 2.0;
            rho[t + 2] = before / 2.0;
        }
        t += 2;
    }
    let count = (m * n) as f64;
    let tau = -1.0 + 2.0 * rho[..end].iter().sum::<f64>() + rho.get(end).copied().unwrap_or(0.0);
    count / tau.max(1.0 / count.log10())
}
