//! The moves of annealing over the set of non-terminal types.

use std::rc::Rc;

use rand::{Rng, RngExt};

use super::nonterminal_set::NonterminalSet;
use crate::regions::TypeId;
use crate::rules::AddRule;
use edifice_optim::annealing::Landscape;

/// Maximum number of types that a move adds.
const GROWTH: usize = 24;

impl NonterminalSet {
    /// A random member; none when the facades are single terminals.
    fn any<R: Rng>(&self, rng: &mut R) -> Option<TypeId> {
        let count = self.members.len();
        (count > 0).then(|| self.members[rng.random_range(0..count)])
    }

    /// A random strip of a random member that is neither terminal nor member.
    fn outsider<R: Rng>(&mut self, rng: &mut R) -> Option<TypeId> {
        let member = self.any(rng)?;
        let strips = self.strip_types(member);
        let id = *strips.get(rng.random_range(0..strips.len().max(1)))?;
        (self.prices[id as usize] > 0.0 && id != member).then_some(id)
    }

    /// A strip like one that a rule of the set names, with a border shifted by one line.
    fn shifted<R: Rng>(&mut self, rng: &mut R) -> Option<(TypeId, TypeId)> {
        let user = self.any(rng)?;
        let candidate = Rc::clone(&self.rules[user as usize].as_ref()?.1);
        let strips = self
            .types
            .borrow_mut()
            .strips(user, candidate.arrangement.axis()?);
        self.extend();
        let at = rng.random_range(0..candidate.successors.len());
        let old = candidate.successors[at];
        let (a, b) = (
            usize::from(candidate.lines[at]),
            usize::from(candidate.lines[at + 1]),
        );
        let (a, b) = match rng.random_range(0..4) {
            0 => (a.checked_sub(1)?, b),
            1 => (a + 1, b),
            2 => (a, b + 1),
            _ => (a, b.checked_sub(1)?),
        };
        if a >= b || b > strips.intervals() || (a == 0 && b == strips.intervals()) {
            return None;
        }
        let new = strips.strip(a, b);
        (self.prices[new as usize] > 0.0).then_some((old, new))
    }

    /// Makes members of all successors of a rule that seems reasonable for a member.
    fn insert_successors<R: Rng>(&mut self, rng: &mut R) -> Option<bool> {
        let member = self.any(rng)?;
        let candidate =
            self.exploration
                .borrow_mut()
                .sample(&mut self.types.borrow_mut(), member, rng);
        self.extend();
        let newcomers: Vec<TypeId> = candidate
            .successors
            .iter()
            .copied()
            .filter(|s| self.prices[*s as usize] > 0.0)
            .collect();
        if newcomers.is_empty() {
            return None;
        }
        Some(newcomers.into_iter().all(|id| self.insert(id)))
    }

    fn change<R: Rng>(&mut self, rng: &mut R) -> Option<bool> {
        match rng.random_range(0..16) {
            0..6 => {
                let id = self.outsider(rng)?;
                Some(self.insert(id))
            }
            6..10 => {
                let id = self.any(rng)?;
                (!self.is_root(id)).then(|| self.erase(id))
            }
            10..14 => {
                let (old, new) = self.shifted(rng)?;
                let member = self.rules[old as usize].is_some() && !self.is_root(old);
                Some((!member || self.erase(old)) && self.insert(new))
            }
            _ => self.insert_successors(rng),
        }
    }
}

impl Landscape for NonterminalSet {
    type Solution = Vec<AddRule>;

    fn cost(&self) -> f64 {
        self.total
    }

    fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
        self.growth = GROWTH;
        match self.change(rng) {
            Some(true) => {
                self.drop_orphans();
                Some(self.total)
            }
            Some(false) => {
                self.undo();
                None
            }
            None => None,
        }
    }

    fn accept(&mut self) {
        self.log.clear();
    }

    fn reject(&mut self) {
        self.undo();
    }

    fn solution(&self) -> Vec<AddRule> {
        self.rules()
    }
}
