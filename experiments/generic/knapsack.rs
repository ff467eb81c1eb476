//! Knapsack problems with a known optimum: what the optimizers are compared on.
//!
//! Of items with a value and a weight, choose some whose weights sum to at most the capacity; the cost is the value of those
//! that are left out.

use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;

use edifice_base::{Error, Result};
use edifice_io::{json, read_bytes};
use edifice_sweep::{Outcome, Shared};

/// A problem.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Knapsack {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "version")]
    _version: u64,
    /// Most weight.
    pub capacity: u64,
    /// Value and weight of each item.
    pub items: Vec<(u64, u64)>,
}

const FORMAT: &str = "edifice/knapsack";

/// The errors of a problem or a solution.
#[derive(Debug, thiserror::Error)]
enum KnapsackError {
    #[error("there are no items")]
    Empty,
    #[error("the table of the exact solution would be too large: capacity {0}")]
    TooLarge(u64),
    #[error("the optimizer packed more than the capacity: {weight} of {capacity}")]
    Overfull { weight: u64, capacity: u64 },
}

/// Largest capacity.
const MOST: u64 = 1_000_000;

/// A problem with the least cost of any solution.
pub(crate) struct Solved {
    /// The problem.
    pub problem: Knapsack,
    least: u64,
}

impl Solved {
    /// Reads a problem and solves it by dynamic programming.
    ///
    /// # Errors
    /// [`Error::Input`], [`Error::Content`].
    pub(crate) fn read(path: &Path) -> Result<Arc<Self>> {
        static SOLVED: Shared<Solved> = Shared::new();
        SOLVED.get(path.display().to_string(), || {
            let bytes = read_bytes(path)?;
            json::check_header(&bytes, path, FORMAT, 1)?;
            let problem: Knapsack = json::parse_json(&bytes, path)?;
            if problem.items.is_empty() {
                return Err(Error::content(path, KnapsackError::Empty));
            }
            if problem.capacity > MOST {
                return Err(Error::content(
                    path,
                    KnapsackError::TooLarge(problem.capacity),
                ));
            }
            let least = problem.total() - problem.most_value();
            Ok(Solved { problem, least })
        })
    }

    /// The outcome of a solution, computed from the problem alone.
    ///
    /// # Errors
    /// [`Error::Method`] for one that does not fit.
    pub(crate) fn judge(&self, packed: &[bool]) -> Result<Outcome> {
        let chosen = || self.problem.items.iter().zip(packed).filter(|(_, p)| **p);
        let weight = chosen().map(|((_, weight), _)| weight).sum::<u64>();
        let value = chosen().map(|((value, _), _)| value).sum::<u64>();
        let capacity = self.problem.capacity;
        if weight > capacity {
            return Err(Error::method(KnapsackError::Overfull { weight, capacity }));
        }
        let mut found = Outcome::default();
        let left = (self.problem.total() - value) as f64;
        found.metrics.insert("left_out".into(), left);
        let optimal = f64::from(u8::from(self.problem.total() - value == self.least));
        found.metrics.insert("optimal".into(), optimal);
        found.bound = Some(self.least as f64);
        Ok(found)
    }
}

impl Knapsack {
    /// Value of all items.
    pub(crate) fn total(&self) -> u64 {
        self.items.iter().map(|(value, _)| value).sum()
    }

    /// Takes out items, those of least value for their weight first, until the rest fits.
    pub(crate) fn repair(&self, packed: &mut [bool]) {
        let mut weight: u64 = (self.items.iter().zip(&*packed))
            .filter(|(_, p)| **p)
            .map(|((_, weight), _)| weight)
            .sum();
        while weight > self.capacity {
            let worst = (0..packed.len())
                .filter(|&i| packed[i] && self.items[i].1 > 0)
                .min_by(|&a, &b| {
                    let (a, b) = (self.items[a], self.items[b]);
                    (a.0 * b.1).cmp(&(b.0 * a.1))
                });
            let Some(worst) = worst else { break };
            packed[worst] = false;
            weight -= self.items[worst].1;
        }
    }

    /// The most value that fits: `best[c] = max(best[c], best[c - weight] + value)`, item by item.
    fn most_value(&self) -> u64 {
        let mut best = vec![0u64; self.capacity as usize + 1];
        for &(value, weight) in &self.items {
            let weight = weight.min(self.capacity + 1) as usize;
            for c in (weight..best.len()).rev() {
                best[c] = best[c].max(best[c - weight] + value);
            }
        }
        best[self.capacity as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(capacity: u64, items: Vec<(u64, u64)>) -> Knapsack {
        Knapsack {
            _format: FORMAT.into(),
            _version: 1,
            capacity,
            items,
        }
    }

    #[test]
    fn the_optimum_is_that_of_enumeration() {
        let mut state = 7u64;
        let mut draw = |most: u64| {
            state = state * 48_271 % 2_147_483_647;
            state % most
        };
        for _ in 0..200 {
            let items: Vec<(u64, u64)> = (0..8).map(|_| (draw(20), draw(12))).collect();
            let knapsack = problem(draw(40), items.clone());
            let best = (0u32..256)
                .filter_map(|set| {
                    let own = || (0..8).filter(|i| set >> i & 1 == 1);
                    let weight: u64 = own().map(|i| items[i].1).sum();
                    let value: u64 = own().map(|i| items[i].0).sum();
                    (weight <= knapsack.capacity).then_some(value)
                })
                .max();
            assert_eq!(Some(knapsack.most_value()), best);
            let mut all = vec![true; 8];
            knapsack.repair(&mut all);
            let least = knapsack.total() - knapsack.most_value();
            let solved = Solved {
                problem: knapsack,
                least,
            };
            let found = solved.judge(&all).unwrap();
            assert!(found.metrics["left_out"] >= found.bound.unwrap());
        }
    }

    #[test]
    fn a_solution_that_does_not_fit_is_refused() {
        let solved = Solved {
            problem: problem(3, vec![(1, 2), (1, 2)]),
            least: 1,
        };
        assert!(solved.judge(&[true, true]).is_err());
        assert_eq!(
            solved.judge(&[true, false]).unwrap().metrics["optimal"],
            1.0
        );
    }
}
