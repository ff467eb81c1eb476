//! Exploration: rules drawn with probability `exp(-H) / sum exp(-H)` (Sec. 4.2 and 4.4).
//!
//! ```text
//! H(rule) = lambda_1 cost_r(rule) + lambda_2 sum_{lines of the rule} cost_sl(line)          (Eq. 5)
//! cost_sl(line) = sum_{repeated regions inside R that the line cuts} terminals / terminals of R
//! ```
//!
//! The rules that are drawn from are in [`super::candidates`].

use std::rc::Rc;

use rand::Rng;
use rustc_hash::FxHashSet;

use super::candidates::{self, Candidate, OpenLines};
use super::feasible_candidates::{Blocked, FeasibleCache, FeasibleCandidates, draw};
use super::line_costs::Occurrences;
use super::priced_candidates::{PricedCandidates, append_needs};
use super::protection::Protection;
use super::symmetry::Repeated;
use crate::operations::Operations;
use crate::regions::{Strips, TypeId, Types};
use crate::rules::grid;
use crate::rules::{Arrangement, RuleCandidate, operation_cost};
use edifice_grammar::Costs;
use edifice_shape::Axis;

/// Weights of the two parts of Eq. 5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lambdas {
    pub rule: f64,
    pub lines: f64,
}

/// The splitting heuristic of a layout.
#[derive(Debug)]
pub(crate) struct Exploration {
    costs: Costs,
    operations: Operations,
    lambdas: Lambdas,
    occurrences: Occurrences,
    repeated_types: FxHashSet<TypeId>,
    protection: Protection,
    lists: Vec<Option<Rc<CandidateList>>>,
    /// The lines of the type last asked for that cross a protected region.
    blocked: Blocked,
    /// The feasible candidates found lately, by type and blocked lines: walks meet the same again and again.
    cache: FeasibleCache,
}

/// The rules for one type, and the cost of every line. Rules are numbered: candidates, then grids.
#[derive(Debug)]
struct CandidateList {
    candidates: Vec<Candidate>,
    grids: Vec<Rc<RuleCandidate>>,
    /// `H` of each rule when nothing is protected, Eq. 5.
    h: Vec<f64>,
    line_costs: [Vec<f64>; 2],
    /// The feasible candidates when nothing is protected: all of the list.
    open: Rc<FeasibleCandidates>,
}

impl Exploration {
    pub(crate) fn new(
        types: &Types,
        repeated: Vec<Repeated>,
        costs: Costs,
        operations: Operations,
        lambdas: Lambdas,
    ) -> Self {
        Self {
            costs,
            operations,
            lambdas,
            occurrences: Occurrences::new(types, &repeated),
            repeated_types: repeated.iter().map(|r| r.id).collect(),
            protection: Protection::new(repeated),
            lists: Vec::new(),
            blocked: Blocked::default(),
            cache: FeasibleCache::default(),
        }
    }

    /// The regions that the present walk protects (Sec. 4.7).
    pub(crate) fn protection(&mut self) -> &mut Protection {
        &mut self.protection
    }

    /// Ends the protection of all regions for the rest of the walk.
    pub(crate) fn unprotect(&mut self) {
        self.protection.lift();
        self.blocked.lift();
    }

    /// Draws a rule for a type with probability `exp(-H) / sum exp(-H)`.
    pub(crate) fn sample<R: Rng>(
        &mut self,
        types: &mut Types,
        id: TypeId,
        rng: &mut R,
    ) -> Rc<RuleCandidate> {
        self.choose(types, id, |sums| draw(sums, rng))
    }

    /// As [`Exploration::sample`], the place among the rules that are left being chosen from the sums of their weights up to each.
    pub(crate) fn choose(
        &mut self,
        types: &mut Types,
        id: TypeId,
        place: impl FnOnce(&[f64]) -> usize,
    ) -> Rc<RuleCandidate> {
        let (list, left) = self.left(types, id);
        let position = left.position(place(left.sums()));
        self.feasible_rule(types, id, &list, &left, position)
    }

