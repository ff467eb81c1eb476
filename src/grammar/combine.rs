//! Several deterministic grammars as one stochastic grammar (Wu et al. 2014, Sec. 5).
//!
//! The paper combines grammars by hand, in an editor, and names Bayesian model merging as the
//! automatic way for simple layouts. Here structurally similar grammars are merged by the *role* of
//! their parts, so that a ground floor of one facade may stand under the floors of another:
//!
//! 1. Every grammar, of a joint one each facade's, is made size-independent; its symbols get a prefix of their own
//!    (`G1_`, ...).
//! 2. The axioms form one group. A group of two or more symbols becomes one symbol with one rule of
//!    weight 1 from each member.
//! 3. Where members split along y (floors, cornices, attics), their non-terminal parts are aligned
//!    from bottom to top by dynamic programming, members one after another, so that the sum of
//!    similarities is largest; aligned parts form a group again (step 2).
//! 4. Splits along x are taken as they are: columns of different facades do not line up.
//!
//! The similarity of two parts is the share of their areas with equal labels (intersection of label
//! histograms), times the ratio of their heights unless both repeat along y and so fill any height;
//! parts less similar than [`LEAST_SIMILARITY`] are never aligned.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::resize::size_independent;
use super::{
    Derivation, Grammar, GrammarError, Operation, Rule, Size, Start, Successor, derivation,
};
use edifice_shape::Axis;

/// Parts less similar than this do not play the same role.
pub const LEAST_SIMILARITY: f64 = 0.3;

/// A symbol of one of the grammars.
type Member<'g> = (usize, &'g str);

/// Merges deterministic grammars of one unit into a stochastic, size-independent one, derived with
/// [`derive_at`](super::derive_at). Its size is the largest width and height of the inputs; each facade of a joint
/// grammar counts as a grammar of its own.
///
/// # Errors
/// [`GrammarError`] for an invalid or stochastic grammar, different units, or no grammar at all.
pub fn combine(grammars: &[Grammar]) -> Result<Grammar, GrammarError> {
    let first = grammars.first().ok_or(GrammarError::NoStart)?;
    if grammars.iter().any(|g| g.starts.is_empty()) {
        return Err(GrammarError::NoStart);
    }
    let each = grammars.iter().flat_map(Grammar::of_each_start);
    let grammars = &each.collect::<Vec<_>>()[..];
    let mut sources = Vec::with_capacity(grammars.len());
    for (index, grammar) in grammars.iter().enumerate() {
        if grammar.unit != first.unit {
            return Err(GrammarError::Units {
                first: first.unit.clone(),
                second: grammar.unit.clone(),
            });
        }
        let derivation = derivation(grammar, 0)?;
        sources.push(Source::new(index, grammar, &derivation));
    }
    let written = grammars
        .iter()
        .flat_map(|g| g.rules.iter().map(|r| &r.operation));
    let mut merger = Merger {
        sources: &sources,
        labels: written.flat_map(Operation::symbols).collect(),
        groups: FxHashMap::default(),
        todo: Vec::new(),
        rules: Vec::new(),
    };
    let axioms: Vec<Member> = grammars
        .iter()
        .enumerate()
        .map(|(i, g)| (i, g.starts[0].symbol.as_str()))
        .collect();
    let symbol = merger.symbol(axioms);
    while let Some(members) = merger.todo.pop() {
        merger.make_rules(&members);
    }
    let largest = |extent: fn(&Start) -> f64| {
        let extents = grammars.iter().map(|g| extent(&g.starts[0]));
        extents.fold(0.0, f64::max)
    };
    let start = Start {
        name: "combined".into(),
        symbol,
        width: largest(|s| s.width),
        height: largest(|s| s.height),
    };
    let combined = Grammar {
        unit: first.unit.clone(),
        starts: vec![start],
        rules: merger.rules,
    };
    super::check(&combined)?;
    Ok(combined)
}

/// One of the grammars, with what its symbols look like.
struct Source<'g> {
    prefix: String,
    rules: BTreeMap<&'g str, Rule>,
    looks: BTreeMap<&'g str, Look>,
}

/// The look of a non-terminal region.
struct Look {
    height: f64,
    /// Share of the area by label.
    labels: BTreeMap<String, f64>,
    /// True if something in it repeats along y.
    stretches: bool,
}

