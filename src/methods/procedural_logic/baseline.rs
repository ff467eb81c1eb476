//! The split-only baseline of Wu et al. 2014, Table 2: procedural logic for one facade.

use rustc_hash::{FxHashMap, FxHashSet};

use super::affinity::Affinity;
use super::alphabet::Alphabet;
use super::canvas::Canvas;
use super::nary::{NaryNode, NaryTree};
use super::parameters::{ParameterError, Parameters};
use super::parse::{NoSplit, parse};
use crate::grammar::{Grammar, Operation, Rule, Start, Successor};
use crate::shape::{Axis, Facade, LayoutError};

/// Why a facade has no baseline grammar.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BaselineError {
    /// The layout is not a tiling.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The tiling cannot be split by straight lines.
    #[error(transparent)]
    NoSplit(#[from] NoSplit),
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}

/// The split grammar of one tiling: parsed with the affinities of this facade alone, binary splits
/// made n-ary, and one symbol for all regions of identical content (label, offset and size).
///
/// The grammar derives back the tiling, region by region. Symbols are `Facade`, `NT1`, `NT2`, ...
/// in order of derivation, renamed where a label of the tiling bears the same name.
///
/// # Errors
/// [`BaselineError`] for a parameter out of range, a layout that is not a tiling, or a tiling that
/// no sequence of straight cuts makes.
pub fn baseline_grammar(
    facade: &Facade,
    parameters: &Parameters,
) -> Result<Grammar, BaselineError> {
    let parameters = parameters.checked()?;
    let mut alphabet = Alphabet::default();
    let canvas = Canvas::from_tiling(facade, &mut alphabet)?;
    let mut affinity = Affinity::new(parameters.facing);
    affinity.add(&canvas, alphabet.len());
    let binary = parse(&canvas, &affinity.normalized(), &parameters)?;
    let tree = NaryTree::from_binary(&binary);
    let tolerance = 1e-7 * facade.width.max(facade.height);
    Ok(share_content(&tree, &alphabet, tolerance, facade))
}

/// What a region holds: its label; or its split, its extent across the split, and its parts with
/// their sizes, in units of the tolerance.
#[derive(PartialEq, Eq, Hash)]
enum Content {
    Insert(u32),
    Split(Axis, i64, Vec<(usize, i64)>),
}

/// One rule per distinct content (bottom-up hash-consing).
fn share_content(tree: &NaryTree, alphabet: &Alphabet, tolerance: f64, facade: &Facade) -> Grammar {
    let extents = tree.extents();
    let mut ids: FxHashMap<Content, usize> = FxHashMap::default();
    let mut class = vec![0; tree.nodes.len()];
    let mut example = Vec::new();
    for (node, content) in tree.nodes.iter().enumerate().rev() {
        let key = match content {
            NaryNode::Insert(label) => Content::Insert(*label),
            NaryNode::Split {
                axis,
                sizes,
                children,
            } => {
                let size = |s: f64| (s / tolerance).round() as i64;
                let parts = children.iter().zip(sizes);
                Content::Split(
                    *axis,
                    size(extents[node][axis.other() as usize]),
                    parts.map(|(&c, &s)| (class[c as usize], size(s))).collect(),
                )
            }
        };
        class[node] = *ids.entry(key).or_insert_with(|| {
            example.push(node);
            example.len() - 1
        });
    }
    write_rules(tree, &class, &example, alphabet, facade)
}

/// The rules in order of derivation.
fn write_rules(
    tree: &NaryTree,
    class: &[usize],
    example: &[usize],
    alphabet: &Alphabet,
    facade: &Facade,
) -> Grammar {
    let taken: FxHashSet<&str> = alphabet.names().iter().map(String::as_str).collect();
    let mut names = vec![None; example.len()];
    let mut order = Vec::new();
    let mut todo = vec![class[0]];
    while let Some(id) = todo.pop() {
        if names[id].is_some() {
            continue;
        }
        names[id] = Some(match &tree.nodes[example[id]] {
            NaryNode::Insert(label) => alphabet.name(*label).to_owned(),
            NaryNode::Split { children, .. } => {
                let name = if order.is_empty() {
                    "Facade".to_owned()
                } else {
                    format!("NT{}", order.len())
                };
                order.push(id);
                todo.extend(children.iter().rev().map(|&child| class[child as usize]));
                free_name(name, &taken)
            }
        });
    }
    let name = |id: usize| names[id].clone().unwrap_or_default();
    let rules = order
        .iter()
        .filter_map(|&id| match &tree.nodes[example[id]] {
            NaryNode::Insert(_) => None,
            NaryNode::Split {
                axis,
                sizes,
                children,
            } => Some(Rule {
                symbol: name(id),
                weight: None,
                operation: Operation::Split {
                    axis: *axis,
                    successors: children
                        .iter()
                        .zip(sizes)
                        .map(|(&child, &size)| Successor::new(name(class[child as usize]), size))
                        .collect(),
                },
            }),
        })
        .collect();
    Grammar {
        unit: facade.unit.clone(),
        starts: vec![Start {
            name: facade.name.clone(),
            symbol: name(class[0]),
            width: facade.width,
            height: facade.height,
        }],
        rules,
    }
}

/// The name, with underscores until no label of the facade is called the same.
fn free_name(mut name: String, taken: &FxHashSet<&str>) -> String {
    while taken.contains(name.as_str()) {
        name.push('_');
    }
    name
}
