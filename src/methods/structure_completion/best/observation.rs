//! The lattice of a partial layout: lines of its windows, the share of them that is seen, typical sizes.

use super::by_place::ByPlace;
use crate::layout::lines::{LatticeLine, lines, median};
use crate::layout::{Class, Element};
use crate::partial::PartialLayout;
use edifice_shape::{Axis, Rect};

/// Share of the cells of a lattice that hold a window, where nothing else is known.
const OCCUPANCY: f64 = 0.9;

/// Without a mask: up to the first share of its cells a lattice is taken as seen element by element, from the second on as
/// seen in one region.
const REGION: [f64; 2] = [0.65, 0.85];

/// Up to this share of its cells a lattice may be seen element by element.
pub(super) const SCATTERED: f64 = REGION[0];

/// A partial layout with the lattice of its elements.
#[derive(Debug, Clone)]
pub struct Observation<'a> {
    /// The partial layout to complete.
    pub partial: &'a PartialLayout,
    /// Observed elements, and those that are taken as observed (mirrored ones).
    pub elements: ByPlace,
    /// Columns of the windows.
    pub columns: Vec<LatticeLine>,
    /// Rows of the windows, from the bottom.
    pub rows: Vec<LatticeLine>,
    /// Typical width and height of a window.
    pub size: (f64, f64),
    /// Share of the cells of the observed lattice that hold an observed window.
    pub seen: f64,
}

impl<'a> Observation<'a> {
    /// The lattice of `elements`; `fallback` is a typical window size where there is no window.
    pub fn new(partial: &'a PartialLayout, elements: Vec<Element>, fallback: (f64, f64)) -> Self {
        let windows: Vec<Rect> = of(&elements, Class::Window).map(|e| e.rect).collect();
        let wide = median(windows.iter().map(|r| r.width)).unwrap_or(fallback.0);
        let high = median(windows.iter().map(|r| r.height)).unwrap_or(fallback.1);
        let (rows, _) = lines(&windows, Axis::Y);
        let across = standing(&elements, (wide, high));
        let (columns, _) = lines(&across, Axis::X);
        let cells = (columns.len() * rows.len()) as f64;
        let seen = if cells > 0.0 {
            windows.len() as f64 / cells
        } else {
            0.0
        };
        let facade = [partial.width, partial.height];
        let mut by_place = ByPlace::new(facade, (wide, high), elements.len());
        elements.into_iter().for_each(|e| by_place.push(e));
        Self {
            partial,
            elements: by_place,
            columns,
            rows,
            size: (wide, high),
            seen,
        }
    }

    /// Rectangles that stand on the columns, as `standing` gives them.
    pub fn standing(&self) -> Vec<Rect> {
        standing(&self.elements, self.size)
    }

    /// The lines along an axis.
    pub fn lines(&self, axis: Axis) -> &[LatticeLine] {
        match axis {
            Axis::X => &self.columns,
            Axis::Y => &self.rows,
        }
    }

    /// Typical extent of a window along an axis.
    pub fn extent(&self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.size.0,
            Axis::Y => self.size.1,
        }
    }

    /// Length of the facade along an axis.
    pub fn length(&self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.partial.width,
            Axis::Y => self.partial.height,
        }
    }

    /// Factor of an invented line at `at` along `axis`: for each crossing line, how probable it is that its
    /// cell shows no window though there is one. Without a mask, beyond the seen lines, this is mixed with 1 by the
    /// probability that a region is seen.
    pub fn evidence(&self, axis: Axis, at: f64) -> f64 {
        let crossing = self.lines(axis.other());
        let factor = |line: &LatticeLine| {
            let (x, y) = match axis {
                Axis::X => (at, line.at),
                Axis::Y => (line.at, at),
            };
            match &self.partial.unknown {
                None => 1.0 - OCCUPANCY * self.seen.min(0.95),
                Some(_) if self.partial.is_unknown(x, y) => 1.0,
                Some(_) => 1.0 - OCCUPANCY,
            }
        };
        let scattered = crossing.iter().map(factor).product::<f64>();
        // Without a mask, a lattice that is seen nearly whole is a part of the facade that is seen, and says nothing of
        // what lies beyond it.
        let beyond = match (&self.partial.unknown, self.lines(axis)) {
            (None, [first, .., last]) => at < first.at || at > last.at,
            _ => false,
        };
        let region = match beyond {
            true => ((self.seen - REGION[0]) / (REGION[1] - REGION[0])).clamp(0.0, 0.95),
            false => 0.0,
        };
        (region + (1.0 - region) * scattered).max(1e-12)
    }
}

/// Rectangles that stand on the columns: for each balcony of one window a rectangle of the typical `size` of a window
/// before which it hangs, as the window may be hidden itself; then the windows in their order.
fn standing(elements: &[Element], (wide, high): (f64, f64)) -> Vec<Rect> {
    let narrow = of(elements, Class::Balcony).filter(|b| b.rect.width < 2.0 * wide);
    let behind = narrow.map(|b| {
        let x = b.rect.centre().0;
        Rect::new(x - wide / 2.0, b.rect.y, wide, high)
    });
    let windows = of(elements, Class::Window).map(|e| e.rect);
    behind.chain(windows).collect()
}

/// The elements of a class.
pub fn of(elements: &[Element], class: Class) -> impl Iterator<Item = &Element> {
    elements.iter().filter(move |e| e.class == class)
}
