//! A parsed facade as a split grammar of its own.

pub(super) mod baseline;
pub(super) mod joining;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::alphabet::Alphabet;
use crate::nary::{NaryNode, NaryTree};
use edifice_grammar::{Grammar, Operation, Rule, Start, Successor};
use edifice_shape::Axis;

/// The content of a region: its label; or its split, its extent across the split, and its parts with
/// their sizes, in units of the tolerance.
#[derive(PartialEq, Eq, Hash)]
enum Content {
    Insert(u32),
    Split(Axis, i64, Vec<(usize, i64)>),
}

/// The split grammar of one tree, with one symbol for all regions of identical content: label,
/// offset and size (bottom-up hash-consing).
///
/// Symbols are `Facade`, `NT1`, `NT2`, ... in order of derivation, with underscores added where a
/// label bears the same name.
pub fn split_grammar(tree: &NaryTree, alphabet: &Alphabet, name: &str, unit: &str) -> Grammar {
    let Classes { class, example } = classes(tree);
    let (start, rules) = write_rules(tree, &class, &example, alphabet);
    Grammar {
        unit: unit.to_owned(),
        starts: vec![Start {
            name: name.to_owned(),
            symbol: start,
            width: tree.width,
            height: tree.height,
        }],
        rules,
    }
}

/// Regions of identical content.
pub(crate) struct Classes {
    /// Class of each node.
    pub class: Vec<usize>,
    /// A node of each class.
    pub example: Vec<usize>,
}

/// Numbers regions of identical content: label, offset and size (bottom-up hash-consing).
pub(crate) fn classes(tree: &NaryTree) -> Classes {
    let tolerance = 1e-7 * tree.width.max(tree.height);
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
    Classes { class, example }
}

/// The start symbol and the rules in order of derivation.
fn write_rules(
    tree: &NaryTree,
    class: &[usize],
    example: &[usize],
    alphabet: &Alphabet,
) -> (String, Vec<Rule>) {
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
    (name(class[0]), rules)
}

/// The name, with underscores until no label of the facade is called the same.
fn free_name(mut name: String, taken: &FxHashSet<&str>) -> String {
    while taken.contains(name.as_str()) {
        name.push('_');
    }
    name
}
