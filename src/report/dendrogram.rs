//! Dendrograms of agglomerative clusterings.

use super::axis::{Fitted, Scale};
use super::colour::{INK, MUTED, category};
use super::drawing::{Anchor, Area, Drawing, Text};
use super::frame::{self, SMALL};
use super::render::text_width;

/// Room for the name of a leaf, across the direction of reading.
const LINE: f64 = 14.0;

/// Width that axis and margins take beside a tree that stands upright, in pixels.
const BESIDE: f64 = 90.0;

/// Height that title and axis take above and below a tree that lies on its side, in pixels.
const ABOVE_AND_BELOW: f64 = 80.0;

/// One merge: clusters below the number of leaves are leaves, `leaves + k` is the k-th merge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Merge {
    /// One of the two clusters.
    pub left: usize,
    /// The other of the two clusters.
    pub right: usize,
    /// Distance at which they meet.
    pub height: f64,
}

/// A clustering as a tree, leaves in the order that the merges imply: at the bottom, or, when they are
/// many, at the left, where the panel grows with their number so that every name can be read.
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

    /// The leaves from left to right, or from the top down.
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

    /// True if the names do not fit side by side: then the tree lies on its side.
    fn lies(&self, width: f64) -> bool {
        self.leaves.len() as f64 * LINE > width - BESIDE
    }

    /// The height that the panel takes where a width and a height are offered: a tree that lies on its
    /// side needs a line for each leaf.
    pub(super) fn height(&self, (width, height): (f64, f64)) -> f64 {
        match self.lies(width) {
            false => height,
            true => height.max(self.leaves.len() as f64 * LINE + ABOVE_AND_BELOW),
        }
    }

    pub(super) fn draw(&self, out: &mut Drawing, area: Area) {
        let lies = self.lies(area.width);
        let area = frame::title(out, area, &self.title);
        let heights = Scale::new(&self.label)
            .from_zero()
            .fit(self.merges.iter().map(|m| m.height));
        match lies {
            false => self.draw_upright(out, area, &heights),
            true => self.draw_lying(out, area, &heights),
        }
    }

    /// Leaves in a row at the bottom, their names below them.
    fn draw_upright(&self, out: &mut Drawing, area: Area, y: &Fitted) {
        let n = self.leaves.len();
        let ticks = y.ticks().map(|(_, t)| text_width(t, SMALL));
        let widest = ticks.fold(0.0, f64::max);
        let slot = (area.width - widest - 56.0) / n.max(1) as f64;
        let size = SMALL.min(slot * 0.95);
        let plot = area.inside(widest + 34.0, 0.0, 22.0, self.longest(size) + 18.0);
        frame::y_ticks(out, plot, y, &self.label);
        let place = |along: f64, height: f64| {
            let x = plot.x + along * slot;
            (x, plot.bottom() - height * plot.height)
        };
        for (i, &leaf) in self.order().iter().enumerate() {
            let (x, bottom) = place(i as f64 + 0.5, 0.0);
            self.name(out, leaf, (x, bottom + 12.0), size, true);
            let mark = Area {
                x: x - slot * 0.45,
                y: bottom + 2.0,
                width: slot * 0.9,
                height: 6.0,
            };
            self.mark(out, leaf, mark);
        }
        self.tree(out, y, &place);
    }

    /// Leaves in a column at the left, a line each, their names left of them.
    fn draw_lying(&self, out: &mut Drawing, area: Area, x: &Fitted) {
        let plot = area.inside(self.longest(SMALL) + 24.0, 4.0, 30.0, 46.0);
        frame::x_ticks(out, plot, x, &self.label, true);
        let slot = plot.height / self.leaves.len() as f64;
        let place = |along: f64, height: f64| {
            let y = plot.y + along * slot;
            (plot.x + height * plot.width, y)
        };
        for (i, &leaf) in self.order().iter().enumerate() {
            let (left, y) = place(i as f64 + 0.5, 0.0);
            self.name(out, leaf, (left - 12.0, y), SMALL, false);
            let mark = Area {
                x: left - 8.0,
                y: y - slot * 0.45,
                width: 6.0,
                height: slot * 0.9,
            };
            self.mark(out, leaf, mark);
        }
        self.tree(out, x, &place);
    }

    /// Width of the longest name.
    fn longest(&self, size: f64) -> f64 {
        let widths = self.leaves.iter().map(|l| text_width(l, size));
        widths.fold(0.0, f64::max)
    }

    fn name(&self, out: &mut Drawing, leaf: usize, at: (f64, f64), size: f64, vertical: bool) {
        out.label(Text {
            at,
            text: self.leaves[leaf].clone(),
            size,
            anchor: Anchor::End,
            colour: self.groups.get(leaf).map_or(INK, |&g| category(g)),
            bold: false,
            vertical,
        });
    }

    /// A bar in the colour of the leaf's group.
    fn mark(&self, out: &mut Drawing, leaf: usize, area: Area) {
        if let Some(&group) = self.groups.get(leaf) {
            out.rect(area, category(group));
        }
    }

    /// The merges as brackets; `place` turns a position among the leaves, in leaves, and a height, as a
    /// fraction of the axis, into a point.
    fn tree(&self, out: &mut Drawing, heights: &Fitted, place: &dyn Fn(f64, f64) -> (f64, f64)) {
        let n = self.leaves.len();
        let mut at = vec![(0.0, 0.0); n + self.merges.len()];
        for (i, &leaf) in self.order().iter().enumerate() {
            at[leaf].0 = i as f64 + 0.5;
        }
        for (k, merge) in self.merges.iter().enumerate() {
            let top = heights.place(merge.height).unwrap_or(0.0);
            let (l, r) = (at[merge.left.min(n + k)], at[merge.right.min(n + k)]);
            let bracket =
                [l, (l.0, top), (r.0, top), r].map(|(along, height)| place(along, height));
            out.path(bracket.to_vec(), 1.2, MUTED);
            at[n + k] = ((l.0 + r.0) / 2.0, top);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Mark;
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
        assert_eq!(tree.height((200.0, 100.0)), 100.0);
        assert_eq!(tree.height((100.0, 100.0)), 136.0);
    }

    /// A comb of `count` leaves.
    fn comb(count: usize) -> Dendrogram {
        let names = (0..count).map(|i| format!("facade_{i:03}")).collect();
        let merge = |k: usize| Merge {
            left: if k == 0 { 0 } else { count + k - 1 },
            right: k + 1,
            height: (k + 1) as f64,
        };
        Dendrogram::new(
            "clusters",
            "distance",
            names,
            (0..count - 1).map(merge).collect(),
        )
    }

    #[test]
    fn every_name_is_written_readably_and_apart() {
        for (count, width) in [
            (2, 200.0),
            (20, 480.0),
            (47, 760.0),
            (48, 760.0),
            (134, 760.0),
            (400, 480.0),
        ] {
            let tree = comb(count).groups((0..count).map(|i| i % 2).collect());
            let area = Area {
                x: 0.0,
                y: 0.0,
                width,
                height: tree.height((width, 700.0)),
            };
            let mut out = Drawing::new(area.width, area.height);
            tree.draw(&mut out, area);
            let names = out.marks.iter().filter_map(|mark| match mark {
                Mark::Text(text) if text.text.starts_with("facade_") => Some(text),
                _ => None,
            });
            let names: Vec<&Text> = names.collect();
            assert_eq!(names.len(), count);
            let size = names[0].size;
            assert!(size >= 11.5, "{count}: {size}");
            let line = |t: &Text| if t.vertical { t.at.0 } else { t.at.1 };
            let mut lines: Vec<f64> = names.iter().map(|t| line(t)).collect();
            lines.sort_by(f64::total_cmp);
            for pair in lines.windows(2) {
                assert!(pair[1] - pair[0] >= size, "{count}: {pair:?}");
            }
            if !names[0].vertical {
                // Names end left of the marks of their leaves, which end left of the tree.
                let ends = |path: bool| {
                    let points = out.marks.iter().filter_map(|mark| match mark {
                        Mark::Fill { points, .. } if !path => Some(points),
                        Mark::Path { points, .. } if path => Some(points),
                        _ => None,
                    });
                    let xs = points.flatten().map(|p| p.0);
                    let low = xs.clone().fold(f64::INFINITY, f64::min);
                    (low, xs.fold(f64::NEG_INFINITY, f64::max))
                };
                let (marks, tree) = (ends(false), ends(true));
                let left = |t: &&&Text| t.anchor == Anchor::End && t.at.0 <= marks.0;
                assert_eq!(names.iter().filter(left).count(), count);
                assert!(marks.1 <= tree.0, "{marks:?} {tree:?}");
            }
            let inside = |&(x, y): &(f64, f64)| {
                (0.0..=area.width).contains(&x) && (0.0..=area.height).contains(&y)
            };
            for mark in &out.marks {
                if let Mark::Path { points, .. } | Mark::Fill { points, .. } = mark {
                    assert!(points.iter().all(inside), "{count}: {points:?}");
                }
            }
        }
    }
}
