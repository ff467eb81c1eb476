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
    /// Number of observed elements.
    pub observed: usize,
    /// Row by row, true where an element is observed.
    pub seen: Vec<bool>,
    /// Row by row: about 1 where an element is, about 0 where none is.
    values: Vec<f64>,
}

impl Cells {
    /// The completed value of a cell, counted row by row.
    pub(crate) fn value(&self, cell: usize) -> f64 {
        self.values[cell]
    }

    /// Number of cells.
    pub(crate) fn count(&self) -> usize {
        self.values.len()
    }

    /// Of the cells that three observed elements at the corners of a rectangle imply, the share that is observed; `None` where
    /// none is implied. Each cell counts once for every three that imply it.
    pub(crate) fn closed(&self) -> Option<f64> {
        let count = self.columns.len();
        let rows: Vec<&[bool]> = self.seen.chunks(count).collect();
        let (mut implied, mut closed) = (0, 0);
        for (a, one) in rows.iter().enumerate() {
            let own = one.iter().filter(|seen| **seen).count();
            for (_, other) in rows.iter().enumerate().filter(|(b, _)| *b != a) {
                // A column of both rows, and another one of the first row.
                let both = (0..count).filter(|&c| one[c] && other[c]).count();
                implied += both * own.saturating_sub(1);
                closed += both * both.saturating_sub(1);
            }
        }
        (implied > 0).then(|| closed as f64 / implied as f64)
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
    let mut seen = vec![false; known.len()];
    for (r, c) in row.iter().zip(&column) {
        let cell = r * columns.len() + c;
        (known[cell], seen[cell]) = (Some(1.0), true);
    }
    let values = soft_impute(rows.len(), columns.len(), &known, LAMBDA, Limits::default());
    Cells {
        columns,
        rows,
        observed: rects.len(),
        seen,
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
                if cells.value(r * cells.columns.len() + c) > FILLED {
                    let (x, y) = (column.at - column.size / 2.0, row.at - row.size / 2.0);
                    elements.push(Element::new(class, Rect::new(x, y, column.size, row.size)));
                }
            }
        }
    }
    completion(partial, elements, Reason::LowRank)
}
