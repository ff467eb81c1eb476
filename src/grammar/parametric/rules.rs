//! Rules without sizes and counts, each written once.

use rustc_hash::FxHashMap;

use super::error::LibraryError;
use edifice_shape::Axis;

/// What stands for a region in a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Symbol {
    /// A label, by its index.
    Terminal(u32),
    /// A rule, by its index.
    Rule(u32),
}

/// One item on the right-hand side of a rule.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Item {
    /// One part.
    Part(Symbol),
    /// A period of parts that stands at least twice in a row; how often is a parameter.
    Repeat(Vec<Symbol>),
}

impl Item {
    /// The symbols of the item, one period of a repeat.
    pub fn symbols(&self) -> &[Symbol] {
        match self {
            Item::Part(symbol) => std::slice::from_ref(symbol),
            Item::Repeat(period) => period,
        }
    }

    /// Whether it is a repeat.
    pub fn is_repeat(&self) -> bool {
        matches!(self, Item::Repeat(_))
    }
}

/// A split of a region into parts, whose sizes and counts are parameters.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Rule {
    /// Direction of the split (x: left to right; y: bottom to top).
    pub axis: Axis,
    /// The parts in order; at least two, or one repeat.
    pub items: Vec<Item>,
}

/// Labels and rules without duplicates; a rule stands after the rules that it uses.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rules {
    labels: Vec<String>,
    rules: Vec<Rule>,
    of_label: FxHashMap<String, u32>,
    of_rule: FxHashMap<Rule, u32>,
}

impl Rules {
    /// A table from its parts.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] for a label or rule that stands twice, a rule that does not split, or that uses a
    /// symbol that is no label and no earlier rule of the other direction.
    pub fn from_parts(labels: Vec<String>, rules: Vec<Rule>) -> Result<Self, LibraryError> {
        let wrong = |place: String, message: &str| {
            let message = message.to_owned();
            Err(LibraryError::Invalid { place, message })
        };
        let mut table = Self::default();
        for (k, label) in labels.iter().enumerate() {
            if label.is_empty() {
                return wrong(format!("labels[{k}]"), "a label is empty");
            }
            if table.label(label) != Symbol::Terminal(k as u32) {
                return wrong(format!("labels[{k}]"), "this label stands twice");
            }
        }
        for (k, rule) in rules.into_iter().enumerate() {
            let splits = rule.items.len() > 1 || rule.items.first().is_some_and(Item::is_repeat);
            if !splits {
                return wrong(
                    format!("rules[{k}]"),
                    "expected at least two items, or one repeat",
                );
            }
            for (n, item) in rule.items.iter().enumerate() {
                let place = || format!("rules[{k}].items[{n}]");
                if item.symbols().is_empty() {
                    return wrong(place(), "a repeat has no parts");
                }
                for &symbol in item.symbols() {
                    match symbol {
                        Symbol::Terminal(l) if (l as usize) < table.labels.len() => {}
                        Symbol::Rule(r) if r as usize >= k => {
                            return wrong(place(), "expected the index of an earlier rule");
                        }
                        Symbol::Rule(r) if table.rule(r).axis == rule.axis => {
                            return wrong(place(), "expected a rule of the other direction");
                        }
                        Symbol::Rule(_) => {}
                        Symbol::Terminal(_) => return wrong(place(), "there is no such label"),
                    }
                }
            }
            if table.intern(rule) != Symbol::Rule(k as u32) {
                return wrong(format!("rules[{k}]"), "this rule stands twice");
            }
        }
        Ok(table)
    }

    /// The labels by index.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// The rules by index.
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }

    /// The rule of an index.
    pub fn rule(&self, index: u32) -> &Rule {
        &self.rules[index as usize]
    }

    /// The symbol of a label, new where it is not known.
    pub fn label(&mut self, label: &str) -> Symbol {
        if let Some(&known) = self.of_label.get(label) {
            return Symbol::Terminal(known);
        }
        let index = self.labels.len() as u32;
        self.labels.push(label.to_owned());
        self.of_label.insert(label.to_owned(), index);
        Symbol::Terminal(index)
    }

    /// The symbol of a rule, new where it is not known.
    pub fn intern(&mut self, rule: Rule) -> Symbol {
        if let Some(&known) = self.of_rule.get(&rule) {
            return Symbol::Rule(known);
        }
        let index = self.rules.len() as u32;
        self.rules.push(rule.clone());
        self.of_rule.insert(rule, index);
        Symbol::Rule(index)
    }

    /// The direction in which a symbol splits; none for a label.
    pub fn axis(&self, symbol: Symbol) -> Option<Axis> {
        match symbol {
            Symbol::Terminal(_) => None,
            Symbol::Rule(rule) => Some(self.rule(rule).axis),
        }
    }
}