    /// Of all rules that [`Exploration::sample`] may draw, the one with the least sum of its cost and what
    /// the types that it needs are worth; `None` when all are infinite.
    pub(crate) fn cheapest(
        &mut self,
        types: &mut Types,
        id: TypeId,
        worth: impl Fn(TypeId) -> f64,
    ) -> Option<Rc<RuleCandidate>> {
        let (list, left) = self.left(types, id);
        let position = match left.priced() {
            Some(priced) => priced.cheapest(worth),
            None => {
                let priced = self.priced(types, id, &list, &left);
                self.cache.keep_priced(&left, priced).cheapest(worth)
            }
        };
        Some(self.feasible_rule(types, id, &list, &left, position?))
    }

    /// The feasible candidates with their costs, for Eq. 4.
    fn priced(
        &self,
        types: &mut Types,
        id: TypeId,
        list: &CandidateList,
        left: &FeasibleCandidates,
    ) -> PricedCandidates {
        let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
        let is_terminal = |id| types.is_terminal(id);
        PricedCandidates::new(left.positions(), |position, needs| {
            let (arrangement, successors) = match list.candidates.get(position) {
                Some(rule) => {
                    let successors = self.successors(rule, &strips[rule.axis as usize]);
                    let count = append_needs(needs, successors, is_terminal);
                    (rule.arrangement, count)
                }
                None => {
                    let grid = &list.grids[position - list.candidates.len()];
                    let successors = grid.successors.iter().copied();
                    let count = append_needs(needs, successors, is_terminal);
                    (grid.arrangement, count)
                }
            };
            self.cost(arrangement, successors)
        })
    }

