//! A design in the making: parts with sizes, and the rules that split them.

use rustc_hash::FxHashMap;

use edifice_grammar::{Grammar, Operation, Rule, Start, Successor};
use edifice_shape::Axis;

/// A symbol with its size in centimetres.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Part {
    /// Terminal label or non-terminal symbol.
    pub symbol: String,
    /// True if it has no rule.
    pub terminal: bool,
    /// Extent along x.
    pub width: u32,
    /// Extent along y.
    pub height: u32,
}

/// A terminal part.
pub(crate) fn leaf(label: &str, width: u32, height: u32) -> Part {
    Part {
        symbol: label.to_string(),
        terminal: true,
        width,
        height,
    }
}

impl Part {
    fn along(&self, axis: Axis) -> u32 {
        match axis {
            Axis::X => self.width,
            Axis::Y => self.height,
        }
    }
}

/// The properties in which equal parts agree: operation, and the parts inside.
type Content = (bool, Axis, Vec<Part>, u32);

/// The rules so far.
#[derive(Debug, Default)]
pub(crate) struct Draft {
    rules: Vec<Rule>,
    known: FxHashMap<Content, Part>,
    names: FxHashMap<String, usize>,
}

impl Draft {
    /// Parts side by side, left to right, all of one height.
    pub(crate) fn row(&mut self, name: &str, parts: Vec<Part>) -> Part {
        self.split(name, Axis::X, parts)
    }

    /// Parts on top of each other, bottom to top, all of one width.
    pub(crate) fn stack(&mut self, name: &str, parts: Vec<Part>) -> Part {
        self.split(name, Axis::Y, parts)
    }

    /// Parts of size zero vanish, neighbouring terminals of one label become one.
    fn split(&mut self, name: &str, axis: Axis, parts: Vec<Part>) -> Part {
        let mut joined: Vec<Part> = Vec::with_capacity(parts.len());
        for part in parts.into_iter().filter(|p| p.width > 0 && p.height > 0) {
            match joined.last_mut() {
                Some(last) if last.terminal && part.terminal && last.symbol == part.symbol => {
                    match axis {
                        Axis::X => last.width += part.width,
                        Axis::Y => last.height += part.height,
                    }
                }
                _ => joined.push(part),
            }
        }
        match joined.len() {
            1 => joined.swap_remove(0),
            _ => self.rule(name, axis, joined, 1),
        }
    }

    /// A period that stands `times` times along x.
    pub(crate) fn repeat(&mut self, name: &str, period: Vec<Part>, times: u32) -> Part {
        match times {
            0 | 1 => self.row(name, period),
            _ => self.rule(name, Axis::X, period, times),
        }
    }

    /// A period that stands `times` times along y.
    pub(crate) fn repeat_up(&mut self, name: &str, period: Vec<Part>, times: u32) -> Part {
        match times {
            0 | 1 => self.stack(name, period),
            _ => self.rule(name, Axis::Y, period, times),
        }
    }

    fn rule(&mut self, name: &str, axis: Axis, parts: Vec<Part>, times: u32) -> Part {
        let across = parts.first().map_or(0, |p| p.along(axis.other()));
        debug_assert!(
            parts.iter().all(|p| p.along(axis.other()) == across),
            "{name}: parts differ across the split: {parts:?}"
        );
        let content = (times > 1, axis, parts.clone(), times);
        if let Some(part) = self.known.get(&content) {
            return part.clone();
        }
        let along: u32 = parts.iter().map(|p| p.along(axis)).sum::<u32>() * times;
        let count = self.names.entry(name.to_string()).or_default();
        *count += 1;
        let symbol = match count {
            1 => name.to_string(),
            n => format!("{name}{n}"),
        };
        let successors = parts
            .iter()
            .map(|p| Successor::new(p.symbol.clone(), f64::from(p.along(axis))))
            .collect();
        let operation = match times {
            1 => Operation::Split { axis, successors },
            _ => Operation::Repeat { axis, successors },
        };
        self.rules.push(Rule {
            symbol: symbol.clone(),
            weight: None,
            operation,
        });
        let (width, height) = match axis {
            Axis::X => (along, across),
            Axis::Y => (across, along),
        };
        let part = Part {
            symbol,
            terminal: false,
            width,
            height,
        };
        self.known.insert(content, part.clone());
        part
    }

    /// The grammar that starts at `root`, its rules from the whole to the parts.
    pub(crate) fn finish(self, name: &str, root: &Part) -> Grammar {
        let mut reached = vec![root.symbol.clone()];
        let mut rules: Vec<Rule> = Vec::new();
        let mut next = 0;
        while let Some(symbol) = reached.get(next).cloned() {
            next += 1;
            let Some(rule) = self.rules.iter().find(|r| r.symbol == symbol) else {
                continue;
            };
            for inner in rule.operation.symbols() {
                if !reached.iter().any(|s| s == inner) {
                    reached.push(inner.to_string());
                }
            }
            rules.push(rule.clone());
        }
        Grammar {
            unit: "cm".to_string(),
            starts: vec![Start {
                name: name.to_string(),
                symbol: root.symbol.clone(),
                width: f64::from(root.width),
                height: f64::from(root.height),
            }],
            rules,
        }
    }
}
