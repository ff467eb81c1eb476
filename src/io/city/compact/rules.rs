//! Rules and placements.
//!
//! A placement is told by its difference from what is likely: a building stands near the one before it and is turned like it, a
//! part stands on the part below it, a part of an instance is where its rule puts it, and the numbers of an instance are near those of
//! the instance of the same symbol before it.

mod parts;

use rustc_hash::FxHashMap;

use super::error::CompactError;
use super::identity::Identities;
use super::integers::{BitTree, Natural, Whole, bits_of, plain};
use super::range_coder::{Bit, Coder};
use super::steps::{SHARES, in_steps};
use super::unit::Steps;
use edifice_grammar::instance::{InstanceRule, Placement};

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
    flags: [Bit; 4],
    /// True if rules may have parameters and factors: not in version 1.
    parametric: bool,
    levels: Natural,
    again: Bit,
    /// The numbers of the instance of each symbol before, and what codes them: the first of a symbol, then others, by parameter.
    numbers_before: FxHashMap<usize, Vec<i64>>,
    numbers_models: [[Whole; PARAMETERS]; 2],
}

/// Parameters with probabilities of their own.
const PARAMETERS: usize = 6;

/// Names of the bits of [`Rules::flags`].
#[derive(Clone, Copy)]
enum Flag {
    WholeWeight,
    HasParts,
    Present,
    Scaled,
}

