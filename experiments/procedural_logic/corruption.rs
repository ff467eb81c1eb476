//! Label images as a segmentation gives them: seeded faults of given strength.
//!
//! An *element* is a connected area that fills its bounding rectangle and is not of the most frequent label:
//! a window, a door, a balcony, a piece of roof between two windows. Faults come in this order:
//! - *missing*: a window takes the label around it;
//! - *merged*: the wall between a window and the next one of its row becomes window;
//! - *gaps*: a strip of 2 to 4 px across an element takes the label around it;
//! - *edges*: each side of each element, borders of the image apart, moves by a whole number of pixels,
//!   uniform from `-edges` to `edges`, independently; what an element leaves takes the label beyond that
//!   side;
//! - *specks*: ellipses with half axes of 1 to 3 px and a random other label, at random places, until
//!   they cover the given share of the area.

use rand::{Rng, RngExt};

use edifice_shape::{LabelGrid, Span, components};

/// Label of windows.
const WINDOW: &str = "window";

/// Half axes of specks, in pixels.
const SPECK: std::ops::RangeInclusive<i64> = 1..=3;

/// Width of gaps, in pixels.
const GAP: std::ops::RangeInclusive<usize> = 2..=4;

/// The strength of each fault; zero by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Corruption {
    /// Largest displacement of a side, in pixels.
    pub edges: i64,
    /// Share of the area under specks, 0 to 1.
    pub specks: f64,
    /// Share of the elements with a gap, 0 to 1.
    pub gaps: f64,
    /// Share of the windows merged with the next one, 0 to 1.
    pub merged: f64,
    /// Share of the windows that are missing, 0 to 1.
    pub missing: f64,
}

/// A rectangle of one label, in pixels.
#[derive(Debug, Clone, Copy)]
struct Element {
    label: u16,
    /// `[from, to)` along x and along y.
    range: [[usize; 2]; 2],
}

impl Corruption {
    /// The label image with faults; its columns and rows must be pixels ([`pixels`]).
    pub fn apply<R: Rng>(&self, grid: &LabelGrid, rng: &mut R) -> LabelGrid {
        let mut picture = Picture::new(grid);
        let window = grid.labels.iter().position(|label| label == WINDOW);
        let is_window = |element: &Element| Some(usize::from(element.label)) == window;
        if self.missing > 0.0 {
            for element in picture.elements() {
                if is_window(&element) && rng.random_bool(self.missing) {
                    let around = picture.around(&element);
                    picture.fill(element.range, around);
                }
            }
        }
        if self.merged > 0.0 {
            let windows: Vec<Element> = picture.elements();
            let windows: Vec<Element> = windows.into_iter().filter(is_window).collect();
            for (index, window) in windows.iter().enumerate() {
                if let Some(next) = next_of_row(window, &windows[index + 1..])
                    && rng.random_bool(self.merged)
                {
                    let [across, up] = window.range;
                    picture.fill([[across[1], next.range[0][0]], up], window.label);
                }
            }
        }
        if self.gaps > 0.0 {
            for element in picture.elements() {
                if rng.random_bool(self.gaps) {
                    picture.gap(&element, rng);
                }
            }
        }
        if self.edges > 0 {
            picture.move_edges(self.edges, rng);
        }
        picture.specks(self.specks, rng);
        picture.grid
    }
}

/// The label image on square pixels of side `pitch`, each with the label at its middle.
pub fn pixels(grid: &LabelGrid, pitch: f64) -> LabelGrid {
    let count = |cuts: &[f64]| ((cuts[cuts.len() - 1] / pitch).round() as usize).max(1);
    let cuts = |count: usize| (0..=count).map(|k| k as f64).collect::<Vec<f64>>();
    let find = |cuts: &[f64], n: usize| -> Vec<usize> {
        let middle = |k: usize| (k as f64 + 0.5) * cuts[cuts.len() - 1] / n as f64;
        let cell = |k: usize| cuts.partition_point(|&cut| cut <= middle(k)) - 1;
        (0..n).map(cell).collect()
    };
    let (width, height) = (count(&grid.xs), count(&grid.ys));
    let columns = find(&grid.xs, width);
    let mut cells = Vec::with_capacity(width * height);
    for j in find(&grid.ys, height) {
        cells.extend(columns.iter().map(|&i| grid.at(i, j)));
    }
    LabelGrid {
        name: grid.name.clone(),
        unit: "px".into(),
        xs: cuts(width),
        ys: cuts(height),
        labels: grid.labels.clone(),
        cells,
    }
}

/// The nearest window to the right, of those that come later, in about the same rows and not farther
/// than one and a half times the width.
fn next_of_row<'a>(window: &Element, later: &'a [Element]) -> Option<&'a Element> {
    let [across, up] = window.range;
    let reach = across[1] + (across[1] - across[0]) * 3 / 2;
    let beside = later.iter().filter(|other| {
        let [left, rows] = [other.range[0][0], other.range[1][0]];
        rows.abs_diff(up[0]) <= 2 && left > across[1] && left <= reach
    });
    beside.min_by_key(|other| other.range[0][0])
}

/// A label image of pixels that is being changed.
struct Picture {
    grid: LabelGrid,
}

impl Picture {
    fn new(grid: &LabelGrid) -> Self {
        Self { grid: grid.clone() }
    }

