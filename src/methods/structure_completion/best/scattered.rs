//! Evidence of the seen lines for windows where no mask tells what is hidden.
//!
//! Without a mask a window that is not seen may be hidden or not there. The completed matrix of cells of the seen rows and
//! columns (soft-impute, Mazumder et al. 2010; the baseline of Fig. 19) tells how many are hidden among those that are seen.
//! Single windows are hidden here and there where two things hold: a share q of its filled cells that is well below 1 is seen,
//! and the seen lines reach the sides of the facade, so that no half and no corner of it can be what is hidden. Then two things
//! follow that the features of a candidate do not hold:
//!
//! - A line of m windows on which none is seen would have to be hidden whole, with probability `(1 - q)^m`, q now without the
//!   bias that each seen line has at least one seen window. Where that is below a limit ([`RARE`]), its windows are so much less
//!   probable, whether the chain, a mirror image or another facade proposes them.
//! - A cell of a seen row and a seen column is judged by the other rows and columns, too: its probability is a mean of what
//!   was learnt and of the completed matrix. Among the candidates of one cell the learnt order stays.
//!
//! How far the completed matrix is believed depends on the agreement of the rows. Of the cells that three seen windows at the
//! corners of a rectangle imply, a share a is seen ([`Cells::closed`]). If windows of a full grid were hidden at random, a would be the share d of
//! all cells that is seen; `kappa = (a - d) / (1 - d)` is the agreement beyond this (the form of Cohen 1960).
//! Lines of which no window is seen are missing among the cells, so that d is too large: the kappa of windows hidden at random is
//! below 0, and 0 is beyond chance. Rows that agree
//! beyond chance show the layout of the facade itself, with gaps that are its own: there the matrix alone is believed, also when it
//! says that nothing is hidden, and a window is added only where it is nearly as probable as not ([`SHOWN`]).

use super::candidates::Candidates;
use super::observation::{Observation, of};
use super::{at_most, bare};
use crate::baselines::{Cells, cells};
use crate::layout::lines::LatticeLine;
use crate::layout::{Class, Element};
use crate::partial::PartialLayout;
use edifice_shape::{Axis, Rect};

/// A window is on a seen line when its centre is nearer than this share of the typical extent.
const ON_LINE: f64 = 0.35;
/// A line that is hidden whole with at least this probability is none that speaks against itself: parts of facades that are
/// hidden so were learnt from. Where rows agree by chance, and where they agree beyond it.
const RARE: [f64; 2] = [0.2, 0.5];
/// Share of the completed matrix in the probability of a cell, by agreement as before.
const BELIEF: [f64; 2] = [0.5, 1.0];
/// Shares of the filled cells that are seen, where rows agree by chance: up to the first, single windows are hidden; from the
/// second on, a region. Where they agree beyond it no share speaks for a region.
const SINGLE: [f64; 2] = [0.8, 0.95];
/// Agreement of rows: up to the first that of chance, from the second on beyond it.
const AGREEMENT: [f64; 2] = [-0.2, 0.0];
/// Seen windows: up to the first they agree by chance, from the second on agreement says something.
const ENOUGH: [f64; 2] = [6.0, 12.0];
/// Share of all cells that is seen: up to the first, rows can agree beyond chance; from the second on there is nothing to agree
/// on.
const GAPS: [f64; 2] = [0.8, 0.95];
/// Least value of a window that is added where rows agree beyond chance.
const SHOWN: f64 = 0.4;
/// Least learnt probability of the best candidate of a cell, so that a cell of which little was learnt can be raised.
const LEAST: f64 = 0.05;
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
    /// Degree to which rows agree beyond chance, from 0 to 1.
    agreement: f64,
    /// Factor of a window on a column and on a row that would be hidden whole.
    hidden: [f64; 2],
}

/// The place of a window.
enum Place {
    /// In the cell of a seen row and a seen column.
    Cell(usize),
    /// On a line of which no window is seen; with the factor of its probability.
    Unseen(f64),
}

