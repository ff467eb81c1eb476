//! Bootstrap intervals of a mean over instances and seeds.

use rand::RngExt;

use edifice_base::rng::Stream;

/// A mean with an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Mean over instances of the means over seeds.
    pub mean: f64,
    /// 2.5th percentile of the resampled means.
    pub low: f64,
    /// 97.5th percentile.
    pub high: f64,
}

/// Times that instances and seeds are resampled.
const RESAMPLES: usize = 2_000;

/// The mean of values by instance and seed, with a 95 % percentile interval; `None` without values.
///
/// Each resample draws as many instances as there are, with replacement, and within each as many seeds as it has.
pub fn bootstrap(by_instance: &[Vec<f64>], rng: &mut Stream) -> Option<Interval> {
    let groups: Vec<&Vec<f64>> = by_instance
        .iter()
        .filter(|group| !group.is_empty())
        .collect();
    if groups.is_empty() {
        return None;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let means: Vec<f64> = groups.iter().map(|group| mean(group)).collect();
    let mut resampled: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let mut sum = 0.0;
            for _ in 0..groups.len() {
                let group = groups[rng.random_range(0..groups.len())];
                let drawn = (0..group.len()).map(|_| group[rng.random_range(0..group.len())]);
                sum += drawn.sum::<f64>() / group.len() as f64;
            }
            sum / groups.len() as f64
        })
        .collect();
    resampled.sort_by(f64::total_cmp);
    let quantile = |q: f64| resampled[((RESAMPLES - 1) as f64 * q).round() as usize];
    Some(Interval {
        mean: mean(&means),
        low: quantile(0.025),
        high: quantile(0.975),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;

    #[test]
    fn the_interval_covers_the_true_mean_as_often_as_it_says() {
        let mut covered = 0;
        for trial in 0..200 {
            let mut rng = stream(3, "coverage", trial);
            let data: Vec<Vec<f64>> = (0..25)
                .map(|_| {
                    let centre: f64 = (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
                    (0..3).map(|_| centre + rng.random::<f64>() - 0.5).collect()
                })
                .collect();
            let interval = bootstrap(&data, &mut rng).unwrap();
            covered += usize::from(interval.low <= 0.0 && 0.0 <= interval.high);
        }
        // Percentile intervals of 25 instances are a little narrow; 200 trials have a standard error of 1.5 %.
        assert!((178..=198).contains(&covered), "{covered} of 200");
    }

    #[test]
    fn degenerate_data() {
        let rng = &mut stream(0, "bootstrap", 0);
        assert_eq!(bootstrap(&[], rng), None);
        assert_eq!(bootstrap(&[vec![]], rng), None);
        let one = bootstrap(&[vec![2.5]], rng).unwrap();
        assert_eq!((one.mean, one.low, one.high), (2.5, 2.5, 2.5));
    }
}