impl<'g> Source<'g> {
    fn new(index: usize, grammar: &'g Grammar, derivation: &Derivation) -> Self {
        let relaxed = size_independent(grammar).rules;
        let symbols = grammar.rules.iter().map(|r| r.symbol.as_str());
        let rules: BTreeMap<&str, Rule> = symbols.zip(relaxed).collect();
        let mut looks = BTreeMap::new();
        // Inner regions come after the regions around them: from the back, parts are known first.
        for region in derivation.non_terminals.iter().rev() {
            let rule = &grammar.rules[region.rule];
            let symbol = rule.symbol.as_str();
            if looks.contains_key(symbol) {
                continue;
            }
            let mut labels: BTreeMap<String, f64> = BTreeMap::new();
            for terminal in &derivation.facade.regions {
                let middle = |axis| terminal.rect.start(axis) + terminal.rect.extent(axis) / 2.0;
                let inside =
                    |axis| (region.rect.start(axis)..region.rect.end(axis)).contains(&middle(axis));
                if inside(Axis::X) && inside(Axis::Y) {
                    let share = terminal.rect.area() / region.rect.area();
                    *labels.entry(terminal.label.clone()).or_default() += share;
                }
            }
            let repeats = matches!(
                rule.operation,
                Operation::Repeat { axis: Axis::Y, .. }
                    | Operation::RepeatAba { axis: Axis::Y, .. }
            );
            let inner = |s: &&str| looks.get(s).is_some_and(|look: &Look| look.stretches);
            let stretches = repeats || rule.operation.symbols().iter().any(inner);
            let height = region.rect.height;
            looks.insert(
                symbol,
                Look {
                    height,
                    labels,
                    stretches,
                },
            );
        }
        Self {
            prefix: format!("G{}_", index + 1),
            rules,
            looks,
        }
    }
}

impl Look {
    /// The similarity of two parts that could play the same role, from 0 to 1.
    fn similarity(&self, other: &Self) -> f64 {
        let shared = self.labels.iter().map(|(label, share)| {
            let of_other = other.labels.get(label).copied().unwrap_or(0.0);
            share.min(of_other)
        });
        let heights = match self.stretches && other.stretches {
            true => 1.0,
            false => self.height.min(other.height) / self.height.max(other.height),
        };
        shared.sum::<f64>() * heights
    }
}

struct Merger<'s, 'g> {
    sources: &'s [Source<'g>],
    /// Every terminal label: new symbols must differ from them.
    labels: BTreeSet<&'g str>,
    /// The symbol made for each group.
    groups: FxHashMap<Vec<Member<'g>>, String>,
    /// Groups whose rules are still to be made.
    todo: Vec<Vec<Member<'g>>>,
    rules: Vec<Rule>,
}

