//! Elements in the cells of a lattice whose lines are given.

use rand::{Rng, RngExt};

use super::by_place::ByPlace;
use super::observation::{Observation, of};
use crate::layout::lines::{LatticeLine, median};
use crate::layout::{Class, Element};
use edifice_shape::Rect;

/// Share of cells of a line that hold a window, before any is seen.
const OCCUPANCY: f64 = 0.9;

/// Probability that a seen shop stands on another column too.
const SHOPS: f64 = 0.5;
/// Probability that a seen door stands on another column too.
const DOORS: f64 = 0.1;

/// Windows, and the balconies that go with them, in the cells that are not known.
///
/// A cell holds a window with the share of windows in the known cells of its row and of its column (with two
/// pseudo-observations of `OCCUPANCY`). Its width is its column's, its height its row's. A window has a balcony
/// with the share of windows with balconies in its row and its column, placed as the nearest one of them.
pub fn fill<R: Rng>(
    observation: &Observation,
    columns: &[LatticeLine],
    rows: &[LatticeLine],
    rng: &mut R,
) -> Vec<Element> {
    let lattice = Lattice::new(observation, columns, rows);
    let facade = [observation.partial.width, observation.partial.height];
    let mut added = ByPlace::new(facade, observation.size, rows.len() * columns.len());
    for (r, row) in rows.iter().enumerate() {
        for (c, column) in columns.iter().enumerate() {
            let cell = lattice.cell(r, c);
            let window = match cell.window {
                Some(window) => window,
                None => {
                    let (wide, high) = (column.size, row.size);
                    let rect = Rect::new(column.at - wide / 2.0, row.at - high / 2.0, wide, high);
                    let element = Element::new(Class::Window, rect);
                    let share = lattice.share(r, c, |cell| cell.window.is_some());
                    if !is_free(observation, &added, &element) || rng.random::<f64>() > share {
                        continue;
                    }
                    added.push(element);
                    rect
                }
            };
            if cell.balcony.is_none()
                && let Some(balcony) = lattice.balcony(r, c, window, rng)
            {
                add(
                    observation,
                    Element::new(Class::Balcony, balcony),
                    &mut added,
                );
            }
        }
    }
    for (class, share) in [(Class::Shop, SHOPS), (Class::Door, DOORS)] {
        for element in of(&observation.elements, class) {
            repeat(observation, element, columns, share, rng, &mut added);
        }
    }
    added.into_elements()
}

/// True if an element may stand there: observed elements are among those of the observation.
fn is_free(observation: &Observation, added: &ByPlace, element: &Element) -> bool {
    !observation.elements.exclude(element)
        && !added.exclude(element)
        && observation.partial.has_room(element)
}

/// Adds an element where it is allowed and free.
fn add(observation: &Observation, element: Element, added: &mut ByPlace) {
    if is_free(observation, added, &element) {
        added.push(element);
    }
}

/// Repeats an element of the ground floor on other columns, at the same offset, each with probability `share`.
fn repeat<R: Rng>(
    observation: &Observation,
    element: &Element,
    columns: &[LatticeLine],
    share: f64,
    rng: &mut R,
    added: &mut ByPlace,
) {
    let x = element.rect.centre().0;
    let near = columns
        .iter()
        .min_by(|a, b| (a.at - x).abs().total_cmp(&(b.at - x).abs()));
    let Some(own) = near else { return };
    for column in columns.iter().filter(|c| c.at != own.at) {
        if rng.random::<f64>() < share {
            let rect = Rect {
                x: element.rect.x + column.at - own.at,
                ..element.rect
            };
            add(observation, Element::new(element.class, rect), added);
        }
    }
}

/// The contents of a cell of the lattice, as seen: known or not, its window, its balcony.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    known: bool,
    window: Option<Rect>,
    balcony: Option<Rect>,
}

struct Lattice {
    columns: usize,
    cells: Vec<Cell>,
    masked: bool,
}

/// The line nearest to a coordinate, within 0.6 of its extent.
fn nearest(lines: &[LatticeLine], at: f64) -> Option<usize> {
    let distance = |line: &LatticeLine| (line.at - at).abs();
    let index =
        (0..lines.len()).min_by(|&a, &b| distance(&lines[a]).total_cmp(&distance(&lines[b])))?;
    (distance(&lines[index]) < 0.6 * lines[index].size).then_some(index)
}

