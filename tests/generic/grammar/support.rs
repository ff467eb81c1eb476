//! Random valid grammars, and a derivation too simple to be wrong.
#![allow(dead_code)] // each test file uses its own part of this module

use std::collections::HashMap;

use edifice::grammar::{Grammar, Operation, Rule, Size, Start, Successor};
use edifice::rng::{Stream, stream};
use edifice::shape::{Axis, Rect, Region};
use rand::RngExt;

/// A random deterministic grammar of absolute integer sizes: all five operations, shared symbols.
pub(super) fn random_grammar(seed: u64) -> Grammar {
    let mut rng = stream(seed, "random_grammar", 0);
    let (width, height) = (rng.random_range(1..200), rng.random_range(1..200));
    let mut maker = Maker {
        rules: Vec::new(),
        done: HashMap::new(),
        rng,
    };
    let symbol = maker.region(width, height, 5);
    Grammar {
        unit: "px".into(),
        starts: vec![Start {
            name: "random".into(),
            symbol,
            width: f64::from(width),
            height: f64::from(height),
        }],
        rules: maker.rules,
    }
}

struct Maker {
    rules: Vec<Rule>,
    /// Finished symbols by size: reusing one makes no cycle.
    done: HashMap<(u32, u32), Vec<String>>,
    rng: Stream,
}

impl Maker {
    fn region(&mut self, w: u32, h: u32, depth: u32) -> String {
        let terminal = ["wall", "window", "door", "Wall 2", "balcon\u{e9}"];
        if depth == 0 || self.rng.random_bool(0.3) {
            return terminal[self.rng.random_range(0..terminal.len())].into();
        }
        if let Some(done) = self.done.get(&(w, h))
            && self.rng.random_bool(0.7)
        {
            return done[self.rng.random_range(0..done.len())].clone();
        }
        let axis = Axis::BOTH[self.rng.random_range(0..2)];
        let operation = match self.rng.random_range(0..5) {
            1 => self.repeat(axis, w, h, depth),
            2 => self.aba(axis, w, h, depth),
            3 => self.sym(axis, w, h, depth),
            4 => Some(self.grid(w, h, depth)),
            _ => None,
        };
        let operation = operation.unwrap_or_else(|| {
            let extent = if axis == Axis::X { w } else { h };
            let sizes = self.parts(extent);
            Operation::Split {
                axis,
                successors: self.successors(axis, w, h, &sizes, depth),
            }
        });
        let symbol = format!("NT{}", self.rules.len());
        self.rules.push(Rule {
            symbol: symbol.clone(),
            weight: None,
            operation,
        });
        self.done.entry((w, h)).or_default().push(symbol.clone());
        symbol
    }

    /// A random way to write `total` as one to five positive parts.
    fn parts(&mut self, total: u32) -> Vec<u32> {
        let mut cuts: Vec<u32> = (0..self.rng.random_range(0..5))
            .map(|_| self.rng.random_range(0..=total))
            .chain([0, total])
            .collect();
        cuts.sort_unstable();
        cuts.dedup();
        cuts.windows(2).map(|c| c[1] - c[0]).collect()
    }

    fn successors(
        &mut self,
        axis: Axis,
        w: u32,
        h: u32,
        sizes: &[u32],
        depth: u32,
    ) -> Vec<Successor> {
        let one = |maker: &mut Self, size| match axis {
            Axis::X => maker.region(size, h, depth - 1),
            Axis::Y => maker.region(w, size, depth - 1),
        };
        sizes
            .iter()
            .map(|&size| Successor::new(one(self, size), f64::from(size)))
            .collect()
    }

    fn repeat(&mut self, axis: Axis, w: u32, h: u32, depth: u32) -> Option<Operation> {
        let extent = if axis == Axis::X { w } else { h };
        let times = (2..=6).rev().find(|n| extent % n == 0)?;
        let sizes = self.parts(extent / times);
        Some(Operation::Repeat {
            axis,
            successors: self.successors(axis, w, h, &sizes, depth),
        })
    }

    fn aba(&mut self, axis: Axis, w: u32, h: u32, depth: u32) -> Option<Operation> {
        let extent = if axis == Axis::X { w } else { h };
        let n = self.rng.random_range(1..4);
        let a = (1..extent).find(|a| extent > (n + 1) * a && (extent - (n + 1) * a) % n == 0)?;
        let sizes = [a, (extent - (n + 1) * a) / n];
        let mut ab = self.successors(axis, w, h, &sizes, depth);
        let b = ab.pop()?;
        let a = ab.pop()?;
        Some(Operation::RepeatAba { axis, a, b })
    }

