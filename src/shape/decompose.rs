//! From a label grid to a tiling of rectangles that full lines can split (Wu et al. 2014, Sec. 3.1).
//!
//! Areas of equal label that are rectangles (windows, doors, ...) should stay whole; others (the wall
//! around windows) must be cut. The rule, applied to the whole facade and then to every part:
//!
//! 1. A part of one label is a terminal.
//! 2. A full line of a part is *clean* when it runs along an edge of every area of the part that it
//!    crosses: no rectangle is ever crossed, and other areas only where they have a corner anyway.
//! 3. Cut along all clean horizontal lines (floors first); if there is none, along all clean vertical
//!    ones. Since a cut in one direction leaves no further clean line in that direction, directions
//!    alternate.
//! 4. If there is no clean line (interlocked elements), cut along the one full line on a label edge
//!    that crosses the fewest rectangles of the whole picture; then the fewest areas of the part that
//!    it does not run along; then the shortest length of those; then horizontal before vertical; then
//!    the lowest position. Elements that end up in pieces are reported.
//!
//! Every cut depends on the content of its part only, so that equal parts are cut equally, wherever
//! they are.

use super::components::{Component, components};
use super::{Axis, Facade, GridError, LabelGrid, Rect, Region, Span};

/// A tiling made from a label grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Decomposition {
    /// The tiling; regions from the bottom up, then from the left.
    pub facade: Facade,
    /// Rectangular areas of the picture that could not stay whole.
    pub cut_elements: Vec<Region>,
    /// Areas of the picture: rectangles, and others.
    pub areas: (usize, usize),
}

/// Decomposes a label grid into a tiling that is always splittable by full lines and paints exactly
/// the same picture. O(cells) for each level of nesting.
///
/// # Errors
/// [`GridError`] when the grid is not [valid](LabelGrid::check).
pub fn decompose(grid: &LabelGrid) -> Result<Decomposition, GridError> {
    grid.check()?;
    let grid = grid.merged();
    let whole = Span {
        left: 0,
        right: grid.columns(),
        bottom: 0,
        top: grid.rows(),
    };
    let mut element_of = vec![0; grid.cells.len()];
    let elements = components(&grid, whole, &mut element_of);
    let mut cutter = Cutter {
        area_of: vec![0; grid.cells.len()],
        seen: vec![0; elements.len()],
        stamp: 0,
        grid: &grid,
        element_of: &element_of,
        elements: &elements,
    };
    let mut terminals = Vec::new();
    let mut parts = vec![whole];
    while let Some(part) = parts.pop() {
        match cutter.cuts(part) {
            Some((axis, lines)) => parts.extend(pieces(part, axis, &lines)),
            None => terminals.push(part),
        }
    }
    terminals.sort_unstable_by_key(|t| (t.bottom, t.left));

    let mut pieces_of = vec![0; elements.len()];
    for t in &terminals {
        pieces_of[element_of[t.bottom * grid.columns() + t.left] as usize] += 1;
    }
    let rectangles = || {
        elements
            .iter()
            .zip(&pieces_of)
            .filter(|(e, _)| e.is_rectangle())
    };
    let cut = rectangles().filter(|&(_, &pieces)| pieces > 1);
    let label_at = |t: Span| grid.at(t.left, t.bottom);
    let regions = terminals.iter().map(|&t| region(&grid, t, label_at(t)));
    Ok(Decomposition {
        cut_elements: cut.map(|(e, _)| region(&grid, e.bounds, e.label)).collect(),
        areas: (rectangles().count(), elements.len() - rectangles().count()),
        facade: Facade::new(
            grid.name.clone(),
            grid.unit.clone(),
            grid.xs[grid.columns()],
            grid.ys[grid.rows()],
            regions.collect(),
        )?,
    })
}

/// A span of the grid as a region.
fn region(grid: &LabelGrid, span: Span, label: u16) -> Region {
    let (x, y) = (grid.xs[span.left], grid.ys[span.bottom]);
    Region {
        label: grid.labels[usize::from(label)].clone(),
        rect: Rect::new(x, y, grid.xs[span.right] - x, grid.ys[span.top] - y),
    }
}

/// The pieces of a part between increasing cut lines.
fn pieces(part: Span, axis: Axis, lines: &[usize]) -> Vec<Span> {
    let (start, end) = part.along(axis);
    let starts = [start].into_iter().chain(lines.iter().copied());
    let ends = lines.iter().copied().chain([end]);
    let piece = |(from, to)| match axis {
        Axis::X => Span {
            left: from,
            right: to,
            ..part
        },
        Axis::Y => Span {
            bottom: from,
            top: to,
            ..part
        },
    };
    starts.zip(ends).map(piece).collect()
}

