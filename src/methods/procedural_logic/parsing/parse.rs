//! Facade parse tree generation (Sec. 3.3): split lines of least energy, recursively.

use crate::affinity::Coefficients;
use crate::canvas::Canvas;
use crate::lines::{Lines, Proposal, Rule, Scope};
use crate::parameters::Parameters;
use edifice_shape::{Axis, Rect};

/// A node of a binary split tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BinaryNode {
    /// The scope is one asset with this label.
    Insert(u32),
    /// Eq. 1: two parts along `axis`, with their sizes.
    Split {
        /// Splitting direction.
        axis: Axis,
        /// Sizes `s_1`, `s_2` along the axis, in the unit of the facade.
        sizes: [f64; 2],
        /// The parts' nodes; every child comes after its parent.
        children: [u32; 2],
    },
}

/// A binary split tree over a facade; node 0 is the root.
#[derive(Debug, Clone, PartialEq)]
pub struct BinaryTree {
    /// Extent along x.
    pub width: f64,
    /// Extent along y.
    pub height: f64,
    /// The nodes.
    pub nodes: Vec<BinaryNode>,
    /// Splits that had to cross an edge since no line of the scope met condition b.
    pub forced: usize,
}

/// No line may split a scope of a tiling whose regions must stay whole.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "no straight line splits the part from ({}, {}) to ({}, {}) without cutting a region",
    scope.x, scope.y, scope.right(), scope.top()
)]
pub struct NoSplit {
    /// The scope, a pinwheel or worse.
    pub scope: Rect,
}

/// Parses one facade into its binary split tree.
///
/// Of a label image every scope with an edge has a proposal in the end: when none meets condition
/// b, lines that only touch corners are tried, then lines that cut the fewest assets.
///
/// Complexity: `O(cells)` for the terms, then `O(rows + columns)` per node.
///
/// # Errors
/// [`NoSplit`] for a tiling that no sequence of straight cuts makes.
pub fn parse(
    canvas: &Canvas,
    coefficients: &Coefficients,
    parameters: &Parameters,
) -> Result<BinaryTree, NoSplit> {
    let lines = Lines::new(canvas, coefficients, parameters);
    let mut tree = BinaryTree {
        width: canvas.width(),
        height: canvas.height(),
        nodes: vec![BinaryNode::Insert(0)],
        forced: 0,
    };
    let whole = Scope {
        range: [(0, canvas.columns()), (0, canvas.rows())],
    };
    let mut todo = vec![(0_usize, whole, None)];
    while let Some((node, scope, parent)) = todo.pop() {
        if !lines.has_edge(&scope) {
            let [(i, _), (j, _)] = scope.range;
            tree.nodes[node] = BinaryNode::Insert(canvas.label_at(i, j));
            continue;
        }
        let proposal = propose(&lines, canvas, &scope, parent, parameters, &mut tree.forced)?;
        let axis = proposal.axis;
        let view = canvas.view(axis);
        let (start, end) = scope.range[axis as usize];
        let children = [tree.nodes.len(), tree.nodes.len() + 1];
        tree.nodes[node] = BinaryNode::Split {
            axis,
            sizes: [
                view.cuts[proposal.line] - view.cuts[start],
                view.cuts[end] - view.cuts[proposal.line],
            ],
            children: children.map(|child| child as u32),
        };
        tree.nodes.extend([BinaryNode::Insert(0); 2]);
        let mut parts = [scope; 2];
        parts[0].range[axis as usize] = (start, proposal.line);
        parts[1].range[axis as usize] = (proposal.line, end);
        todo.push((children[1], parts[1], Some(axis)));
        todo.push((children[0], parts[0], Some(axis)));
    }
    Ok(tree)
}

/// The best line under the strictest rule that allows one.
fn propose(
    lines: &Lines,
    canvas: &Canvas,
    scope: &Scope,
    parent: Option<Axis>,
    parameters: &Parameters,
    forced: &mut usize,
) -> Result<Proposal, NoSplit> {
    let rules: &[Rule] = if canvas.is_rigid() {
        &[Rule::Whole]
    } else {
        &[Rule::NoCrossing, Rule::NoCut, Rule::Any]
    };
    for (rank, &rule) in rules.iter().enumerate() {
        if let Some(proposal) = lines.best(scope, parent, rule, parameters) {
            *forced += usize::from(rank > 0);
            return Ok(proposal);
        }
    }
    let [(left, right), (bottom, top)] = scope.range;
    let (x, y) = (canvas.xs[left], canvas.ys[bottom]);
    Err(NoSplit {
        scope: Rect::new(x, y, canvas.xs[right] - x, canvas.ys[top] - y),
    })
}
