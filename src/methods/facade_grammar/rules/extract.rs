//! From rules over region types to a split grammar.

use rustc_hash::FxHashMap;

use super::candidate::{Arrangement, RuleCandidate};
use crate::regions::{TypeId, Types};
use crate::rules::AddRule;
use edifice_grammar::{Grammar, Operation, Rule, Size, Start, Successor};
use edifice_shape::{Axis, Facade};

/// Writes the rules that the facades need as a grammar, top down, with symbols that no label uses.
pub(crate) fn grammar(types: &mut Types, facades: &[Facade], rules: &[AddRule]) -> Grammar {
    let by_type: FxHashMap<TypeId, &RuleCandidate> =
        rules.iter().map(|r| (r.id, &*r.candidate)).collect();
    let mut names = Names::new(types, facades.len());
    let mut starts = Vec::new();
    for (facade, root) in facades.iter().zip(types.roots.clone()) {
        let symbol = names.of(types, root);
        starts.push(Start {
            name: facade.name.clone(),
            symbol,
            width: facade.width,
            height: facade.height,
        });
    }
    let mut written = Vec::new();
    let mut next = 0;
    while let Some(&id) = names.order.get(next) {
        next += 1;
        if let Some(candidate) = by_type.get(&id) {
            let symbol = names.of(types, id);
            let operation = operation(types, id, candidate, &mut names);
            written.push(Rule {
                symbol,
                weight: None,
                operation,
            });
        }
    }
    Grammar {
        unit: facades.first().map_or_else(String::new, |f| f.unit.clone()),
        starts,
        rules: written,
    }
}

fn operation(
    types: &mut Types,
    id: TypeId,
    candidate: &RuleCandidate,
    names: &mut Names,
) -> Operation {
    let mut strips = |axis| -> Vec<Successor> {
        let sizes = sizes(types, id, axis, &candidate.lines);
        let successors = candidate.successors.iter().zip(sizes);
        successors
            .map(|(&s, size)| Successor::new(names.of(types, s), size))
            .collect()
    };
    match candidate.arrangement {
        Arrangement::Split(axis) => Operation::Split {
            axis,
            successors: strips(axis),
        },
        Arrangement::Repeat(axis) => Operation::Repeat {
            axis,
            successors: strips(axis),
        },
        Arrangement::Symmetric(axis, center) => Operation::SymSplit {
            axis,
            successors: strips(axis),
            center,
        },
        Arrangement::RepeatAba(axis) => {
            let mut successors = strips(axis);
            let b = successors.remove(1);
            let a = successors.remove(0);
            Operation::RepeatAba { axis, a, b }
        }
        Arrangement::Grid => {
            let absolute = |sizes: Vec<f64>| sizes.into_iter().map(Size::Absolute).collect();
            let cells = candidate
                .successors
                .chunks(candidate.lines.len() - 1)
                .map(|row| row.iter().map(|&s| names.of(types, s)).collect())
                .collect();
            Operation::GridSplit {
                columns: absolute(sizes(types, id, Axis::X, &candidate.lines)),
                rows: absolute(sizes(types, id, Axis::Y, &candidate.rows)),
                cells,
            }
        }
    }
}

/// Sizes between the lines of a rule.
fn sizes(types: &mut Types, id: TypeId, axis: Axis, lines: &[u16]) -> Vec<f64> {
    let strips = types.strips(id, axis);
    let layout = &types.layouts[usize::from(types.region(id).layout)];
    let coordinates = match axis {
        Axis::X => &layout.xs,
        Axis::Y => &layout.ys,
    };
    let at = |line: u16| coordinates[usize::from(strips.cuts[usize::from(line)])];
    lines.windows(2).map(|w| at(w[1]) - at(w[0])).collect()
}

/// Symbols of types: the label of a terminal, `Facade` for a root, `NT1`, `NT2`, ... for the rest.
struct Names {
    prefix: String,
    axiom: String,
    by_type: FxHashMap<TypeId, String>,
    /// Types that have a symbol of their own, in the order in which they were named.
    order: Vec<TypeId>,
    several: bool,
}

impl Names {
    fn new(types: &Types, facades: usize) -> Self {
        let free = |name: &str| !types.labels.iter().any(|l| l.starts_with(name));
        let pick = |wanted: &str| {
            let mut name = wanted.to_owned();
            while !free(&name) {
                name.push('_');
            }
            name
        };
        Self {
            prefix: pick("NT"),
            axiom: pick("Facade"),
            by_type: FxHashMap::default(),
            order: Vec::new(),
            several: facades > 1,
        }
    }

    fn of(&mut self, types: &Types, id: TypeId) -> String {
        if types.is_terminal(id) {
            return types.labels[id as usize].clone();
        }
        if let Some(name) = self.by_type.get(&id) {
            return name.clone();
        }
        let root = types.roots.contains(&id);
        let count = self.by_type.len();
        let name = match (root, self.several) {
            (true, false) => self.axiom.clone(),
            (true, true) => format!("{}{}", self.axiom, count + 1),
            (false, false) => format!("{}{count}", self.prefix),
            (false, true) => format!("{}{}", self.prefix, count + 1),
        };
        self.by_type.insert(id, name.clone());
        self.order.push(id);
        name
    }
}
