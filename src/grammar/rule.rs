//! The nouns of split grammars.

use std::collections::{BTreeMap, BTreeSet};

use edifice_shape::Axis;

/// A size along the split axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// In the grammar's unit.
    Absolute(f64),
    /// A weight: what absolute sizes leave over is shared in proportion (Wu et al. 2014, Sec. 5).
    Relative(f64),
}

impl Size {
    /// The number, whatever its kind.
    pub fn value(self) -> f64 {
        match self {
            Size::Absolute(v) | Size::Relative(v) => v,
        }
    }
}

/// One symbol written on the right-hand side of a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Successor {
    /// Non-terminal symbol or terminal label.
    pub symbol: String,
    /// Its extent along the split axis.
    pub size: Size,
}

impl Successor {
    /// A successor of absolute size.
    pub fn new(symbol: impl Into<String>, size: f64) -> Self {
        Self {
            symbol: symbol.into(),
            size: Size::Absolute(size),
        }
    }
}

/// The operation of a rule on its rectangle (Wu et al. 2014, Sec. 3.1 and 4.7).
#[derive(Debug, Clone, PartialEq)]
pub enum Operation {
    /// Successors in order along the axis (x: left to right, y: bottom to top).
    Split {
        /// Direction.
        axis: Axis,
        /// The parts.
        successors: Vec<Successor>,
    },
    /// `successors` is one period, repeated a whole number of times, at least 2.
    Repeat {
        /// Direction.
        axis: Axis,
        /// One period.
        successors: Vec<Successor>,
    },
    /// A B A B ... B A.
    RepeatAba {
        /// Direction.
        axis: Axis,
        /// The outer element.
        a: Successor,
        /// The element between two outer ones.
        b: Successor,
    },
    /// The half from the outside in, and its mirror image.
    SymSplit {
        /// Direction.
        axis: Axis,
        /// From the outside in.
        successors: Vec<Successor>,
        /// True if the last successor stands once in the middle.
        center: bool,
    },
    /// Columns and rows at once.
    GridSplit {
        /// Widths of the columns, left to right.
        columns: Vec<Size>,
        /// Heights of the rows, bottom to top.
        rows: Vec<Size>,
        /// One symbol per cell, `cells[row][column]`.
        cells: Vec<Vec<String>>,
    },
}

impl Operation {
    /// Number of successors written in the rule, `|alpha|` of Eq. 2.
    pub fn successor_count(&self) -> usize {
        match self {
            Operation::Split { successors, .. }
            | Operation::Repeat { successors, .. }
            | Operation::SymSplit { successors, .. } => successors.len(),
            Operation::RepeatAba { .. } => 2,
            Operation::GridSplit { cells, .. } => cells.iter().map(Vec::len).sum(),
        }
    }

    /// The name of the operation in files and on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Operation::Split { .. } => "split",
            Operation::Repeat { .. } => "repeat",
            Operation::RepeatAba { .. } => "repeat_aba",
            Operation::SymSplit { .. } => "sym_split",
            Operation::GridSplit { .. } => "grid_split",
        }
    }

    /// True if a size is relative: the rule says itself what gives way at another size.
    pub fn has_relative_sizes(&self) -> bool {
        let relative = |size: &Size| matches!(size, Size::Relative(_));
        match self {
            Operation::Split { successors, .. }
            | Operation::Repeat { successors, .. }
            | Operation::SymSplit { successors, .. } => {
                successors.iter().any(|s| relative(&s.size))
            }
            Operation::RepeatAba { a, b, .. } => relative(&a.size) || relative(&b.size),
            Operation::GridSplit { columns, rows, .. } => columns.iter().chain(rows).any(relative),
        }
    }

    /// The symbols written in the rule, in order.
    pub fn symbols(&self) -> Vec<&str> {
        match self {
            Operation::Split { successors, .. }
            | Operation::Repeat { successors, .. }
            | Operation::SymSplit { successors, .. } => {
                successors.iter().map(|s| s.symbol.as_str()).collect()
            }
            Operation::RepeatAba { a, b, .. } => vec![&a.symbol, &b.symbol],
            Operation::GridSplit { cells, .. } => {
                cells.iter().flatten().map(String::as_str).collect()
            }
        }
    }
}

