//! Agreement of the edges of two structures: precision and recall.

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
