//! The shape of the tail of importance weights.

/// Least share of a candidate among all that is kept.
const NEGLIGIBLE: f64 = 10.0 * f64::EPSILON;

/// Pareto's k of the largest `min(n / 5, 3 sqrt(n))` weights, given as logarithms: the shape of a generalised Pareto distribution
/// fitted to what they exceed the others by, with a weak prior towards 1/2. Below 0.5 the weights have a variance, below 0.7
/// estimates are of use, above 1 not even their mean exists; infinity where fewer than 5 weights exceed the others.
///
/// O(n log n + sqrt(n) m) for m in the tail. Equal to ArviZ's `psislw`. Sources: Vehtari, Simpson, Gelman, Yao and Gabry 2024, *Pareto
/// smoothed importance sampling*; Zhang and Stephens 2009.
///
/// # Examples
/// ```
/// use edifice_model::program::pareto_k;
/// // Weights u^-k have the tail k.
/// let tail = |k: f64| pareto_k(&(1..=4000).map(|i| -k * (f64::from(i) / 4000.0).ln()).collect::<Vec<_>>());
/// assert!((tail(0.3) - 0.3).abs() < 0.1 && (tail(0.9) - 0.9).abs() < 0.1);
/// ```
pub fn pareto_k(log_weights: &[f64]) -> f64 {
    let n = log_weights.len();
    let mut sorted: Vec<f64> = log_weights.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(&top) = sorted.last() else {
        return f64::INFINITY;
    };
    let count = (n as f64 / 5.0).min(3.0 * (n as f64).sqrt()).ceil() as usize;
    let Some(cut) = n.checked_sub(count + 1) else {
        return f64::INFINITY;
    };
    let cut = (sorted[cut] - top).max(f64::MIN_POSITIVE.ln());
    let tail: Vec<f64> = sorted
        .iter()
        .map(|x| x - top)
        .filter(|x| *x > cut)
        .map(|x| x.exp() - cut.exp())
        .collect();
    match tail.len() {
        0..=4 => f64::INFINITY,
        _ => shape(&tail),
    }
}

/// Empirical Bayes estimate of the shape of a generalised Pareto distribution, of rising data.
fn shape(data: &[f64]) -> f64 {
    let n = data.len() as f64;
    let candidates = 30 + n.sqrt() as usize;
    let quarter = data[(n / 4.0 + 0.5) as usize - 1];
    let largest = data[data.len() - 1];
    let k_of = |b: f64| data.iter().map(|x| (-b * x).ln_1p()).sum::<f64>() / n;
    let b: Vec<f64> = (1..=candidates)
        .map(|i| 1.0 - (candidates as f64 / (i as f64 - 0.5)).sqrt())
        .map(|b| b / (3.0 * quarter) + 1.0 / largest)
        .collect();
    let fits: Vec<f64> = b
        .iter()
        .map(|&b| {
            let k = k_of(b);
            n * ((-b / k).ln() - k - 1.0)
        })
        .collect();
    let share = |i: usize| 1.0 / fits.iter().map(|f| (f - fits[i]).exp()).sum::<f64>();
    let (mut sum, mut mean) = (0.0, 0.0);
    for (i, b) in b.iter().enumerate() {
        let share = share(i);
        if share >= NEGLIGIBLE {
            sum += share;
            mean += share * b;
        }
    }
    (n * k_of(mean / sum) + 5.0) / (n + 10.0)
}
