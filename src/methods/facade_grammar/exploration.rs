//! Exploration: rules drawn with probability `exp(-H) / sum exp(-H)` (Sec. 4.2 and 4.4).
//!
//! ```text
//! H(rule) = lambda_1 cost_r(rule) + lambda_2 sum_{lines of the rule} cost_sl(line)          (Eq. 5)
//! cost_sl(line) = sum_{repeated regions inside R that the line cuts} terminals / terminals of R
//! ```
//!
//! The rules that are drawn from are in [`super::reasonable`].

use std::rc::Rc;

use rand::Rng;
use rustc_hash::FxHashSet;

use super::choice::{Arrangement, Choice, operation_cost};
use super::grid;
use super::operations::Operations;
use super::protection::{Protection, contains};
use super::reasonable::{self, Candidate, OpenLines};
use super::regions::{Region, Strips, TypeId, Types, ends};
use super::remainder::{Blocked, LeftRule, Remainder, Remainders};
use super::symmetry::Repeated;
use crate::grammar::Costs;
use crate::shape::Axis;

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
    /// Occurrences of repeated regions: per sheet and bottom row, sorted by left edge.
    occurrences: Vec<Vec<Vec<(Region, f64)>>>,
    repeated_types: FxHashSet<TypeId>,
    protection: Protection,
    menus: Vec<Option<Rc<Menu>>>,
    /// Of the type last asked for: which lines cross a protected region.
    blocked: Blocked,
    /// What is left of menus, by type and blocked lines; walks meet the same again and again.
    remainders: Remainders,
}

/// What rules are compared by.
pub(crate) trait Pricing {
    /// Makes room for types that were met since; all successors are among them.
    fn meet(&mut self, types: &Types);
    /// The price of a rule with these cost and successors, no less than its cost; anything above `limit`
    /// when it is above.
    fn price(&mut self, cost: f64, limit: f64, successors: impl Iterator<Item = TypeId>) -> f64;
}

/// The rules for one type, and the cost of every line. Rules are numbered: candidates, then grids.
#[derive(Debug)]
struct Menu {
    candidates: Vec<Candidate>,
    grids: Vec<Rc<Choice>>,
    /// Each rule when nothing is protected.
    rules: Vec<LeftRule>,
    line_costs: [Vec<f64>; 2],
    /// What is left when nothing is protected: all.
    open: Rc<Remainder>,
}

impl Exploration {
    pub fn new(
        types: &Types,
        repeated: Vec<Repeated>,
        costs: Costs,
        operations: Operations,
        lambdas: Lambdas,
    ) -> Self {
        let mut occurrences: Vec<Vec<Vec<(Region, f64)>>> = types
            .sheets
            .iter()
            .map(|s| vec![Vec::new(); s.ys.len()])
            .collect();
        for group in &repeated {
            for &region in &group.occurrences {
                occurrences[usize::from(region.sheet)][usize::from(region.y0)]
                    .push((region, f64::from(group.terminals)));
            }
        }
        for row in occurrences.iter_mut().flatten() {
            row.sort_by_key(|(r, _)| (r.x0, r.x1, r.y1));
        }
        Self {
            costs,
            operations,
            lambdas,
            occurrences,
            repeated_types: repeated.iter().map(|r| r.id).collect(),
            protection: Protection::new(repeated),
            menus: Vec::new(),
            blocked: Blocked::default(),
            remainders: Remainders::default(),
        }
    }

    /// What the present walk protects (Sec. 4.7).
    pub fn protection(&mut self) -> &mut Protection {
        &mut self.protection
    }

    /// Protects nothing.
    pub fn unprotect(&mut self) {
        self.protection.lift();
        self.blocked.lift();
    }

    /// Draws a rule for a type with probability `exp(-H) / sum exp(-H)`.
    pub fn sample<R: Rng>(&mut self, types: &mut Types, id: TypeId, rng: &mut R) -> Rc<Choice> {
        let (menu, left) = self.left(types, id);
        let place = left.draw(rng);
        self.rule_left(types, id, &menu, &left, place)
    }

