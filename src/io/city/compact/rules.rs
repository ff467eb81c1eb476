//! Rules and placements.
//!
//! A placement is told by its difference from what is likely: a building stands beside the one before it and is turned like it, a
//! part stands on the part below it, a part of an instance is where its rule puts it, and the numbers of an instance are near those of
//! the instance of the same symbol before it.

mod parts;
mod place;

use rustc_hash::FxHashMap;

use super::error::{ARRANGED, CompactError};
use super::identity::Identities;
use super::integers::{BitTree, Natural, Whole, plain};
use super::range_coder::{Bit, Coder};
use super::rows::{Footprint, PLACES};
use super::unit::Steps;
use edifice_grammar::instance::{Begins, InstanceRule};

/// Most placements of a file.
const MOST_PLACEMENTS: u64 = 8_000_000;

/// Most levels of a rule with parameters.
const MOST_LEVELS: u64 = 4096;

/// A placement in steps.
#[derive(Debug, Clone, Copy, Default)]
struct Pose {
    symbol: usize,
    at: [i64; 3],
    turn: i64,
    size: [i64; 3],
    /// Width and depth of an instance of a rule with parameters; otherwise 0.
    plan: [i64; 2],
}

impl Pose {
    fn footprint(&self) -> Footprint {
        Footprint {
            at: [self.at[0], self.at[1]],
            turn: self.turn,
            size: self.plan,
        }
    }
}

/// The reference of a placement, from which its numbers are differences.
#[derive(Clone, Copy, PartialEq)]
enum Near {
    /// The axiom's successor before it.
    Before = 0,
    /// Nothing: the first of a rule.
    First = 1,
    /// The rule's successor before it, on which it may stand.
    Below = 2,
    /// The rule's own part.
    Like = 3,
}

/// Learnt probabilities of placements near to one kind of thing; of templates, or of non-terminals.
#[derive(Default)]
struct PoseModels {
    at: [Whole; 3],
    turn: Whole,
    /// Width, height; depth, by the bits of the width.
    size: [Natural; 2],
    depth: FxHashMap<usize, Natural>,
    /// Differences of sizes.
    change: [Whole; 3],
    factor: Bit,
}

/// Writes or reads the rules of a grammar.
pub(super) struct Rules<'a, C> {
    coder: C,
    steps: Steps,
    symbols: &'a [String],
    numbers: FxHashMap<&'a str, usize>,
    templates: usize,
    identities: Identities,
    placements: u64,
    models: Vec<PoseModels>,
    quarter: Vec<BitTree>,
    is_rule: Vec<Bit>,
    symbol: [BitTree; 2],
    as_usual: Bit,
    counts: Natural,
    weight: Natural,
    flags: [Bit; 5],
    /// True if rules may have parameters and factors: not in version 1.
    parametric: bool,
    /// True if buildings follow each other in rows: from version 3 on.
    rows: bool,
    /// True if rules may be rows: from version 5 on. What a building begins, by what the one before it begins.
    arranged: bool,
    begins: [BitTree; 4],
    /// The beginnings of the axiom's buildings, as far as it is known; true while one is told that goes on with a row.
    told: Vec<Begins>,
    in_row: bool,
    /// True for the axiom's rules; the place of a building beside the one before it, and the rest, by the place.
    is_top: Bit,
    beside: [BitTree; 2],
    rest: [[[Whole; 2]; PLACES]; 2],
    /// Levels of the first rule of each symbol, where they are needed to read the axiom's.
    levels_of: FxHashMap<String, usize>,
    levels: Natural,
    again: [Bit; 2],
    /// The numbers of the instance of each symbol before, and what codes them: the first of a symbol, then others, by parameter.
    numbers_before: FxHashMap<usize, Vec<i64>>,
    numbers_models: Vec<[Whole; PARAMETERS]>,
    /// The numbers of the instance before, of any symbol, and its symbol.
    last_numbers: Vec<i64>,
    last_symbol: Option<usize>,
}

/// Contexts of poses: a template or a non-terminal by what it is near to, and in rows besides.
const CONTEXTS: usize = 10;

/// Parameters with probabilities of their own.
const PARAMETERS: usize = 6;

