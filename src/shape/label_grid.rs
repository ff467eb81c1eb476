//! An irregular grid of labelled cells: what label images and overlaid rectangles have in common.

/// Labelled cells between sorted coordinates.
///
/// Cell `(column i, row j)` spans `xs[i]..xs[i+1]` by `ys[j]..ys[j+1]` (y up) and has label
/// `labels[cells[j * columns + i]]`. A label image of W x H pixels has `xs = 0..=W`, `ys = 0..=H`;
/// neighbouring equal columns and rows may be merged without changing what it says.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelGrid {
    /// Name, for tables and file names.
    pub name: String,
    /// Unit of all lengths.
    pub unit: String,
    /// Column boundaries, strictly increasing, `columns + 1` of them, from 0.
    pub xs: Vec<f64>,
    /// Row boundaries, strictly increasing from the bottom, `rows + 1` of them, from 0.
    pub ys: Vec<f64>,
    /// Label names.
    pub labels: Vec<String>,
    /// Index into `labels` of each cell, row by row from the bottom.
    pub cells: Vec<u16>,
}

impl LabelGrid {
    /// Number of columns of cells.
    pub fn columns(&self) -> usize {
        self.xs.len() - 1
    }

    /// Number of rows of cells.
    pub fn rows(&self) -> usize {
        self.ys.len() - 1
    }

    /// Label index of the cell in column `i`, row `j` from the bottom.
    pub fn at(&self, i: usize, j: usize) -> u16 {
        self.cells[j * self.columns() + i]
    }
}
