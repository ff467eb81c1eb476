//! The rules that Eq. 4 chooses from, ready to be compared again and again.

use std::cell::Cell;

use crate::regions::TypeId;

/// Rules for one type. Of rules with the same cost and needs, only the first.
#[derive(Debug)]
pub(crate) struct PricedCandidates {
    /// The rules, the cheapest first.
    priced: Vec<PricedCandidate>,
    needs: Vec<TypeId>,
    /// Index of the rule that was the cheapest in the last call.
    last: Cell<usize>,
}

/// A rule: where it stands in its list, what it costs (Eq. 2), and where its needs stand.
#[derive(Debug, Clone, Copy)]
struct PricedCandidate {
    cost: f64,
    position: u32,
    needs: (u32, u32),
}

/// Appends the types among successors that need a rule themselves, each once; counts the successors.
pub(crate) fn append_needs(
    needs: &mut Vec<TypeId>,
    successors: impl Iterator<Item = TypeId>,
    is_terminal: impl Fn(TypeId) -> bool,
) -> usize {
    let from = needs.len();
    let mut count = 0;
    needs.extend(
        successors
            .inspect(|_| count += 1)
            .filter(|id| !is_terminal(*id)),
    );
    needs[from..].sort_unstable();
    let mut kept = from;
    for next in from..needs.len() {
        if kept == from || needs[kept - 1] != needs[next] {
            needs[kept] = needs[next];
            kept += 1;
        }
    }
    needs.truncate(kept);
    count
}

impl PricedCandidates {
    /// Rules with these positions and costs; `append` adds what the rule at a position needs to a list, and
    /// returns its cost.
    pub(crate) fn new(
        positions: impl Iterator<Item = usize>,
        append: impl Fn(usize, &mut Vec<TypeId>) -> f64,
    ) -> Self {
        let mut needs = Vec::new();
        let priced = positions.map(|position| {
            let from = needs.len() as u32;
            PricedCandidate {
                cost: append(position, &mut needs),
                position: position as u32,
                needs: (from, needs.len() as u32),
            }
        });
        let mut priced: Vec<PricedCandidate> = priced.collect();
        let needed = |one: &PricedCandidate| &needs[one.needs.0 as usize..one.needs.1 as usize];
        priced.sort_unstable_by(|a, b| {
            let by_cost = a.cost.total_cmp(&b.cost);
            let by_needs = by_cost.then_with(|| needed(a).cmp(needed(b)));
            by_needs.then(a.position.cmp(&b.position))
        });
        priced.dedup_by(|later, first| later.cost == first.cost && needed(later) == needed(first));
        priced.shrink_to_fit();
        needs.shrink_to_fit();
        Self {
            priced,
            needs,
            last: Cell::new(0),
        }
    }

    /// Numbers of eight bytes that this takes, about.
    pub(crate) fn held(&self) -> usize {
        3 * self.priced.len() + self.needs.len() / 2
    }

    /// The position of the rule with the least value: its cost and what its needs are worth. Of several, the
    /// one that stands first in the list; `None` when all are infinite.
    pub(crate) fn cheapest(&self, worth: impl Fn(TypeId) -> f64) -> Option<usize> {
        let mut best = (f64::INFINITY, u32::MAX, 0);
        // What was cheapest last time spares summing most others to the end.
        let last = self.last.get();
        for which in (last..last + 1).chain(0..self.priced.len()) {
            let Some(one) = self.priced.get(which) else {
                break;
            };
            if one.cost > best.0 {
                break;
            }
            let mut value = one.cost;
            for &id in &self.needs[one.needs.0 as usize..one.needs.1 as usize] {
                value += worth(id);
                if value > best.0 {
                    break;
                }
            }
            if value < best.0 || value == best.0 && one.position < best.1 {
                best = (value, one.position, which);
            }
        }
        self.last.set(best.2);
        best.0.is_finite().then_some(best.1 as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rules: position, cost, needs.
    fn priced(rules: &[(usize, f64, Vec<TypeId>)]) -> PricedCandidates {
        PricedCandidates::new(rules.iter().map(|rule| rule.0), |position, needs| {
            let (_, cost, needed) = rules.iter().find(|rule| rule.0 == position).unwrap();
            needs.extend(needed);
            *cost
        })
    }

    #[test]
    fn the_first_of_least_value_is_found_whatever_was_found_before() {
        let rules = [
            (3, 2.0, vec![7, 9]),
            (4, 2.0, vec![7, 9]),
            (5, 3.0, vec![8]),
            (1, 9.0, vec![]),
            (6, 4.0, vec![8, 9]),
        ];
        let known = priced(&rules);
        assert_eq!(known.priced.len(), 4);
        let worth = |seven: f64, eight: f64| {
            move |id| match id {
                7 => seven,
                8 => eight,
                _ => 1.0,
            }
        };
        for _ in 0..2 {
            assert_eq!(known.cheapest(worth(1.0, 2.0)), Some(3));
            assert_eq!(known.cheapest(worth(6.0, 5.0)), Some(5));
            // As much as 5, then as much as 1, which stands before it.
            assert_eq!(known.cheapest(worth(2.0, 2.0)), Some(3));
            assert_eq!(known.cheapest(worth(6.0, 7.0)), Some(1));
            assert_eq!(known.cheapest(worth(f64::INFINITY, 7.0)), Some(1));
        }
        let unknown = priced(&[(0, 1.0, vec![2])]);
        assert_eq!(unknown.cheapest(|_| f64::INFINITY), None);
        assert_eq!(priced(&[]).cheapest(|_| 0.0), None);
    }

    #[test]
    fn needs_are_listed_once() {
        let mut needs = vec![9];
        let successors = [5, 1, 9, 5, 2].into_iter();
        assert_eq!(append_needs(&mut needs, successors, |id| id < 3), 5);
        assert_eq!(needs, [9, 5, 9]);
    }
}
