//! The feasible candidates: the rules that protection (Sec. 4.7) leaves of those that exploration draws from.
//!
//! A walk splits a type with some of its lines blocked. The rules that are left and their weights depend
//! on nothing else, and walks meet the same blocked lines again and again: they are weighed once.

use std::cell::{OnceCell, RefCell};
use std::rc::Rc;

use rand::{Rng, RngExt};
use rustc_hash::FxHashMap;

use super::priced_candidates::PricedCandidates;
use super::protection::Protection;
use crate::regions::{TypeId, Types, ends};
use crate::rules::RuleCandidate;
use edifice_shape::Axis;

/// The lines of one type that cross protected regions other than itself.
#[derive(Debug, Default)]
pub(crate) struct Blocked {
    /// For each axis and cut, true if the cut is blocked.
    lines: [Vec<bool>; 2],
    any: [bool; 2],
}

impl Blocked {
    /// Marks the lines of a type; whether any is blocked.
    pub(crate) fn mark(&mut self, protection: &Protection, types: &mut Types, id: TypeId) -> bool {
        self.lift();
        if protection.is_lifted() {
            return false;
        }
        let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
        for (blocked, strips) in self.lines.iter_mut().zip(&strips) {
            blocked.clear();
            blocked.resize(strips.cuts.len(), false);
        }
        for inside in protection.inside(types.region(id)) {
            for axis in Axis::BOTH {
                let (cuts, (from, to)) = (&strips[axis as usize].cuts, ends(inside, axis));
                let crossing =
                    cuts.partition_point(|&c| c <= from)..cuts.partition_point(|&c| c < to);
                self.any[axis as usize] |= !crossing.is_empty();
                self.lines[axis as usize][crossing].fill(true);
            }
        }
        self.any[0] || self.any[1]
    }

    /// Unblocks all lines.
    pub(crate) fn lift(&mut self) {
        self.any = [false; 2];
    }

    /// True if a line along an axis is blocked.
    pub(crate) fn any(&self, axis: Axis) -> bool {
        self.any[axis as usize]
    }

    /// For each cut along an axis, true if it is blocked.
    pub(crate) fn along(&self, axis: Axis) -> &[bool] {
        &self.lines[axis as usize]
    }

    /// The lines, of those given along an axis, that are not blocked.
    pub(crate) fn without<'a>(
        &'a self,
        axis: Axis,
        lines: &'a [u16],
    ) -> impl Iterator<Item = u16> + 'a {
        let along: &[bool] = if self.any(axis) {
            self.along(axis)
        } else {
            &[]
        };
        let blocked = |line: &u16| along.get(usize::from(*line)).is_some_and(|b| *b);
        lines.iter().copied().filter(move |line| !blocked(line))
    }

    /// True if a rule has a blocked line.
    pub(crate) fn crosses(&self, rule: &RuleCandidate) -> bool {
        let along = |axis: Axis, lines: &[u16]| {
            self.any(axis) && lines.iter().any(|l| self.along(axis)[usize::from(*l)])
        };
        match rule.arrangement.axis() {
            Some(axis) => along(axis, &rule.lines),
            None => along(Axis::X, &rule.lines) || along(Axis::Y, &rule.rows),
        }
    }

    /// Writes the key of a type with its blocked lines: the type, then one bit for each line.
    fn key(&self, id: TypeId, key: &mut Vec<u64>) {
        key.clear();
        key.push(u64::from(id));
        for word in self.lines.iter().flat_map(|lines| lines.chunks(64)) {
            let bits = word.iter().rev().map(|&b| u64::from(b));
            key.push(bits.fold(0, |word, bit| word << 1 | bit));
        }
    }
}

/// The feasible candidates of one type: the rules of its list that have no blocked line.
#[derive(Debug)]
pub(crate) struct FeasibleCandidates {
    /// Their positions in the list.
    positions: Vec<u32>,
    /// Sums of `exp(-H)`, up to a common factor, over the rules up to and with each.
    weights: Vec<f64>,
    /// The rules that were drawn, by position.
    rules: RefCell<FxHashMap<usize, Rc<RuleCandidate>>>,
    /// All of them for Eq. 4, once they were asked for.
    priced: OnceCell<PricedCandidates>,
}

impl FeasibleCandidates {
    /// The rules with these `H` and positions, at most `most`.
    pub(crate) fn new(left: impl Iterator<Item = (f64, usize)>, most: usize) -> Self {
        let (mut weights, mut positions) = (Vec::with_capacity(most), Vec::with_capacity(most));
        for (h, position) in left {
            weights.push(h);
            positions.push(position as u32);
        }
        weigh(&mut weights);
        weights.shrink_to_fit();
        positions.shrink_to_fit();
        Self {
            positions,
            weights,
            rules: RefCell::default(),
            priced: OnceCell::new(),
        }
    }

    /// True if no rule is left.
    pub(crate) fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The positions of its rules in the list.
    pub(crate) fn positions(&self) -> impl Iterator<Item = usize> + '_ {
        self.positions.iter().map(|position| *position as usize)
    }

    /// Its rules for Eq. 4, if they were asked for before.
    pub(crate) fn priced(&self) -> Option<&PricedCandidates> {
        self.priced.get()
    }

    /// Sums of `exp(-H)`, up to a common factor, over the rules up to and with each.
    pub(crate) fn sums(&self) -> &[f64] {
        &self.weights
    }

    /// The position in the list of the rule at a place among those that are left.
    pub(crate) fn position(&self, place: usize) -> usize {
        self.positions[place] as usize
    }

    /// The rule at a position, if it was drawn before.
    pub(crate) fn rule(&self, position: usize) -> Option<Rc<RuleCandidate>> {
        self.rules.borrow().get(&position).cloned()
    }
}

