//! The graph of a hierarchical model.

use super::super::error::ModelError;
use super::super::graph::{order, reaches};

/// Most configurations of the categorical parents of one family.
pub(crate) const MOST_CONFIGURATIONS: usize = 16;

/// The variable that selects one of the linear Gaussians of a group of real columns.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) enum Selector {
    /// The group's own second-level hidden variable, with its number of values.
    Hidden(usize),
    /// The style S itself.
    Style,
    /// The values of these categorical columns.
    Codes(Vec<usize>),
}

/// Graph of a model over the real groups and the categorical columns of a schema.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Structure {
    /// Cardinality of S.
    pub styles: usize,
    /// Per real group.
    pub selectors: Vec<Selector>,
    /// Lateral edges: per real group, its parents among the real groups, ascending.
    pub parents: Vec<Vec<usize>>,
    /// Per categorical column, its parents among the categorical columns, ascending.
    pub code_parents: Vec<Vec<usize>>,
    /// Per real group, the categorical columns whose categories shift its means, ascending.
    #[serde(default, skip_serializing_if = "none")]
    pub shifts: Vec<Vec<usize>>,
    /// Share of the background in every real group ([`super::background`]), in [0, 1).
    #[serde(default, skip_serializing_if = "absent")]
    pub background: f64,
}

/// True if there is no background: files of models without one do not name it.
fn absent(share: &f64) -> bool {
    *share == 0.0
}

/// True if no list has an entry: files of models without such edges do not name them.
fn none(lists: &[Vec<usize>]) -> bool {
    lists.iter().all(Vec::is_empty)
}

impl Structure {
    /// Cardinalities of S and of every hidden variable as given, no lateral edges.
    pub(crate) fn new(styles: usize, selector: &Selector, groups: usize, codes: usize) -> Self {
        Self {
            styles,
            selectors: vec![selector.clone(); groups],
            parents: vec![Vec::new(); groups],
            code_parents: vec![Vec::new(); codes],
            shifts: vec![Vec::new(); groups],
            background: 0.0,
        }
    }

    /// Categorical columns that are parents of something, ascending.
    pub(crate) fn regressors(&self) -> Vec<usize> {
        let lists = self.code_parents.iter().chain(&self.shifts);
        let mut all: Vec<usize> = lists.flatten().copied().collect();
        for selector in &self.selectors {
            if let Selector::Codes(list) = selector {
                all.extend(list);
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Number of lateral edges between groups and columns.
    pub(crate) fn edges(&self) -> usize {
        let lists = self.parents.iter().chain(&self.code_parents);
        lists.chain(&self.shifts).map(Vec::len).sum()
    }

    /// Number of linear Gaussians of group `g`; `sizes` are the numbers of categories.
    pub(crate) fn states(&self, g: usize, sizes: &[usize]) -> usize {
        match &self.selectors[g] {
            Selector::Hidden(k) => *k,
            Selector::Style => self.styles,
            Selector::Codes(columns) => columns.iter().map(|&c| sizes[c]).product(),
        }
    }

    /// Groups with every parent before its children; the name of a group on a cycle otherwise.
    pub(crate) fn order(&self, names: &[String]) -> Result<Vec<usize>, ModelError> {
        order(&self.parents, names)
    }

    /// True if group `to` is reached from group `from` along lateral edges.
    pub(crate) fn reaches(&self, from: usize, to: usize) -> bool {
        reaches(&self.parents, from, to)
    }
}

/// Index of the configuration of `columns` in a row of codes, first column slowest.
pub(crate) fn configuration(columns: &[usize], sizes: &[usize], codes: &[u32]) -> usize {
    columns
        .iter()
        .fold(0, |index, &c| index * sizes[c] + codes[c] as usize)
}
