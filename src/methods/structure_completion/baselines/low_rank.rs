//! Low-rank completion of the matrix of cells (Fig. 19).

use super::completion;
use crate::completion::{Completion, Reason};
use crate::layout::lines::{LatticeLine, lines};
use crate::layout::{Class, Element};
use crate::partial::PartialLayout;
use edifice_model::low_rank::{Limits, soft_impute};
use edifice_shape::{Axis, Rect};

/// Penalty of the nuclear norm.
const LAMBDA: f64 = 0.5;
/// A cell is filled where its completed value is above this.
const FILLED: f64 = 0.5;

/// The completed matrix of cells of one class.
pub(crate) struct Cells {
    /// The observed columns.
    pub columns: Vec<LatticeLine>,
    /// The observed rows, from the bottom.
    pub rows: Vec<LatticeLine>,
    /// Row by row: about 1 where an element is, about 0 where none is.
    values: Vec<f64>,
}

impl Cells {
    /// The completed value of a cell.
    pub(crate) fn value(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns.len() + column]
    }

    /// Number of filled cells.
    pub(crate) fn filled(&self) -> usize {
        self.values.iter().filter(|v| **v > FILLED).count()
    }
}

/// The matrix over the observed columns and rows of elements of one class: 1 where one is observed, 0 on known wall,
/// otherwise unknown; completed by soft-impute.
pub(crate) fn cells(partial: &PartialLayout, rects: &[Rect]) -> Cells {
    let (columns, column) = lines(rects, Axis::X);
    let (rows, row) = lines(rects, Axis::Y);
    let mut known: Vec<Option<f64>> = Vec::with_capacity(columns.len() * rows.len());
    for r in &rows {
        for c in &columns {
            known.push((!partial.is_unknown(c.at, r.at)).then_some(0.0));
        }
    }
    for (r, c) in row.iter().zip(&column) {
        known[r * columns.len() + c] = Some(1.0);
    }
    let values = soft_impute(rows.len(), columns.len(), &known, LAMBDA, Limits::default());
    Cells {
        columns,
        rows,
        values: values.transpose().iter().copied().collect(),
    }
}

/// Elements in the filled cells of each class. There are no lines but the observed ones.
pub fn low_rank(partial: &PartialLayout) -> Completion {
    let mut elements = Vec::new();
    for class in Class::ALL {
        let rects: Vec<Rect> = partial.of(class).map(|e| e.rect).collect();
        let cells = cells(partial, &rects);
        for (r, row) in cells.rows.iter().enumerate() {
            for (c, column) in cells.columns.iter().enumerate() {
                if cells.value(r, c) > FILLED {
                    let (x, y) = (column.at - column.size / 2.0, row.at - row.size / 2.0);
                    elements.push(Element::new(class, Rect::new(x, y, column.size, row.size)));
                }
            }
        }
    }
    completion(partial, elements, Reason::LowRank)
}
