//! The set of non-terminal types with the best rule of each: what annealing changes.

use std::cell::RefCell;
use std::rc::Rc;

use crate::adp::exploration::Exploration;
use crate::adp::walk::SharedTypes;
use crate::regions::{TypeId, Types};
use crate::rules::AddRule;
use crate::rules::RuleCandidate;
use crate::rules::RulePricer;
use edifice_shape::Axis;

/// A member's rule and its cost.
pub(super) type Ruled = (f64, Rc<RuleCandidate>);

/// The set of non-terminal types with the best rule of each.
pub(crate) struct NonterminalSet {
    pub(super) types: SharedTypes,
    pub(super) pricer: RulePricer,
    pub(super) exploration: Rc<RefCell<Exploration>>,
    /// Estimated cost of types that are no members.
    pub(super) values: Vec<f64>,
    pub(super) rules: Vec<Option<Ruled>>,
    /// 0 for terminals and members, infinite for other types.
    pub(super) prices: Vec<f64>,
    /// Number of rules that name the type.
    pub(super) uses: Vec<u32>,
    pub(super) members: Vec<TypeId>,
    pub(super) position: Vec<u32>,
    /// Types of all strips of a type, and of its cells where grids are allowed, sorted.
    pub(super) strips: Vec<Option<Rc<[TypeId]>>>,
    pub(super) total: f64,
    pub(super) log: Vec<(TypeId, Option<Ruled>)>,
    pub(super) orphans: Vec<TypeId>,
    /// Maximum number of types that one move may add, so that a move stays a small change.
    pub(super) growth: usize,
}

impl NonterminalSet {
    /// Starts from the rules of a grammar; `values` prices types by what was learnt of them.
    pub(crate) fn new(
        types: SharedTypes,
        pricer: RulePricer,
        exploration: Rc<RefCell<Exploration>>,
        values: Vec<f64>,
        start: &[AddRule],
    ) -> Self {
        exploration.borrow_mut().unprotect();
        let mut members = Self {
            types,
            pricer,
            exploration,
            values,
            rules: Vec::new(),
            prices: Vec::new(),
            uses: Vec::new(),
            members: Vec::new(),
            position: Vec::new(),
            strips: Vec::new(),
            total: 0.0,
            log: Vec::new(),
            orphans: Vec::new(),
            growth: 0,
        };
        members.extend();
        for rule in start {
            let cost = rule.candidate.cost(&members.pricer.costs);
            members.set_rule(rule.id, Some((cost, Rc::clone(&rule.candidate))));
        }
        for rule in start {
            members.improve(rule.id);
        }
        members.drop_orphans();
        members.log.clear();
        members
    }

    /// The set as rules.
    pub(super) fn rules(&self) -> Vec<AddRule> {
        self.members
            .iter()
            .filter_map(|&id| {
                self.rules[id as usize]
                    .as_ref()
                    .map(|(_, candidate)| AddRule {
                        id,
                        candidate: Rc::clone(candidate),
                    })
            })
            .collect()
    }

    /// Tables follow the types discovered since the last call.
    pub(super) fn extend(&mut self) {
        let types = self.types.borrow();
        let (known, all) = (self.rules.len(), types.len());
        self.rules.resize(all, None);
        self.uses.resize(all, 0);
        self.position.resize(all, u32::MAX);
        self.strips.resize(all, None);
        for id in known..all {
            self.prices.push(if types.is_terminal(id as TypeId) {
                0.0
            } else {
                f64::INFINITY
            });
        }
        let costs = self.pricer.costs;
        for id in self.values.len()..all {
            self.values
                .push(costs.split + costs.successor * f64::from(types.terminals(id as TypeId)));
        }
    }

    pub(super) fn is_root(&self, id: TypeId) -> bool {
        self.types.borrow().roots.contains(&id)
    }

    /// Gives a type a rule, another rule, or none, and remembers how it was.
    pub(super) fn set_rule(&mut self, id: TypeId, rule: Option<Ruled>) {
        let slot = id as usize;
        if let Some((cost, candidate)) = &rule {
            self.total += cost;
            for &s in &candidate.successors {
                self.uses[s as usize] += 1;
            }
        }
        let old = std::mem::replace(&mut self.rules[slot], rule);
        if let Some((cost, candidate)) = &old {
            self.total -= cost;
            for &s in &candidate.successors {
                self.uses[s as usize] -= 1;
                if self.uses[s as usize] == 0 && self.rules[s as usize].is_some() {
                    self.orphans.push(s);
                }
            }
        }
        match (old.is_some(), self.rules[slot].is_some()) {
            (false, true) => {
                self.position[slot] = self.members.len() as u32;
                self.members.push(id);
                self.prices[slot] = 0.0;
            }
            (true, false) => {
                let at = self.position[slot] as usize;
                self.members.swap_remove(at);
                if let Some(&moved) = self.members.get(at) {
                    self.position[moved as usize] = at as u32;
                }
                self.position[slot] = u32::MAX;
                self.prices[slot] = f64::INFINITY;
            }
            _ => {}
        }
        self.log.push((id, old));
    }

