//! Rules without sizes and counts, each written once.

use rustc_hash::FxHashMap;

use crate::shape::Axis;

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