    /// Of all rules that [`Exploration::sample`] may draw, the one of least price; of several, the first.
    /// `None` when all are infinite.
    pub fn cheapest(
        &mut self,
        types: &mut Types,
        id: TypeId,
        prices: &mut impl Pricing,
    ) -> Option<Rc<Choice>> {
        let (menu, left) = self.left(types, id);
        let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
        prices.meet(types);
        // What was cheapest last time makes most others not worth the sum.
        let mut best = (f64::INFINITY, left.cheapest_last());
        for (place, cost) in left.costs_from(best.1) {
            if cost <= best.0 {
                let price = match menu.candidates.get(place) {
                    Some(candidate) => {
                        let strips = &strips[candidate.axis as usize];
                        let successors = self.successors(candidate, strips);
                        prices.price(cost, best.0, successors)
                    }
                    None => {
                        let grid = &menu.grids[place - menu.candidates.len()];
                        prices.price(cost, best.0, grid.successors.iter().copied())
                    }
                };
                if price < best.0 || price == best.0 && place < best.1 {
                    best = (price, place);
                }
            }
        }
        if best.0.is_infinite() {
            return None;
        }
        left.remember_cheapest(best.1);
        Some(self.rule_left(types, id, &menu, &left, best.1))
    }

    /// All rules that [`Exploration::sample`] may draw.
    #[cfg(test)]
    pub fn all_left(&mut self, types: &mut Types, id: TypeId) -> Vec<Rc<Choice>> {
        let (menu, left) = self.left(types, id);
        let places = left.costs_from(0).map(|(place, _)| place);
        places
            .map(|place| self.rule_left(types, id, &menu, &left, place))
            .collect()
    }