impl Lattice {
    fn new(observation: &Observation, columns: &[LatticeLine], rows: &[LatticeLine]) -> Self {
        let masked = observation.partial.unknown.is_some();
        let mut cells = vec![Cell::default(); columns.len() * rows.len()];
        for (r, row) in rows.iter().enumerate() {
            for (c, column) in columns.iter().enumerate() {
                cells[r * columns.len() + c].known =
                    masked && !observation.partial.is_unknown(column.at, row.at);
            }
        }
        for window in of(&observation.elements, Class::Window) {
            let (x, y) = window.rect.centre();
            if let (Some(c), Some(r)) = (nearest(columns, x), nearest(rows, y)) {
                let cell = &mut cells[r * columns.len() + c];
                (cell.known, cell.window) = (true, Some(window.rect));
            }
        }
        for balcony in of(&observation.elements, Class::Balcony) {
            let b = balcony.rect;
            let Some(c) = nearest(columns, b.centre().0) else {
                continue;
            };
            let wide = b.width > 2.0 * columns[c].size;
            // A balcony reaches over the lower part of its window, or hangs right below it.
            let under = |row: &LatticeLine| b.y < row.at && b.top() > row.at - 0.8 * row.size;
            if let (false, Some(r)) = (wide, rows.iter().position(under)) {
                cells[r * columns.len() + c].balcony = Some(b);
            }
        }
        Self {
            columns: columns.len(),
            cells,
            masked,
        }
    }

    fn cell(&self, r: usize, c: usize) -> Cell {
        self.cells[r * self.columns + c]
    }

    fn row(&self, r: usize) -> impl Iterator<Item = (usize, Cell)> + '_ {
        (0..self.columns).map(move |c| (c, self.cell(r, c)))
    }

    fn column(&self, c: usize) -> impl Iterator<Item = (usize, Cell)> + '_ {
        (0..self.cells.len() / self.columns).map(move |r| (r, self.cell(r, c)))
    }

    /// Probability of a cell from the known cells of its row and its column.
    fn share(&self, r: usize, c: usize, holds: impl Fn(&Cell) -> bool) -> f64 {
        let rate = |cells: &mut dyn Iterator<Item = (usize, Cell)>| {
            let (mut known, mut held) = (2.0, 2.0 * OCCUPANCY);
            for (_, cell) in cells.filter(|(_, cell)| cell.known) {
                known += 1.0;
                held += f64::from(u8::from(holds(&cell)));
            }
            held / known
        };
        let (row, column) = (rate(&mut self.row(r)), rate(&mut self.column(c)));
        (row * column / OCCUPANCY).clamp(0.02, 0.98)
    }

    /// A balcony for a window, drawn by how many windows of the row and the column have one.
    fn balcony<R: Rng>(&self, r: usize, c: usize, window: Rect, rng: &mut R) -> Option<Rect> {
        let pair = |cell: &Cell| Some((cell.window?, cell.balcony));
        let rate = |cells: Vec<(usize, Cell)>| {
            let seen: Vec<bool> = cells
                .iter()
                .filter_map(|(_, cell)| Some(pair(cell)?.1.is_some()))
                .collect();
            let with = seen.iter().filter(|b| **b).count();
            (seen.len(), with as f64 / seen.len().max(1) as f64)
        };
        let (row, column) = (rate(self.row(r).collect()), rate(self.column(c).collect()));
        let share = match (row, column) {
            ((0, _), (0, _)) => 0.0,
            ((0, _), (_, share)) => 0.7 * share,
            ((_, share), (0, _)) => share,
            // The row says more: balconies stand in rows.
            ((_, row), (_, column)) => 0.75 * row + 0.25 * column,
        };
        // Where elements are hidden one by one, a window may be seen without its balcony.
        let share = if self.masked {
            share
        } else {
            (1.6 * share).min(0.98)
        };
        if share <= 0.0 || rng.random::<f64>() > share {
            return None;
        }
        let nearest = |cells: Vec<(usize, Cell)>, own: usize| {
            let with = cells.into_iter().filter_map(|(k, cell)| {
                let (window, balcony) = pair(&cell)?;
                Some((k.abs_diff(own), window, balcony?))
            });
            with.min_by_key(|(distance, ..)| *distance)
        };
        let found =
            nearest(self.row(r).collect(), c).or_else(|| nearest(self.column(c).collect(), r));
        let (_, from, balcony) = found?;
        let (dx, dy) = (balcony.x - from.x, balcony.y - from.y);
        Some(Rect::new(
            window.x + dx,
            window.y + dy,
            balcony.width,
            balcony.height,
        ))
    }
}

/// Lines by position: an observed line as it is, an invented one with the extent of the nearest observed one.
pub fn lines_at(observed: &[LatticeLine], invented: &[f64], typical: f64) -> Vec<LatticeLine> {
    let mut lines = observed.to_vec();
    for &at in invented {
        let near = observed
            .iter()
            .min_by(|a, b| (a.at - at).abs().total_cmp(&(b.at - at).abs()));
        lines.push(LatticeLine {
            at,
            size: near.map_or(typical, |l| l.size),
            count: 0,
        });
    }
    lines.sort_by(|a, b| a.at.total_cmp(&b.at));
    lines
}

/// Median gap of lines; `None` of fewer than two.
pub fn typical_gap(lines: &[LatticeLine]) -> Option<f64> {
    median(lines.windows(2).map(|w| w[1].at - w[0].at))
}