/// Changes the probabilities of windows at both overlaps, one for each of the first candidates; with a mask none. Returns the
/// least value of a window that may be added.
pub(crate) fn weigh(
    observation: &Observation,
    candidates: &Candidates,
    [loose, tight]: [&mut [f64]; 2],
) -> f64 {
    let Some(seen) = seen(observation) else {
        return 0.0;
    };
    let cells = cells(observation.partial, &seen);
    if let Some(closed) = cells.closed() {
        bare::weigh(&seen, closed, &candidates.all, [&mut *loose, &mut *tight]);
    }
    let Some(scattered) = Scattered::new(observation, cells) else {
        return 0.0;
    };
    let places: Vec<Option<Place>> = candidates
        .all
        .iter()
        .map(|c| {
            let is_window = c.element.class == Class::Window;
            is_window.then(|| scattered.place(observation, &c.element))
        })
        .collect();
    // What was learnt of a cell is the probability of its best candidate.
    let mut learnt = vec![LEAST; scattered.cells.count()];
    for (place, probability) in places.iter().zip(loose.iter()) {
        if let Some(Place::Cell(cell)) = place {
            learnt[*cell] = learnt[*cell].max(*probability);
        }
    }
    let each = places.iter().zip(loose.iter_mut().zip(tight));
    for (place, (loose, tight)) in each {
        let factor = match place {
            Some(Place::Cell(cell)) => scattered.of_cell(*cell, learnt[*cell]) / learnt[*cell],
            Some(Place::Unseen(factor)) => *factor,
            None => continue,
        };
        *loose = (*loose * factor).min(1.0);
        *tight = (*tight * factor).min(1.0);
    }
    SHOWN * scattered.single * scattered.agreement
}

/// The seen windows; `None` with a mask, and of none.
fn seen(observation: &Observation) -> Option<Vec<Rect>> {
    let windows = of(&observation.elements, Class::Window).map(|e| e.rect);
    let windows: Vec<Rect> = windows.collect();
    (observation.partial.unknown.is_none() && !windows.is_empty()).then_some(windows)
}

impl Scattered {
    /// `None` where one region is hidden.
    fn new(observation: &Observation, cells: Cells) -> Option<Self> {
        let seen = cells.observed as f64;
        let filled = (cells.filled() as f64).max(seen);
        let share = seen / filled;
        let agreement = agreement(&cells);
        let single = mix([at_most(share, SINGLE), 1.0], agreement);
        let single = single * reach(observation.partial, &cells);
        let hidden = [cells.columns.len(), cells.rows.len()].map(|lines| {
            // Each line has a seen window because it would not be a line otherwise; the fewest that give every line one
            // say nothing of the share.
            let cover = cells.columns.len().max(cells.rows.len()) as f64;
            let share = (seen - cover) / (filled - cover).max(1.0);
            let whole = (1.0 - share).powf(filled / lines as f64);
            1.0 - single + single * (whole / mix(RARE, agreement)).min(1.0)
        });
        (single > 0.0).then_some(Self {
            cells,
            single,
            agreement,
            hidden,
        })
    }

    fn place(&self, observation: &Observation, window: &Element) -> Place {
        let (x, y) = window.rect.centre();
        let on = |lines: &[LatticeLine], at: f64, axis: Axis| {
            let near = |l: &LatticeLine| (l.at - at).abs() < ON_LINE * observation.extent(axis);
            lines.iter().position(near)
        };
        let (columns, rows) = (&self.cells.columns, &self.cells.rows);
        match (on(rows, y, Axis::Y), on(columns, x, Axis::X)) {
            (Some(row), Some(column)) => Place::Cell(row * columns.len() + column),
            (Some(_), None) => Place::Unseen(self.hidden[0]),
            (None, Some(_)) => Place::Unseen(self.hidden[1]),
            (None, None) => Place::Unseen(self.hidden[0].min(self.hidden[1])),
        }
    }

    /// Probability of a window in a cell of which a probability was learnt.
    fn of_cell(&self, cell: usize, learnt: f64) -> f64 {
        let completed = self.cells.value(cell).clamp(0.0, 1.0);
        let belief = self.single * mix(BELIEF, self.agreement);
        learnt + belief * (completed - learnt)
    }
}

