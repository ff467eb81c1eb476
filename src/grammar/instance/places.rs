//! The places of the successors of a rule in one of its instances.

use std::borrow::Cow;

use rustc_hash::FxHashMap;

use super::parametric::along_and_across;
use super::{InstanceGrammar, InstanceRule, Placement};

/// A grammar's rules by symbol, to walk from the axiom down as a derivation does.
pub struct Places<'g> {
    grammar: &'g InstanceGrammar,
    rules: FxHashMap<&'g str, usize>,
}

impl<'g> Places<'g> {
    /// Of several rules of a symbol, the first counts.
    pub fn new(grammar: &'g InstanceGrammar) -> Self {
        let mut rules: FxHashMap<&str, usize> = FxHashMap::default();
        for (k, rule) in grammar.rules.iter().enumerate() {
            rules.entry(rule.symbol.as_str()).or_insert(k);
        }
        Self { grammar, rules }
    }

    /// The index of the rule that replaces a symbol; `None` for templates.
    pub fn rule(&self, symbol: &str) -> Option<usize> {
        self.rules.get(symbol).copied()
    }

    /// True of a rule with parameters, which is a type of buildings.
    pub(super) fn is_type(&self, rule: usize) -> bool {
        self.grammar.rules[rule].levels > 0
    }

    /// The successors of a rule in its instance `own`, in metres in the frame of `own`; `None` is absent.
    ///
    /// In a row ([`InstanceRule::row`]) the first successor stands at its own place, and each of the others begins where the one before
    /// it ends, after a gap.
    pub fn of<'a>(&self, rule: usize, own: &'a Placement) -> Vec<Option<Cow<'a, Placement>>>
    where
        'g: 'a,
    {
        let rule: &'g InstanceRule = &self.grammar.rules[rule];
        let place = |(i, successor): (usize, &'g Placement)| {
            let placed = match own.parts.get(i) {
                None if rule.levels == 0 => Cow::Borrowed(successor),
                None => Cow::Owned(rule.part(i, &own.numbers)),
                Some(None) => return None,
                Some(Some(part)) => Cow::Borrowed(part),
            };
            Some(match rule.is_unscaled() {
                true => placed,
                false => Cow::Owned(rule.scaled(&placed)),
            })
        };
        let mut placed: Vec<Option<Cow<Placement>>> =
            rule.successors.iter().enumerate().map(place).collect();
        if rule.row {
            let mut end = None;
            for placed in placed.iter_mut().flatten() {
                let half = self.length(placed, placed.turn) / 2.0;
                if let Some(end) = end {
                    placed.to_mut().at[0] += end + half;
                }
                end = Some(placed.at[0] + half);
            }
        }
        placed
    }

    /// Width and depth of a template or a building, in metres, with the factors of its rule.
    pub fn sides(&self, placed: &Placement) -> [f64; 2] {
        match (self.rule(&placed.symbol), &placed.numbers[..]) {
            (Some(rule), &[w, d, ..]) => {
                let [x, y, _] = self.grammar.rules[rule].scale;
                [w * x, d * y]
            }
            _ => [placed.size[0], placed.size[1]],
        }
    }

    /// The length of a row that a template or a building takes, in metres: its width, or its depth if that lies rather along the row, to
    /// which it is turned by `turn` degrees.
    pub fn length(&self, placed: &Placement, turn: f64) -> f64 {
        let [w, d] = self.sides(placed);
        let quarters = (turn / 90.0).round();
        along_and_across(90.0 * quarters, w, d)[0]
    }
}