    /// The successors of a rule without the blocked lines.
    fn successors<'a>(
        &'a self,
        rule: &'a Candidate,
        strips: &'a Strips,
    ) -> impl Iterator<Item = TypeId> + 'a {
        let blocked: &[bool] = if self.blocked.any(rule.axis) {
            self.blocked.along(rule.axis)
        } else {
            &[]
        };
        let ends = rule.lines[1..].iter().map(|line| usize::from(*line));
        let open = ends.filter(|line| !blocked.get(*line).is_some_and(|b| *b));
        open.scan(0, |from, to| {
            let strip = strips.strip(*from, to);
            *from = to;
            Some(strip)
        })
    }

    /// Which lines of a type cross a protected region.
    pub fn blocked(&mut self, types: &mut Types, id: TypeId) -> &Blocked {
        self.blocked.mark(&self.protection, types, id);
        &self.blocked
    }

    /// The rules of a type that cut no protected region. Where every rule cuts one, protection gives
    /// way for the rest of the walk.
    fn left(&mut self, types: &mut Types, id: TypeId) -> (Rc<Menu>, Rc<Remainder>) {
        let menu = self.menu(types, id);
        if self.blocked.mark(&self.protection, types, id) {
            let remainder = self.remainder(id, &menu);
            if !remainder.is_empty() {
                return (menu, remainder);
            }
            self.unprotect();
        }
        let open = Rc::clone(&menu.open);
        (menu, open)
    }

    /// The rule at a place of the menu, without the blocked lines, made once for a remainder.
    fn rule_left(
        &mut self,
        types: &mut Types,
        id: TypeId,
        menu: &Menu,
        left: &Remainder,
        place: usize,
    ) -> Rc<Choice> {
        if let Some(known) = left.rule(place) {
            return known;
        }
        let rule = self.rule(types, id, menu, place);
        self.remainders.keep_rule(left, place, &rule);
        rule
    }

    /// The rule of least `H` for a type when nothing is protected; of several, the first.
    pub fn best(&mut self, types: &mut Types, id: TypeId) -> Option<Rc<Choice>> {
        self.unprotect();
        let menu = self.menu(types, id);
        let best = menu.rules.iter().min_by(|a, b| a.h.total_cmp(&b.h))?;
        Some(self.rule(types, id, &menu, best.place))
    }

    /// The rules of the menu that can do without the blocked lines.
    fn remainder(&mut self, id: TypeId, menu: &Menu) -> Rc<Remainder> {
        if let Some(known) = self.remainders.get(id, &self.blocked) {
            return known;
        }
        let open = Axis::BOTH
            .map(|axis| OpenLines::new(self.blocked.along(axis), &menu.line_costs[axis as usize]));
        let candidates = menu.candidates.iter().enumerate();
        let left = candidates.filter_map(|(place, candidate)| {
            if !self.blocked.any(candidate.axis) {
                return Some(menu.rules[place]);
            }
            let (successors, cut) = candidate.without(&open[candidate.axis as usize])?;
            Some(self.left_rule(place, candidate.arrangement, successors, cut))
        });
        let grids = (menu.candidates.len()..).zip(&menu.grids);
        let grids = grids.filter(|(_, grid)| !self.blocked.crosses(grid));
        let left = left.chain(grids.map(|(place, _)| menu.rules[place]));
        let remainder = Rc::new(Remainder::new(left, menu.rules.len()));
        self.remainders.keep(id, &self.blocked, &remainder);
        remainder
    }

    /// The rule at a place in the menu, without the blocked lines.
    fn rule(&self, types: &mut Types, id: TypeId, menu: &Menu, place: usize) -> Rc<Choice> {
        let Some(candidate) = menu.candidates.get(place) else {
            return Rc::clone(&menu.grids[place - menu.candidates.len()]);
        };
        let mut lines = candidate.lines.clone();
        if self.blocked.any(candidate.axis) {
            let blocked = self.blocked.along(candidate.axis);
            lines.retain(|l| !blocked[usize::from(*l)]);
        }
        let strips = types.strips(id, candidate.axis);
        Rc::new(Choice::between(candidate.arrangement, lines, &strips))
    }

    /// A rule at a place of the menu whose lines cost `cut` together (Eq. 2 and 5).
    fn left_rule(
        &self,
        place: usize,
        arrangement: Arrangement,
        successors: usize,
        cut: f64,
    ) -> LeftRule {
        let cost =
            operation_cost(arrangement, &self.costs) + self.costs.successor * successors as f64;
        LeftRule {
            place,
            cost,
            h: self.lambdas.rule * cost + self.lambdas.lines * cut,
        }
    }

    /// For every cost that a line has, the grid of all lines that cost no more.
    fn grids(&self, types: &mut Types, id: TypeId, line_costs: &[Vec<f64>; 2]) -> Vec<Rc<Choice>> {
        if !self.operations.grid_split {
            return Vec::new();
        }
        let Some(cells) = types.cells(id) else {
            return Vec::new();
        };
        reasonable::grids(line_costs, cells.intervals())
            .into_iter()
            .map(|(columns, rows)| Rc::new(grid::between(&cells, columns, rows)))
            .collect()
    }

    fn menu(&mut self, types: &mut Types, id: TypeId) -> Rc<Menu> {
        let index = id as usize;
        if self.menus.len() <= index {
            self.menus.resize(index + 1, None);
        }
        if let Some(menu) = &self.menus[index] {
            return Rc::clone(menu);
        }
        let region = types.region(id);
        let terminals = f64::from(types.terminals(id));
        let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
        let line_costs =
            Axis::BOTH.map(|axis| self.line_costs(region, terminals, axis, &strips[axis as usize]));
        let candidates: Vec<Candidate> = Axis::BOTH
            .into_iter()
            .flat_map(|axis| {
                let slot = axis as usize;
                reasonable::along(
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
        let along = candidates.iter().enumerate().map(|(place, c)| {
            let cut = cut(&c.lines, &line_costs[c.axis as usize]);
            self.left_rule(place, c.arrangement, c.lines.len() - 1, cut)
        });
        let across = (candidates.len()..).zip(&grids).map(|(place, grid)| {
            let cut = cut(&grid.lines, &line_costs[0]) + cut(&grid.rows, &line_costs[1]);
            self.left_rule(place, grid.arrangement, grid.successors.len(), cut)
        });
        let rules: Vec<LeftRule> = along.chain(across).collect();
        let menu = Rc::new(Menu {
            open: Rc::new(Remainder::new(rules.iter().copied(), rules.len())),
            candidates,
            grids,
            rules,
            line_costs,
        });
        self.menus[index] = Some(Rc::clone(&menu));
        menu
    }

    /// `cost_sl` of every cut of a region (Fig. 8).
    fn line_costs(&self, region: Region, terminals: f64, axis: Axis, strips: &Strips) -> Vec<f64> {
        let mut costs = vec![0.0; strips.cuts.len() + 1];
        for row in &self.occurrences[usize::from(region.sheet)]
            [usize::from(region.y0)..usize::from(region.y1)]
        {
            let first = row.partition_point(|(r, _)| r.x0 < region.x0);
            for (r, weight) in row[first..].iter().take_while(|(r, _)| r.x0 < region.x1) {
                if *r == region || !contains(region, *r) {
                    continue;
                }
                let (from, to) = ends(*r, axis);
                costs[strips.cuts.partition_point(|&c| c <= from)] += weight;
                costs[strips.cuts.partition_point(|&c| c < to)] -= weight;
            }
        }
        let mut sum = 0.0;
        for cost in &mut costs {
            sum += *cost;
            *cost = sum / terminals;
        }
        costs
    }
}
