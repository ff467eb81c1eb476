//! Directed graphs, given by the parents of every vertex.

use super::error::ModelError;

/// Topological order: every parent before its children; the name of a vertex on a cycle otherwise.
pub(crate) fn order(parents: &[Vec<usize>], names: &[String]) -> Result<Vec<usize>, ModelError> {
    let mut done = vec![false; parents.len()];
    let mut order = Vec::with_capacity(parents.len());
    while order.len() < parents.len() {
        let ready = (0..parents.len()).find(|&g| !done[g] && parents[g].iter().all(|&p| done[p]));
        match ready {
            Some(g) => {
                done[g] = true;
                order.push(g);
            }
            None => {
                // Every unfinished vertex has an unfinished parent: walking up ends on a cycle.
                let mut g = (0..parents.len()).find(|&g| !done[g]).unwrap_or(0);
                for _ in 0..parents.len() {
                    g = parents[g].iter().copied().find(|&p| !done[p]).unwrap_or(g);
                }
                return Err(ModelError::Cycle {
                    variable: names[g].clone(),
                });
            }
        }
    }
    Ok(order)
}

/// True if `to` is `from` or a descendant of it.
pub(crate) fn reaches(parents: &[Vec<usize>], from: usize, to: usize) -> bool {
    to == from || parents[to].iter().any(|&p| reaches(parents, from, p))
}
