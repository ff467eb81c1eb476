//! Lateral edges: greedy and acyclic, from the expected statistics of the current fit.
//!
//! With the hidden variables' posteriors held (O* of Eq. 2), the score of a structure is a sum
//! over families, and an edge changes the term of its child only: the closed-form evidence of the
//! child's regression, summed over its states, or of a categorical child's table, summed over styles. All candidate
//! regressions are therefore read off one scatter matrix over all real columns (and indicators of categories) per state.
//! Edges are added, taken out and turned round (Koller and
//! Friedman 2009, Sec. 18.4.3). The structure so proposed is fitted by EM and kept only if its
//! Cheeseman-Stutz score is higher.

use rustc_hash::FxHashMap;

use super::super::conjugate::dirichlet_evidence;
use super::super::graph::reaches;
use super::Settings;
use super::fit::{Problem, Scored};
use super::infer::MOST_ASSIGNMENTS;
use super::structure::{MOST_CONFIGURATIONS, Structure};
use super::wide::Wide;

/// The structure with lateral edges of highest evidence that greedy moves reach: from no edges and
/// from those of `scored`, an edge is added, taken out or turned round, whatever gains most, until
/// nothing gains or `goes_on` says no. All else is as in `scored`. Edges from categories are searched where `wide` has them.
pub(crate) fn propose(
    problem: &Problem,
    scored: &Scored,
    wide: &Wide,
    settings: &Settings,
    goes_on: &dyn Fn() -> bool,
) -> Structure {
    let max_parents = settings.most_parents;
    let mut families = Families {
        problem,
        wide,
        goes_on,
        parents: parents(problem, settings.category_edges),
        evidence: FxHashMap::default(),
    };
    let given = &scored.shape.structure;
    let mut nothing = given.clone();
    nothing.parents.iter_mut().for_each(Vec::clear);
    if wide.categories {
        nothing.shifts.iter_mut().for_each(Vec::clear);
        nothing.code_parents.iter_mut().for_each(Vec::clear);
    }
    let (fresh, evidence) = families.climb(nothing, max_parents);
    let (kept, evidence_kept) = families.climb(given.clone(), max_parents);
    if evidence_kept >= evidence - LEAST_GAIN {
        kept
    } else {
        fresh
    }
}

/// Moves after which a climb asks again if it shall go on.
const ASKED: usize = 256;

/// Gains below this are rounding.
const LEAST_GAIN: f64 = 1e-6;

/// A lateral edge, from parent to child.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edge {
    /// Real group to real group.
    Real(usize, usize),
    /// Categorical column to real group.
    Shift(usize, usize),
    /// Categorical column to categorical column.
    Table(usize, usize),
}

/// A change of one lateral edge.
#[derive(Clone, Copy, Debug)]
enum Move {
    Add(Edge),
    Remove(Edge),
    Reverse(Edge),
}

/// A child with its parents.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Family {
    /// Real group, its real parents, the columns that shift it.
    Real(usize, Vec<usize>, Vec<usize>),
    /// Categorical column and its parents.
    Table(usize, Vec<usize>),
}

impl Edge {
    fn parent(self) -> usize {
        match self {
            Self::Real(p, _) | Self::Shift(p, _) | Self::Table(p, _) => p,
        }
    }

    fn turned(self) -> Self {
        match self {
            Self::Real(p, g) => Self::Real(g, p),
            Self::Table(p, c) => Self::Table(c, p),
            Self::Shift(..) => self,
        }
    }

    /// The list of parents that it is in, or would be.
    fn list(self, structure: &Structure) -> &Vec<usize> {
        match self {
            Self::Real(_, g) => &structure.parents[g],
            Self::Shift(_, g) => &structure.shifts[g],
            Self::Table(_, c) => &structure.code_parents[c],
        }
    }

    fn list_mut(self, structure: &mut Structure) -> &mut Vec<usize> {
        match self {
            Self::Real(_, g) => &mut structure.parents[g],
            Self::Shift(_, g) => &mut structure.shifts[g],
            Self::Table(_, c) => &mut structure.code_parents[c],
        }
    }

    /// The family of its child as it is.
    fn family(self, structure: &Structure) -> Family {
        match self {
            Self::Real(_, g) | Self::Shift(_, g) => Family::of_group(structure, g),
            Self::Table(_, c) => Family::Table(c, structure.code_parents[c].clone()),
        }
    }

    /// The family of its child if the parents in its list were `list`.
    fn family_with(self, structure: &Structure, list: Vec<usize>) -> Family {
        match self {
            Self::Real(_, g) => Family::Real(g, list, structure.shifts[g].clone()),
            Self::Shift(_, g) => Family::Real(g, structure.parents[g].clone(), list),
            Self::Table(_, c) => Family::Table(c, list),
        }
    }
}