/// Finds the lines to cut parts along.
struct Cutter<'a> {
    grid: &'a LabelGrid,
    /// Areas of the whole picture, and the one of each cell.
    elements: &'a [Component],
    element_of: &'a [u32],
    /// Area of each cell within the part at hand.
    area_of: Vec<u32>,
    /// Marks of elements or areas met on a line, valid when equal to a stamp.
    seen: Vec<u64>,
    stamp: u64,
}

/// The cost of a line, compared in order: rectangles crossed, areas crossed uncleanly, their length on the line.
type Badness = (usize, usize, f64);

impl Cutter<'_> {
    /// The lines to cut a part along, increasing; `None` for a part of one label.
    fn cuts(&mut self, part: Span) -> Option<(Axis, Vec<usize>)> {
        let areas = components(self.grid, part, &mut self.area_of);
        if areas.len() == 1 {
            return None;
        }
        let mut marks = Marks::new(areas.len());
        let mut worst: Option<(Badness, Axis, usize)> = None;
        for axis in [Axis::Y, Axis::X] {
            let (start, end) = part.along(axis);
            let mut clean = Vec::new();
            for line in start + 1..end {
                if !self.meet(part, axis, line, &mut marks) {
                    continue;
                }
                if marks.unclean().next().is_none() {
                    clean.push(line);
                }
            }
            if !clean.is_empty() {
                return Some((axis, clean));
            }
        }
        for axis in [Axis::Y, Axis::X] {
            let (start, end) = part.along(axis);
            for line in start + 1..end {
                if !self.meet(part, axis, line, &mut marks) {
                    continue;
                }
                let badness = self.badness(part, axis, line, &marks);
                if worst.is_none_or(|(least, ..)| less(badness, least)) {
                    worst = Some((badness, axis, line));
                }
            }
        }
        worst.map(|(_, axis, line)| (axis, vec![line]))
    }

    /// The cells on both sides of a line across `axis`, with the length of their common side.
    fn sides(
        &self,
        part: Span,
        axis: Axis,
        line: usize,
    ) -> impl Iterator<Item = (usize, usize, f64)> {
        let columns = self.grid.columns();
        let (start, end) = part.along(axis.other());
        let cuts = match axis {
            Axis::X => &self.grid.ys,
            Axis::Y => &self.grid.xs,
        };
        (start..end).map(move |k| {
            let (before, after) = match axis {
                Axis::X => (k * columns + line - 1, k * columns + line),
                Axis::Y => ((line - 1) * columns + k, line * columns + k),
            };
            (before, after, cuts[k + 1] - cuts[k])
        })
    }

    /// Notes the areas that a line crosses and runs along; whether it lies on any label edge.
    fn meet(&self, part: Span, axis: Axis, line: usize, marks: &mut Marks) -> bool {
        marks.clear();
        let mut on_edge = false;
        for (before, after, _) in self.sides(part, axis, line) {
            let (a, b) = (self.area_of[before], self.area_of[after]);
            if a == b {
                marks.cross(a);
            } else {
                marks.run_along(a);
                marks.run_along(b);
                on_edge = true;
            }
        }
        on_edge
    }

    fn badness(&mut self, part: Span, axis: Axis, line: usize, marks: &Marks) -> Badness {
        self.stamp += 1;
        let mut crossed = Vec::new();
        let mut length = 0.0;
        for (before, after, side) in self.sides(part, axis, line) {
            let area = self.area_of[before];
            if area != self.area_of[after] {
                continue;
            }
            crossed.push(self.element_of[before] as usize);
            if !marks.runs_along(area) {
                length += side;
            }
        }
        let mut rectangles = 0;
        for element in crossed {
            let new = std::mem::replace(&mut self.seen[element], self.stamp) != self.stamp;
            rectangles += usize::from(new && self.elements[element].is_rectangle());
        }
        (rectangles, marks.unclean().count(), length)
    }
}

fn less(a: Badness, b: Badness) -> bool {
    (a.0, a.1)
        .cmp(&(b.0, b.1))
        .then(a.2.total_cmp(&b.2))
        .is_lt()
}

/// The areas that one line crosses, and those that it runs along.
struct Marks {
    stamp: u32,
    crossed_at: Vec<u32>,
    along_at: Vec<u32>,
    crossed: Vec<u32>,
}

impl Marks {
    fn new(areas: usize) -> Self {
        Self {
            stamp: 0,
            crossed_at: vec![0; areas],
            along_at: vec![0; areas],
            crossed: Vec::new(),
        }
    }

