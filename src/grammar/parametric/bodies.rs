//! The rules of a library as strings, as Wu's cost counts them.
//!
//! A repeat is a rule of its own, written once for all rules that use it; a rule that is one repeat is that
//! repeat. Every other rule is a split.

use rustc_hash::FxHashMap;

use super::rules::{Item, Rules, Symbol};
use edifice_shape::Axis;

/// A symbol of a string: a label, or a body by its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Letter {
    /// A label, by its index.
    Label(u32),
    /// A body, by its index.
    Body(u32),
}

/// A right-hand side.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Body {
    /// Direction.
    pub axis: Axis,
    /// Whether the letters are one period of a repeat; else those of a split.
    pub repeat: bool,
    /// The letters in order.
    pub letters: Vec<Letter>,
}

/// All bodies, each once.
#[derive(Debug, Clone, Default)]
pub struct Bodies {
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The body of each rule.
    pub of_rule: Vec<u32>,
    /// The body of each repeat of each rule, by rule and item.
    of_repeat: FxHashMap<(u32, usize), u32>,
    index: FxHashMap<Body, u32>,
}

impl Bodies {
    /// The bodies of all rules.
    pub fn new(rules: &Rules) -> Self {
        let mut all = Self::default();
        for (number, rule) in rules.rules().iter().enumerate() {
            for (item, written) in rule.items.iter().enumerate() {
                if let Item::Repeat(period) = written {
                    let repeat = all.repeat(rule.axis, period);
                    all.of_repeat.insert((number as u32, item), repeat);
                }
            }
            let body = match &rule.items[..] {
                [Item::Repeat(period)] => all.repeat(rule.axis, period),
                items => {
                    let letters = items.iter().map(|item| match item {
                        Item::Part(symbol) => all.letter(*symbol),
                        Item::Repeat(period) => Letter::Body(all.repeat(rule.axis, period)),
                    });
                    let letters = letters.collect();
                    all.intern(Body {
                        axis: rule.axis,
                        repeat: false,
                        letters,
                    })
                }
            };
            all.of_rule.push(body);
        }
        all
    }

    /// The body of a repeat that stands as an item of a rule.
    pub fn repeat_of(&self, rule: u32, item: usize) -> u32 {
        self.of_repeat[&(rule, item)]
    }

    /// The letter of a symbol whose rule is known.
    pub fn letter(&self, symbol: Symbol) -> Letter {
        match symbol {
            Symbol::Terminal(label) => Letter::Label(label),
            Symbol::Rule(rule) => Letter::Body(self.of_rule[rule as usize]),
        }
    }

    fn repeat(&mut self, axis: Axis, period: &[Symbol]) -> u32 {
        let letters = period.iter().map(|&symbol| self.letter(symbol)).collect();
        self.intern(Body {
            axis,
            repeat: true,
            letters,
        })
    }

    fn intern(&mut self, body: Body) -> u32 {
        if let Some(&known) = self.index.get(&body) {
            return known;
        }
        let new = self.bodies.len() as u32;
        self.bodies.push(body.clone());
        self.index.insert(body, new);
        new
    }
}
