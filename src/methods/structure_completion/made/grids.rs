//! Perfect grids of which a part is seen: what a method has to complete exactly before anything else counts.

use rand::RngExt;
use rand::seq::SliceRandom;

use crate::layout::{Class, Element, Layout};
use crate::partial::PartialLayout;
use edifice_base::rng::{Stream, stream};
use edifice_shape::Rect;

/// A perfect grid: equal windows, equal gaps, equal margins on both sides.
pub fn grid(
    columns: usize,
    rows: usize,
    window: (f64, f64),
    gap: (f64, f64),
    margin: (f64, f64),
) -> Layout {
    let at = |k: usize, size: f64, gap: f64, margin: f64| margin + k as f64 * (size + gap);
    let extent = |n: usize, size: f64, gap: f64, margin: f64| {
        2.0 * margin + n as f64 * size + n.saturating_sub(1) as f64 * gap
    };
    let mut elements = Vec::with_capacity(columns * rows);
    for r in 0..rows {
        for c in 0..columns {
            let (x, y) = (
                at(c, window.0, gap.0, margin.0),
                at(r, window.1, gap.1, margin.1),
            );
            elements.push(Element::new(
                Class::Window,
                Rect::new(x, y, window.0, window.1),
            ));
        }
    }
    Layout {
        name: format!("grid_{columns}x{rows}"),
        width: extent(columns, window.0, gap.0, margin.0),
        height: extent(rows, window.1, gap.1, margin.1),
        elements,
    }
}

/// The part of a grid that is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sight {
    /// A random 30 % of the cells, at least one of each row and of each column; nothing is known of the others.
    Scattered,
    /// One row and one column; nothing is known of the other cells.
    Cross,
    /// The left or the right half of the facade, wall included.
    Half,
    /// Half of the rows and half of the columns about the middle, rounded up; nothing is known of the other cells.
    Block,
}

impl Sight {
    /// All of them.
    pub const ALL: [Sight; 4] = [Sight::Scattered, Sight::Cross, Sight::Half, Sight::Block];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Sight::Scattered => "30 % seen",
            Sight::Cross => "cross",
            Sight::Half => "half",
            Sight::Block => "block",
        }
    }

    /// The grid as a partial layout, and the windows that are hidden. `columns` and `rows` are those of the grid, whose
    /// windows are listed row by row.
    pub fn of(
        self,
        grid: &Layout,
        (columns, rows): (usize, usize),
        rng: &mut Stream,
    ) -> (PartialLayout, Vec<Element>) {
        let mut unknown = None;
        let cell = |k: usize| (k % columns, k / columns);
        let seen: Vec<bool> = match self {
            Sight::Scattered => scattered(columns, rows, rng),
            Sight::Cross => {
                let (c, r) = (rng.random_range(0..columns), rng.random_range(0..rows));
                let on = |k: usize| cell(k).0 == c || cell(k).1 == r;
                (0..columns * rows).map(on).collect()
            }
            Sight::Half => {
                let half = grid.width / 2.0;
                let x = if rng.random() { half } else { 0.0 };
                let hidden = Rect::new(x, 0.0, half, grid.height);
                unknown = Some(vec![hidden]);
                let on = |e: &Element| {
                    let (x, y) = e.rect.centre();
                    !hidden.contains(x, y)
                };
                grid.elements.iter().map(on).collect()
            }
            Sight::Block => {
                let range = |n: usize| {
                    let size = n.div_ceil(2);
                    let from = (n - size) / 2;
                    from..from + size
                };
                let (across, up) = (range(columns), range(rows));
                let on = |k: usize| across.contains(&cell(k).0) && up.contains(&cell(k).1);
                (0..columns * rows).map(on).collect()
            }
        };
        let side = |wanted: bool| {
            let own = grid
                .elements
                .iter()
                .zip(&seen)
                .filter(|(_, seen)| **seen == wanted);
            own.map(|(e, _)| *e).collect::<Vec<Element>>()
        };
        let partial = PartialLayout {
            width: grid.width,
            height: grid.height,
            observed: side(true),
            unknown,
            forbidden: Vec::new(),
        };
        (partial, side(false))
    }
}

/// A random 30 % of the cells, drawn again until each row and each column has one.
fn scattered(columns: usize, rows: usize, rng: &mut Stream) -> Vec<bool> {
    let cells = columns * rows;
    // A diagonal, so that there is one in each line, and random cells beside it.
    let mut lines: Vec<usize> = (0..columns.max(rows)).collect();
    lines.shuffle(rng);
    let mut seen = vec![false; cells];
    for (k, line) in lines.iter().enumerate() {
        seen[(line % rows) * columns + k % columns] = true;
    }
    let wanted = (0.3 * cells as f64).round() as usize;
    let mut others: Vec<usize> = (0..cells).filter(|k| !seen[*k]).collect();
    others.shuffle(rng);
    let missing = wanted.saturating_sub(cells - others.len());
    for k in others.into_iter().take(missing) {
        seen[k] = true;
    }
    seen
}

/// Number of grids of [`all`].
pub const COUNT: usize = 24;

/// 24 grids from 4 x 4 to 9 x 7, each with its number of columns and rows: random proportions, equal gaps, and equal margins
/// that are less than a gap and a window.
pub fn all(seed: u64) -> Vec<(Layout, (usize, usize))> {
    let made = |k: usize| {
        let mut rng = stream(seed, "made grids", k as u64);
        let (columns, rows) = (4 + k % 6, 4 + k / 6);
        let window = (rng.random_range(8.0..20.0), rng.random_range(12.0..30.0));
        let gap = (
            window.0 * rng.random_range(0.3..1.8),
            window.1 * rng.random_range(0.3..1.5),
        );
        let margin = (
            (window.0 + gap.0) * rng.random_range(0.15..0.9),
            (window.1 + gap.1) * rng.random_range(0.15..0.9),
        );
        (grid(columns, rows, window, gap, margin), (columns, rows))
    };
    (0..COUNT).map(made).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_have_equal_margins() {
        let made = grid(4, 3, (10.0, 16.0), (8.0, 12.0), (6.0, 9.0));
        assert_eq!(made.elements.len(), 12);
        let last = made.elements[11].rect;
        assert_eq!(
            (made.width - last.right(), made.height - last.top()),
            (6.0, 9.0)
        );
        assert_eq!(all(1).last().map(|g| g.1), Some((9, 7)));
    }

    #[test]
    fn each_line_is_seen_once_at_least() {
        for (k, (layout, (columns, rows))) in all(2).iter().enumerate() {
            for sight in [Sight::Scattered, Sight::Cross] {
                let mut rng = stream(2, "sight", k as u64);
                let (partial, hidden) = sight.of(layout, (*columns, *rows), &mut rng);
                assert_eq!(partial.observed.len() + hidden.len(), columns * rows);
                let mut at: Vec<[i64; 2]> = Vec::new();
                at.extend(
                    partial
                        .observed
                        .iter()
                        .map(|e| [e.rect.x as i64, e.rect.y as i64]),
                );
                for (axis, lines) in [*columns, *rows].into_iter().enumerate() {
                    let mut own: Vec<i64> = at.iter().map(|p| p[axis]).collect();
                    own.sort_unstable();
                    own.dedup();
                    assert_eq!(own.len(), lines, "{k} {sight:?}");
                }
            }
        }
    }
}