/// Names of the bits of [`Rules::flags`].
#[derive(Clone, Copy)]
enum Flag {
    WholeWeight,
    HasParts,
    Present,
    Scaled,
    Row,
}

impl<'a, C: Coder> Rules<'a, C> {
    /// `symbols`: the first `templates` of them are terminals.
    pub(super) fn new(
        coder: C,
        steps: Steps,
        symbols: &'a [String],
        templates: usize,
        identities: Identities,
        version: u16,
    ) -> Self {
        let numbers = symbols.iter().enumerate().map(|(i, s)| (s.as_str(), i));
        let rules = symbols.len() - templates;
        Self {
            coder,
            steps,
            symbols,
            numbers: numbers.collect(),
            templates,
            identities,
            placements: 0,
            models: (0..CONTEXTS).map(|_| PoseModels::default()).collect(),
            quarter: vec![BitTree::new(2); CONTEXTS],
            is_rule: vec![Bit::default(); 4],
            symbol: [BitTree::below(templates), BitTree::below(rules)],
            as_usual: Bit::default(),
            counts: Natural::default(),
            weight: Natural::default(),
            flags: [Bit::default(); 5],
            parametric: version > 1,
            rows: version > 2,
            arranged: version >= ARRANGED,
            begins: [(); 4].map(|()| BitTree::new(2)),
            told: Vec::new(),
            in_row: false,
            is_top: Bit::default(),
            beside: [(); 2].map(|()| BitTree::below(PLACES)),
            rest: Default::default(),
            levels_of: FxHashMap::default(),
            levels: Natural::default(),
            again: Default::default(),
            numbers_before: FxHashMap::default(),
            numbers_models: vec![Default::default(); parts::NUMBER_CONTEXTS],
            last_numbers: Vec::new(),
            last_symbol: None,
        }
    }

    /// The coder and the identities, when all is done.
    pub(super) fn finish(self) -> (C, Identities) {
        (self.coder, self.identities)
    }

    /// Goes on with another coder; the one so far.
    pub(super) fn switch(&mut self, coder: C) -> C {
        std::mem::replace(&mut self.coder, coder)
    }

    /// All rules, of which the first are `known`: what the others make, then the numbers of instances.
    pub(super) fn rules(
        &mut self,
        given: &[InstanceRule],
        known: &[InstanceRule],
        axiom: usize,
    ) -> Result<Vec<InstanceRule>, CompactError> {
        let end = known.len() + self.count(given.len().saturating_sub(known.len()))?;
        let mut rules: Vec<Option<InstanceRule>> = known.iter().cloned().map(Some).collect();
        let mut later = Vec::new();
        for i in known.len()..end {
            let own = given.get(i);
            let top = own.is_some_and(|r| self.numbers.get(r.symbol.as_str()) == Some(&axiom));
            // Who reads the axiom's buildings needs to know the rules' levels.
            let rule = match self.rows && self.coder.bit(&mut self.is_top, top) {
                true => {
                    later.push(i);
                    None
                }
                false => Some(self.rule(own, axiom)?),
            };
            rules.push(rule);
            if self.coder.exhausted() {
                return Err(CompactError::Truncated);
            }
        }
        for rule in rules.iter().flatten() {
            let levels = self.levels_of.entry(rule.symbol.clone());
            levels.or_insert(rule.levels);
        }
        for &i in &later {
            rules[i] = Some(self.rule(given.get(i), axiom)?);
        }
        let mut rules: Vec<InstanceRule> = rules.into_iter().flatten().collect();
        let first = parts::first_rules(&rules);
        let mut told = vec![false; rules.len()];
        later.iter().for_each(|&i| told[i] = true);
        for i in (0..rules.len()).filter(|&i| !told[i]) {
            let mut successors = std::mem::take(&mut rules[i].successors);
            for (k, placed) in successors.iter_mut().enumerate() {
                let given = given.get(i).map(|r| &r.successors[k]);
                let count = first
                    .get(&placed.symbol)
                    .map_or(0, |&r| rules[r].parameters());
                placed.numbers = self.numbers(&placed.symbol, given, count)?;
            }
            rules[i].successors = successors;
        }
        Ok(rules)
    }

