//! Transformation to n-ary split nodes (Sec. 4.1.1, Eq. 9).

use crate::alphabet::Alphabet;
use crate::parse::{BinaryNode, BinaryTree};
use edifice_shape::{Axis, Rect, Region};

/// A node of an n-ary split tree.
#[derive(Debug, Clone, PartialEq)]
pub enum NaryNode {
    /// The scope is one asset with this label.
    Insert(u32),
    /// Two or more parts along `axis`, none of them split along the same axis.
    Split {
        /// Splitting direction.
        axis: Axis,
        /// Sizes along the axis, in the unit of the facade.
        sizes: Vec<f64>,
        /// The parts, indices of later nodes.
        children: Vec<u32>,
    },
}

/// An n-ary split tree over a facade; node 0 is the root and every child comes after its parent.
#[derive(Debug, Clone, PartialEq)]
pub struct NaryTree {
    /// Extent along x.
    pub width: f64,
    /// Extent along y.
    pub height: f64,
    /// The nodes.
    pub nodes: Vec<NaryNode>,
}

impl NaryTree {
    /// Rewrites nested binary splits of one direction as n-ary splits until none is left (Eq. 9).
    pub fn from_binary(tree: &BinaryTree) -> Self {
        Self::joined(tree, |_| true)
    }

    /// As [`NaryTree::from_binary`], but only the nodes that `join` picks are joined with a split of the same direction
    /// around them.
    pub(crate) fn joined(tree: &BinaryTree, join: impl Fn(usize) -> bool) -> Self {
        let mut nodes = vec![NaryNode::Insert(0)];
        let mut todo = vec![(0_usize, 0_usize)];
        while let Some((from, to)) = todo.pop() {
            nodes[to] = match tree.nodes[from] {
                BinaryNode::Insert(label) => NaryNode::Insert(label),
                BinaryNode::Split { axis, .. } => {
                    let (sizes, parts) = collect(tree, axis, from, &join);
                    let first = nodes.len();
                    nodes.resize(first + parts.len(), NaryNode::Insert(0));
                    todo.extend(parts.iter().enumerate().map(|(i, &part)| (part, first + i)));
                    NaryNode::Split {
                        axis,
                        sizes,
                        children: (first..first + parts.len()).map(|c| c as u32).collect(),
                    }
                }
            };
        }
        Self {
            width: tree.width,
            height: tree.height,
            nodes,
        }
    }

    /// The binary tree as it stands, node by node.
    pub(crate) fn unjoined(tree: &BinaryTree) -> Self {
        let node = |node: &BinaryNode| match *node {
            BinaryNode::Insert(label) => NaryNode::Insert(label),
            BinaryNode::Split {
                axis,
                sizes,
                children,
            } => NaryNode::Split {
                axis,
                sizes: sizes.to_vec(),
                children: children.to_vec(),
            },
        };
        Self {
            width: tree.width,
            height: tree.height,
            nodes: tree.nodes.iter().map(node).collect(),
        }
    }

    /// Width and height of each node.
    pub(crate) fn extents(&self) -> Vec<[f64; 2]> {
        let mut extents = vec![[self.width, self.height]; self.nodes.len()];
        for (node, content) in self.nodes.iter().enumerate() {
            if let NaryNode::Split {
                axis,
                sizes,
                children,
            } = content
            {
                for (&child, &size) in children.iter().zip(sizes) {
                    extents[child as usize] = extents[node];
                    extents[child as usize][*axis as usize] = size;
                }
            }
        }
        extents
    }

    /// The regions that the inserts fill.
    pub(crate) fn regions(&self, alphabet: &Alphabet) -> Vec<Region> {
        let mut regions = Vec::new();
        let mut todo = vec![(0_u32, Rect::new(0.0, 0.0, self.width, self.height))];
        while let Some((node, rect)) = todo.pop() {
            match &self.nodes[node as usize] {
                NaryNode::Insert(label) => regions.push(Region {
                    label: alphabet.name(*label).to_owned(),
                    rect,
                }),
                NaryNode::Split {
                    axis,
                    sizes,
                    children,
                } => {
                    let mut start = rect.start(*axis);
                    for (&child, &size) in children.iter().zip(sizes) {
                        todo.push((child, rect.strip(*axis, start, size)));
                        start += size;
                    }
                }
            }
        }
        regions
    }

    /// Number of split nodes.
    pub fn splits(&self) -> usize {
        let is_split = |node: &&NaryNode| matches!(node, NaryNode::Split { .. });
        self.nodes.iter().filter(is_split).count()
    }
}

impl BinaryTree {
    /// Number of split nodes.
    pub fn splits(&self) -> usize {
        let is_split = |node: &&BinaryNode| matches!(node, BinaryNode::Split { .. });
        self.nodes.iter().filter(is_split).count()
    }
}

/// The parts of the chain of joined splits along `axis` that starts at `root`, in order, with sizes.
fn collect(
    tree: &BinaryTree,
    axis: Axis,
    root: usize,
    join: &impl Fn(usize) -> bool,
) -> (Vec<f64>, Vec<usize>) {
    let (mut out_sizes, mut parts) = (Vec::new(), Vec::new());
    let mut todo = vec![(root, 0.0)];
    while let Some((node, size)) = todo.pop() {
        match tree.nodes[node] {
            BinaryNode::Split {
                axis: a,
                sizes,
                children,
            } if a == axis && (node == root || join(node)) => {
                todo.push((children[1] as usize, sizes[1]));
                todo.push((children[0] as usize, sizes[0]));
            }
            _ => {
                out_sizes.push(size);
                parts.push(node);
            }
        }
    }
    (out_sizes, parts)
}