impl<'g> Merger<'_, 'g> {
    /// The symbol of a group of parts with one role.
    fn symbol(&mut self, members: Vec<Member<'g>>) -> String {
        if let Some(symbol) = self.groups.get(&members) {
            return symbol.clone();
        }
        let (source, name) = members[0];
        let mut symbol = match members.len() {
            1 if self.rule(members[0]).is_none() => return name.to_owned(),
            1 => format!("{}{name}", self.sources[source].prefix),
            _ => format!("Role{}", self.groups.len() + 1),
        };
        while self.labels.contains(symbol.as_str()) {
            symbol.push('_');
        }
        self.groups.insert(members.clone(), symbol.clone());
        self.todo.push(members);
        symbol
    }

    /// The rules of a group: one from each member.
    fn make_rules(&mut self, members: &[Member<'g>]) {
        let symbol = self.groups[members].clone();
        let weight = (members.len() > 1).then_some(1.0);
        let roles = self.roles(members);
        for &member in members {
            let operation = match self.rule(member) {
                Some(rule) => {
                    let mut operation = rule.operation.clone();
                    for name in names(&mut operation) {
                        let Some(part) = self.part((member.0, name)) else {
                            continue;
                        };
                        let role = roles.iter().find(|role| role.contains(&part));
                        *name = self.symbol(role.cloned().unwrap_or_else(|| vec![part]));
                    }
                    operation
                }
                // A facade of one region has no rule: here it becomes a split into itself.
                None => Operation::Split {
                    axis: Axis::X,
                    successors: vec![Successor {
                        symbol: member.1.to_owned(),
                        size: Size::Relative(1.0),
                    }],
                },
            };
            self.rules.push(Rule {
                symbol: symbol.clone(),
                weight,
                operation,
            });
        }
    }

    fn rule(&self, (source, symbol): Member) -> Option<&Rule> {
        self.sources[source].rules.get(symbol)
    }

    /// The symbol of a source's own part, when it is a non-terminal.
    fn part(&self, (source, symbol): (usize, &str)) -> Option<Member<'g>> {
        let (name, _) = self.sources[source].rules.get_key_value(symbol)?;
        Some((source, name))
    }

    /// The parts of the members that split along y, grouped by role, from bottom to top.
    fn roles(&self, members: &[Member<'g>]) -> Vec<Vec<Member<'g>>> {
        let mut roles: Vec<Vec<Member<'g>>> = Vec::new();
        if members.len() < 2 {
            return roles;
        }
        for &member in members {
            let Some(rule) = self.rule(member) else {
                continue;
            };
            if axis(&rule.operation) != Some(Axis::Y) {
                continue;
            }
            let mut parts: Vec<Member<'g>> = Vec::new();
            for symbol in rule.operation.symbols() {
                if let Some(part) = self.part((member.0, symbol))
                    && !parts.contains(&part)
                {
                    parts.push(part);
                }
            }
            roles = self.align(roles, &parts);
        }
        roles
    }

    /// Joins parts to roles, order kept, so that the sum of similarities is largest.
    fn align(&self, roles: Vec<Vec<Member<'g>>>, parts: &[Member<'g>]) -> Vec<Vec<Member<'g>>> {
        let (n, m) = (roles.len(), parts.len());
        let value = |i: usize, j: usize| {
            let look = |(source, symbol): Member| self.sources[source].looks.get(symbol);
            let pairs = roles[i]
                .iter()
                .filter_map(|&r| Some((look(r)?, look(parts[j])?)));
            let best = pairs.map(|(a, b)| a.similarity(b)).fold(0.0, f64::max);
            if best < LEAST_SIMILARITY {
                f64::NEG_INFINITY
            } else {
                best
            }
        };
        // best[i][j]: largest sum over the first i roles and j parts.
        let mut best = vec![vec![0.0f64; m + 1]; n + 1];
        for i in 1..=n {
            for j in 1..=m {
                let joined = best[i - 1][j - 1] + value(i - 1, j - 1);
                best[i][j] = joined.max(best[i - 1][j]).max(best[i][j - 1]);
            }
        }
        let (mut i, mut j) = (n, m);
        let mut out = Vec::with_capacity(n + m);
        while i > 0 || j > 0 {
            if i > 0 && j > 0 && best[i][j] == best[i - 1][j - 1] + value(i - 1, j - 1) {
                (i, j) = (i - 1, j - 1);
                let mut role = roles[i].clone();
                role.push(parts[j]);
                out.push(role);
            } else if j > 0 && (i == 0 || best[i][j] == best[i][j - 1]) {
                j -= 1;
                out.push(vec![parts[j]]);
            } else {
                i -= 1;
                out.push(roles[i].clone());
            }
        }
        out.reverse();
        out
    }
}

/// Direction of the operation; none for a grid.
fn axis(operation: &Operation) -> Option<Axis> {
    match operation {
        Operation::Split { axis, .. }
        | Operation::Repeat { axis, .. }
        | Operation::RepeatAba { axis, .. }
        | Operation::SymSplit { axis, .. } => Some(*axis),
        Operation::GridSplit { .. } => None,
    }
}

/// The written symbols, to be changed.
fn names(operation: &mut Operation) -> Vec<&mut String> {
    match operation {
        Operation::Split { successors, .. }
        | Operation::Repeat { successors, .. }
        | Operation::SymSplit { successors, .. } => {
            successors.iter_mut().map(|s| &mut s.symbol).collect()
        }
        Operation::RepeatAba { a, b, .. } => vec![&mut a.symbol, &mut b.symbol],
        Operation::GridSplit { cells, .. } => cells.iter_mut().flatten().collect(),
    }
}
