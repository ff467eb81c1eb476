//! Measures of the agreement of two partitions of the same items.

/// Adjusted Rand index (Hubert and Arabie 1985) of two labelings of the same items: 1 for equal
/// partitions, 0 on average for unrelated ones. One item, or two trivial partitions, agree: 1.
pub fn adjusted_rand_index(a: &[usize], b: &[usize]) -> f64 {
    let pairs = |n: f64| n * (n - 1.0) / 2.0;
    let side = |labels: &[usize]| labels.iter().max().map_or(0, |m| m + 1);
    let mut counts = vec![vec![0.0; side(b)]; side(a)];
    for (&i, &j) in a.iter().zip(b) {
        counts[i][j] += 1.0;
    }
    let together: f64 = counts.iter().flatten().map(|&n| pairs(n)).sum();
    let rows: f64 = counts.iter().map(|row| pairs(row.iter().sum())).sum();
    let columns: f64 = (0..side(b))
        .map(|j| pairs(counts.iter().map(|row| row[j]).sum()))
        .sum();
    let all = pairs(a.len().min(b.len()) as f64);
    let expected = if all > 0.0 { rows * columns / all } else { 0.0 };
    let most = (rows + columns) / 2.0;
    if most - expected <= 0.0 {
        return 1.0;
    }
    (together - expected) / (most - expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_partitions_under_other_names_agree() {
        assert_eq!(adjusted_rand_index(&[0, 0, 1, 2], &[2, 2, 0, 1]), 1.0);
        assert_eq!(adjusted_rand_index(&[0], &[3]), 1.0);
    }

    #[test]
    fn a_case_by_hand() {
        // 2 pairs together in both; 4 and 3 in each; 15 in all.
        let (a, b) = ([0, 0, 0, 1, 1, 1], [0, 0, 1, 1, 2, 2]);
        let expected = 6.0 * 3.0 / 15.0;
        assert_eq!(
            adjusted_rand_index(&a, &b),
            (2.0 - expected) / (4.5 - expected)
        );
    }
}
