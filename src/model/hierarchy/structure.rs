//! What the graph of a hierarchical model looks like.

use super::super::error::ModelError;
use super::super::graph::{order, reaches};

/// What selects one of the linear Gaussians of a group of real columns.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) enum Selector {
    /// The group's own second-level hidden variable, with so many values.
    Hidden(usize),
    /// The style S itself.
    Style,
    /// The values of these categorical columns.
    Codes(Vec<usize>),
}

/// Graph of a model over the real groups and the categorical columns of a schema.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Structure {
    /// Cardinality of S.
    pub styles: usize,
    /// Per real group.
    pub selectors: Vec<Selector>,
    /// Lateral edges: per real group, its parents among the real groups, ascending.
    pub parents: Vec<Vec<usize>>,
    /// Per categorical column, its parents among the categorical columns, ascending.
    pub code_parents: Vec<Vec<usize>>,
}

impl Structure {
    /// Cardinalities of S and of every hidden variable as given, no lateral edges.
    pub fn new(styles: usize, selector: &Selector, groups: usize, codes: usize) -> Self {
        Self {
            styles,
            selectors: vec![selector.clone(); groups],
            parents: vec![Vec::new(); groups],
            code_parents: vec![Vec::new(); codes],
        }
    }

    /// Number of linear Gaussians of group `g`; `sizes` are the numbers of categories.
    pub fn states(&self, g: usize, sizes: &[usize]) -> usize {
        match &self.selectors[g] {
            Selector::Hidden(k) => *k,
            Selector::Style => self.styles,
            Selector::Codes(columns) => columns.iter().map(|&c| sizes[c]).product(),
        }
    }

    /// Groups with every parent before its children; the name of a group on a cycle otherwise.
    pub fn order(&self, names: &[String]) -> Result<Vec<usize>, ModelError> {
        order(&self.parents, names)
    }

    /// Whether group `to` is reached from group `from` along lateral edges.
    pub fn reaches(&self, from: usize, to: usize) -> bool {
        reaches(&self.parents, from, to)
    }
}

/// Index of the configuration of `columns` in a row of codes, first column slowest.
pub(crate) fn configuration(columns: &[usize], sizes: &[usize], codes: &[u32]) -> usize {
    columns
        .iter()
        .fold(0, |index, &c| index * sizes[c] + codes[c] as usize)
}