impl Family {
    fn of_group(structure: &Structure, g: usize) -> Self {
        Self::Real(g, structure.parents[g].clone(), structure.shifts[g].clone())
    }
}

/// Evidence of families; kept once known.
struct Families<'a> {
    problem: &'a Problem<'a>,
    wide: &'a Wide,
    goes_on: &'a dyn Fn() -> bool,
    /// Real groups that may be parents.
    parents: Vec<bool>,
    evidence: FxHashMap<Family, f64>,
}

/// Share of the rows that may lack a value of a real group that is a parent, where categories are parents as well: values
/// that are missing by the thousand (at atoms) would each be integrated out of all their children.
const MOST_MISSING: f64 = 0.05;

/// Real groups that may be parents: as published, all.
fn parents(problem: &Problem, categories: bool) -> Vec<bool> {
    let rows = problem.rows;
    let most = match categories {
        true => (MOST_MISSING * rows.rows as f64) as usize,
        false => rows.rows,
    };
    let incomplete = |g: usize, i: &usize| {
        let own = &rows.real(*i)[problem.schema.columns(g)];
        own.iter().any(|v| v.is_nan())
    };
    let groups = 0..problem.schema.groups.len();
    let lacking = groups.map(|g| (0..rows.rows).filter(|i| incomplete(g, i)).count());
    lacking.map(|count| count <= most).collect()
}

