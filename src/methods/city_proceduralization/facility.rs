//! Facility location: of some candidates those are chosen that serve best.
//!
//! The cost of a customer i is the least cost c(i, k) of the chosen candidates k. One candidate after the other is chosen: always the one that
//! removes most cost for its own price. Gains only fall as more are chosen, so that a gain that was computed before is a bound (the lazy
//! greedy choice of submodular facility location, Minoux 1978).

use std::collections::BinaryHeap;

use super::gain::Gain;

/// Candidates, and what customers still cost.
pub(super) struct Facilities {
    /// For each candidate, the customers that it may serve, and at which cost.
    pub(super) served: Vec<Vec<(usize, f64)>>,
    /// Price of each candidate, above 0.
    pub(super) price: Vec<f64>,
    /// Cost of each customer by those chosen.
    pub(super) left: Vec<f64>,
}

impl Facilities {
    /// The cost that a candidate would remove, per price.
    pub(super) fn gain(&self, candidate: usize) -> Gain {
        let won = self.served[candidate].iter();
        let won = won.map(|&(i, cost)| (self.left[i] - cost).max(0.0));
        Gain {
            value: won.sum::<f64>() / self.price[candidate],
            candidate,
        }
    }

    /// Chooses a candidate.
    pub(super) fn take(&mut self, candidate: usize) {
        for &(i, cost) in &self.served[candidate] {
            self.left[i] = self.left[i].min(cost);
        }
    }

    /// Chooses candidates beside those `chosen`, until there are `count` or none removes any cost.
    pub(super) fn choose(&mut self, mut chosen: Vec<usize>, count: usize) -> Vec<usize> {
        let mut is_chosen = vec![false; self.served.len()];
        chosen.iter().for_each(|&k| is_chosen[k] = true);
        let mut heap: BinaryHeap<Gain> = (0..self.served.len()).map(|k| self.gain(k)).collect();
        while chosen.len() < count
            && let Some(top) = heap.pop()
        {
            if is_chosen[top.candidate] {
                continue;
            }
            let now = self.gain(top.candidate);
            // Gains only fall: one that is still the largest is.
            if heap.peek().is_some_and(|next| now.value < next.value) {
                heap.push(now);
                continue;
            }
            if now.value <= 0.0 {
                break;
            }
            self.take(top.candidate);
            is_chosen[top.candidate] = true;
            chosen.push(top.candidate);
        }
        chosen
    }
}
