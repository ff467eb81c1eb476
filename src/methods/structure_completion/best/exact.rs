//! Exact lattices: the seen windows are some cells of one lattice of equal windows, equal gaps and equal margins.
//!
//! With columns `x_0 + k g` and rows `y_0 + k h`, the seen windows fix `x_0, y_0, g, h` (`g` and `h` are the least gaps of
//! seen lines, and the other gaps are multiples of them). Of all numbers of lines that hold the seen ones and stay within
//! the outline, the largest with equal margins is meant. The lattice is the completion that takes the fewest numbers to
//! write down; it is proposed where
//!
//! - windows have one size, and lines one gap, up to 0.02 of a window's extent (a measured facade has no such luck by chance);
//! - at least 3 windows are seen, on at least 2 columns and 2 rows;
//! - no cell of it lies on known wall, or where another element is seen.
//!
//! Margins that are equal up to a fiftieth of the gap are equal.

use super::observation::{Observation, of};
use super::regular::clash;
use crate::layout::{Class, Element};
use edifice_shape::{Axis, Rect};

/// Exact up to this share of the extent of a window.
const EXACT: f64 = 0.02;
/// Least number of seen windows.
const LEAST: usize = 3;

/// The hidden windows of the exact lattice; `None` where the seen ones are none of one, or all of it.
pub(super) fn hidden(observation: &Observation) -> Option<Vec<Element>> {
    let seen: Vec<Rect> = of(&observation.elements, Class::Window)
        .map(|e| e.rect)
        .collect();
    if seen.len() < LEAST {
        return None;
    }
    let [(columns, width), (rows, height)] = [
        lattice_of(observation, &seen, Axis::X)?,
        lattice_of(observation, &seen, Axis::Y)?,
    ];
    let mut hidden = Vec::new();
    for &y in &rows {
        for &x in &columns {
            let rect = Rect::new(x - width / 2.0, y - height / 2.0, width, height);
            let window = Element::new(Class::Window, rect);
            if seen.iter().any(|s| s.overlap(&rect) > 0.5 * rect.area()) {
                continue;
            }
            if observation.elements.iter().any(|e| clash(e, &window)) {
                return None;
            }
            hidden.push(with_room(observation, window)?);
        }
    }
    (!hidden.is_empty()).then_some(hidden)
}

/// A centre this near to the edge of an unknown rectangle, in units of the facade, is on it: rounding only.
const EDGE: f64 = 1e-9;

/// The window where there is room for it, on the unknown side of an edge that its centre is on.
fn with_room(observation: &Observation, window: Element) -> Option<Element> {
    let (dx, dy) = (
        EDGE * observation.partial.width,
        EDGE * observation.partial.height,
    );
    let ways = [(0.0, 0.0), (dx, 0.0), (-dx, 0.0), (0.0, dy), (0.0, -dy)];
    let mut moved = ways.into_iter().map(|(x, y)| {
        let mut window = window;
        window.rect.x += x;
        window.rect.y += y;
        window
    });
    moved.find(|w| observation.partial.has_room(w))
}

