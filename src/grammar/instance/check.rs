//! The conditions that every instance grammar meets before it is derived.

use rustc_hash::FxHashMap;

use super::limits::DEEPEST;
use super::{InstanceGrammar, InstanceGrammarError, InstanceRule, Placement};

impl InstanceGrammar {
    /// Number of symbols with rules.
    pub fn non_terminals(&self) -> usize {
        let mut symbols: Vec<&str> = self.rules.iter().map(|r| r.symbol.as_str()).collect();
        symbols.sort_unstable();
        symbols.dedup();
        symbols.len()
    }

    /// Checks numbers, references and nesting.
    ///
    /// # Errors
    /// [`InstanceGrammarError`].
    pub fn check(&self) -> Result<(), InstanceGrammarError> {
        let symbols = self.symbols()?;
        match symbols.get(self.axiom.as_str()) {
            Some(Symbol::Rule(_)) => Ok(()),
            _ => Err(InstanceGrammarError::NoAxiom(self.axiom.clone())),
        }
    }

    /// Names every symbol, and checks numbers, references and nesting.
    pub(super) fn symbols(&self) -> Result<FxHashMap<&str, Symbol>, InstanceGrammarError> {
        let mut symbols = FxHashMap::default();
        for (i, template) in self.templates.iter().enumerate() {
            if symbols
                .insert(template.symbol.as_str(), Symbol::Template(i))
                .is_some()
            {
                return Err(InstanceGrammarError::Ambiguous(template.symbol.clone()));
            }
            let count = template.mesh.positions.len();
            let mut indices = template.mesh.triangles.iter().flatten();
            if let Some(&index) = indices.find(|&&i| i as usize >= count) {
                let template = i;
                return Err(InstanceGrammarError::Dangling {
                    template,
                    index,
                    count,
                });
            }
            let place = || format!("templates[{i}].positions");
            let mut values = template.mesh.positions.iter().flatten();
            values.try_for_each(|&v| number(v, "coordinate", v.is_finite(), place))?;
        }
        for (i, rule) in self.rules.iter().enumerate() {
            match symbols.get(rule.symbol.as_str()) {
                Some(Symbol::Template(_)) => {
                    return Err(InstanceGrammarError::Ambiguous(rule.symbol.clone()));
                }
                Some(Symbol::Rule(_)) => {}
                None => {
                    symbols.insert(rule.symbol.as_str(), Symbol::Rule(i));
                }
            }
            let usable = rule.weight.is_finite() && rule.weight >= 0.0;
            number(rule.weight, "weight", usable, || {
                format!("rules[{i}].weight")
            })?;
        }
        // Before the parts: in a grammar with a cycle or a symbol that is not there they say little.
        self.check_cycles(&symbols)?;
        for (rule, r) in self.rules.iter().enumerate() {
            let unknown = |s: &Placement| !symbols.contains_key(s.symbol.as_str());
            if let Some(successor) = r.successors.iter().position(unknown) {
                return Err(InstanceGrammarError::UnknownSymbol {
                    rule,
                    successor,
                    symbol: r.successors[successor].symbol.clone(),
                });
            }
        }
        for (rule, r) in self.rules.iter().enumerate() {
            self.check_parameters(rule, &symbols)?;
            for (successor, s) in r.successors.iter().enumerate() {
                let place = || format!("rules[{rule}].successors[{successor}]");
                self.check_placement(s, &symbols, &place)?;
            }
        }
        Ok(symbols)
    }

    /// Depth-first search over the rules; an open rule met again is a cycle.
    fn check_cycles(&self, symbols: &FxHashMap<&str, Symbol>) -> Result<(), InstanceGrammarError> {
        let mut by_symbol: FxHashMap<&str, Vec<usize>> = FxHashMap::default();
        for (i, rule) in self.rules.iter().enumerate() {
            by_symbol.entry(rule.symbol.as_str()).or_default().push(i);
        }
        let mut state: FxHashMap<&str, bool> = FxHashMap::default();
        for rule in &self.rules {
            let mut stack = vec![(rule.symbol.as_str(), true)];
            while let Some((symbol, enter)) = stack.pop() {
                if !enter {
                    state.insert(symbol, true);
                    continue;
                }
                match state.get(symbol) {
                    Some(true) => continue,
                    Some(false) => return Err(InstanceGrammarError::Cyclic(symbol.to_owned())),
                    None => {}
                }
                state.insert(symbol, false);
                stack.push((symbol, false));
                if stack.iter().filter(|s| !s.1).count() > DEEPEST {
                    return Err(InstanceGrammarError::TooDeep(symbol.to_owned()));
                }
                let mut inner: Vec<&str> = by_symbol
                    .get(symbol)
                    .into_iter()
                    .flatten()
                    .flat_map(|&i| &self.rules[i].successors)
                    .map(|s| s.symbol.as_str())
                    .filter(|s| matches!(symbols.get(s), Some(Symbol::Rule(_))))
                    .collect();
                inner.sort_unstable();
                inner.dedup();
                stack.extend(inner.into_iter().map(|s| (s, true)));
            }
        }
        Ok(())
    }
}

