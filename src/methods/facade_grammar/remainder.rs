//! What protection (Sec. 4.7) leaves of the rules that exploration draws from.
//!
//! A walk splits a type with some of its lines blocked. The rules that are left and their weights depend
//! on nothing else, and walks meet the same blocked lines again and again: they are weighed once.

use std::cell::{OnceCell, RefCell};
use std::rc::Rc;

use rand::{Rng, RngExt};
use rustc_hash::FxHashMap;

use super::choice::Choice;
use super::offers::Offers;
use super::protection::Protection;
use super::regions::{TypeId, Types, ends};
use crate::shape::Axis;

/// The lines of one type that cross protected regions other than itself.
#[derive(Debug, Default)]
pub(crate) struct Blocked {
    /// By axis and cut.
    lines: [Vec<bool>; 2],
    any: [bool; 2],
}

impl Blocked {
    /// Marks the lines of a type; whether any is blocked.
    pub fn mark(&mut self, protection: &Protection, types: &mut Types, id: TypeId) -> bool {
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

    /// Blocks nothing.
    pub fn lift(&mut self) {
        self.any = [false; 2];
    }

    /// Whether any line along an axis is blocked.
    pub fn any(&self, axis: Axis) -> bool {
        self.any[axis as usize]
    }

    /// Which cuts along an axis are blocked.
    pub fn along(&self, axis: Axis) -> &[bool] {
        &self.lines[axis as usize]
    }

    /// Those of some lines along an axis that are not blocked.
    pub fn without<'a>(&'a self, axis: Axis, lines: &'a [u16]) -> impl Iterator<Item = u16> + 'a {
        let along: &[bool] = if self.any(axis) {
            self.along(axis)
        } else {
            &[]
        };
        let blocked = |line: &u16| along.get(usize::from(*line)).is_some_and(|b| *b);
        lines.iter().copied().filter(move |line| !blocked(line))
    }

    /// Whether a rule has a blocked line.
    pub fn crosses(&self, rule: &Choice) -> bool {
        let along = |axis: Axis, lines: &[u16]| {
            self.any(axis) && lines.iter().any(|l| self.along(axis)[usize::from(*l)])
        };
        match rule.arrangement.axis() {
            Some(axis) => along(axis, &rule.lines),
            None => along(Axis::X, &rule.lines) || along(Axis::Y, &rule.rows),
        }
    }

    /// The type and its blocked lines, one bit each.
    fn key(&self, id: TypeId, key: &mut Vec<u64>) {
        key.clear();
        key.push(u64::from(id));
        for word in self.lines.iter().flat_map(|lines| lines.chunks(64)) {
            let bits = word.iter().rev().map(|&b| u64::from(b));
            key.push(bits.fold(0, |word, bit| word << 1 | bit));
        }
    }
}

/// The rules of a menu that are left.
#[derive(Debug)]
pub(crate) struct Remainder {
    /// Their places in the menu.
    places: Vec<u32>,
    /// Their `exp(-H)`, up to a factor, summed up to each.
    weights: Vec<f64>,
    /// Those that were drawn, by place.
    rules: RefCell<FxHashMap<usize, Rc<Choice>>>,
    /// All of them for Eq. 4, once they were asked for.
    offers: OnceCell<Offers>,
}

impl Remainder {
    /// The rules with these `H` and places, at most `most`.
    pub fn new(left: impl Iterator<Item = (f64, usize)>, most: usize) -> Self {
        let (mut weights, mut places) = (Vec::with_capacity(most), Vec::with_capacity(most));
        for (h, place) in left {
            weights.push(h);
            places.push(place as u32);
        }
        weigh(&mut weights);
        weights.shrink_to_fit();
        places.shrink_to_fit();
        Self {
            places,
            weights,
            rules: RefCell::default(),
            offers: OnceCell::new(),
        }
    }

    /// Whether no rule is left.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The places of its rules in the menu.
    pub fn places(&self) -> impl Iterator<Item = usize> + '_ {
        self.places.iter().map(|place| *place as usize)
    }

    /// Its rules for Eq. 4, if they were asked for before.
    pub fn offers(&self) -> Option<&Offers> {
        self.offers.get()
    }

    /// Draws a place in the menu; there is one.
    pub fn draw<R: Rng>(&self, rng: &mut R) -> usize {
        self.places[draw(&self.weights, rng)] as usize
    }

