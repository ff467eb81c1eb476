//! The rules of all types as one network of steps.
//!
//! A rule is a path: it starts at nothing, each step writes one successor, and the last step pays for the
//! operation and ends at the type that the rule splits. A step can be made when the node before it is reached
//! and every non-terminal that it writes has a rule. A grammar is a set of steps by which all facades are
//! reached, and costs the sum of the costs of its steps, each once.

use std::collections::BTreeSet;

use edifice_facade_grammar::Operations;
use edifice_grammar::Costs;
use edifice_shape::Axis;

use super::catalogue::{Catalogue, Symbol};
use super::content::{Content, along};

/// The operation of a rule on the successors on its path.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Way {
    Split(Axis),
    Repeat(Axis),
    RepeatAba(Axis),
    /// With the last successor once in the middle, or not.
    SymSplit(Axis, bool),
    /// Its columns are the path, or its rows.
    OneRow(Axis),
    /// Lines along x and y.
    Grid(Vec<u32>, Vec<u32>),
}

/// A step of a rule.
#[derive(Debug)]
pub(super) struct Step {
    /// The node before it; none at the start of a rule.
    pub from: Option<usize>,
    /// The types that its successors need.
    pub needs: Vec<usize>,
    /// The node after it.
    pub to: usize,
    /// Its cost.
    pub cost: f64,
    /// The lines between which its successor first stands.
    pub part: Option<(u32, u32)>,
    /// The operation, at the end of a rule.
    pub way: Option<Way>,
}

/// All rules. Nodes below the number of types are the types.
pub(super) struct Network {
    /// Steps in an order in which every step into a node comes before every step out of it.
    pub steps: Vec<Step>,
    /// The steps of each type's rules.
    pub steps_of: Vec<std::ops::Range<usize>>,
    /// Number of nodes.
    pub nodes: usize,
    /// The types that need a rule: facades of several tiles.
    pub roots: BTreeSet<usize>,
}

impl Network {
    /// All rules of the types; `None` when they have more than `most` steps.
    pub(super) fn new(
        catalogue: &Catalogue,
        operations: Operations,
        costs: &Costs,
        most: usize,
    ) -> Option<Self> {
        let mut builder = Builder {
            catalogue,
            operations,
            costs,
            steps: Vec::new(),
            nodes: catalogue.types.len(),
            target: 0,
        };
        let mut steps_of = Vec::new();
        for (index, content) in catalogue.types.iter().enumerate() {
            let first = builder.steps.len();
            builder.target = index;
            for axis in Axis::BOTH {
                builder.along(content, axis);
            }
            if operations.grid_split && !builder.grids(content, most) {
                return None;
            }
            steps_of.push(first..builder.steps.len());
            if builder.steps.len() > most {
                return None;
            }
        }
        let roots = catalogue.roots.iter().filter_map(|root| match root {
            Symbol::Type(index) => Some(*index),
            Symbol::Terminal(_) => None,
        });
        Some(Self {
            steps: builder.steps,
            steps_of,
            nodes: builder.nodes,
            roots: roots.collect(),
        })
    }
}

struct Builder<'a> {
    catalogue: &'a Catalogue,
    operations: Operations,
    costs: &'a Costs,
    steps: Vec<Step>,
    nodes: usize,
    /// The type at hand.
    target: usize,
}

