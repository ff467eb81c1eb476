//! Evidence of the seen lines for windows where no mask tells what is hidden.
//!
//! Without a mask a window that is not seen may be hidden or not there. The completed matrix of cells of the seen rows and
//! columns (soft-impute, Mazumder et al. 2010; the baseline of Fig. 19) tells how many are hidden among those that are seen.
//! Single windows are hidden here and there where two things hold: a share q of its filled cells that is well below 1 is seen,
//! and the seen lines reach the sides of the facade, so that no half and no corner of it can be what is hidden. Then two things
//! follow that the features of a candidate do not hold:
//!
//! - A line of m windows on which none is seen would have to be hidden whole, with probability `(1 - q)^m`, q now without the
//!   bias that each seen line has at least one seen window. Where that is below [`RARE`], its windows are so much less
//!   probable, whether the chain, a mirror image or another facade proposes them.
//! - A cell of a seen row and a seen column is judged by the other rows and columns, too: its probability is the mean of what
//!   was learnt and of the completed matrix.

use super::candidates::Candidates;
use super::observation::{Observation, of};
use crate::baselines::{Cells, cells};
use crate::layout::lines::LatticeLine;
use crate::layout::{Class, Element};
use crate::partial::PartialLayout;
use edifice_shape::{Axis, Rect};

/// A window is on a seen line when its centre is nearer than this share of the typical extent.
const ON_LINE: f64 = 0.35;
/// A line that is hidden whole with at least this probability is none that speaks against itself: parts of facades that are
/// hidden so were learnt from.
const RARE: f64 = 0.2;
/// Shares of the filled cells that are seen: up to the first, single windows are hidden; from the second on, a region.
const SINGLE: [f64; 2] = [0.8, 0.95];
/// Room for a further line between the outermost seen one and the side of the facade, in distances of lines: up to the first
/// there is none, from the second on there is.
const ROOM: [f64; 2] = [0.6, 1.1];
/// The same below the lowest row, where many facades have a floor without windows.
const ROOM_BELOW: [f64; 2] = [1.5, 1.8];

/// Windows hidden here and there.
struct Scattered {
    cells: Cells,
    /// Probability that single windows are hidden, and not a region.
    single: f64,
    /// Factor of a window on a column and on a row that would be hidden whole.
    hidden: [f64; 2],
}

/// Changes the probabilities of windows, one for each of the first candidates; with a mask none.
pub(crate) fn weigh(observation: &Observation, candidates: &Candidates, probabilities: &mut [f64]) {
    let Some(scattered) = Scattered::new(observation) else {
        return;
    };
    for (candidate, probability) in candidates.all.iter().zip(probabilities) {
        if candidate.element.class == Class::Window {
            *probability = scattered.weighed(observation, &candidate.element, *probability);
        }
    }
}

impl Scattered {
    /// `None` with a mask, without a window, and where one region is hidden.
    fn new(observation: &Observation) -> Option<Self> {
        let seen: Vec<Rect> = of(&observation.elements, Class::Window)
            .map(|e| e.rect)
            .collect();
        if observation.partial.unknown.is_some() || seen.is_empty() {
            return None;
        }
        let cells = cells(observation.partial, &seen);
        let filled = cells.filled().max(seen.len()) as f64;
        let share = seen.len() as f64 / filled;
        let single = at_most(share, SINGLE) * reach(observation.partial, &cells);
        let hidden = [cells.columns.len(), cells.rows.len()].map(|lines| {
            // Each line has a seen window because it would not be a line otherwise; the fewest that give every line one
            // say nothing of the share.
            let cover = cells.columns.len().max(cells.rows.len()) as f64;
            let share = (seen.len() as f64 - cover) / (filled - cover).max(1.0);
            let whole = (1.0 - share).powf(filled / lines as f64);
            1.0 - single + single * (whole / RARE).min(1.0)
        });
        (single > 0.0).then_some(Self {
            cells,
            single,
            hidden,
        })
    }

    /// The probability of one window.
    fn weighed(&self, observation: &Observation, window: &Element, probability: f64) -> f64 {
        let (x, y) = window.rect.centre();
        let on = |lines: &[LatticeLine], at: f64, axis: Axis| {
            let near = |l: &LatticeLine| (l.at - at).abs() < ON_LINE * observation.extent(axis);
            lines.iter().position(near)
        };
        let (columns, rows) = (&self.cells.columns, &self.cells.rows);
        match (on(rows, y, Axis::Y), on(columns, x, Axis::X)) {
            (Some(row), Some(column)) => {
                let completed = self.cells.value(row, column).clamp(0.0, 1.0);
                probability + self.single * (completed - probability) / 2.0
            }
            (Some(_), None) => probability * self.hidden[0],
            (None, Some(_)) => probability * self.hidden[1],
            (None, None) => probability * self.hidden[0].min(self.hidden[1]),
        }
    }
}