    fn rule(
        &mut self,
        given: Option<&InstanceRule>,
        axiom: usize,
    ) -> Result<InstanceRule, CompactError> {
        let number = given.map_or(0, |r| self.numbers[r.symbol.as_str()]);
        let symbol = self.name(true, number)?;
        let weight = self.weight(given.map_or(0.0, |r| r.weight));
        let mut levels = 0;
        let mut scale = [1.0; 3];
        if self.parametric {
            let own = given.map_or(0, |r| r.levels as u64);
            levels = self.levels.code(&mut self.coder, own);
            if levels > MOST_LEVELS {
                return Err(CompactError::TooLarge("levels"));
            }
            if self.flag(Flag::Scaled, given.is_some_and(|r| !r.is_unscaled())) {
                let own = given.map_or(scale, |r| r.scale);
                scale = own.map(|v| plain(&mut self.coder, v));
            }
        }
        let row = self.arranged && self.flag(Flag::Row, given.is_some_and(|r| r.row));
        let levels = levels as usize;
        let count = self.count(given.map_or(0, |r| r.successors.len()))?;
        let top = self.numbers.get(symbol.as_str()) == Some(&axiom);
        let mut successors = Vec::new();
        let mut before = Pose::default();
        for k in 0..count {
            let near = match (top, k) {
                (true, _) => Near::Before,
                (false, 0) => Near::First,
                _ => Near::Below,
            };
            let given = given.map(|r| &r.successors[k]);
            self.in_row = top && self.told.get(k) == Some(&Begins::Nothing);
            let (placed, pose) = self.placement(near, &before, given, levels > 0)?;
            before = pose;
            successors.push(placed);
        }
        self.in_row = false;
        Ok(InstanceRule {
            symbol,
            weight,
            levels,
            row,
            scale,
            successors,
        })
    }

    /// The beginnings of the axiom's buildings: before the rules, since those in rows are told differently.
    pub(super) fn begins(&mut self, given: &[Begins]) -> Result<(), CompactError> {
        const ALL: [Begins; 4] = [
            Begins::Nothing,
            Begins::Row,
            Begins::Block,
            Begins::District,
        ];
        let count = self.count(given.len())?;
        let mut before = Begins::District;
        for k in 0..count {
            if self.coder.exhausted() {
                return Err(CompactError::Truncated);
            }
            let own = given.get(k).map_or(0, |b| *b as usize);
            let found = self.begins[before as usize].code(&mut self.coder, own);
            before = *ALL.get(found).ok_or(CompactError::Index("building"))?;
            self.told.push(before);
        }
        Ok(())
    }

    /// The beginnings of the axiom's buildings, once they are known.
    pub(super) fn told(&mut self) -> Vec<Begins> {
        std::mem::take(&mut self.told)
    }

    fn name(&mut self, is_rule: bool, number: usize) -> Result<String, CompactError> {
        Ok(self.symbols[self.number(is_rule, number)?].clone())
    }

    fn number(&mut self, is_rule: bool, number: usize) -> Result<usize, CompactError> {
        let (first, end) = match is_rule {
            true => (self.templates, self.symbols.len()),
            false => (0, self.templates),
        };
        let own = number.clamp(first, end.max(first + 1) - 1) - first;
        let found = first + self.symbol[usize::from(is_rule)].code(&mut self.coder, own);
        match found < end {
            true => Ok(found),
            false => Err(CompactError::Index("symbol")),
        }
    }

    fn count(&mut self, given: usize) -> Result<usize, CompactError> {
        let count = self.counts.code(&mut self.coder, given as u64);
        match count <= MOST_PLACEMENTS {
            true => Ok(count as usize),
            false => Err(CompactError::TooLarge("placements")),
        }
    }

    fn flag(&mut self, flag: Flag, given: bool) -> bool {
        self.coder.bit(&mut self.flags[flag as usize], given)
    }

    fn weight(&mut self, given: f64) -> f64 {
        let whole = given.fract() == 0.0 && (0.0..1e15).contains(&given);
        match self.flag(Flag::WholeWeight, whole) {
            true => self.weight.code(&mut self.coder, given as u64) as f64,
            false => plain(&mut self.coder, given),
        }
    }
}
