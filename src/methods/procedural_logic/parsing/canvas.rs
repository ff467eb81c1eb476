//! A facade as the parser sees it: an irregular grid of labelled assets.

use crate::alphabet::Alphabet;
use edifice_shape::{Axis, Facade, LabelGrid, LayoutError};

/// Labelled cells between sorted coordinates; an edge runs wherever two neighbouring cells belong
/// to different assets.
///
/// Of a label image every label is one asset, so that edges separate labels and the wall may be
/// split anywhere; of a tiling every region is an asset of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Canvas {
    /// Column boundaries, strictly increasing, `columns + 1` of them.
    pub xs: Vec<f64>,
    /// Row boundaries from the bottom, strictly increasing, `rows + 1` of them.
    pub ys: Vec<f64>,
    /// Asset of each cell, row by row from the bottom.
    assets: Vec<u32>,
    /// Label of each asset, a number of the alphabet.
    labels: Vec<u32>,
    /// True if the assets are rectangles that no line may cut.
    rigid: bool,
}

impl Canvas {
    /// A label image: neighbouring equal rows and columns are merged, which loses nothing.
    ///
    /// `labels` are the numbers of the grid's labels ([`Alphabet::intern_all`]).
    ///
    /// Complexity: linear in the cells (rows are compared whole, columns on the merged rows).
    pub fn from_grid(grid: &LabelGrid, labels: Vec<u32>) -> Self {
        let columns = grid.columns();
        let row = |j: usize| &grid.cells[j * columns..(j + 1) * columns];
        let keep_rows: Vec<usize> = (0..grid.rows())
            .filter(|&j| j == 0 || row(j) != row(j - 1))
            .collect();
        let keep_columns: Vec<usize> = (0..columns)
            .filter(|&i| i == 0 || keep_rows.iter().any(|&j| row(j)[i] != row(j)[i - 1]))
            .collect();
        let assets = keep_rows
            .iter()
            .flat_map(|&j| keep_columns.iter().map(move |&i| u32::from(row(j)[i])))
            .collect();
        Self {
            xs: boundaries(&keep_columns, &grid.xs),
            ys: boundaries(&keep_rows, &grid.ys),
            assets,
            labels,
            rigid: false,
        }
    }

    /// A tiling: every region is an asset that stays whole.
    ///
    /// # Errors
    /// [`LayoutError`] naming the overlap or the gap that keeps the layout from being a tiling.
    pub fn from_tiling(facade: &Facade, alphabet: &mut Alphabet) -> Result<Self, LayoutError> {
        facade.check_tiling()?;
        let grid = facade.indexed()?;
        let (xs, ys) = (grid.xs.values().to_vec(), grid.ys.values().to_vec());
        let columns = xs.len() - 1;
        let mut assets = vec![0; columns * (ys.len() - 1)];
        for (index, span) in grid.spans.iter().enumerate() {
            for j in span.bottom..span.top {
                assets[j * columns + span.left..j * columns + span.right].fill(index as u32);
            }
        }
        let labels = facade
            .regions
            .iter()
            .map(|region| alphabet.intern(&region.label))
            .collect();
        Ok(Self {
            xs,
            ys,
            assets,
            labels,
            rigid: true,
        })
    }

    /// Number of columns of cells.
    pub fn columns(&self) -> usize {
        self.xs.len() - 1
    }

    /// Number of rows of cells.
    pub fn rows(&self) -> usize {
        self.ys.len() - 1
    }

    /// Extent along x, in the unit of the facade.
    pub fn width(&self) -> f64 {
        self.xs[self.columns()] - self.xs[0]
    }

    /// Extent along y, in the unit of the facade.
    pub fn height(&self) -> f64 {
        self.ys[self.rows()] - self.ys[0]
    }

    /// True if no line may cut an asset.
    pub fn is_rigid(&self) -> bool {
        self.rigid
    }

    /// Label of the cell in column `i`, row `j` from the bottom.
    pub fn label_at(&self, i: usize, j: usize) -> u32 {
        self.labels[self.assets[j * self.columns() + i] as usize]
    }

    /// The facade seen along `axis`.
    pub(crate) fn view(&self, axis: Axis) -> View<'_> {
        let columns = self.columns();
        match axis {
            Axis::X => View {
                canvas: self,
                cuts: &self.xs,
                spans: &self.ys,
                step: 1,
                stride: columns,
            },
            Axis::Y => View {
                canvas: self,
                cuts: &self.ys,
                spans: &self.xs,
                step: columns,
                stride: 1,
            },
        }
    }
}

/// A canvas seen along one axis: `k` counts the cells along the axis, so that lines run between
/// `k - 1` and `k`, and `t` counts the cells along a line.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    canvas: &'a Canvas,
    /// Coordinates of the lines.
    pub cuts: &'a [f64],
    /// Boundaries of the cells along a line.
    pub spans: &'a [f64],
    step: usize,
    stride: usize,
}

impl View<'_> {
    /// Number of cells along the axis.
    pub(crate) fn depth(&self) -> usize {
        self.cuts.len() - 1
    }

    /// Number of cells along a line.
    pub(crate) fn span(&self) -> usize {
        self.spans.len() - 1
    }

    /// Asset of a cell.
    pub(crate) fn asset(&self, k: usize, t: usize) -> u32 {
        self.canvas.assets[k * self.step + t * self.stride]
    }

    /// Label of an asset.
    pub(crate) fn label(&self, asset: u32) -> u32 {
        self.canvas.labels[asset as usize]
    }
}

/// Coordinates of the kept cells' lower ends, and the upper end of the last.
fn boundaries(kept: &[usize], all: &[f64]) -> Vec<f64> {
    kept.iter()
        .map(|&index| all[index])
        .chain(all.last().copied())
        .collect()
}
