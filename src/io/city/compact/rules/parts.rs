//! Data that instances have beside their rules: numbers of parameters, and residuals.

use rustc_hash::FxHashMap;

use super::{CompactError, Flag, Near, PARAMETERS, Rules};
use crate::compact::integers::bits_of;
use crate::compact::range_coder::Coder;
use crate::compact::steps::in_steps;
use edifice_grammar::instance::{InstanceRule, Placement};

/// Sizes of the change of the number before that are told apart.
const CHANGES: usize = 4;
/// Contexts of numbers.
pub(super) const NUMBER_CONTEXTS: usize = 4 * CHANGES;

/// The context of a number: whether an instance of the symbol is known, whether it is the instance before, and by how much the
/// number before in this instance differs.
fn context(known: bool, again: bool, change: i64) -> usize {
    let size = bits_of(change.unsigned_abs().saturating_add(1)) / 2;
    (usize::from(known) * 2 + usize::from(again)) * CHANGES + size.min(CHANGES - 1)
}

impl<C: Coder> Rules<'_, C> {
    /// The parts of the instances of `rules`.
    pub(in crate::compact) fn residuals(
        &mut self,
        given: &[InstanceRule],
        rules: &mut [InstanceRule],
    ) -> Result<(), CompactError> {
        let first = first_rules(rules);
        for i in 0..rules.len() {
            let mut successors = std::mem::take(&mut rules[i].successors);
            for (k, placed) in successors.iter_mut().enumerate() {
                let given = given.get(i).map(|r| &r.successors[k]);
                placed.parts = self.parts(placed, given, rules, &first, 0)?;
            }
            rules[i].successors = successors;
        }
        Ok(())
    }

    /// The `count` numbers of an instance, as differences from those of the last instance of its symbol, or, from version 3 on,
    /// where there was none, from those of the last of any symbol.
    pub(super) fn numbers(
        &mut self,
        symbol: &str,
        given: Option<&Placement>,
        count: usize,
    ) -> Result<Vec<f64>, CompactError> {
        if count == 0 {
            return Ok(Vec::new());
        }
        if self.coder.exhausted() {
            return Err(CompactError::Truncated);
        }
        let steps = self.steps.length;
        let symbol = self.numbers.get(symbol).copied().unwrap_or(0);
        let before = self.numbers_before.remove(&symbol);
        let known = before.is_some();
        // What is likely is near the building before, if that is of the same type.
        let again = self.last_symbol == Some(symbol);
        let mut last = before.unwrap_or_else(|| match self.rows {
            true => std::mem::take(&mut self.last_numbers),
            false => Vec::new(),
        });
        let height = last.last().copied().unwrap_or(0);
        last.resize(count, height);
        let mut change = 0;
        for (k, v) in last.iter_mut().enumerate() {
            let context = match self.rows {
                true => context(known, again, change),
                false => usize::from(known),
            };
            let model = &mut self.numbers_models[context][k.min(PARAMETERS - 1)];
            let own = given.and_then(|g| g.numbers.get(k)).copied();
            let own = in_steps(own.unwrap_or(0.0), steps)?;
            change = model.code(&mut self.coder, own.max(1).wrapping_sub(*v));
            *v = v.wrapping_add(change);
        }
        let numbers = last.iter().map(|&v| v as f64 / steps as f64).collect();
        self.last_numbers.clone_from(&last);
        self.last_symbol = Some(symbol);
        self.numbers_before.insert(symbol, last);
        Ok(numbers)
    }

    /// Codes the places of an instance's successors; `None` for those that stand where the rule puts them.
    fn parts(
        &mut self,
        instance: &Placement,
        given: Option<&Placement>,
        rules: &[InstanceRule],
        first: &FxHashMap<String, usize>,
        depth: usize,
    ) -> Result<Vec<Option<Placement>>, CompactError> {
        let Some(rule) = first.get(&instance.symbol).map(|&r| &rules[r]) else {
            return Ok(Vec::new());
        };
        if depth > 64 {
            return Err(CompactError::TooLarge("depth"));
        }
        let given = given.map(|g| &g.parts).filter(|p| !p.is_empty());
        if !self.flag(Flag::HasParts, given.is_some()) {
            return Ok(Vec::new());
        }
        let mut parts = Vec::new();
        for k in 0..rule.successors.len() {
            let own = given.and_then(|g| g[k].as_ref());
            if !self.flag(Flag::Present, own.is_some()) {
                parts.push(None);
                continue;
            }
            let usual = self.pose(&rule.part(k, &instance.numbers), self.steps.length)?;
            let (mut placed, _) = self.placement(Near::Like, &usual, own, false)?;
            let count = first
                .get(&placed.symbol)
                .map_or(0, |&r| rules[r].parameters());
            placed.numbers = self.numbers(&placed.symbol, own, count)?;
            placed.parts = self.parts(&placed, own, rules, first, depth + 1)?;
            parts.push(Some(placed));
        }
        Ok(parts)
    }
}

/// The first rule of each symbol.
pub(super) fn first_rules(rules: &[InstanceRule]) -> FxHashMap<String, usize> {
    let mut first: FxHashMap<String, usize> = FxHashMap::default();
    for (i, rule) in rules.iter().enumerate() {
        first.entry(rule.symbol.clone()).or_insert(i);
    }
    first
}