    fn sym(&mut self, axis: Axis, w: u32, h: u32, depth: u32) -> Option<Operation> {
        let extent = if axis == Axis::X { w } else { h };
        let center = extent % 2 == 1 || self.rng.random_bool(0.5);
        let half = extent / 2;
        if half == 0 {
            return None;
        }
        let mut sizes = self.parts(half);
        if center {
            let last = sizes.pop()?;
            sizes.push(2 * last + extent % 2);
        }
        Some(Operation::SymSplit {
            axis,
            successors: self.successors(axis, w, h, &sizes, depth),
            center,
        })
    }

    fn grid(&mut self, w: u32, h: u32, depth: u32) -> Operation {
        let (columns, rows) = (self.parts(w), self.parts(h));
        let cells = rows
            .iter()
            .map(|&y| {
                columns
                    .iter()
                    .map(|&x| self.region(x, y, depth - 1))
                    .collect()
            })
            .collect();
        let sizes = |parts: Vec<u32>| parts.into_iter().map(|v| Size::Absolute(f64::from(v)));
        Operation::GridSplit {
            columns: sizes(columns).collect(),
            rows: sizes(rows).collect(),
            cells,
        }
    }
}

/// Derivation by recursion, for deterministic grammars of absolute sizes.
pub(super) fn naive(grammar: &Grammar, symbol: &str, rect: Rect, out: &mut Vec<Region>) {
    let Some(rule) = grammar.rules.iter().find(|r| r.symbol == symbol) else {
        let label = symbol.into();
        out.push(Region { label, rect });
        return;
    };
    let mut line = |axis: Axis, parts: Vec<Successor>| {
        let mut at = rect.start(axis);
        for part in parts {
            let extent = part.size.value();
            naive(grammar, &part.symbol, rect.strip(axis, at, extent), out);
            at += extent;
        }
    };
    match &rule.operation {
        Operation::Split { axis, successors } => line(*axis, successors.clone()),
        Operation::Repeat { axis, successors } => {
            let period: f64 = successors.iter().map(|s| s.size.value()).sum();
            let times = (rect.extent(*axis) / period).round() as usize;
            line(*axis, vec![successors.clone(); times].concat());
        }
        Operation::RepeatAba { axis, a, b } => {
            let mut parts = vec![a.clone()];
            let mut sum = a.size.value();
            while sum + 0.5 < rect.extent(*axis) {
                parts.extend([b.clone(), a.clone()]);
                sum += a.size.value() + b.size.value();
            }
            line(*axis, parts);
        }
        Operation::SymSplit {
            axis,
            successors,
            center,
        } => {
            let mut mirror = successors.clone();
            mirror.reverse();
            if *center {
                mirror.remove(0);
            }
            line(*axis, [successors.clone(), mirror].concat());
        }
        Operation::GridSplit {
            columns,
            rows,
            cells,
        } => {
            let mut y = rect.y;
            for (row, height) in cells.iter().zip(rows) {
                let mut x = rect.x;
                for (cell, width) in row.iter().zip(columns) {
                    let part = Rect::new(x, y, width.value(), height.value());
                    naive(grammar, cell, part, out);
                    x += width.value();
                }
                y += height.value();
            }
        }
    }
}

/// The same grammar with every size relative.
pub(super) fn size_independent(grammar: &Grammar) -> Grammar {
    let mut out = grammar.clone();
    for rule in &mut out.rules {
        for size in sizes(&mut rule.operation) {
            *size = Size::Relative(size.value());
        }
    }
    out
}

/// The same grammar with a second, weighted way to derive some symbols.
pub(super) fn stochastic(grammar: &Grammar, seed: u64) -> Grammar {
    let mut out = size_independent(grammar);
    let mut rng = stream(seed, "stochastic", 0);
    for mut rule in out.rules.clone() {
        if rng.random_bool(0.5) {
            for first in out.rules.iter_mut().filter(|r| r.symbol == rule.symbol) {
                first.weight = Some(rng.random_range(0.1..10.0));
            }
            rule.weight = Some(rng.random_range(0.1..10.0));
            for size in sizes(&mut rule.operation) {
                *size = Size::Relative(size.value() * rng.random_range(0.5..2.0));
            }
            out.rules.push(rule);
        }
    }
    out
}

fn sizes(operation: &mut Operation) -> Vec<&mut Size> {
    match operation {
        Operation::Split { successors, .. }
        | Operation::Repeat { successors, .. }
        | Operation::SymSplit { successors, .. } => {
            successors.iter_mut().map(|s| &mut s.size).collect()
        }
        Operation::RepeatAba { a, b, .. } => vec![&mut a.size, &mut b.size],
        Operation::GridSplit { columns, rows, .. } => columns.iter_mut().chain(rows).collect(),
    }
}