/// Centres of the lines of the exact lattice along an axis, and the extent of its windows.
fn lattice_of(observation: &Observation, seen: &[Rect], axis: Axis) -> Option<(Vec<f64>, f64)> {
    let length = observation.length(axis);
    let size = seen[0].extent(axis);
    let tolerance = EXACT * size;
    if seen
        .iter()
        .any(|r| (r.extent(axis) - size).abs() > tolerance)
    {
        return None;
    }
    let mut at: Vec<f64> = seen.iter().map(|r| r.start(axis) + size / 2.0).collect();
    at.sort_by(f64::total_cmp);
    let mut lines: Vec<f64> = Vec::new();
    for x in at {
        match lines.last() {
            Some(last) if x - last <= tolerance => {}
            _ => lines.push(x),
        }
    }
    let (first, last) = (*lines.first()?, *lines.last()?);
    let gaps = lines.windows(2).map(|w| w[1] - w[0]);
    let least = gaps.fold(f64::INFINITY, f64::min);
    if !least.is_finite() || least < size || length / least > MOST {
        return None;
    }
    // The whole extent gives the gap more exactly than one gap does.
    let parts = ((last - first) / least).round();
    let gap = (last - first) / parts;
    let on_lattice = |x: &f64| {
        let k = ((x - first) / gap).round();
        (x - first - k * gap).abs() <= tolerance
    };
    if !lines.iter().all(on_lattice) {
        return None;
    }
    // A further line crosses the seen ones where nothing is known.
    let crossing = observation.lines(axis.other());
    let open = |x: f64| {
        let unknown = |y: f64| match axis {
            Axis::X => observation.partial.is_unknown(x, y),
            Axis::Y => observation.partial.is_unknown(y, x),
        };
        crossing.iter().all(|line| unknown(line.at))
    };
    let edge = EDGE * length;
    let open = |x: f64| [0.0, edge, -edge].into_iter().any(|by| open(x + by));
    let room = |from: f64, space: f64, step: f64| {
        let most = (((space - size / 2.0) / gap + 1e-9).floor()).max(0.0) as usize;
        (1..=most)
            .take_while(|&k| open(from + step * k as f64))
            .count()
    };
    let (before, after) = (room(first, first, -gap), room(last, length - last, gap));
    // Equal margins: as many lines as there is room for on one side fix those of the other.
    let margins = |b: usize, a: usize| (first - b as f64 * gap) - (length - last - a as f64 * gap);
    let pairs = (0..=before).flat_map(|b| (0..=after).map(move |a| (b, a)));
    let equal = pairs.filter(|&(b, a)| margins(b, a).abs() <= tolerance.max(EXACT * gap));
    let (b, a) = equal.max_by_key(|&(b, a)| b + a)?;
    let start = first - b as f64 * gap;
    let count = b + parts as usize + a;
    Some(((0..=count).map(|k| start + k as f64 * gap).collect(), size))
}

/// Most lines of an axis.
const MOST: f64 = 500.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::partial::PartialLayout;

    fn window(c: usize, r: usize) -> Element {
        let (x, y) = (15.0 + 30.0 * c as f64, 20.0 + 50.0 * r as f64);
        Element::new(Class::Window, Rect::new(x, y, 12.0, 24.0))
    }

    fn hidden_of(observed: Vec<Element>, unknown: Option<Vec<Rect>>) -> Option<Vec<Element>> {
        // Five columns, four rows: margins of 15 and 20.
        let partial = PartialLayout {
            width: 162.0,
            height: 214.0,
            observed: observed.clone(),
            unknown,
            forbidden: Vec::new(),
        };
        let observation = Observation::new(&partial, observed, (12.0, 24.0));
        hidden(&observation)
    }

    #[test]
    fn a_block_is_continued_to_equal_margins() {
        let block = vec![window(1, 1), window(2, 1), window(1, 2), window(2, 2)];
        let hidden = hidden_of(block, None).unwrap();
        assert_eq!(hidden.len(), 16);
        for r in 0..4 {
            for c in 0..5 {
                let window = window(c, r);
                let found = hidden.iter().any(|h| h.rect.iou(&window.rect) > 0.999);
                assert_eq!(
                    found,
                    !((1..3).contains(&c) && (1..3).contains(&r)),
                    "{c} {r}"
                );
            }
        }
    }

    #[test]
    fn what_is_no_exact_lattice_is_none() {
        let mut moved = vec![window(1, 1), window(2, 1), window(1, 2), window(2, 2)];
        moved[3].rect.x += 1.0;
        assert_eq!(hidden_of(moved, None), None);
        // Known wall in a cell.
        let block = vec![window(1, 1), window(2, 1), window(1, 2), window(2, 2)];
        let below = Some(vec![Rect::new(0.0, 0.0, 162.0, 60.0)]);
        assert_eq!(hidden_of(block, below), None);
        assert_eq!(hidden_of(vec![window(1, 1), window(2, 1)], None), None);
    }
}
