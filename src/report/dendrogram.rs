//! Dendrograms of agglomerative clusterings.

use super::axis::Scale;
use super::colour::{INK, MUTED, category};
use super::drawing::{Anchor, Area, Drawing, Text, text_width};
use super::frame::{self, SMALL};

/// One merge: clusters below the number of leaves are leaves, `leaves + k` is the k-th merge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Merge {
    /// One cluster.
    pub left: usize,
    /// The other.
    pub right: usize,
    /// Distance at which they meet.
    pub height: f64,
}

/// A clustering as a tree, leaves at the bottom in the order that the merges imply.
#[derive(Debug, Clone)]
pub struct Dendrogram {
    title: String,
    label: String,
    leaves: Vec<String>,
    merges: Vec<Merge>,
    groups: Vec<usize>,
}

impl Dendrogram {
    /// A tree over named leaves; each merge refers to leaves and earlier merges only. `label` names
    /// the height.
    pub fn new(
        title: impl Into<String>,
        label: impl Into<String>,
        leaves: Vec<String>,
        merges: Vec<Merge>,
    ) -> Self {
        Self {
            title: title.into(),
            label: label.into(),
            leaves,
            merges,
            groups: Vec::new(),
        }
    }

    /// Colours each leaf by its group.
    pub fn groups(mut self, groups: Vec<usize>) -> Self {
        self.groups = groups;
        self
    }

    /// The leaves from left to right.
    pub fn order(&self) -> Vec<usize> {
        let n = self.leaves.len();
        let mut child = vec![false; n + self.merges.len()];
        for merge in &self.merges {
            for c in [merge.left, merge.right] {
                if let Some(mark) = child.get_mut(c) {
                    *mark = true;
                }
            }
        }
        let mut stack: Vec<usize> = (0..child.len()).filter(|&c| !child[c]).collect();
        let mut order = Vec::with_capacity(n);
        while let Some(cluster) = stack.pop() {
            match cluster.checked_sub(n) {
                None => order.push(cluster),
                Some(k) => {
                    let merge = self.merges[k];
                    // A cluster may only contain what came before it: otherwise this never ends.
                    stack.extend(
                        [merge.right, merge.left]
                            .into_iter()
                            .filter(|&c| c < cluster),
                    );
                }
            }
        }
        order
    }

    pub(super) fn draw(&self, out: &mut Drawing, area: Area) {
        let area = frame::title(out, area, &self.title);
        let n = self.leaves.len();
        let y = Scale::new(&self.label)
            .from_zero()
            .fit(self.merges.iter().map(|m| m.height));
        let widest = y
            .ticks()
            .map(|(_, t)| text_width(t, SMALL))
            .fold(0.0, f64::max);
        let slot = (area.width - widest - 56.0) / n.max(1) as f64;
        let size = SMALL.min(slot * 0.95);
        let named = size >= 5.0;
        let longest = self
            .leaves
            .iter()
            .map(|l| text_width(l, size))
            .fold(0.0, f64::max);
        let foot = if named { longest + 18.0 } else { 18.0 };
        let plot = area.inside(widest + 34.0, 0.0, 22.0, foot);
        frame::y_ticks(out, plot, &y, &self.label);
        let order = self.order();
        let mut at = vec![(0.0, plot.bottom()); n + self.merges.len()];
        for (i, &leaf) in order.iter().enumerate() {
            let x = plot.x + (i as f64 + 0.5) * slot;
            at[leaf] = (x, plot.bottom());
            let colour = self.groups.get(leaf).map_or(INK, |&g| category(g));
            if named {
                out.label(Text {
                    at: (x, plot.bottom() + 12.0),
                    text: self.leaves[leaf].clone(),
                    size,
                    anchor: Anchor::End,
                    colour,
                    bold: false,
                    vertical: true,
                });
            }
            if !self.groups.is_empty() {
                out.rect(
                    Area {
                        x: x - slot * 0.45,
                        y: plot.bottom() + 2.0,
                        width: slot * 0.9,
                        height: 6.0,
                    },
                    colour,
                );
            }
        }
        for (k, merge) in self.merges.iter().enumerate() {
            let top = plot.bottom() - y.place(merge.height).unwrap_or(0.0) * plot.height;
            let (l, r) = (at[merge.left.min(n + k)], at[merge.right.min(n + k)]);
            out.path(vec![l, (l.0, top), (r.0, top), r], 1.2, MUTED);
            at[n + k] = ((l.0 + r.0) / 2.0, top);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_visits_every_leaf_once() {
        let merge = |left, right, height| Merge {
            left,
            right,
            height,
        };
        let names = (0..4).map(|i| i.to_string()).collect();
        let merges = vec![merge(2, 0, 1.0), merge(3, 1, 2.0), merge(5, 4, 3.0)];
        let tree = Dendrogram::new("", "", names, merges);
        assert_eq!(tree.order(), [3, 1, 2, 0]);
    }
}
