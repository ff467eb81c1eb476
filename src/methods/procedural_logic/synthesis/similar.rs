//! Similar structures: the proportions of one facade on the rules of another.
//!
//! A starting rule that a single facade has says nothing about how its parameters vary (Sec. 4.4). Facades
//! with similar starting rules do: the trees of both are aligned from the root down, split by split along one
//! axis, the parts in order, so that as many as possible call the same rule, or else insert the same labels.
//! A part that is aligned takes its share of the split from the other facade, one that is not keeps its own,
//! and the shares are scaled to fill the split. The result is a parameter vector of the first facade's
//! starting rule, whatever the second one's.

use crate::nary::{NaryNode, NaryTree};
use crate::rules::{Call, Instance, InstanceError, RuleSet};

/// Gain of an alignment for two parts that call the same rule, and for two that insert the same labels.
const SAME_RULE: u32 = 3;
const SAME_LABELS: u32 = 1;

/// A parse tree with the call and the labels of each node.
pub(crate) struct Structure {
    tree: NaryTree,
    calls: Vec<Call>,
    /// Sorted labels at and below each node.
    labels: Vec<Vec<u32>>,
}

impl Structure {
    /// The tree that an instance stands for.
    ///
    /// # Errors
    /// [`InstanceError`] for an instance of other rules.
    pub(super) fn new(rules: &RuleSet, instance: &Instance) -> Result<Self, InstanceError> {
        let tree = rules.expand(instance)?;
        let mut calls = vec![instance.start; tree.nodes.len()];
        let mut labels = vec![Vec::new(); tree.nodes.len()];
        for (node, content) in tree.nodes.iter().enumerate() {
            if let (NaryNode::Split { children, .. }, Call::Rule(rule)) = (content, calls[node]) {
                let parts = &rules.rules()[rule as usize].children;
                for (&child, &call) in children.iter().zip(parts) {
                    calls[child as usize] = call;
                }
            }
        }
        for (node, content) in tree.nodes.iter().enumerate().rev() {
            let mut set = match content {
                NaryNode::Insert(label) => vec![*label],
                NaryNode::Split { children, .. } => {
                    let below = children.iter().flat_map(|&child| &labels[child as usize]);
                    below.copied().collect()
                }
            };
            set.sort_unstable();
            set.dedup();
            labels[node] = set;
        }
        Ok(Self {
            tree,
            calls,
            labels,
        })
    }

    /// This structure at the size and with the proportions of another facade, and the share of the nodes
    /// of both that were aligned, 0..=1.
    ///
    /// Complexity: `O(sum a b)` over the aligned splits with `a` and `b` parts.
    pub(super) fn proportioned(&self, other: &Self) -> (Instance, f64) {
        let mut nodes = self.tree.nodes.clone();
        let mut aligned = 0_usize;
        let mut todo = vec![(
            0_usize,
            Some(0_usize),
            [other.tree.width, other.tree.height],
        )];
        while let Some((own, donor, extent)) = todo.pop() {
            aligned += usize::from(donor.is_some());
            let NaryNode::Split {
                axis,
                sizes,
                children,
            } = &self.tree.nodes[own]
            else {
                continue;
            };
            let (partners, donor_sizes) = self.partners(own, other, donor);
            let share = |size: f64, sizes: &[f64]| size / sizes.iter().sum::<f64>();
            let shares: Vec<f64> = (0..children.len())
                .map(|k| match partners[k] {
                    Some((place, _)) => share(donor_sizes[place], donor_sizes),
                    None => share(sizes[k], sizes),
                })
                .collect();
            let whole: f64 = shares.iter().sum();
            let total = extent[*axis as usize];
            let new: Vec<f64> = shares.iter().map(|s| total * s / whole).collect();
            for (k, &child) in children.iter().enumerate() {
                let mut extent = extent;
                extent[*axis as usize] = new[k];
                todo.push((child as usize, partners[k].map(|p| p.1), extent));
            }
            nodes[own] = NaryNode::Split {
                axis: *axis,
                sizes: new,
                children: children.clone(),
            };
        }
        let tree = NaryTree {
            width: other.tree.width,
            height: other.tree.height,
            nodes,
        };
        let all = self.tree.nodes.len() + other.tree.nodes.len();
        let share = 2.0 * aligned as f64 / all as f64;
        (tree.instance(self.calls[0]), share)
    }

    /// For each part of `own`, the part of `donor` that it is aligned with (place and node), and the
    /// sizes of the donor's parts.
    fn partners<'a>(
        &self,
        own: usize,
        other: &'a Self,
        donor: Option<usize>,
    ) -> (Vec<Option<Partner>>, &'a [f64]) {
        let (mine, theirs) = match (
            &self.tree.nodes[own],
            donor.map(|donor| &other.tree.nodes[donor]),
        ) {
            (
                NaryNode::Split { axis, children, .. },
                Some(NaryNode::Split {
                    axis: along,
                    sizes,
                    children: parts,
                }),
            ) if axis == along => (children, (parts, sizes)),
            (NaryNode::Split { children, .. }, _) => return (vec![None; children.len()], &[]),
            (NaryNode::Insert(_), _) => return (Vec::new(), &[]),
        };
        let (parts, sizes) = theirs;
        let score = |i: usize, j: usize| {
            let (a, b) = (mine[i] as usize, parts[j] as usize);
            if self.calls[a] == other.calls[b] {
                SAME_RULE
            } else if self.labels[a] == other.labels[b] {
                SAME_LABELS
            } else {
                0
            }
        };
        let places = align(mine.len(), parts.len(), score);
        let partners = places
            .into_iter()
            .map(|place| place.map(|j| (j, parts[j] as usize)))
            .collect();
        (partners, sizes)
    }
}

/// A part that another is aligned with: its place among its siblings, and its node.
type Partner = (usize, usize);

/// The alignment in order of `n` items with `m` others of largest total score; items of score 0 never meet.
fn align(n: usize, m: usize, score: impl Fn(usize, usize) -> u32) -> Vec<Option<usize>> {
    // best[i][j]: largest total of items i.. with others j..
    let mut best = vec![0_u32; (n + 1) * (m + 1)];
    let at = |i: usize, j: usize| i * (m + 1) + j;
    for i in (0..n).rev() {
        for j in (0..m).rev() {
            let skip = best[at(i + 1, j)].max(best[at(i, j + 1)]);
            let met = match score(i, j) {
                0 => 0,
                score => score + best[at(i + 1, j + 1)],
            };
            best[at(i, j)] = skip.max(met);
        }
    }
    let mut places = vec![None; n];
    let (mut i, mut j) = (0, 0);
    while i < n && j < m {
        let score = score(i, j);
        if score > 0 && best[at(i, j)] == score + best[at(i + 1, j + 1)] {
            places[i] = Some(j);
            (i, j) = (i + 1, j + 1);
        } else if best[at(i, j)] == best[at(i + 1, j)] {
            i += 1;
        } else {
            j += 1;
        }
    }
    places
}
