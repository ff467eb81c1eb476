//! The choice of elements by expected F1.
//!
//! With `p_i` the probability that candidate `i` is true and `E[n]` the expected number of hidden elements, a set `S`
//! has the expected score `2 sum_{i in S} p_i / (|S| + E[n])` (the ratio of expectations). Candidates are taken by
//! falling probability, as long as that rises and none of those taken excludes them.

use super::candidates::Candidates;

/// Indices of the chosen candidates, by falling probability, and the expected score.
pub fn select(candidates: &Candidates, probability: &[f64], expected: f64) -> (Vec<usize>, f64) {
    let mut order: Vec<usize> = (0..probability.len()).collect();
    order.sort_by(|&a, &b| probability[b].total_cmp(&probability[a]).then(a.cmp(&b)));
    let mut chosen: Vec<usize> = Vec::new();
    let (mut sum, mut score) = (0.0, 0.0);
    for index in order {
        let element = &candidates.all[index].element;
        let excluded = |&other: &usize| {
            let other = &candidates.all[other].element;
            other.excludes(element)
                || (other.class == element.class && other.rect.iou(&element.rect) > 0.3)
        };
        if chosen.iter().any(excluded) {
            continue;
        }
        let next = 2.0 * (sum + probability[index])
            / ((chosen.len() + 1) as f64 + expected.max(sum + probability[index]));
        if next < score {
            break;
        }
        sum += probability[index];
        score = next;
        chosen.push(index);
    }
    (chosen, score)
}
