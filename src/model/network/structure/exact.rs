//! The structure of highest score of a few variables, by dynamic programs over sets of variables (Silander and Myllymäki 2006).
//!
//! ```text
//! b(i, C) = max over U in C of score(i, U)                       best parents of variable i among the candidates C
//! s(W)    = max over i in W of s(W \ {i}) + b(i, W \ {i})        best structure of the variables W; i is a sink of it
//! ```
//! Every structure without a cycle has a sink, so that `s` of all variables is the highest score of all structures.
//!
//! Time: `O(n² 2ⁿ)` besides the `n 2ⁿ⁻¹` families.

use super::constraints::Allowed;
use super::families::Families;

/// Most variables for which all families are counted.
pub(super) const MOST: usize = 6;

/// Parents of each variable, ascending, and the score; `None` where the constraints leave no structure.
pub(super) fn best(
    families: &mut Families,
    allowed: &Allowed,
    most_parents: usize,
) -> Option<(Vec<Vec<usize>>, f64)> {
    let n = families.variables();
    let members = |set: usize| (0..n).filter(move |&i| set >> i & 1 == 1);
    // For each variable and set of candidates, the score and the set of the best parents among them.
    let mut chosen = vec![vec![(f64::NEG_INFINITY, 0); 1 << n]; n];
    for (child, chosen) in chosen.iter_mut().enumerate() {
        let required = allowed.required[child]
            .iter()
            .fold(0, |set, &p| set | 1 << p);
        for set in (0..1_usize << n).filter(|set| set >> child & 1 == 0) {
            let may = set & required == required
                && set.count_ones() as usize <= most_parents
                && members(set).all(|p| allowed.may(p, child));
            if may {
                let parents: Vec<usize> = members(set).collect();
                chosen[set] = (families.score(child, &parents), set);
            }
            for p in members(set) {
                let fewer = chosen[set & !(1 << p)];
                if fewer.0 > chosen[set].0 {
                    chosen[set] = fewer;
                }
            }
        }
    }
    // For each set of variables, the score of its best structure and a sink of it.
    let mut scores = vec![(f64::NEG_INFINITY, 0); 1 << n];
    scores[0].0 = 0.0;
    for set in 1..1_usize << n {
        for sink in members(set) {
            let rest = set & !(1 << sink);
            let score = scores[rest].0 + chosen[sink][rest].0;
            if score > scores[set].0 {
                scores[set] = (score, sink);
            }
        }
    }
    let all = (1 << n) - 1;
    let mut parents = vec![Vec::new(); n];
    let mut set = all;
    while set > 0 {
        let (score, sink) = scores[set];
        if score == f64::NEG_INFINITY {
            return None;
        }
        set &= !(1 << sink);
        parents[sink] = members(chosen[sink][set].1).collect();
    }
    Some((parents, scores[all].0))
}
