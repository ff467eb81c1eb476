//! Estimates of `V(R)` from one completed walk (Sec. 4.5).

use crate::regions::TypeId;
use crate::rules::AddRule;

/// Sums the rules that each type of a walk needs; keeps its tables between calls.
#[derive(Debug, Default)]
pub(crate) struct ValueEstimates {
    /// Step of the walk that gave each type its rule; `NONE` for others.
    step: Vec<u32>,
    /// Steps for the successors of each step's rule, and where those of the next step begin.
    needed: Vec<u32>,
    ends: Vec<usize>,
    /// Last step whose sum counts each step.
    counted: Vec<u32>,
    waiting: Vec<u32>,
}

/// The entry of a type that has no rule in the walk.
const NONE: u32 = u32::MAX;

impl ValueEstimates {
    /// For each step of the walk, the cost of its rule and of all rules below, shared ones once.
    pub(crate) fn costs(&mut self, walk: &[AddRule], costs: &[f64]) -> Vec<f64> {
        let types = walk.iter().map(|a| a.id as usize + 1).max().unwrap_or(0);
        if self.step.len() < types {
            self.step.resize(types, NONE);
        }
        for (step, action) in walk.iter().enumerate() {
            self.step[action.id as usize] = step as u32;
        }
        self.needed.clear();
        self.ends.clear();
        for action in walk {
            let successors = action.candidate.successors.iter();
            let steps = successors.filter_map(|&s: &TypeId| self.step.get(s as usize));
            self.needed.extend(steps.filter(|step| **step != NONE));
            self.ends.push(self.needed.len());
        }
        for action in walk {
            self.step[action.id as usize] = NONE;
        }
        self.counted.clear();
        self.counted.resize(walk.len(), NONE);
        (0..walk.len() as u32)
            .map(|step| self.sum_below(step, costs))
            .collect()
    }

    fn sum_below(&mut self, start: u32, costs: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.waiting.push(start);
        self.counted[start as usize] = start;
        while let Some(step) = self.waiting.pop() {
            let step = step as usize;
            sum += costs[step];
            let first = step.checked_sub(1).map_or(0, |before| self.ends[before]);
            for &needed in &self.needed[first..self.ends[step]] {
                let counted = &mut self.counted[needed as usize];
                if *counted != start {
                    *counted = start;
                    self.waiting.push(needed);
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use std::rc::Rc;

    use super::*;
    use crate::rules::{Arrangement, RuleCandidate};
    use edifice_shape::Axis;

    fn step(id: TypeId, successors: &[TypeId]) -> AddRule {
        let candidate = RuleCandidate {
            arrangement: Arrangement::Split(Axis::X),
            lines: Vec::new(),
            rows: Vec::new(),
            successors: successors.to_vec(),
        };
        AddRule {
            id,
            candidate: Rc::new(candidate),
        }
    }

    #[test]
    fn shared_rules_count_once() {
        // 9 needs 7 and twice 5; 7 needs 5; 1 is a terminal.
        let walk = [step(9, &[7, 5, 1, 5]), step(7, &[5, 1]), step(5, &[1, 1])];
        let mut estimates = ValueEstimates::default();
        assert_eq!(estimates.costs(&walk, &[4.0, 2.0, 1.0]), [7.0, 3.0, 1.0]);
        // Nothing stays of one walk for the next, which gives 7 no rule.
        let walk = [step(9, &[7, 5]), step(5, &[1])];
        assert_eq!(estimates.costs(&walk, &[2.0, 1.0]), [3.0, 1.0]);
        assert_eq!(estimates.costs(&[], &[]), [0.0; 0]);
    }
}
