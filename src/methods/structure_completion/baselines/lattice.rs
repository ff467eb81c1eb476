//! The lattice of the observed elements, continued at its typical spacing.

use super::completion;
use crate::completion::{Completion, Reason};
use crate::layout::lines::{LatticeLine, lines, median};
use crate::layout::{Class, Element};
use crate::partial::PartialLayout;
use edifice_shape::{Axis, Rect};

/// Lines that are added on a side, or in a gap, at most: no facade has as many, whatever outline its file gives.
const MOST_LINES: u16 = 500;

/// Continues the columns and rows of each class that has at least two of one of them, at their median gap, to the
/// borders; with `fill` also in gaps wide enough for further lines. Every free cell that may hold an
/// element gets one.
pub fn lattice(partial: &PartialLayout, fill: bool) -> Completion {
    let mut elements = Vec::new();
    for class in Class::ALL {
        let rects: Vec<Rect> = partial.of(class).map(|e| e.rect).collect();
        if rects.len() < 2 {
            continue;
        }
        let columns = continued(&lines(&rects, Axis::X).0, partial.width, fill);
        let rows = continued(&lines(&rects, Axis::Y).0, partial.height, fill);
        for row in &rows {
            for column in &columns {
                let (x, y) = (column.at - column.size / 2.0, row.at - row.size / 2.0);
                elements.push(Element::new(class, Rect::new(x, y, column.size, row.size)));
            }
        }
    }
    completion(partial, elements, Reason::Lattice)
}

/// Lines with further ones at the median gap, as long as they fit.
fn continued(lines: &[LatticeLine], length: f64, fill: bool) -> Vec<LatticeLine> {
    let gaps: Vec<f64> = lines.windows(2).map(|w| w[1].at - w[0].at).collect();
    let mut all = lines.to_vec();
    let (Some(gap), Some(first), Some(last)) =
        (median(gaps.iter().copied()), lines.first(), lines.last())
    else {
        return all;
    };
    let mut step = |from: &LatticeLine, direction: f64| {
        let inside = |at: f64| at - from.size / 2.0 >= 0.0 && at + from.size / 2.0 <= length;
        let next = |at: &f64| Some(at + direction * gap);
        let further = std::iter::successors(next(&from.at), next).take(MOST_LINES.into());
        let own = further.take_while(|at| inside(*at));
        all.extend(own.map(|at| LatticeLine { at, ..*from }));
    };
    step(first, -1.0);
    step(last, 1.0);
    if fill {
        for (pair, wide) in lines.windows(2).zip(&gaps) {
            let parts = (wide / gap).round().min(f64::from(MOST_LINES)) as usize;
            for k in 1..parts {
                let at = pair[0].at + wide * k as f64 / parts as f64;
                all.push(LatticeLine { at, ..pair[0] });
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_beyond_all_measure_gets_no_lattice_beyond_all_measure() {
        let window = |y: f64| Element::new(Class::Window, Rect::new(10.0, y, 20.0, 30.0));
        let partial = |height: f64| PartialLayout {
            width: 100.0,
            height,
            observed: vec![window(60.0), window(120.0)],
            unknown: None,
            forbidden: Vec::new(),
        };
        let added = |height: f64| lattice(&partial(height), true).added.len();
        // 60 apart: 14 above, one below.
        assert_eq!(added(1000.0), 15);
        assert!(added(9.5e22) <= 2 * usize::from(MOST_LINES));
    }
}