    fn clear(&mut self) {
        self.stamp += 1;
        self.crossed.clear();
    }

    fn cross(&mut self, area: u32) {
        let mark = &mut self.crossed_at[area as usize];
        if std::mem::replace(mark, self.stamp) != self.stamp {
            self.crossed.push(area);
        }
    }

    fn run_along(&mut self, area: u32) {
        self.along_at[area as usize] = self.stamp;
    }

    fn runs_along(&self, area: u32) -> bool {
        self.along_at[area as usize] == self.stamp
    }

    /// Areas that the line crosses but does not run along.
    fn unclean(&self) -> impl Iterator<Item = u32> {
        self.crossed
            .iter()
            .copied()
            .filter(|&a| !self.runs_along(a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::splittable;
    use proptest::prelude::*;

    /// A grid of unit cells from a picture, the top row first, one letter a label.
    fn picture(rows: &[&str]) -> LabelGrid {
        let (columns, count) = (rows[0].len(), rows.len());
        let letters = rows.iter().rev().flat_map(|row| row.bytes());
        LabelGrid {
            name: "p".into(),
            unit: "px".into(),
            xs: (0..=columns).map(|k| k as f64).collect(),
            ys: (0..=count).map(|k| k as f64).collect(),
            labels: (b'a'..=b'z').map(|c| (c as char).to_string()).collect(),
            cells: letters.map(|c| u16::from(c - b'a')).collect(),
        }
    }

    fn checked(grid: &LabelGrid) -> Decomposition {
        let result = decompose(grid).unwrap();
        assert_eq!(splittable(&result.facade), Ok(()));
        let repainted = LabelGrid::from_facade(&result.facade, None).unwrap();
        assert_eq!(repainted.merged(), grid.merged());
        result
    }

    #[test]
    fn floors_come_first() {
        let result = checked(&picture(&["aaaaa", "abaca", "aaaaa"]));
        // Three strips, the middle one of five.
        assert_eq!(result.facade.regions.len(), 7);
        assert_eq!(result.facade.regions[0].rect, Rect::new(0.0, 0.0, 5.0, 1.0));
        assert_eq!(result.areas, (2, 1));
        assert!(result.cut_elements.is_empty());
    }

    #[test]
    fn a_window_one_pixel_higher_forces_only_its_own_sliver() {
        let result = checked(&picture(&["aaaaa", "aaaba", "abaaa", "abaaa", "aaaba"]));
        let wall_slivers = result
            .facade
            .regions
            .iter()
            .filter(|r| r.rect.area() == 1.0);
        assert_eq!(result.cut_elements, []);
        assert!(wall_slivers.count() <= 4);
    }

    #[test]
    fn lines_that_would_cross_an_element_wait() {
        // The pillar c blocks every horizontal line: columns first.
        let result = checked(&picture(&["aacdd", "bbcdd", "bbcee"]));
        assert_eq!(result.facade.regions.len(), 5);
        assert_eq!(result.cut_elements, []);
    }

    #[test]
    fn other_areas_are_crossed_only_at_their_corners() {
        // The L of b is cut at its own corner, not where c ends.
        let result = checked(&picture(&["bad", "bad", "bbd", "ccd", "cce"]));
        assert_eq!(result.facade.regions.len(), 6);
    }

    #[test]
    fn a_pinwheel_costs_one_element() {
        let result = checked(&picture(&["abb", "aec", "ddc"]));
        assert_eq!(result.cut_elements.len(), 1);
        assert_eq!(result.facade.regions.len(), 6);
    }

    /// Pictures of a few rectangles over a wall.
    fn pictures() -> impl Strategy<Value = LabelGrid> {
        prop::collection::vec((0usize..8, 0usize..8, 1usize..4, 1usize..4, 0u16..4), 0..9).prop_map(
            |rects| {
                let mut grid = picture(&["aaaaaaaaaa"; 10]);
                for (x, y, w, h, label) in rects {
                    for j in y..(y + h).min(10) {
                        for i in x..(x + w).min(10) {
                            grid.cells[j * 10 + i] = label;
                        }
                    }
                }
                grid
            },
        )
    }

    proptest! {
        #[test]
        fn always_splittable_and_exact(grid in pictures()) {
            let result = checked(&grid);
            let cut: usize = result.cut_elements.len();
            prop_assert!(cut <= result.areas.0);
            prop_assert!(result.facade.regions.len() >= result.areas.0 + result.areas.1);
        }

        #[test]
        fn noise_is_decomposed_too(cells in prop::collection::vec(0u16..2, 36)) {
            let mut grid = picture(&["aaaaaa"; 6]);
            grid.cells = cells;
            checked(&grid);
        }
    }
}
