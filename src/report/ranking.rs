//! Critical-difference diagrams (Demsar 2006, Fig. 1): mean ranks on a line, bars join what does not differ.

use super::colour::{INK, MUTED};
use super::drawing::{Anchor, Area, Drawing};
use super::frame::{self, LABEL, SMALL};

/// Mean ranks of several methods.
#[derive(Debug, Clone)]
pub struct Ranking {
    title: String,
    /// Name and mean rank, 1 the best.
    entries: Vec<(String, f64)>,
    critical: f64,
    groups: Vec<(usize, usize)>,
}

impl Ranking {
    /// Methods with their mean ranks, the critical difference, and the groups within it: first and last position in the order of
    /// mean ranks.
    pub fn new(
        title: impl Into<String>,
        mut entries: Vec<(String, f64)>,
        critical: f64,
        groups: Vec<(usize, usize)>,
    ) -> Self {
        entries.sort_by(|a, b| a.1.total_cmp(&b.1));
        Self {
            title: title.into(),
            entries,
            critical,
            groups,
        }
    }

    pub(super) fn draw(&self, out: &mut Drawing, area: Area) {
        let area = frame::title(out, area, &self.title);
        let count = self.entries.len().max(2);
        let plot = area.inside(20.0, 46.0, 20.0, 10.0);
        let last = (count - 1) as f64;
        let x = |rank: f64| plot.x + (rank - 1.0) / last * plot.width;
        out.path(vec![(plot.x, plot.y), (plot.right(), plot.y)], 1.5, INK);
        for rank in 1..=count {
            let at = x(rank as f64);
            out.path(vec![(at, plot.y - 5.0), (at, plot.y)], 1.5, INK);
            out.text((at, plot.y - 9.0), &rank.to_string(), SMALL, Anchor::Middle);
        }
        let wide = self.critical / last * plot.width;
        if wide <= plot.width {
            let y = plot.y - 30.0;
            out.path(vec![(plot.x, y), (plot.x + wide, y)], 2.0, INK);
            let text = format!("critical difference {:.2}", self.critical);
            out.text((plot.x + wide + 8.0, y + 4.0), &text, SMALL, Anchor::Start);
        }
        for (level, &(first, end)) in self.groups.iter().enumerate() {
            let y = plot.y + 8.0 + 6.0 * level as f64;
            let ends = (x(self.entries[first].1) - 4.0, x(self.entries[end].1) + 4.0);
            out.path(vec![(ends.0, y), (ends.1, y)], 4.0, MUTED);
        }
        let top = plot.y + 20.0 + 6.0 * self.groups.len() as f64;
        let half = self.entries.len().div_ceil(2);
        for (place, (name, rank)) in self.entries.iter().enumerate() {
            // The better half is written on the left from above, the others on the right from below.
            let left = place < half;
            let row = if left {
                place
            } else {
                self.entries.len() - 1 - place
            };
            let y = top + 20.0 * row as f64;
            let text = format!("{name}  {rank:.2}");
            let (end, anchor) = match left {
                true => (plot.x, Anchor::Start),
                false => (plot.right(), Anchor::End),
            };
            out.path(vec![(x(*rank), plot.y), (x(*rank), y), (end, y)], 1.0, INK);
            out.text((end, y - 3.0), &text, LABEL, anchor);
        }
    }
}