    /// The rule at a place, if it was drawn before.
    pub fn rule(&self, place: usize) -> Option<Rc<Choice>> {
        self.rules.borrow().get(&place).cloned()
    }
}

/// Numbers that a generation of remainders may hold, eight bytes each.
const HELD: usize = 4_000_000;
/// Of these, what a remainder takes beside its rules' weights, and what a rule takes, about.
const PER_REMAINDER: usize = 24;
const PER_RULE: usize = 24;

/// By type and blocked lines.
type Generation = FxHashMap<Box<[u64]>, Rc<Remainder>>;

/// The remainders met lately: when a generation is full, a new one begins, which takes over what is
/// asked for again, and the one before goes.
#[derive(Debug, Default)]
pub(crate) struct Remainders {
    young: Generation,
    old: Generation,
    /// Numbers that the young generation holds.
    held: usize,
    key: Vec<u64>,
}

impl Remainders {
    /// What is left of a type's menu, if it is known.
    pub fn get(&mut self, id: TypeId, blocked: &Blocked) -> Option<Rc<Remainder>> {
        blocked.key(id, &mut self.key);
        if let Some(known) = self.young.get(self.key.as_slice()) {
            return Some(Rc::clone(known));
        }
        let (key, known) = self.old.remove_entry(self.key.as_slice())?;
        self.insert(key, Rc::clone(&known));
        Some(known)
    }

    /// Keeps what is left of a type's menu.
    pub fn keep(&mut self, id: TypeId, blocked: &Blocked, remainder: &Rc<Remainder>) {
        blocked.key(id, &mut self.key);
        self.insert(self.key.as_slice().into(), Rc::clone(remainder));
    }

    /// Keeps a rule that was drawn from a remainder. Rules of open menus count too, though they never go.
    pub fn keep_rule(&mut self, remainder: &Remainder, place: usize, rule: &Rc<Choice>) {
        self.held += PER_RULE;
        remainder.rules.borrow_mut().insert(place, Rc::clone(rule));
    }

    /// Keeps the rules of a remainder for Eq. 4.
    pub fn keep_offers<'a>(&mut self, remainder: &'a Remainder, offers: Offers) -> &'a Offers {
        self.held += offers.held();
        remainder.offers.get_or_init(|| offers)
    }

    fn insert(&mut self, key: Box<[u64]>, remainder: Rc<Remainder>) {
        if self.held > HELD {
            self.old = std::mem::take(&mut self.young);
            self.held = 0;
        }
        let offers = remainder.offers.get().map_or(0, Offers::held);
        let rules = PER_RULE * remainder.rules.borrow().len();
        self.held += PER_REMAINDER + key.len() + 2 * remainder.places.len() + rules + offers;
        self.young.insert(key, remainder);
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
fn draw<R: Rng>(sums: &[f64], rng: &mut R) -> usize {
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
        let mut remainders = Remainders::default();
        let here = blocked([vec![false, true, false], vec![false; 70]]);
        let kept = Rc::new(Remainder::new([(1.0, 4), (2.0, 6)].into_iter(), 3));
        remainders.keep(8, &here, &kept);
        assert!(Rc::ptr_eq(&remainders.get(8, &here).unwrap(), &kept));
        assert!(remainders.get(9, &here).is_none());
        let mut last = vec![false; 70];
        last[69] = true;
        let other = blocked([vec![false, true, false], last]);
        assert!(remainders.get(8, &other).is_none());
    }

    #[test]
    fn remainders_not_asked_for_give_way() {
        let mut remainders = Remainders::default();
        let here = blocked([vec![false, true, false], vec![false; 3]]);
        let many = (0..=HELD).map(|place| (1.0, place));
        let large = Rc::new(Remainder::new(many, HELD + 1));
        for id in 1..4 {
            // Each fills a generation; the first is asked for whenever one is full.
            remainders.keep(id, &here, &large);
            assert!(remainders.get(1, &here).is_some());
        }
        assert!(remainders.get(2, &here).is_none());
        assert!(remainders.get(3, &here).is_some());
    }

    #[test]
    fn weights_add_up_and_lesser_h_is_likelier() {
        let left = [(3.0, 10), (3.0 + 2f64.ln(), 11)].into_iter();
        let remainder = Remainder::new(left, 2);
        assert!((remainder.weights[0] - 1.0).abs() < 1e-12);
        assert!((remainder.weights[1] - 1.5).abs() < 1e-12);
        assert_eq!(remainder.places, [10, 11]);
    }
}
