//! Lines of a lattice: where the columns and rows of elements lie along one axis.

use super::{Class, Element};
use edifice_shape::{Axis, Rect};

/// Elements are on one line when their centres differ by less than this share of their typical extent.
const SAME_LINE: f64 = 0.35;

/// A line: the mean centre of its elements along the axis, and their mean extent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeLine {
    /// Mean centre.
    pub at: f64,
    /// Mean extent along the axis.
    pub size: f64,
    /// Number of elements on it.
    pub count: usize,
}

/// The lines of rectangles along an axis, in order, and the line of each rectangle: sorted centres are
/// split where two neighbours differ by more than 0.35 of the median extent.
pub fn lines(rects: &[Rect], axis: Axis) -> (Vec<LatticeLine>, Vec<usize>) {
    let centre = |r: &Rect| r.start(axis) + r.extent(axis) / 2.0;
    let Some(typical) = median(rects.iter().map(|r| r.extent(axis))) else {
        return (Vec::new(), Vec::new());
    };
    let mut order: Vec<usize> = (0..rects.len()).collect();
    order.sort_by(|&a, &b| centre(&rects[a]).total_cmp(&centre(&rects[b])));
    let mut lines: Vec<LatticeLine> = Vec::new();
    let mut of = vec![0; rects.len()];
    let mut last = f64::NEG_INFINITY;
    for index in order {
        let (at, size) = (centre(&rects[index]), rects[index].extent(axis));
        if at - last > SAME_LINE * typical {
            lines.push(LatticeLine {
                at: 0.0,
                size: 0.0,
                count: 0,
            });
        }
        if let Some(line) = lines.last_mut() {
            line.at += at;
            line.size += size;
            line.count += 1;
        }
        of[index] = lines.len() - 1;
        last = at;
    }
    for line in &mut lines {
        line.at /= line.count as f64;
        line.size /= line.count as f64;
    }
    (lines, of)
}

/// Numbers of columns and of rows of the windows among elements.
pub fn numbers<'a>(elements: impl IntoIterator<Item = &'a Element>) -> (usize, usize) {
    let windows = elements.into_iter().filter(|e| e.class == Class::Window);
    let windows: Vec<Rect> = windows.map(|e| e.rect).collect();
    (
        lines(&windows, Axis::X).0.len(),
        lines(&windows, Axis::Y).0.len(),
    )
}

/// The lower median; `None` of nothing.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len().checked_sub(1)? / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_a_grid() {
        let rects: Vec<Rect> = (0..12)
            .map(|k| Rect::new(f64::from(k % 4) * 10.0 + f64::from(k / 4), 0.0, 5.0, 5.0))
            .collect();
        let (columns, of) = lines(&rects, Axis::X);
        let at: Vec<f64> = columns.iter().map(|l| l.at).collect();
        assert_eq!(at, [3.5, 13.5, 23.5, 33.5]);
        assert_eq!(of[..5], [0, 1, 2, 3, 0]);
        assert!(lines(&[], Axis::Y).0.is_empty());
    }
}
