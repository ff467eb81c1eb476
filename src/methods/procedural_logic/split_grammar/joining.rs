//! The binary splits that become one n-ary split (Eq. 9), when the grammar of one facade is written.

use serde::{Deserialize, Serialize};

use crate::nary::{NaryNode, NaryTree};
use crate::parse::BinaryTree;
use crate::split_grammar::{Classes, classes};

/// The set of nested splits of one direction that are joined.
///
/// The text joins first and finds common rules then (Sec. 4.1); after that, the order in which lines of one direction
/// were found is forgotten.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Joining {
    /// All, before common rules are found: the order of Sec. 4.1.
    #[default]
    All,
    /// Common rules are found in the binary tree first; then a split that one rule calls once is joined with that rule.
    UsedOnce,
    /// None: the binary tree with its common rules.
    Binary,
}

impl Joining {
    /// The n-ary tree of a binary one.
    pub(crate) fn apply(self, tree: &BinaryTree) -> NaryTree {
        match self {
            Joining::All => NaryTree::from_binary(tree),
            Joining::UsedOnce => {
                let calls = calls(tree);
                NaryTree::joined(tree, |node| calls[node] == 1)
            }
            Joining::Binary => NaryTree::unjoined(tree),
        }
    }
}

/// The number of times that the rules of the binary tree call the rule of each node, regions of identical content having one rule.
fn calls(tree: &BinaryTree) -> Vec<usize> {
    let binary = NaryTree::unjoined(tree);
    let Classes { class, example } = classes(&binary);
    let mut calls = vec![0; example.len()];
    for &node in &example {
        if let NaryNode::Split { children, .. } = &binary.nodes[node] {
            for &child in children {
                calls[class[child as usize]] += 1;
            }
        }
    }
    class.into_iter().map(|class| calls[class]).collect()
}