impl Builder<'_> {
    /// Rules along one axis.
    fn along(&mut self, content: &Content, axis: Axis) {
        let lines = content.lines(axis);
        let n = lines.len() - 1;
        if n < 2 {
            return;
        }
        let end = lines[n];
        // What stands between two positions, if both are lines.
        let between = |from: u32, to: u32| {
            let both = lines.contains(&from) && lines.contains(&to);
            both.then(|| content.strip(axis, from, to))
        };
        // Two or more successors from end to end.
        let nodes = self.path(content, axis, &lines, |a, b| b - a < n);
        self.close(nodes[n], Way::Split(axis), self.costs.split);
        if self.operations.grid_split {
            self.close(nodes[n], Way::OneRow(axis), self.costs.grid_split);
        }
        if self.operations.repeat {
            for k in 1..n {
                let period = lines[k];
                let first = between(0, period);
                let equal = |i: u32| between(i * period, (i + 1) * period) == first;
                if end.is_multiple_of(period) && (1..end / period).all(equal) {
                    let nodes = self.path(content, axis, &lines[..=k], |_, _| true);
                    self.close(nodes[k], Way::Repeat(axis), self.costs.repeat);
                }
            }
        }
        if self.operations.repeat_aba {
            for b in 2..n {
                for a in 1..b {
                    let (a, period) = (lines[a], lines[b]);
                    let (outer, inner) = (between(0, a), between(a, period));
                    let equal = |i: u32| {
                        let at = i * period;
                        between(at, at + a) == outer && between(at + a, at + period) == inner
                    };
                    let times = (end - a) / period;
                    let last = between(times * period, end) == outer;
                    if (end - a).is_multiple_of(period) && last && (1..times).all(equal) {
                        let middle = self.node();
                        let last = self.node();
                        self.write(content, axis, None, (0, a), middle);
                        self.write(content, axis, Some(middle), (a, period), last);
                        self.close(Some(last), Way::RepeatAba(axis), self.costs.repeat_aba);
                    }
                }
            }
        }
        if self.operations.sym_split {
            self.mirrored(content, axis, &lines);
        }
    }

    /// Rules that write the half from the outside in.
    fn mirrored(&mut self, content: &Content, axis: Axis, lines: &[u32]) {
        let end = content.extent[along(axis)];
        let half: Vec<u32> = lines
            .iter()
            .copied()
            .filter(|&at| 2 * at <= end && lines.contains(&(end - at)))
            .collect();
        let mut nodes = vec![None];
        for j in 1..half.len() {
            let node = self.node();
            for i in 0..j {
                let (from, to) = (half[i], half[j]);
                let same =
                    content.strip(axis, from, to) == content.strip(axis, end - to, end - from);
                if same {
                    self.write(content, axis, nodes[i], (from, to), node);
                }
            }
            nodes.push(Some(node));
        }
        let last = self.node();
        for (&at, &node) in half.iter().zip(&nodes).skip(1) {
            if 2 * at < end {
                self.write(content, axis, node, (at, end - at), last);
            } else {
                self.close(node, Way::SymSplit(axis, false), self.costs.sym_split);
            }
        }
        self.close(Some(last), Way::SymSplit(axis, true), self.costs.sym_split);
    }

    /// Rules of two columns and two rows at least; false when there are too many.
    fn grids(&mut self, content: &Content, most: usize) -> bool {
        let inner = |axis| {
            let lines = content.lines(axis);
            lines[1..lines.len() - 1].to_vec()
        };
        let (xs, ys) = (inner(Axis::X), inner(Axis::Y));
        if xs.is_empty() || ys.is_empty() {
            return true;
        }
        if xs.len() + ys.len() > 20 || self.steps.len() + (1 << (xs.len() + ys.len())) > most {
            return false;
        }
        for columns in chosen(&xs, content.extent[0]) {
            for rows in chosen(&ys, content.extent[1]) {
                let mut needs = BTreeSet::new();
                for x in columns.windows(2) {
                    let column = content.strip(Axis::X, x[0], x[1]);
                    for y in rows.windows(2) {
                        let cell = column.strip(Axis::Y, y[0], y[1]);
                        if let Symbol::Type(index) = self.catalogue.symbol(&cell) {
                            needs.insert(index);
                        }
                    }
                }
                let cells = (columns.len() - 1) * (rows.len() - 1);
                self.steps.push(Step {
                    from: None,
                    needs: needs.into_iter().collect(),
                    to: self.target,
                    cost: self.costs.grid_split + self.costs.successor * cells as f64,
                    part: None,
                    way: Some(Way::Grid(columns.clone(), rows)),
                });
            }
        }
        true
    }

    /// Steps between all pairs of lines that are allowed; the node of each line.
    fn path(
        &mut self,
        content: &Content,
        axis: Axis,
        lines: &[u32],
        allowed: impl Fn(usize, usize) -> bool,
    ) -> Vec<Option<usize>> {
        let mut nodes = vec![None];
        for b in 1..lines.len() {
            let node = self.node();
            for a in (0..b).filter(|&a| allowed(a, b)) {
                self.write(content, axis, nodes[a], (lines[a], lines[b]), node);
            }
            nodes.push(Some(node));
        }
        nodes
    }

    fn node(&mut self) -> usize {
        self.nodes += 1;
        self.nodes - 1
    }

    /// A step that writes a successor.
    fn write(
        &mut self,
        content: &Content,
        axis: Axis,
        from: Option<usize>,
        part: (u32, u32),
        to: usize,
    ) {
        let needs = match self.catalogue.symbol(&content.strip(axis, part.0, part.1)) {
            Symbol::Type(index) => vec![index],
            Symbol::Terminal(_) => Vec::new(),
        };
        self.steps.push(Step {
            from,
            needs,
            to,
            cost: self.costs.successor,
            part: Some(part),
            way: None,
        });
    }

    /// The step that ends a rule.
    fn close(&mut self, from: Option<usize>, way: Way, cost: f64) {
        self.steps.push(Step {
            from,
            needs: Vec::new(),
            to: self.target,
            cost,
            part: None,
            way: Some(way),
        });
    }
}

/// Every non-empty choice of inner lines, with both ends.
fn chosen(inner: &[u32], end: u32) -> Vec<Vec<u32>> {
    let choice = |bits: usize| {
        let lines = (0..inner.len()).filter(move |i| bits >> i & 1 == 1);
        let inner = lines.map(|i| inner[i]);
        std::iter::once(0).chain(inner).chain([end]).collect()
    };
    (1..1 << inner.len()).map(choice).collect()
}
