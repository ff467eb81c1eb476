//! Every grammar of a tiny layout, one by one.

use std::collections::BTreeSet;

use edifice_facade_grammar::Operations;
use edifice_grammar::Costs;
use edifice_shape::Axis;

use super::content::Content;

/// The least cost of a grammar of `facades`: picks any type that waits for a rule, tries all its rules.
pub fn brute_force(facades: &[Content], operations: Operations, costs: &Costs) -> f64 {
    let roots = facades.iter().filter(|facade| facade.label().is_none());
    cheapest(
        roots.cloned().collect(),
        &BTreeSet::new(),
        operations,
        costs,
    )
}

/// The least cost of rules for the types that wait and for those that these rules need, besides `done`.
fn cheapest(
    mut waiting: BTreeSet<Content>,
    done: &BTreeSet<Content>,
    operations: Operations,
    costs: &Costs,
) -> f64 {
    let Some(content) = waiting.pop_last() else {
        return 0.0;
    };
    let mut done = done.clone();
    done.insert(content.clone());
    let mut best = f64::INFINITY;
    for (cost, parts) in rules(&content, operations, costs) {
        if cost >= best {
            continue;
        }
        let mut waiting = waiting.clone();
        waiting.extend(parts.into_iter().filter(|part| !done.contains(part)));
        best = best.min(cost + cheapest(waiting, &done, operations, costs));
    }
    best
}

/// Every rule of a content: what it costs, and the non-terminals among its parts.
fn rules(
    content: &Content,
    operations: Operations,
    costs: &Costs,
) -> Vec<(f64, BTreeSet<Content>)> {
    let mut rules = Vec::new();
    for axis in Axis::BOTH {
        for lines in subsets(&content.lines(axis)) {
            let parts: Vec<Content> = lines
                .windows(2)
                .map(|w| content.strip(axis, w[0], w[1]))
                .collect();
            if parts.len() > 1
                && let Some(cost) = cheapest_way(&parts, operations, costs)
            {
                rules.push((cost, non_terminals(parts)));
            }
        }
    }
    if operations.grid_split {
        for columns in subsets(&content.lines(Axis::X)) {
            for rows in subsets(&content.lines(Axis::Y)) {
                let cells: Vec<Content> = columns
                    .windows(2)
                    .flat_map(|x| {
                        let column = content.strip(Axis::X, x[0], x[1]);
                        rows.windows(2)
                            .map(move |y| column.strip(Axis::Y, y[0], y[1]))
                    })
                    .collect();
                if cells.len() > 1 {
                    let cost = costs.grid_split + costs.successor * cells.len() as f64;
                    rules.push((cost, non_terminals(cells)));
                }
            }
        }
    }
    rules
}

/// The cheapest operation along one axis that writes out these parts.
fn cheapest_way(parts: &[Content], operations: Operations, costs: &Costs) -> Option<f64> {
    let n = parts.len();
    let successors = |count: usize| costs.successor * count as f64;
    let mut ways = vec![costs.split + successors(n)];
    if operations.repeat {
        for period in (1..n).filter(|period| n.is_multiple_of(*period)) {
            if (period..n).all(|i| parts[i] == parts[i - period]) {
                ways.push(costs.repeat + successors(period));
            }
        }
    }
    if operations.repeat_aba && n >= 3 && n % 2 == 1 && (2..n).all(|i| parts[i] == parts[i - 2]) {
        ways.push(costs.repeat_aba + successors(2));
    }
    if operations.sym_split && (0..n).all(|i| parts[i] == parts[n - 1 - i]) {
        ways.push(costs.sym_split + successors(n.div_ceil(2)));
    }
    ways.into_iter().reduce(f64::min)
}

fn non_terminals(parts: Vec<Content>) -> BTreeSet<Content> {
    let several = |part: &Content| part.label().is_none();
    parts.into_iter().filter(several).collect()
}

/// The lists of positions that begin and end as `lines` does.
fn subsets(lines: &[u32]) -> Vec<Vec<u32>> {
    let between = lines.len() - 2;
    let chosen = |bits: usize| {
        let inner = (0..between).filter(move |i| bits >> i & 1 == 1);
        let mut list = vec![lines[0]];
        list.extend(inner.map(|i| lines[i + 1]));
        list.extend(lines.last());
        list
    };
    (0..1 << between).map(chosen).collect()
}
