//! Derivation: from a grammar to the facade it describes (Wu et al. 2014, Sec. 3.1).

use std::collections::BTreeMap;

use super::check::check_structure;
use super::limits::{REGION_LIMIT, TOLERANCE};
pub(super) use super::place::Fit;
use super::place::place;
use super::table::Table;
use super::{Grammar, GrammarError};
use edifice_shape::{Facade, Rect, Region};

/// A region split by a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct NonTerminal {
    /// Index of the rule that split it; its symbol is that rule's left-hand side.
    pub rule: usize,
    /// Its place, in the facade's coordinates.
    pub rect: Rect,
    /// Number of regions around it: 0 for the whole facade.
    pub depth: usize,
}

/// A derived facade with the regions that its rules split (the splitting tree of Wu et al. 2014,
/// Fig. 6).
#[derive(Debug, Clone, PartialEq)]
pub struct Derivation {
    /// The terminal regions, depth first: left to right, bottom to top within each rule.
    pub facade: Facade,
    /// The non-terminal regions, depth first, each before what is inside it.
    pub non_terminals: Vec<NonTerminal>,
    /// The origin of each terminal region: the rule that writes it, and the place in the rule's right-hand side; `None`
    /// for a facade that is one terminal.
    pub origins: Vec<Option<(usize, usize)>>,
    /// Rules whose absolute sizes left too little for the relative ones and shrank, by their index: the
    /// least factor. Empty when all absolute sizes are as written.
    pub shrunk: BTreeMap<usize, f64>,
}

/// Derives one start of a deterministic grammar at its own size.
///
/// # Errors
/// [`GrammarError`] for an invalid grammar, sizes that do not fit, or a stochastic grammar.
///
/// # Complexity
/// Linear in the regions made; depth is limited by memory only.
///
/// # Examples
/// ```
/// use edifice_grammar::{Grammar, Operation, Rule, Start, Successor, derive};
/// use edifice_shape::Axis;
/// let grammar = Grammar {
///     unit: "m".into(),
///     starts: vec![Start { name: "row".into(), symbol: "Row".into(), width: 12.0, height: 3.0 }],
///     rules: vec![Rule {
///         symbol: "Row".into(),
///         weight: None,
///         operation: Operation::Repeat {
///             axis: Axis::X,
///             successors: vec![Successor::new("wall", 1.0), Successor::new("window", 2.0)],
///         },
///     }],
/// };
/// let facade = derive(&grammar, 0)?;
/// assert_eq!(facade.regions.len(), 8);
/// assert_eq!(facade.regions[7].rect.right(), 12.0);
/// # Ok::<(), edifice_grammar::GrammarError>(())
/// ```
pub fn derive(grammar: &Grammar, start_index: usize) -> Result<Facade, GrammarError> {
    derivation(grammar, start_index).map(|d| d.facade)
}

/// As [`derive()`], with the non-terminal regions.
///
/// # Errors
/// As [`derive()`].
pub fn derivation(grammar: &Grammar, start_index: usize) -> Result<Derivation, GrammarError> {
    let table = check_structure(grammar)?;
    let start = grammar
        .starts
        .get(start_index)
        .ok_or(GrammarError::StartIndex {
            index: start_index,
            count: grammar.starts.len(),
        })?;
    if let Some(rules) = table.rules_of.iter().find(|rules| rules.len() > 1) {
        return Err(GrammarError::Stochastic {
            symbol: grammar.rules[rules[0]].symbol.clone(),
            count: rules.len(),
        });
    }
    walk(
        grammar,
        &table,
        start_index,
        (start.width, start.height),
        Fit::AsWritten,
        |_, rules| rules[0],
    )
}

/// Derives in a region of the given size, `choose` picking among the rules of a symbol.
pub(super) fn walk(
    grammar: &Grammar,
    table: &Table<'_>,
    start_index: usize,
    (width, height): (f64, f64),
    fit: Fit,
    mut choose: impl FnMut(usize, &[usize]) -> usize,
) -> Result<Derivation, GrammarError> {
    let tolerance = TOLERANCE * width.max(height);
    let mut regions = Vec::new();
    let mut origins = Vec::new();
    let mut non_terminals = Vec::new();
    let mut parts = Vec::new();
    let mut shrunk = BTreeMap::new();
    let domain = Rect::new(0.0, 0.0, width, height);
    let mut stack = vec![(table.starts[start_index], domain, 0, None)];
    while let Some((symbol, rect, depth, origin)) = stack.pop() {
        let rules = &table.rules_of[symbol];
        if rules.is_empty() {
            let label = table.names[symbol].to_owned();
            regions.push(Region { label, rect });
            origins.push(origin);
            continue;
        }
        let rule = choose(symbol, rules);
        non_terminals.push(NonTerminal { rule, rect, depth });
        parts.clear();
        let written = &grammar.rules[rule];
        let factor = place(rule, written, rect, tolerance, fit, |i, part| {
            parts.push((i, part));
        })?;
        if factor < 1.0 {
            let least = shrunk.entry(rule).or_insert(factor);
            *least = factor.min(*least);
        }
        let made = regions.len() + non_terminals.len() + stack.len() + parts.len();
        if made > REGION_LIMIT {
            return Err(GrammarError::TooManyRegions {
                limit: REGION_LIMIT,
            });
        }
        let successors = &table.right[rule];
        stack.extend(
            parts
                .iter()
                .rev()
                .map(|&(i, part)| (successors[i], part, depth + 1, Some((rule, i)))),
        );
    }
    let start = &grammar.starts[start_index];
    Ok(Derivation {
        facade: Facade {
            name: start.name.clone(),
            unit: grammar.unit.clone(),
            width,
            height,
            regions,
        },
        non_terminals,
        origins,
        shrunk,
    })
}
