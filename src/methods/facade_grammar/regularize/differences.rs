//! Systems of constraints on differences of whole numbers.

/// `value[to] >= value[from] + least`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Index of the lower variable.
    pub from: usize,
    /// Index of the higher variable.
    pub to: usize,
    /// Least difference; may be negative.
    pub least: i64,
}

/// The two constraints that make `value[to] - value[from]` exactly `size`.
pub fn exactly(from: usize, to: usize, size: i64) -> [Difference; 2] {
    let up = Difference {
        from,
        to,
        least: size,
    };
    let down = Difference {
        from: to,
        to: from,
        least: -size,
    };
    [up, down]
}

/// Whole numbers between bounds under constraints on their differences, known to be feasible.
///
/// Keeps the least solution: adding a constraint can only raise it, until a value passes its upper
/// bound, which proves that there is no solution (Bellman and Ford's argument).
#[derive(Debug, Clone)]
pub struct Differences {
    least: Vec<i64>,
    upper: Vec<i64>,
    /// Constraints by their `from`.
    above: Vec<Vec<(usize, i64)>>,
}

impl Differences {
    /// Variables between bounds; `None` when some have no room.
    pub fn new(lower: Vec<i64>, upper: Vec<i64>) -> Option<Self> {
        let room = lower.iter().zip(&upper).all(|(l, u)| l <= u);
        room.then(|| Self {
            above: vec![Vec::new(); lower.len()],
            least: lower,
            upper,
        })
    }

    /// The least solution.
    pub fn values(&self) -> &[i64] {
        &self.least
    }

    /// Adds all constraints if they leave a solution; otherwise adds none. Whether it did.
    pub fn add(&mut self, constraints: &[Difference]) -> bool {
        for c in constraints {
            self.above[c.from].push((c.to, c.least));
        }
        let mut raised = self.least.clone();
        let mut queue: Vec<usize> = constraints.iter().map(|c| c.from).collect();
        let mut feasible = true;
        'raise: while let Some(from) = queue.pop() {
            for &(to, least) in &self.above[from] {
                let needed = raised[from] + least;
                if needed > self.upper[to] {
                    feasible = false;
                    break 'raise;
                }
                if needed > raised[to] {
                    raised[to] = needed;
                    queue.push(to);
                }
            }
        }
        if feasible {
            self.least = raised;
        } else {
            for c in constraints.iter().rev() {
                self.above[c.from].pop();
            }
        }
        feasible
    }

    /// Whether whole numbers satisfy every bound and constraint; `lower` are the bounds from below.
    pub fn holds(&self, values: &[i64], lower: &[i64]) -> bool {
        let bounds = (0..values.len()).all(|k| lower[k] <= values[k] && values[k] <= self.upper[k]);
        let above = |from: usize| {
            let mut rows = self.above[from].iter();
            rows.all(|&(to, least)| values[to] >= values[from] + least)
        };
        bounds && (0..values.len()).all(above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Oracle: try every value.
        #[test]
        fn agrees_with_enumeration(
            constraints in prop::collection::vec((0usize..3, 0usize..3, -3i64..4), 1..7)
        ) {
            let all = |values: &[i64; 3], upto: &[(usize, usize, i64)]| {
                upto.iter().all(|&(from, to, least)| values[to] >= values[from] + least)
            };
            let mut system = Differences::new(vec![0; 3], vec![4; 3]).unwrap();
            let mut accepted: Vec<(usize, usize, i64)> = Vec::new();
            for (from, to, least) in constraints {
                let mut trial = accepted.clone();
                trial.push((from, to, least));
                let mut any = false;
                for code in 0..125 {
                    let values = [code % 5, code / 5 % 5, code / 25];
                    any |= all(&values, &trial);
                }
                prop_assert_eq!(system.add(&[Difference { from, to, least }]), any);
                if any {
                    accepted = trial;
                }
                let least: [i64; 3] = system.values().try_into().unwrap();
                prop_assert!(all(&least, &accepted));
                prop_assert!(system.holds(&least, &[0; 3]));
            }
        }
    }
}