    fn size(&self) -> [usize; 2] {
        [self.grid.columns(), self.grid.rows()]
    }

    fn elements(&self) -> Vec<Element> {
        let [columns, rows] = self.size();
        let mut counts = vec![0_usize; self.grid.labels.len()];
        for &label in &self.grid.cells {
            counts[usize::from(label)] += 1;
        }
        let most = counts.iter().max().copied();
        let whole = Span {
            left: 0,
            right: columns,
            bottom: 0,
            top: rows,
        };
        let found = components(&self.grid, whole, &mut vec![0; columns * rows]);
        let elements = found
            .into_iter()
            .filter(|c| c.is_rectangle() && Some(counts[usize::from(c.label)]) != most);
        elements
            .map(|component| {
                let b = component.bounds;
                Element {
                    label: component.label,
                    range: [[b.left, b.right], [b.bottom, b.top]],
                }
            })
            .collect()
    }

    fn fill(&mut self, range: [[usize; 2]; 2], label: u16) {
        let columns = self.grid.columns();
        let [[left, right], [bottom, top]] = range;
        for y in bottom..top {
            self.grid.cells[y * columns + left..y * columns + right].fill(label);
        }
    }

    /// The most frequent label on the ring of pixels around an element; its own if it is the image.
    fn around(&self, element: &Element) -> u16 {
        let [columns, rows] = self.size();
        let [[left, right], [bottom, top]] = element.range;
        let mut counts = vec![0_usize; self.grid.labels.len()];
        let mut count = |x: usize, y: usize| counts[usize::from(self.grid.at(x, y))] += 1;
        for x in left..right {
            if bottom > 0 {
                count(x, bottom - 1);
            }
            if top < rows {
                count(x, top);
            }
        }
        for y in bottom..top {
            if left > 0 {
                count(left - 1, y);
            }
            if right < columns {
                count(right, y);
            }
        }
        let most = counts.iter().max().copied().filter(|&count| count > 0);
        let label = most.and_then(|most| counts.iter().position(|&count| count == most));
        label.map_or(element.label, |label| label as u16)
    }

    /// Cuts an element across its longer side.
    fn gap<R: Rng>(&mut self, element: &Element, rng: &mut R) {
        let length = |axis: usize| element.range[axis][1] - element.range[axis][0];
        let axis = usize::from(length(1) > length(0));
        let width = rng.random_range(GAP);
        if length(axis) < width + 2 {
            return;
        }
        let from = element.range[axis][0] + rng.random_range(1..length(axis) - width);
        let mut range = element.range;
        range[axis] = [from, from + width];
        let around = self.around(element);
        self.fill(range, around);
    }

    /// Moves the sides of every element, in the order of their lower left pixels.
    fn move_edges<R: Rng>(&mut self, most: i64, rng: &mut R) {
        let size = self.size();
        let before = self.grid.clone();
        for element in self.elements() {
            let old = element.range;
            let mut new = old;
            for axis in 0..2 {
                for side in 0..2 {
                    let step = rng.random_range(-most..=most);
                    let place = old[axis][side];
                    if place > 0 && place < size[axis] {
                        let moved = (place as i64 + step).clamp(0, size[axis] as i64);
                        new[axis][side] = moved as usize;
                    }
                }
                if new[axis][0] >= new[axis][1] {
                    new[axis] = old[axis];
                }
            }
            let inside = |x: usize, y: usize| {
                (new[0][0]..new[0][1]).contains(&x) && (new[1][0]..new[1][1]).contains(&y)
            };
            for y in old[1][0]..old[1][1] {
                for x in old[0][0]..old[0][1] {
                    if inside(x, y) {
                        continue;
                    }
                    let (x0, y0) = if x < new[0][0] {
                        (old[0][0] - 1, y)
                    } else if x >= new[0][1] {
                        (old[0][1], y)
                    } else if y < new[1][0] {
                        (x, old[1][0] - 1)
                    } else {
                        (x, old[1][1])
                    };
                    self.grid.cells[y * size[0] + x] = before.at(x0, y0);
                }
            }
            self.fill(new, element.label);
        }
    }

    /// Covers a share of the area with specks.
    fn specks<R: Rng>(&mut self, share: f64, rng: &mut R) {
        let [columns, rows] = self.size();
        let labels = self.grid.labels.len();
        if labels < 2 {
            return;
        }
        let wanted = share * (columns * rows) as f64;
        let mut covered = 0;
        while (covered as f64) < wanted {
            let centre = [rng.random_range(0..columns), rng.random_range(0..rows)];
            let half = [rng.random_range(SPECK), rng.random_range(SPECK)];
            let under = usize::from(self.grid.at(centre[0], centre[1]));
            let label = (under + rng.random_range(1..labels)) % labels;
            for dy in -half[1]..=half[1] {
                for dx in -half[0]..=half[0] {
                    let (x, y) = (centre[0] as i64 + dx, centre[1] as i64 + dy);
                    let inside = dx * dx * half[1] * half[1] + dy * dy * half[0] * half[0]
                        <= half[0] * half[0] * half[1] * half[1];
                    let there = (0..columns as i64).contains(&x) && (0..rows as i64).contains(&y);
                    if inside && there {
                        self.grid.cells[y as usize * columns + x as usize] = label as u16;
                        covered += 1;
                    }
                }
            }
        }
    }
}