/// The first of two values at 0, the second at 1, a straight line between them.
fn mix([first, second]: [f64; 2], share: f64) -> f64 {
    first + share * (second - first)
}

/// Degree to which rows agree beyond chance, from 0 to 1.
fn agreement(cells: &Cells) -> f64 {
    let seen = cells.seen.iter().filter(|seen| **seen).count() as f64 / cells.count() as f64;
    let Some(closed) = cells.closed().filter(|_| seen < GAPS[1]) else {
        return 0.0;
    };
    let kappa = (closed - seen) / (1.0 - seen);
    let enough = 1.0 - at_most(cells.observed as f64, ENOUGH);
    (1.0 - at_most(kappa, AGREEMENT)) * enough * at_most(seen, GAPS)
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
    use rand::RngExt;

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
        let scattered =
            seen(&observation).and_then(|seen| Scattered::new(&observation, cells(partial, &seen)));
        scattered.map_or(0.5, |s| match s.place(&observation, &window) {
            Place::Cell(cell) => s.of_cell(cell, 0.5),
            Place::Unseen(factor) => 0.5 * factor,
        })
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

    /// Rows of a picture of so many columns and rows.
    fn picture(
        columns: usize,
        rows: usize,
        mut on: impl FnMut(usize, usize) -> bool,
    ) -> Vec<String> {
        let mut row = |r| {
            (0..columns)
                .map(|c| if on(c, r) { '#' } else { '.' })
                .collect()
        };
        (0..rows).map(&mut row).collect()
    }

    #[test]
    fn windows_hidden_at_random_agree_less_than_kinds_of_rows() {
        let mut rng = edifice_base::rng::stream(3, "agreement", 0);
        let mut means = [0.0; 2];
        for round in 0..2000 {
            let (columns, rows) = (rng.random_range(1..12), rng.random_range(1..10));
            let shown = rng.random_range(0.2..0.9);
            let random = picture(columns, rows, |c, r| {
                (c, r) == (0, 0) || rng.random::<f64>() < shown
            });
            // Each row is one of two kinds, which share no column; none is hidden.
            let kinds = picture(2 * columns, rows + 1, |c, r| (c < columns) == (r % 2 == 0));
            for (mean, rows) in means.iter_mut().zip([random, kinds]) {
                let rows: Vec<&str> = rows.iter().map(String::as_str).collect();
                let partial = partial(&rows, None);
                let windows: Vec<Rect> = partial.observed.iter().map(|e| e.rect).collect();
                let own = agreement(&cells(&partial, &windows));
                assert!((0.0..=1.0).contains(&own), "{round}: {own} {rows:?}");
                *mean += own / 2000.0;
            }
        }
        println!("{means:?}");
        assert!(means[0] < 0.3 && means[1] > 0.5, "{means:?}");
    }

    #[test]
    fn rows_that_agree_beyond_chance_show_gaps_of_their_own() {
        let agreement_of = |rows: &[&str]| {
            let partial = partial(rows, None);
            let windows: Vec<Rect> = partial.observed.iter().map(|e| e.rect).collect();
            agreement(&cells(&partial, &windows))
        };
        // Two kinds of rows, each as often as the other.
        let kinds = ["#.#.#.#", ".#.#.#.", "#.#.#.#", ".#.#.#."];
        assert_eq!(agreement_of(&kinds), 1.0);
        // Windows of a full grid, here and there.
        let random = ["#..#.#.", ".##...#", "#...##.", "..##..#", "##..#.."];
        assert!(agreement_of(&random) < 0.3);
        // Full rows have nothing to agree on, and one row no other.
        assert_eq!(agreement_of(&["####", "####", "####"]), 0.0);
        assert_eq!(agreement_of(&["#..##"]), 0.0);
        // A column of another kind of row is then not filled.
        let gap = weighed_at(&partial(&kinds, None), 0, 0);
        assert!(gap < 0.1, "{gap}");
    }
}