/// The template or the rule that a symbol names, by index.
#[derive(Debug, Clone, Copy)]
pub(super) enum Symbol {
    Template(usize),
    Rule(usize),
}

fn number(
    value: f64,
    what: &'static str,
    usable: bool,
    place: impl Fn() -> String,
) -> Result<(), InstanceGrammarError> {
    match usable {
        true => Ok(()),
        false => Err(InstanceGrammarError::Number {
            place: place(),
            what,
            value,
        }),
    }
}

impl InstanceGrammar {
    /// Factors, and what the successors of a rule with parameters are.
    fn check_parameters(
        &self,
        rule: usize,
        symbols: &FxHashMap<&str, Symbol>,
    ) -> Result<(), InstanceGrammarError> {
        let r = &self.rules[rule];
        for v in r.scale {
            let usable = v.is_finite() && v > 0.0;
            number(v, "factor", usable, || format!("rules[{rule}].scale"))?;
        }
        if r.row {
            return self.check_row(rule, symbols);
        }
        if r.levels == 0 && r.is_unscaled() {
            return Ok(());
        }
        for (i, s) in r.successors.iter().enumerate() {
            if !matches!(symbols.get(s.symbol.as_str()), Some(Symbol::Template(_))) {
                let symbol = s.symbol.clone();
                return Err(InstanceGrammarError::NoTemplate { rule, symbol });
            }
            let place = || format!("rules[{rule}].successors[{i}]");
            let level = s.at[2];
            let within = level >= 0.0 && level < r.levels as f64;
            number(level, "level", r.levels == 0 || within, place)?;
        }
        Ok(())
    }

    /// Everything in a row has a length.
    fn check_row(
        &self,
        rule: usize,
        symbols: &FxHashMap<&str, Symbol>,
    ) -> Result<(), InstanceGrammarError> {
        let r = &self.rules[rule];
        let levels = r.levels as f64;
        let place = || format!("rules[{rule}].parameters");
        number(levels, "number of levels of a row", r.levels == 0, place)?;
        let factor = r.scale.into_iter().find(|f| *f != 1.0);
        let place = || format!("rules[{rule}].scale");
        number(
            factor.unwrap_or(1.0),
            "factor of a row",
            factor.is_none(),
            place,
        )?;
        let long = |s: &str| match symbols.get(s) {
            Some(Symbol::Template(_)) => true,
            Some(&Symbol::Rule(k)) => self.rules[k].levels > 0,
            None => false,
        };
        match r.successors.iter().find(|s| !long(&s.symbol)) {
            Some(s) => Err(InstanceGrammarError::NoLength {
                rule,
                symbol: s.symbol.clone(),
            }),
            None => Ok(()),
        }
    }

    fn check_placement(
        &self,
        placement: &Placement,
        symbols: &FxHashMap<&str, Symbol>,
        place: &dyn Fn() -> String,
    ) -> Result<(), InstanceGrammarError> {
        for v in placement.at {
            number(v, "shift", v.is_finite(), || format!("{}.at", place()))?;
        }
        let turn = placement.turn;
        number(turn, "turn", turn.is_finite(), || {
            format!("{}.turn", place())
        })?;
        let [w, d, h] = placement.size;
        for v in [w, d, h] {
            let usable = v.is_finite() && v > 0.0;
            number(v, "size", usable, || format!("{}.size", place()))?;
        }
        let rule = match symbols.get(placement.symbol.as_str()) {
            None => return Err(InstanceGrammarError::UnknownPart(placement.symbol.clone())),
            Some(Symbol::Template(_)) => None,
            Some(&Symbol::Rule(rule)) => Some(&self.rules[rule]),
        };
        if rule.is_some() {
            let what = "size of a non-terminal, which takes one factor for all axes";
            number(d, what, w == d && d == h, || format!("{}.size", place()))?;
        }
        let expected = rule.map_or(0, InstanceRule::parameters);
        if placement.numbers.len() != expected {
            return Err(InstanceGrammarError::Numbers {
                symbol: placement.symbol.clone(),
                found: placement.numbers.len(),
                expected,
            });
        }
        for (k, &v) in placement.numbers.iter().enumerate() {
            let usable = v.is_finite() && v > 0.0;
            number(v, "length", usable, || format!("{}.numbers[{k}]", place()))?;
        }
        let expected = rule.map_or(0, |r| r.successors.len());
        if !placement.parts.is_empty() && placement.parts.len() != expected {
            return Err(InstanceGrammarError::Parts {
                symbol: placement.symbol.clone(),
                found: placement.parts.len(),
                expected,
            });
        }
        for (part, successor) in placement
            .parts
            .iter()
            .zip(rule.iter().flat_map(|r| &r.successors))
        {
            let Some(part) = part else { continue };
            let template = |s: &str| matches!(symbols.get(s), Some(Symbol::Template(_)));
            if part.symbol != successor.symbol
                && !(template(&part.symbol) && template(&successor.symbol))
            {
                return Err(InstanceGrammarError::Part {
                    part: part.symbol.clone(),
                    expected: successor.symbol.clone(),
                });
            }
            self.check_placement(part, symbols, place)?;
        }
        Ok(())
    }
}
