//! How well two ways to divide the same houses agree.

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

/// Precision and recall of the edges found, directions ignored; both 1 when there is nothing to
/// find or nothing found wrongly.
pub fn edge_agreement(found: &[(String, String)], truth: &[(String, String)]) -> (f64, f64) {
    let same = |x: &(String, String), y: &(String, String)| {
        (x.0 == y.0 && x.1 == y.1) || (x.0 == y.1 && x.1 == y.0)
    };
    let share = |of: &[(String, String)], among: &[(String, String)]| {
        if of.is_empty() {
            return 1.0;
        }
        let hits = of.iter().filter(|x| among.iter().any(|y| same(x, y)));
        hits.count() as f64 / of.len() as f64
    };
    (share(found, truth), share(truth, found))
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

    #[test]
    fn edges_count_without_direction() {
        let edge = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        let truth = [edge("a", "b"), edge("b", "c")];
        let found = [
            edge("b", "a"),
            edge("a", "c"),
            edge("c", "b"),
            edge("c", "d"),
        ];
        assert_eq!(edge_agreement(&found, &truth), (0.5, 1.0));
        assert_eq!(edge_agreement(&[], &truth), (1.0, 0.0));
    }
}