    /// The successors of a rule without the blocked lines.
    fn successors<'a>(
        &'a self,
        rule: &'a Candidate,
        strips: &'a Strips,
    ) -> impl Iterator<Item = TypeId> + 'a {
        let mut lines = self.blocked.without(rule.axis, &rule.lines);
        let first = lines.next().unwrap_or(0);
        lines.scan(first, |from, to| {
            let strip = strips.strip((*from).into(), to.into());
            *from = to;
            Some(strip)
        })
    }

    /// All rules that [`Exploration::sample`] may draw.
    #[cfg(test)]
    pub(crate) fn all_left(&mut self, types: &mut Types, id: TypeId) -> Vec<Rc<RuleCandidate>> {
        let (list, left) = self.left(types, id);
        let rules = left.positions();
        rules
            .map(|position| self.feasible_rule(types, id, &list, &left, position))
            .collect()
    }

    /// The lines of a type that cross a protected region.
    pub(crate) fn blocked(&mut self, types: &mut Types, id: TypeId) -> &Blocked {
        self.blocked.mark(&self.protection, types, id);
        &self.blocked
    }

    /// The rules of a type that cut no protected region. Where every rule cuts one, protection gives
    /// way for the rest of the walk.
    fn left(
        &mut self,
        types: &mut Types,
        id: TypeId,
    ) -> (Rc<CandidateList>, Rc<FeasibleCandidates>) {
        let list = self.list(types, id);
        if self.blocked.mark(&self.protection, types, id) {
            let feasible = self.feasible(id, &list);
            if !feasible.is_empty() {
                return (list, feasible);
            }
            self.unprotect();
        }
        let open = Rc::clone(&list.open);
        (list, open)
    }

    /// The rule at a position of the list, without the blocked lines, made once for each set of blocked lines.
    fn feasible_rule(
        &mut self,
        types: &mut Types,
        id: TypeId,
        list: &CandidateList,
        left: &FeasibleCandidates,
        position: usize,
    ) -> Rc<RuleCandidate> {
        if let Some(known) = left.rule(position) {
            return known;
        }
        let rule = self.rule(types, id, list, position);
        self.cache.keep_rule(left, position, &rule);
        rule
    }

    /// The rule of least `H` for a type when nothing is protected; of several, the first.
    pub(crate) fn best(&mut self, types: &mut Types, id: TypeId) -> Option<Rc<RuleCandidate>> {
        self.unprotect();
        let list = self.list(types, id);
        let positions = list.h.iter().enumerate();
        let (best, _) = positions.min_by(|a, b| a.1.total_cmp(b.1))?;
        Some(self.rule(types, id, &list, best))
    }

    /// The rules of the list that can do without the blocked lines.
    fn feasible(&mut self, id: TypeId, list: &CandidateList) -> Rc<FeasibleCandidates> {
        if let Some(known) = self.cache.get(id, &self.blocked) {
            return known;
        }
        let open = Axis::BOTH
            .map(|axis| OpenLines::new(self.blocked.along(axis), &list.line_costs[axis as usize]));
        let candidates = list.candidates.iter().enumerate();
        let left = candidates.filter_map(|(position, candidate)| {
            if !self.blocked.any(candidate.axis) {
                return Some((list.h[position], position));
            }
            let (successors, cut) = candidate.without(&open[candidate.axis as usize])?;
            let h = self.h(candidate.arrangement, successors, cut);
            Some((h, position))
        });
        let grids = (list.candidates.len()..).zip(&list.grids);
        let grids = grids.filter(|(_, grid)| !self.blocked.crosses(grid));
        let left = left.chain(grids.map(|(position, _)| (list.h[position], position)));
        let feasible = Rc::new(FeasibleCandidates::new(left, list.h.len()));
        self.cache.keep(id, &self.blocked, &feasible);
        feasible
    }

    /// The rule at a position in the list, without the blocked lines.
    fn rule(
        &self,
        types: &mut Types,
        id: TypeId,
        list: &CandidateList,
        position: usize,
    ) -> Rc<RuleCandidate> {
        let Some(candidate) = list.candidates.get(position) else {
            return Rc::clone(&list.grids[position - list.candidates.len()]);
        };
        let lines = self
            .blocked
            .without(candidate.axis, &candidate.lines)
            .collect();
        let strips = types.strips(id, candidate.axis);
        Rc::new(RuleCandidate::between(
            candidate.arrangement,
            lines,
            &strips,
        ))
    }

    /// Eq. 5 for a rule whose lines cost `cut` together.
    fn h(&self, arrangement: Arrangement, successors: usize, cut: f64) -> f64 {
        self.lambdas.rule * self.cost(arrangement, successors) + self.lambdas.lines * cut
    }

    /// Eq. 2.
    fn cost(&self, arrangement: Arrangement, successors: usize) -> f64 {
        operation_cost(arrangement, &self.costs) + self.costs.successor * successors as f64
    }

    /// For every cost that a line has, the grid of all lines that cost no more.
    fn grids(
        &self,
        types: &mut Types,
        id: TypeId,
        line_costs: &[Vec<f64>; 2],
    ) -> Vec<Rc<RuleCandidate>> {
        if !self.operations.grid_split {
            return Vec::new();
        }
        let Some(cells) = types.cells(id) else {
            return Vec::new();
        };
        candidates::grids(line_costs, cells.intervals())
            .into_iter()
            .map(|(columns, rows)| Rc::new(grid::between(&cells, columns, rows)))
            .collect()
    }

    fn list(&mut self, types: &mut Types, id: TypeId) -> Rc<CandidateList> {
        let index = id as usize;
        if self.lists.len() <= index {
            self.lists.resize(index + 1, None);
        }
        if let Some(list) = &self.lists[index] {
            return Rc::clone(list);
        }
        let region = types.region(id);
        let terminals = f64::from(types.terminals(id));
        let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
        let line_costs = Axis::BOTH.map(|axis| {
            self.occurrences
                .line_costs(region, terminals, axis, &strips[axis as usize])
        });
        let candidates: Vec<Candidate> = Axis::BOTH
            .into_iter()
            .flat_map(|axis| {
                let slot = axis as usize;
                candidates::along(
                    axis,
                    &strips[slot],
                    &line_costs[slot],
                    self.operations,
                    &self.repeated_types,
                )
            })
            .collect();
        let grids = self.grids(types, id, &line_costs);
        let cut = |lines: &[u16], line_costs: &[f64]| -> f64 {
            let inner = &lines[1..lines.len() - 1];
            inner.iter().map(|l| line_costs[usize::from(*l)]).sum()
        };
        let candidate_h = candidates.iter().map(|c| {
            let cut = cut(&c.lines, &line_costs[c.axis as usize]);
            self.h(c.arrangement, c.lines.len() - 1, cut)
        });
        let grid_h = grids.iter().map(|grid| {
            let cut = cut(&grid.lines, &line_costs[0]) + cut(&grid.rows, &line_costs[1]);
            self.h(grid.arrangement, grid.successors.len(), cut)
        });
        let h: Vec<f64> = candidate_h.chain(grid_h).collect();
        let all = h.iter().copied().zip(0..);
        let list = Rc::new(CandidateList {
            open: Rc::new(FeasibleCandidates::new(all, h.len())),
            candidates,
            grids,
            h,
            line_costs,
        });
        self.lists[index] = Some(Rc::clone(&list));
        list
    }
}
