//! The area under the curve of a classifier's scores.

use std::cmp::Ordering;

/// The chance that a score of `positive` is above one of `negative`, ties counting half: 1/2 where nothing tells them apart, and of no scores.
pub fn area_under_curve(positive: &[f64], negative: &[f64]) -> f64 {
    if positive.is_empty() || negative.is_empty() {
        return 0.5;
    }
    let wins = positive.iter().flat_map(|p| {
        negative.iter().map(move |n| match p.total_cmp(n) {
            Ordering::Greater => 1.0,
            Ordering::Equal => 0.5,
            Ordering::Less => 0.0,
        })
    });
    wins.sum::<f64>() / (positive.len() * negative.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::area_under_curve;

    #[test]
    fn pairs_in_order_over_all_pairs() {
        assert_eq!(area_under_curve(&[2.0, 3.0], &[0.0, 1.0]), 1.0);
        assert_eq!(area_under_curve(&[0.0, 1.0], &[2.0, 3.0]), 0.0);
        assert_eq!(area_under_curve(&[1.0, 1.0], &[1.0]), 0.5);
        assert_eq!(area_under_curve(&[0.0, 2.0], &[1.0]), 0.5);
        assert_eq!(area_under_curve(&[], &[1.0]), 0.5);
    }
}