/// `symbol --> operation`, with a weight in a stochastic grammar.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Left-hand side.
    pub symbol: String,
    /// Weight among the rules of the same symbol; `None` in a deterministic grammar.
    pub weight: Option<f64>,
    /// Right-hand side.
    pub operation: Operation,
}

/// A facade that a joint grammar derives (Wu et al. 2014, Fig. 13).
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// Name of the facade.
    pub name: String,
    /// Symbol to start from: a non-terminal, or a terminal when the facade is one region.
    pub symbol: String,
    /// Extent along x.
    pub width: f64,
    /// Extent along y.
    pub height: f64,
}

/// A split grammar with the facade, or facades, that it explains.
#[derive(Debug, Clone, PartialEq)]
pub struct Grammar {
    /// Unit of absolute sizes.
    pub unit: String,
    /// The starts of derivation: one entry, or one per facade for a joint grammar. Never empty.
    pub starts: Vec<Start>,
    /// The rules. The order carries no meaning; writers keep it.
    pub rules: Vec<Rule>,
}

impl Grammar {
    /// Each facade of a joint grammar as a grammar of its own, in order, with the rules that it reaches. A grammar of one
    /// facade is given back as it is, also with rules that are never used. `O(starts x size of the rules)`.
    pub fn of_each_start(&self) -> Vec<Grammar> {
        if self.starts.len() == 1 {
            return vec![self.clone()];
        }
        let own = |start: &Start| {
            let reached = self.reached(&start.symbol);
            let rules = self.rules.iter();
            Grammar {
                unit: self.unit.clone(),
                starts: vec![start.clone()],
                rules: rules
                    .filter(|r| reached.contains(r.symbol.as_str()))
                    .cloned()
                    .collect(),
            }
        };
        self.starts.iter().map(own).collect()
    }

    /// The symbols that a derivation from `symbol` may write, itself included.
    fn reached<'g>(&'g self, symbol: &'g str) -> BTreeSet<&'g str> {
        let mut rules: BTreeMap<&str, Vec<&Rule>> = BTreeMap::new();
        for rule in &self.rules {
            rules.entry(&rule.symbol).or_default().push(rule);
        }
        let mut reached = BTreeSet::from([symbol]);
        let mut todo = vec![symbol];
        while let Some(symbol) = todo.pop() {
            let own = rules.get(symbol).into_iter().flatten();
            for written in own.flat_map(|rule| rule.operation.symbols()) {
                if reached.insert(written) {
                    todo.push(written);
                }
            }
        }
        reached
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One relative size among absolute ones is found in every operation and at every place.
    #[test]
    fn relative_sizes_are_found() {
        let of = |sizes: [Size; 2]| {
            let axis = Axis::X;
            let [a, b] = sizes.map(|size| Successor {
                size,
                ..Successor::new("wall", 1.0)
            });
            let successors = vec![a.clone(), b.clone()];
            [
                Operation::Repeat {
                    axis,
                    successors: successors.clone(),
                },
                Operation::SymSplit {
                    axis,
                    successors: successors.clone(),
                    center: true,
                },
                Operation::Split { axis, successors },
                Operation::RepeatAba { axis, a, b },
                Operation::GridSplit {
                    columns: vec![sizes[0]],
                    rows: vec![sizes[1]],
                    cells: vec![vec!["wall".into()]],
                },
            ]
        };
        let (one, some) = (Size::Absolute(1.0), Size::Relative(1.0));
        for (sizes, is_relative) in [
            ([one, one], false),
            ([one, some], true),
            ([some, one], true),
            ([some, some], true),
        ] {
            for operation in of(sizes) {
                let name = operation.name();
                assert_eq!(
                    operation.has_relative_sizes(),
                    is_relative,
                    "{name} {sizes:?}"
                );
            }
        }
    }
}
