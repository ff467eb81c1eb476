//! The grammar of a set of types, to be derived back by the evaluator.

use edifice_grammar::{Grammar, Operation, Rule, Size, Start, Successor};
use edifice_shape::Axis;

use super::catalogue::{Catalogue, Symbol};
use super::content::Content;
use super::network::{Network, Step, Way};

/// The cheapest grammar whose non-terminals are `members`, of which those that no facade needs are left out.
pub(super) fn grammar(
    catalogue: &Catalogue,
    network: &Network,
    members: &[bool],
    facades: &[Content],
) -> Grammar {
    let starts = facades.iter().zip(&catalogue.roots).enumerate();
    let starts = starts.map(|(i, (facade, &root))| Start {
        name: format!("facade {i}"),
        symbol: name(root),
        width: f64::from(facade.extent[0]),
        height: f64::from(facade.extent[1]),
    });
    let mut needed = vec![false; catalogue.types.len()];
    for &root in &network.roots {
        needed[root] = true;
    }
    let mut rules = Vec::new();
    for t in (0..needed.len())
        .rev()
        .filter(|&t| members.get(t) == Some(&true))
    {
        if needed[t] {
            let path = cheapest(network, t, members);
            for &need in path.iter().flat_map(|step| &step.needs) {
                needed[need] = true;
            }
            rules.push(Rule {
                symbol: name(Symbol::Type(t)),
                weight: None,
                operation: operation(catalogue, &catalogue.types[t], &path),
            });
        }
    }
    Grammar {
        unit: "cell".into(),
        starts: starts.collect(),
        rules,
    }
}

fn name(symbol: Symbol) -> String {
    match symbol {
        Symbol::Terminal(label) => char::from(label).to_string(),
        Symbol::Type(index) => format!("T{index}"),
    }
}

/// The steps of the cheapest rule of a type.
fn cheapest<'n>(network: &'n Network, t: usize, members: &[bool]) -> Vec<&'n Step> {
    let mut value = vec![f64::INFINITY; network.nodes];
    let mut last: Vec<Option<&Step>> = vec![None; network.nodes];
    for step in &network.steps[network.steps_of[t].clone()] {
        let sum = step.from.map_or(0.0, |node| value[node]) + step.cost;
        if step.needs.iter().all(|&t| members[t]) && sum < value[step.to] {
            (value[step.to], last[step.to]) = (sum, Some(step));
        }
    }
    let mut path = Vec::new();
    let mut node = Some(t);
    while let Some(step) = node.and_then(|node| last[node]) {
        path.push(step);
        node = step.from;
    }
    path.reverse();
    path
}

fn operation(catalogue: &Catalogue, content: &Content, path: &[&Step]) -> Operation {
    let written = |axis: Axis| -> Vec<Successor> {
        let parts = path.iter().filter_map(|step| step.part);
        let successor = |(from, to): (u32, u32)| {
            let symbol = catalogue.symbol(&content.strip(axis, from, to));
            Successor::new(name(symbol), f64::from(to - from))
        };
        parts.map(successor).collect()
    };
    let grid = |columns: &[u32], rows: &[u32]| {
        let cells = rows.windows(2).map(|y| {
            let row = content.strip(Axis::Y, y[0], y[1]);
            let cell = |x: &[u32]| name(catalogue.symbol(&row.strip(Axis::X, x[0], x[1])));
            columns.windows(2).map(cell).collect()
        });
        Operation::GridSplit {
            columns: sizes(columns),
            rows: sizes(rows),
            cells: cells.collect(),
        }
    };
    let way = path.last().and_then(|step| step.way.clone());
    match way.expect("a rule ends with its operation") {
        Way::Split(axis) => Operation::Split {
            axis,
            successors: written(axis),
        },
        Way::Repeat(axis) => Operation::Repeat {
            axis,
            successors: written(axis),
        },
        Way::RepeatAba(axis) => {
            let [a, b] = <[Successor; 2]>::try_from(written(axis)).expect("two successors");
            Operation::RepeatAba { axis, a, b }
        }
        Way::SymSplit(axis, center) => Operation::SymSplit {
            axis,
            successors: written(axis),
            center,
        },
        Way::OneRow(axis) => {
            let parts = path.iter().filter_map(|step| step.part);
            let lines: Vec<u32> = std::iter::once(0).chain(parts.map(|p| p.1)).collect();
            match axis {
                Axis::X => grid(&lines, &[0, content.extent[1]]),
                Axis::Y => grid(&[0, content.extent[0]], &lines),
            }
        }
        Way::Grid(columns, rows) => grid(&columns, &rows),
    }
}

fn sizes(lines: &[u32]) -> Vec<Size> {
    let widths = lines.windows(2).map(|w| f64::from(w[1] - w[0]));
    widths.map(Size::Absolute).collect()
}