impl Families<'_> {
    /// Greedy moves until none gains; the structure and the evidence of all its families.
    fn climb(&mut self, mut structure: Structure, max_parents: usize) -> (Structure, f64) {
        loop {
            let mut best: Option<(f64, Move)> = None;
            for (at, m) in self.moves(&structure, max_parents).into_iter().enumerate() {
                if at % ASKED == 0 && !(self.goes_on)() {
                    best = None;
                    break;
                }
                let gain = self.gain(&structure, m);
                if best.is_none_or(|(most, _)| gain.total_cmp(&most).is_ge()) {
                    best = Some((gain, m));
                }
            }
            match best {
                Some((gain, best)) if gain > LEAST_GAIN => apply(&mut structure, best),
                _ => break,
            }
        }
        let groups = (0..structure.parents.len()).map(|g| Family::of_group(&structure, g));
        let tables = structure.code_parents.iter().enumerate();
        let tables = tables.map(|(c, list)| Family::Table(c, list.clone()));
        let all: Vec<Family> = match self.wide.categories {
            true => groups.chain(tables).collect(),
            false => groups.collect(),
        };
        if !(self.goes_on)() {
            return (structure, f64::NEG_INFINITY);
        }
        let total = all.into_iter().map(|f| self.of(f)).sum();
        (structure, total)
    }

    fn gain(&mut self, structure: &Structure, change: Move) -> f64 {
        match change {
            Move::Add(edge) => self.change(structure, edge, with(edge.list(structure), edge)),
            Move::Remove(edge) => self.change(structure, edge, without(edge.list(structure), edge)),
            Move::Reverse(edge) => {
                let turned = edge.turned();
                self.change(structure, edge, without(edge.list(structure), edge))
                    + self.change(structure, turned, with(turned.list(structure), turned))
            }
        }
    }

    /// The gain in log evidence, in nats, if the list of `edge` becomes `list`.
    fn change(&mut self, structure: &Structure, edge: Edge, list: Vec<usize>) -> f64 {
        self.of(edge.family_with(structure, list)) - self.of(edge.family(structure))
    }

    fn of(&mut self, family: Family) -> f64 {
        if let Some(&known) = self.evidence.get(&family) {
            return known;
        }
        let evidence = match &family {
            Family::Real(g, parents, shifts) => self.regression(*g, parents, shifts),
            Family::Table(c, parents) => self.table(*c, parents),
        };
        self.evidence.insert(family, evidence);
        evidence
    }

    fn regression(&self, g: usize, parents: &[usize], shifts: &[usize]) -> f64 {
        let schema = self.problem.schema;
        let indicators = &self.problem.shape.indicators;
        let q = self.wide.side;
        let mut index = vec![0];
        for &p in parents {
            index.extend(schema.columns(p).map(|c| c + 1));
        }
        for &c in shifts {
            index.extend((indicators[c]..indicators[c + 1]).map(|c| c + 1));
        }
        let p = index.len();
        index.extend(schema.columns(g).map(|c| c + 1));
        let n = index.len();
        let mut sub = vec![0.0; n * n];
        let prior = &self.problem.priors.linear;
        let states = self.wide.scatter[g].iter().map(|m| {
            for (a, &i) in index.iter().enumerate() {
                for (b, &j) in index[..=a].iter().enumerate() {
                    sub[a * n + b] = m[i.max(j) * q + i.min(j)];
                }
            }
            prior.evidence(&sub, p, n - p).unwrap_or(f64::NEG_INFINITY)
        });
        states.sum()
    }

    fn table(&self, c: usize, parents: &[usize]) -> f64 {
        let styles = self.wide.styles;
        let size = self.problem.shape.sizes[c];
        let counts = self.wide.counts(self.problem, c, parents);
        let alpha = self.problem.priors.dirichlet;
        let mut total = 0.0;
        for block in counts.chunks(size * styles) {
            for s in 0..styles {
                let column: Vec<f64> = (0..size).map(|v| block[v * styles + s]).collect();
                total += dirichlet_evidence(&column, alpha);
            }
        }
        total
    }

    /// All changes of one edge that leave the graph acyclic and within the limits.
    fn moves(&self, structure: &Structure, max_parents: usize) -> Vec<Move> {
        let groups = structure.parents.len();
        let full = |edge: Edge| edge.list(structure).len() >= max_parents;
        let mut all = Vec::new();
        for g in 0..groups {
            for p in (0..groups).filter(|&p| p != g && self.parents[p]) {
                let edge = Edge::Real(p, g);
                if structure.parents[g].contains(&p) {
                    all.push(Move::Remove(edge));
                    let mut rest = structure.parents.clone();
                    rest[g].retain(|&other| other != p);
                    if self.parents[g] && !full(edge.turned()) && !reaches(&rest, p, g) {
                        all.push(Move::Reverse(edge));
                    }
                } else if !full(edge) && !structure.reaches(g, p) {
                    all.push(Move::Add(edge));
                }
            }
        }
        if self.wide.categories {
            self.category_moves(structure, max_parents, &mut all);
        }
        all
    }

    /// Edges from categories. The configurations of all categorical parents stay few enough to be enumerated in a row
    /// that lacks them all.
    fn category_moves(&self, structure: &Structure, max_parents: usize, all: &mut Vec<Move>) {
        let sizes = &self.problem.shape.sizes;
        let product = |list: &[usize]| list.iter().map(|&c| sizes[c]).product::<usize>();
        let regressors = structure.regressors();
        let configurations = product(&regressors);
        let room =
            |c: usize| regressors.contains(&c) || configurations * sizes[c] <= MOST_ASSIGNMENTS;
        for c in (0..sizes.len()).filter(|&c| sizes[c] <= MOST_CONFIGURATIONS) {
            for g in 0..structure.parents.len() {
                if structure.shifts[g].contains(&c) {
                    all.push(Move::Remove(Edge::Shift(c, g)));
                } else if structure.shifts[g].len() < max_parents && room(c) {
                    all.push(Move::Add(Edge::Shift(c, g)));
                }
            }
            for to in (0..sizes.len()).filter(|&to| to != c) {
                let edge = Edge::Table(c, to);
                let fits = |list: &[usize], more: usize| {
                    list.len() < max_parents && product(list) * sizes[more] <= MOST_CONFIGURATIONS
                };
                if structure.code_parents[to].contains(&c) {
                    all.push(Move::Remove(edge));
                    let mut rest = structure.code_parents.clone();
                    rest[to].retain(|&other| other != c);
                    if fits(&rest[c], to) && room(to) && !reaches(&rest, c, to) {
                        all.push(Move::Reverse(edge));
                    }
                } else if fits(&structure.code_parents[to], c)
                    && room(c)
                    && !reaches(&structure.code_parents, to, c)
                {
                    all.push(Move::Add(edge));
                }
            }
        }
    }
}

fn apply(structure: &mut Structure, change: Move) {
    match change {
        Move::Add(edge) => *edge.list_mut(structure) = with(edge.list(structure), edge),
        Move::Remove(edge) => *edge.list_mut(structure) = without(edge.list(structure), edge),
        Move::Reverse(edge) => {
            *edge.list_mut(structure) = without(edge.list(structure), edge);
            let turned = edge.turned();
            *turned.list_mut(structure) = with(turned.list(structure), turned);
        }
    }
}

fn with(parents: &[usize], edge: Edge) -> Vec<usize> {
    let mut list = parents.to_vec();
    list.push(edge.parent());
    list.sort_unstable();
    list
}

fn without(parents: &[usize], edge: Edge) -> Vec<usize> {
    let others = parents.iter().copied();
    others.filter(|&other| other != edge.parent()).collect()
}