impl<'a, C: Coder> Rules<'a, C> {
    /// `symbols`: the first `templates` of them are terminals.
    pub(super) fn new(
        coder: C,
        steps: Steps,
        symbols: &'a [String],
        templates: usize,
        identities: Identities,
        parametric: bool,
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
            models: (0..8).map(|_| PoseModels::default()).collect(),
            quarter: vec![BitTree::new(2); 8],
            is_rule: vec![Bit::default(); 4],
            symbol: [BitTree::below(templates), BitTree::below(rules)],
            as_usual: Bit::default(),
            counts: Natural::default(),
            weight: Natural::default(),
            flags: [Bit::default(); 4],
            parametric,
            levels: Natural::default(),
            again: Bit::default(),
            numbers_before: FxHashMap::default(),
            numbers_models: Default::default(),
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

    /// All rules: what they make, then the numbers of instances.
    pub(super) fn rules(
        &mut self,
        given: &[InstanceRule],
        axiom: usize,
    ) -> Result<Vec<InstanceRule>, CompactError> {
        let count = self.count(given.len())?;
        let mut rules = Vec::new();
        for i in 0..count {
            rules.push(self.rule(given.get(i), axiom)?);
        }
        let first = parts::first_rules(&rules);
        for i in 0..rules.len() {
            let mut successors = std::mem::take(&mut rules[i].successors);
            for (k, placed) in successors.iter_mut().enumerate() {
                let given = given.get(i).map(|r| &r.successors[k]);
                placed.numbers = self.numbers(&placed.symbol, given, &rules, &first)?;
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
            let (placed, pose) = self.placement(near, &before, given, levels > 0)?;
            before = pose;
            successors.push(placed);
        }
        Ok(InstanceRule {
            symbol,
            weight,
            levels,
            scale,
            successors,
        })
    }

    /// A placement without its parts and numbers; with `shares`, its lengths are shares and levels.
    fn placement(
        &mut self,
        near: Near,
        other: &Pose,
        given: Option<&Placement>,
        shares: bool,
    ) -> Result<(Placement, Pose), CompactError> {
        self.placements += 1;
        if self.placements > MOST_PLACEMENTS {
            return Err(CompactError::TooLarge("placements"));
        }
        if self.coder.exhausted() {
            return Err(CompactError::Truncated);
        }
        let unit = if shares { SHARES } else { self.steps.length };
        let own = match given {
            Some(given) => self.pose(given, unit)?,
            None => Pose::default(),
        };
        let usual = match near {
            Near::Like => self
                .coder
                .bit(&mut self.as_usual, own.symbol == other.symbol),
            // The next building often is of the same type.
            Near::Before if self.parametric => {
                self.coder.bit(&mut self.again, own.symbol == other.symbol)
            }
            _ => false,
        };
        let symbol = match usual {
            true if other.symbol >= self.symbols.len() => {
                return Err(CompactError::Index("symbol"));
            }
            true => other.symbol,
            false => {
                let is_rule = own.symbol >= self.templates;
                let is_rule = self.coder.bit(&mut self.is_rule[near as usize], is_rule);
                self.number(is_rule, own.symbol)?
            }
        };
        let is_rule = symbol >= self.templates;
        let context = near as usize * 2 + usize::from(is_rule);
        let coder = &mut self.coder;
        let models = &mut self.models[context];
        let full = self.steps.turn * 360;
        let quarter = full / 4;
        // Quarter turns, then what is left, from -1/8 to 1/8 of a turn.
        let away = (own.turn - other.turn + quarter / 2).rem_euclid(full);
        let quarters = self.quarter[context].code(coder, (away / quarter) as usize) as i64;
        let rest = models
            .turn
            .code(coder, away - quarters * quarter - quarter / 2);
        let turn = (other
            .turn
            .wrapping_add(quarters * quarter)
            .wrapping_add(rest))
        .rem_euclid(full);
        let mut like = if shares { [SHARES; 3] } else { other.size };
        if quarters % 2 == 1 {
            like.swap(0, 1);
        }
        let mut at = other.at;
        if near == Near::Below {
            at[2] = at[2].wrapping_add(other.size[2]);
        }
        for (axis, at) in at.iter_mut().enumerate() {
            let away = own.at[axis].wrapping_sub(*at);
            *at = at.wrapping_add(models.at[axis].code(coder, away));
        }
        let mut size = [0; 3];
        let mut factor = 1.0;
        let below = matches!(near, Near::Below | Near::Like) && other.symbol < self.templates;
        let stands = below || shares;
        if is_rule {
            let given = given.map_or(1.0, |g| g.size[0]);
            if !coder.bit(&mut models.factor, given == 1.0) {
                factor = plain(coder, given);
            }
        } else if stands {
            for axis in 0..3 {
                // The height of what stands on a part says nothing of its own.
                let like = if near == Near::Below && axis == 2 && !shares {
                    0
                } else {
                    like[axis]
                };
                let change = models.change[axis].code(coder, own.size[axis].wrapping_sub(like));
                size[axis] = like.wrapping_add(change);
            }
        } else {
            size[0] = models.size[0].code(coder, own.size[0] as u64) as i64;
            let depth = models.depth.entry(bits_of(size[0] as u64)).or_default();
            size[1] = depth.code(coder, own.size[1] as u64) as i64;
            size[2] = models.size[1].code(coder, own.size[2] as u64) as i64;
        }
        let pose = Pose {
            symbol,
            at,
            turn,
            size,
        };
        let id = given.and_then(|g| g.id.as_ref());
        let id = self.identities.id(coder, id)?;
        let attributes = given.map(|g| &g.attributes);
        let attributes = self.identities.attributes(coder, attributes)?;
        let length = |v: i64| v as f64 / unit as f64;
        let placed = Placement {
            symbol: self.symbols[symbol].clone(),
            at: at.map(length),
            turn: turn as f64 / self.steps.turn as f64,
            size: if is_rule {
                [factor; 3]
            } else {
                size.map(length)
            },
            id,
            attributes,
            parts: Vec::new(),
            numbers: Vec::new(),
        };
        Ok((placed, pose))
    }

    /// A placement in steps, `unit` of them in a length of 1.
    fn pose(&self, placed: &Placement, unit: i64) -> Result<Pose, CompactError> {
        let symbol = self.numbers.get(placed.symbol.as_str()).copied();
        let symbol = symbol.ok_or(CompactError::Index("symbol"))?;
        let length = |v: f64| in_steps(v, unit);
        let [x, y, z] = placed.at;
        let [w, d, h] = match symbol < self.templates {
            true => placed.size,
            false => [0.0; 3],
        };
        let turn = in_steps(placed.turn, self.steps.turn)?;
        let mut size = [length(w)?, length(d)?, length(h)?];
        if symbol < self.templates {
            size = size.map(|v| v.max(1));
        }
        Ok(Pose {
            symbol,
            at: [length(x)?, length(y)?, length(z)?],
            turn: turn.rem_euclid(360 * self.steps.turn),
            size,
        })
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