/// Numbers that a generation of the cache may hold, eight bytes each.
const HELD: usize = 4_000_000;
/// Numbers that a list takes beside its rules' weights, and that a rule takes, about.
const PER_LIST: usize = 24;
const PER_RULE: usize = 24;

/// By type and blocked lines.
type Generation = FxHashMap<Box<[u64]>, Rc<FeasibleCandidates>>;

/// Two-generation cache: on overflow the old generation is dropped; hits are promoted.
#[derive(Debug, Default)]
pub(crate) struct FeasibleCache {
    young: Generation,
    old: Generation,
    /// Numbers that the young generation holds.
    held: usize,
    key: Vec<u64>,
}

impl FeasibleCache {
    /// The feasible candidates of a type under some blocked lines, if they are in the cache.
    pub(crate) fn get(&mut self, id: TypeId, blocked: &Blocked) -> Option<Rc<FeasibleCandidates>> {
        blocked.key(id, &mut self.key);
        if let Some(known) = self.young.get(self.key.as_slice()) {
            return Some(Rc::clone(known));
        }
        let (key, known) = self.old.remove_entry(self.key.as_slice())?;
        self.insert(key, Rc::clone(&known));
        Some(known)
    }

    /// Puts the feasible candidates of a type under some blocked lines into the cache.
    pub(crate) fn keep(
        &mut self,
        id: TypeId,
        blocked: &Blocked,
        feasible: &Rc<FeasibleCandidates>,
    ) {
        blocked.key(id, &mut self.key);
        self.insert(self.key.as_slice().into(), Rc::clone(feasible));
    }

    /// Keeps a rule that was drawn from a list. Rules of lists without blocked lines count too, though they are never dropped.
    pub(crate) fn keep_rule(
        &mut self,
        feasible: &FeasibleCandidates,
        position: usize,
        rule: &Rc<RuleCandidate>,
    ) {
        self.held += PER_RULE;
        feasible
            .rules
            .borrow_mut()
            .insert(position, Rc::clone(rule));
    }

    /// Keeps the priced candidates of a list for Eq. 4.
    pub(crate) fn keep_priced<'a>(
        &mut self,
        feasible: &'a FeasibleCandidates,
        priced: PricedCandidates,
    ) -> &'a PricedCandidates {
        self.held += priced.held();
        feasible.priced.get_or_init(|| priced)
    }

    fn insert(&mut self, key: Box<[u64]>, feasible: Rc<FeasibleCandidates>) {
        if self.held > HELD {
            self.old = std::mem::take(&mut self.young);
            self.held = 0;
        }
        let priced = feasible.priced.get().map_or(0, PricedCandidates::held);
        let rules = PER_RULE * feasible.rules.borrow().len();
        self.held += PER_LIST + key.len() + 2 * feasible.positions.len() + rules + priced;
        self.young.insert(key, feasible);
    }
}

/// Makes of each `H` the sum of `exp(-H)`, up to a factor, of all up to it.
fn weigh(all: &mut [f64]) {
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    let mut sum = 0.0;
    for h in all {
        sum += (least - *h).exp();
        *h = sum;
    }
}

/// Draws a place with probability proportional to its weight; there is at least one.
pub(crate) fn draw<R: Rng>(sums: &[f64], rng: &mut R) -> usize {
    let at = rng.random::<f64>() * sums[sums.len() - 1];
    sums.partition_point(|sum| *sum <= at).min(sums.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocked(lines: [Vec<bool>; 2]) -> Blocked {
        let any = [lines[0].contains(&true), lines[1].contains(&true)];
        Blocked { lines, any }
    }

    #[test]
    fn remainders_are_told_apart_by_type_and_lines() {
        let mut cache = FeasibleCache::default();
        let here = blocked([vec![false, true, false], vec![false; 70]]);
        let kept = Rc::new(FeasibleCandidates::new([(1.0, 4), (2.0, 6)].into_iter(), 3));
        cache.keep(8, &here, &kept);
        assert!(Rc::ptr_eq(&cache.get(8, &here).unwrap(), &kept));
        assert!(cache.get(9, &here).is_none());
        let mut last = vec![false; 70];
        last[69] = true;
        let other = blocked([vec![false, true, false], last]);
        assert!(cache.get(8, &other).is_none());
    }

    #[test]
    fn remainders_not_asked_for_give_way() {
        let mut cache = FeasibleCache::default();
        let here = blocked([vec![false, true, false], vec![false; 3]]);
        let many = (0..=HELD).map(|position| (1.0, position));
        let large = Rc::new(FeasibleCandidates::new(many, HELD + 1));
        for id in 1..4 {
            // Each fills a generation; the first is asked for whenever one is full.
            cache.keep(id, &here, &large);
            assert!(cache.get(1, &here).is_some());
        }
        assert!(cache.get(2, &here).is_none());
        assert!(cache.get(3, &here).is_some());
    }

    #[test]
    fn weights_add_up_and_lesser_h_is_likelier() {
        let left = [(3.0, 10), (3.0 + 2f64.ln(), 11)].into_iter();
        let feasible = FeasibleCandidates::new(left, 2);
        assert!((feasible.weights[0] - 1.0).abs() < 1e-12);
        assert!((feasible.weights[1] - 1.5).abs() < 1e-12);
        assert_eq!(feasible.positions, [10, 11]);
    }
}
