//! Proportions of numbers whose sum may exceed what a float can hold.

/// Weights above this are scaled down before they are summed.
const LARGE: f64 = 1e150;

/// Factor by which large weights are scaled: a power of two, so that no digit of a weight changes.
const DOWN: f64 = 1.0 / (1u128 << 127) as f64;

/// Numbers in the same proportions as `weights`, small enough that a hundred times their sum is finite. Weights of
/// ordinary size stay as they are.
pub fn summable(weights: &[f64]) -> Vec<f64> {
    let mut weights = weights.to_vec();
    while weights.iter().any(|w| w.is_finite() && *w > LARGE) {
        weights.iter_mut().for_each(|w| *w *= DOWN);
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::summable;

    #[test]
    fn proportions_are_kept_and_sums_are_finite() {
        for large in [1e150, 1e200, 1e300, f64::MAX] {
            let weights = summable(&[large, large / 4.0, large / 8.0]);
            assert!((100.0 * weights.iter().sum::<f64>()).is_finite());
            assert_eq!(weights[0] / weights[1], 4.0);
            assert_eq!(weights[1] / weights[2], 2.0);
        }
        assert_eq!(summable(&[3.0, 0.1]), [3.0, 0.1]);
        assert_eq!(summable(&[f64::MAX, 1e-300])[1], 0.0);
    }
}