    /// Types of all strips of a type, and of its cells where grids are allowed, sorted.
    pub(super) fn strip_types(&mut self, id: TypeId) -> Rc<[TypeId]> {
        if let Some(list) = &self.strips[id as usize] {
            return Rc::clone(list);
        }
        let mut list: Vec<TypeId> = Vec::new();
        {
            let mut types = self.types.borrow_mut();
            for axis in Axis::BOTH {
                list.extend(types.strips(id, axis).all());
            }
            if self.pricer.operations.grid_split
                && let Some(cells) = types.cells(id)
            {
                list.extend(cells.all());
            }
        }
        self.extend();
        list.sort_unstable();
        list.dedup();
        let list: Rc<[TypeId]> = list.into();
        self.strips[id as usize] = Some(Rc::clone(&list));
        list
    }

    /// The cheapest rule of a type over members and terminals.
    pub(super) fn cheapest(&mut self, id: TypeId) -> Option<Ruled> {
        self.strip_types(id);
        let prices = &self.prices;
        let (cost, candidate) =
            self.pricer
                .cheapest(&mut self.types.borrow_mut(), id, &|_, t| prices[t as usize])?;
        Some((cost, Rc::new(candidate)))
    }

    /// Finds the cheapest rule of a member anew.
    pub(super) fn improve(&mut self, id: TypeId) {
        let Some(found) = self.cheapest(id) else {
            return;
        };
        if self.rules[id as usize]
            .as_ref()
            .is_none_or(|(cost, _)| found.0 < cost - 1e-9)
        {
            self.set_rule(id, Some(found));
        }
    }

    /// Makes a type a member, with whatever further members its rule needs.
    pub(super) fn insert(&mut self, id: TypeId) -> bool {
        let mut waiting = vec![id];
        let mut inserted = Vec::new();
        while let Some(id) = waiting.pop() {
            if self.rules[id as usize].is_some() {
                continue;
            }
            if self.growth == 0 {
                return false;
            }
            self.growth -= 1;
            let Some((cost, candidate)) = self
                .cheapest(id)
                .or_else(|| self.cheapest_with_newcomers(id, None))
            else {
                return false;
            };
            let terminals = self.types.borrow().label_count();
            waiting.extend(
                candidate
                    .successors
                    .iter()
                    .filter(|s| **s >= terminals && self.rules[**s as usize].is_none()),
            );
            self.set_rule(id, Some((cost, candidate)));
            inserted.push(id);
        }
        self.reprice(&inserted);
        true
    }

    /// The cheapest rule when types outside the set may be added at their estimated cost.
    pub(super) fn cheapest_with_newcomers(
        &mut self,
        id: TypeId,
        banned: Option<TypeId>,
    ) -> Option<Ruled> {
        let (prices, values) = (&self.prices, &self.values);
        let price = |_: &Types, t: TypeId| {
            if prices[t as usize] == 0.0 {
                0.0
            } else if Some(t) == banned {
                f64::INFINITY
            } else {
                values[t as usize]
            }
        };
        let (_, candidate) = self
            .pricer
            .cheapest(&mut self.types.borrow_mut(), id, &price)?;
        Some((candidate.cost(&self.pricer.costs), Rc::new(candidate)))
    }

    /// Rules that could use new members are found anew.
    pub(super) fn reprice(&mut self, inserted: &[TypeId]) {
        for index in 0..self.members.len() {
            let member = self.members[index];
            let strips = self.strip_types(member);
            if inserted
                .iter()
                .any(|t| *t != member && strips.binary_search(t).is_ok())
            {
                self.improve(member);
            }
        }
    }

    /// Takes a member out; rules that name it are found anew.
    pub(super) fn erase(&mut self, id: TypeId) -> bool {
        let users: Vec<TypeId> = self
            .members
            .iter()
            .copied()
            .filter(|m| {
                self.rules[*m as usize]
                    .as_ref()
                    .is_some_and(|(_, c)| c.successors.contains(&id))
            })
            .collect();
        self.set_rule(id, None);
        let terminals = self.types.borrow().label_count();
        for user in users {
            let Some(rule) = self
                .cheapest(user)
                .or_else(|| self.cheapest_with_newcomers(user, Some(id)))
            else {
                return false;
            };
            let newcomers: Vec<TypeId> = rule
                .1
                .successors
                .iter()
                .copied()
                .filter(|s| *s >= terminals && self.rules[*s as usize].is_none())
                .collect();
            self.set_rule(user, Some(rule));
            for newcomer in newcomers {
                if !self.insert(newcomer) {
                    return false;
                }
            }
        }
        true
    }

    /// Takes out the members that no rule names, and then those that only they named.
    pub(super) fn drop_orphans(&mut self) {
        while let Some(id) = self.orphans.pop() {
            if self.uses[id as usize] == 0 && self.rules[id as usize].is_some() && !self.is_root(id)
            {
                self.set_rule(id, None);
            }
        }
    }

    pub(super) fn undo(&mut self) {
        while let Some((id, old)) = self.log.pop() {
            self.set_rule(id, old);
            self.log.pop();
        }
        self.orphans.clear();
    }
}
