//! Model 3: directed edges without hidden variables, greedily by closed-form evidence.
//!
//! Nothing is hidden, so the score is a sum over families: a group of real columns given real
//! groups and categorical columns, or a categorical column given others. The edge that gains most
//! is added while it gains. A missing real value counts as the column's mean and a row whose family
//! lacks a category is left out of that family: only for choosing edges, EM then integrates them.

use super::super::conjugate::dirichlet_evidence;
use super::super::graph::reaches;
use super::super::table::MISSING;
use super::Settings;
use super::schema::{Rows, Schema};
use super::structure::{MOST_CONFIGURATIONS, Selector, Structure, configuration};

/// An edge that may be added.
#[derive(Clone, Copy)]
enum Edge {
    /// Real group to real group.
    Group(usize, usize),
    /// Categorical column to real group.
    Code(usize, usize),
    /// Categorical column to categorical column.
    Table(usize, usize),
}

/// The data and settings by which families are scored.
struct FamilyScores<'a> {
    schema: &'a Schema,
    rows: &'a Rows,
    settings: &'a Settings,
}

/// The structure with edges added to `structure`.
pub(crate) fn propose(
    (schema, rows): (&Schema, &Rows),
    settings: &Settings,
    mut structure: Structure,
) -> Structure {
    let search = &FamilyScores {
        schema,
        rows,
        settings,
    };
    let (groups, codes) = (search.schema.groups.len(), search.schema.codes.len());
    let sizes = search.schema.sizes();
    let mut candidates = Vec::new();
    for to in 0..groups {
        candidates.extend((0..groups).filter(|&p| p != to).map(|p| Edge::Group(p, to)));
        candidates.extend((0..codes).map(|p| Edge::Code(p, to)));
    }
    for to in 0..codes {
        candidates.extend((0..codes).filter(|&p| p != to).map(|p| Edge::Table(p, to)));
    }
    let score = |edge: Edge, s: &Structure| match edge {
        Edge::Group(_, g) | Edge::Code(_, g) => group(search, s, &sizes, g),
        Edge::Table(_, c) => table(search, s, &sizes, c),
    };
    let most = search.settings.most_parents;
    let gain = |edge: Edge, s: &Structure| -> f64 {
        let with = added(edge, s);
        if allowed(edge, s, &with, &sizes, most) {
            score(edge, &with) - score(edge, s)
        } else {
            f64::NEG_INFINITY
        }
    };
    let mut gains: Vec<f64> = candidates.iter().map(|&e| gain(e, &structure)).collect();
    loop {
        let open = (0..candidates.len())
            .filter(|&i| gains[i] > 0.0 && acyclic(candidates[i], &structure))
            .max_by(|&a, &b| gains[a].total_cmp(&gains[b]));
        let Some(best) = open else {
            return structure;
        };
        structure = added(candidates[best], &structure);
        for (i, &edge) in candidates.iter().enumerate() {
            if same_child(edge, candidates[best]) {
                gains[i] = gain(edge, &structure);
            }
        }
    }
}

fn same_child(a: Edge, b: Edge) -> bool {
    let child = |e: Edge| match e {
        Edge::Group(_, g) | Edge::Code(_, g) => (false, g),
        Edge::Table(_, c) => (true, c),
    };
    child(a) == child(b)
}

fn acyclic(edge: Edge, structure: &Structure) -> bool {
    match edge {
        Edge::Group(from, to) => !structure.reaches(to, from),
        Edge::Code(..) => true,
        Edge::Table(from, to) => !reaches(&structure.code_parents, to, from),
    }
}

fn added(edge: Edge, structure: &Structure) -> Structure {
    let mut structure = structure.clone();
    let add = |list: &mut Vec<usize>, p: usize| {
        list.push(p);
        list.sort_unstable();
    };
    match edge {
        Edge::Group(from, to) => add(&mut structure.parents[to], from),
        Edge::Table(from, to) => add(&mut structure.code_parents[to], from),
        Edge::Code(from, to) => {
            if let Selector::Codes(list) = &mut structure.selectors[to] {
                add(list, from);
            }
        }
    }
    structure
}

/// True if the edge is new and within the limits.
fn allowed(
    edge: Edge,
    before: &Structure,
    after: &Structure,
    sizes: &[usize],
    most: usize,
) -> bool {
    let configurations = |list: &[usize]| list.iter().map(|&c| sizes[c]).product::<usize>();
    match edge {
        Edge::Group(from, to) => {
            !before.parents[to].contains(&from) && after.parents[to].len() <= most
        }
        Edge::Table(from, to) => {
            let list = &after.code_parents[to];
            !before.code_parents[to].contains(&from)
                && list.len() <= most
                && configurations(list) <= MOST_CONFIGURATIONS
        }
        Edge::Code(from, to) => match (&before.selectors[to], &after.selectors[to]) {
            (Selector::Codes(old), Selector::Codes(new)) => {
                !old.contains(&from)
                    && new.len() <= most
                    && configurations(new) <= MOST_CONFIGURATIONS
            }
            _ => false,
        },
    }
}

/// Evidence of a real group given its parents.
fn group(search: &FamilyScores, structure: &Structure, sizes: &[usize], g: usize) -> f64 {
    let Selector::Codes(selector) = &structure.selectors[g] else {
        return f64::NEG_INFINITY;
    };
    let mut columns: Vec<usize> = Vec::new();
    for &p in &structure.parents[g] {
        columns.extend(search.schema.columns(p));
    }
    let p = columns.len() + 1;
    columns.extend(search.schema.columns(g));
    let q = columns.len() + 1;
    let mut scatter = vec![vec![0.0; q * q]; structure.states(g, sizes)];
    let mut u = vec![1.0; q];
    for i in 0..search.rows.rows {
        let (real, codes) = (search.rows.real(i), search.rows.code(i));
        if selector.iter().any(|&c| codes[c] == MISSING) {
            continue;
        }
        for (u, &c) in u[1..].iter_mut().zip(&columns) {
            *u = if real[c].is_nan() { 0.0 } else { real[c] };
        }
        let m = &mut scatter[configuration(selector, sizes, codes)];
        for a in 0..q {
            for b in 0..=a {
                m[a * q + b] += u[a] * u[b];
            }
        }
    }
    let prior = &search.settings.priors.linear;
    scatter
        .iter()
        .map(|m| prior.evidence(m, p, q - p).unwrap_or(f64::NEG_INFINITY))
        .sum()
}

/// Evidence of a categorical column given its parents.
fn table(search: &FamilyScores, structure: &Structure, sizes: &[usize], c: usize) -> f64 {
    let parents = &structure.code_parents[c];
    let rows: usize = parents.iter().map(|&p| sizes[p]).product();
    let mut counts = vec![0.0; rows * sizes[c]];
    for i in 0..search.rows.rows {
        let codes = search.rows.code(i);
        if codes[c] != MISSING && parents.iter().all(|&p| codes[p] != MISSING) {
            counts[configuration(parents, sizes, codes) * sizes[c] + codes[c] as usize] += 1.0;
        }
    }
    let alpha = search.settings.priors.dirichlet;
    counts
        .chunks(sizes[c])
        .map(|n| dirichlet_evidence(n, alpha))
        .sum()
}