/// 1 up to the first limit, 0 from the second on, a straight line between them.
fn at_most(value: f64, limits: [f64; 2]) -> f64 {
    ((limits[1] - value) / (limits[1] - limits[0])).clamp(0.0, 1.0)
}

/// The degree to which the seen lines leave no room for others at the sides of the facade, from 0 to 1.
fn reach(partial: &PartialLayout, cells: &Cells) -> f64 {
    let [left, right] = room(&cells.columns, partial.width);
    let [below, above] = room(&cells.rows, partial.height);
    let sides = [left, right, above].map(|r| at_most(r, ROOM));
    sides.into_iter().fold(at_most(below, ROOM_BELOW), f64::min)
}

/// Room before the first line and after the last one, in distances of lines less the half of one that each line takes.
fn room(lines: &[LatticeLine], extent: f64) -> [f64; 2] {
    let mut gaps: Vec<f64> = lines.windows(2).map(|l| l[1].at - l[0].at).collect();
    gaps.sort_unstable_by(f64::total_cmp);
    let distance = gaps.get(gaps.len() / 2).copied().unwrap_or(extent);
    let ends = [lines[0].at, extent - lines[lines.len() - 1].at];
    ends.map(|end| end / distance - 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Windows of the cells of a picture with `#`, the upper row first; 20 wide, 30 high, 40 and 50 apart.
    fn partial(rows: &[&str], unknown: Option<Vec<Rect>>) -> PartialLayout {
        let cell = |r: usize, c: usize| {
            let (x, y) = (40.0 * c as f64 + 10.0, 50.0 * r as f64 + 10.0);
            Element::new(Class::Window, Rect::new(x, y, 20.0, 30.0))
        };
        let lines = rows.iter().rev().enumerate();
        let observed = lines.flat_map(|(r, line)| {
            let seen = line.char_indices().filter(|(_, cell)| *cell == '#');
            seen.map(move |(c, _)| cell(r, c))
        });
        PartialLayout {
            width: 40.0 * rows[0].len() as f64,
            height: 50.0 * rows.len() as f64,
            observed: observed.collect(),
            unknown,
            forbidden: Vec::new(),
        }
    }

    fn weighed_at(partial: &PartialLayout, row: usize, column: usize) -> f64 {
        let observation = Observation::new(partial, partial.observed.clone(), (20.0, 30.0));
        let (x, y) = (40.0 * column as f64 + 10.0, 50.0 * row as f64 + 10.0);
        let window = Element::new(Class::Window, Rect::new(x, y, 20.0, 30.0));
        Scattered::new(&observation).map_or(0.5, |s| s.weighed(&observation, &window, 0.5))
    }

    #[test]
    fn single_windows_hidden_here_and_there_speak_against_a_line_without_any() {
        let scattered = partial(&["#..#.#", "......", "#.##..", ".##..#", "##.#.#"], None);
        // A hole among many is probable, a column or a row that would be hidden whole is not.
        let hole = weighed_at(&scattered, 0, 2);
        assert!(hole > 0.6, "{hole}");
        assert!(weighed_at(&scattered, 2, 4) < 0.15);
        assert!(weighed_at(&scattered, 3, 1) < 0.15);
    }

    #[test]
    fn a_seen_region_says_nothing_of_what_lies_beyond_it() {
        let region = partial(&["......", "......", "###...", "###...", "###..."], None);
        for (row, column) in [(0, 3), (4, 0), (4, 5)] {
            assert_eq!(weighed_at(&region, row, column), 0.5, "{row} {column}");
        }
    }

    #[test]
    fn room_at_a_side_may_hide_a_region() {
        let holes = ["#.#...", "##....", ".##...", "#.#..."];
        assert_eq!(weighed_at(&partial(&holes, None), 1, 4), 0.5);
    }

    #[test]
    fn a_mask_says_it_itself() {
        let rows = ["......", "#..#.#", "#.##..", ".##..#", "##.#.#"];
        let whole = vec![Rect::new(0.0, 0.0, 240.0, 250.0)];
        assert_eq!(weighed_at(&partial(&rows, Some(whole)), 0, 2), 0.5);
    }

    #[test]
    fn few_seen_windows_leave_every_line_possible() {
        let few = partial(&["....", ".#..", "...#", "...."], None);
        assert!(weighed_at(&few, 0, 2) > 0.3);
    }
}
