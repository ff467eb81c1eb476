//! An irregular grid of labelled cells: what label images and overlaid rectangles have in common.

use std::collections::BTreeMap;

use super::{Axis, Facade, LayoutError};

/// Most cells that a grid painted from a layout may have.
const MAX_CELLS: usize = 1 << 26;

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

/// Why numbers do not make a label grid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// Fewer than two boundaries along an axis.
    #[error("no {} at all", if *.axis == Axis::X { "columns" } else { "rows" })]
    NoCells {
        /// Axis concerned.
        axis: Axis,
    },
    /// A boundary is not finite, does not start at 0, or does not increase.
    #[error("{}s[{index}] is {value}, expected finite increasing numbers from 0", .axis.name())]
    Boundary {
        /// Axis concerned.
        axis: Axis,
        /// Index of the boundary.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// The number of cells is not columns times rows.
    #[error("{found} cells, expected {columns} columns x {rows} rows")]
    CellCount {
        /// Columns.
        columns: usize,
        /// Rows.
        rows: usize,
        /// Cells found.
        found: usize,
    },
    /// A label name is empty.
    #[error("labels[{index}] is empty")]
    EmptyLabel {
        /// Index of the label.
        index: usize,
    },
    /// A cell points to no label.
    #[error("the cell in column {column}, row {row} has label {label}, there are {labels}")]
    NoSuchLabel {
        /// Column from the left.
        column: usize,
        /// Row from the bottom.
        row: usize,
        /// Label index found.
        label: u16,
        /// Number of labels.
        labels: usize,
    },
    /// The layout that was to be painted is not a tiling.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The cut lines of a layout make more cells than memory should hold.
    #[error("{columns} columns x {rows} rows of cells are too many")]
    TooManyCells {
        /// Columns.
        columns: usize,
        /// Rows.
        rows: usize,
    },
    /// More labels than a grid can number.
    #[error("{0} labels, at most 65536 are possible")]
    TooManyLabels(usize),
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

    /// Checks every promise of the fields.
    ///
    /// # Errors
    /// [`GridError`] with the first boundary, label or cell that breaks one.
    pub fn check(&self) -> Result<(), GridError> {
        for (axis, cuts) in [(Axis::X, &self.xs), (Axis::Y, &self.ys)] {
            if cuts.len() < 2 {
                return Err(GridError::NoCells { axis });
            }
            let mut previous = f64::NEG_INFINITY;
            for (index, &value) in cuts.iter().enumerate() {
                if !value.is_finite() || value <= previous || (index == 0 && value != 0.0) {
                    return Err(GridError::Boundary { axis, index, value });
                }
                previous = value;
            }
        }
        if self.cells.len() != self.columns() * self.rows() {
            return Err(GridError::CellCount {
                columns: self.columns(),
                rows: self.rows(),
                found: self.cells.len(),
            });
        }
        if let Some(index) = self.labels.iter().position(String::is_empty) {
            return Err(GridError::EmptyLabel { index });
        }
        let labels = self.labels.len();
        match self.cells.iter().position(|&l| usize::from(l) >= labels) {
            Some(cell) => Err(GridError::NoSuchLabel {
                column: cell % self.columns(),
                row: cell / self.columns(),
                label: self.cells[cell],
                labels,
            }),
            None => Ok(()),
        }
    }

    /// The same picture with as few cells as possible: neighbouring equal rows and columns are
    /// merged, unused labels dropped, labels sorted by name. Two grids show the same picture exactly
    /// when their merged forms are equal. O(cells). The grid must be [checked](Self::check).
    pub fn merged(&self) -> Self {
        let relabelled = self.sorted_labels();
        let columns = self.columns();
        let rows: Vec<&[u16]> = relabelled.cells.chunks_exact(columns).collect();
        let kept_rows = firsts(rows.len(), |j| rows[j] == rows[j - 1]);
        let kept_columns = firsts(columns, |i| {
            kept_rows.iter().all(|&j| rows[j][i] == rows[j][i - 1])
        });
        let mut cells = Vec::with_capacity(kept_rows.len() * kept_columns.len());
        for &j in &kept_rows {
            cells.extend(kept_columns.iter().map(|&i| rows[j][i]));
        }
        let boundaries = |kept: &[usize], cuts: &[f64]| {
            let last = cuts[cuts.len() - 1];
            kept.iter().map(|&k| cuts[k]).chain([last]).collect()
        };
        Self {
            xs: boundaries(&kept_columns, &self.xs),
            ys: boundaries(&kept_rows, &self.ys),
            cells,
            ..relabelled
        }
    }

    /// The same cells with labels sorted by name, unused ones dropped, equal names made one.
    fn sorted_labels(&self) -> Self {
        let mut used = vec![false; self.labels.len()];
        for &label in &self.cells {
            used[usize::from(label)] = true;
        }
        let mut names: BTreeMap<&str, u16> = BTreeMap::new();
        for (name, _) in self.labels.iter().zip(&used).filter(|(_, used)| **used) {
            names.insert(name, 0);
        }
        for (index, number) in names.values_mut().enumerate() {
            *number = index as u16; // no more names than the u16 labels that use them
        }
        let new: Vec<u16> = self
            .labels
            .iter()
            .map(|name| names.get(name.as_str()).copied().unwrap_or(0))
            .collect();
        Self {
            name: self.name.clone(),
            unit: self.unit.clone(),
            xs: self.xs.clone(),
            ys: self.ys.clone(),
            labels: names.into_keys().map(str::to_string).collect(),
            cells: self.cells.iter().map(|&l| new[usize::from(l)]).collect(),
        }
    }

    /// Paints a layout, later regions over earlier ones, onto the grid of its own cut lines.
    ///
    /// Cells that no region covers get the label `background`; without one, the layout must be a
    /// tiling.
    ///
    /// # Errors
    /// [`GridError::Layout`] when it is not; [`GridError::TooManyCells`], [`GridError::TooManyLabels`].
    pub fn from_facade(facade: &Facade, background: Option<&str>) -> Result<Self, GridError> {
        if background.is_none() {
            facade.check_tiling()?;
        }
        let layout = facade.indexed()?;
        let xs = layout.xs.values().to_vec();
        let ys = layout.ys.values().to_vec();
        let (columns, rows) = (xs.len() - 1, ys.len() - 1);
        if columns.saturating_mul(rows) > MAX_CELLS {
            return Err(GridError::TooManyCells { columns, rows });
        }
        let names = facade.regions.iter().map(|r| r.label.as_str());
        let mut labels: Vec<&str> = background.into_iter().chain(names).collect();
        labels.sort_unstable();
        labels.dedup();
        if labels.len() > usize::from(u16::MAX) {
            return Err(GridError::TooManyLabels(labels.len()));
        }
        let number = |name: &str| labels.partition_point(|&l| l < name) as u16;
        let mut cells = vec![background.map_or(0, number); columns * rows];
        for (region, span) in facade.regions.iter().zip(&layout.spans) {
            let label = number(&region.label);
            for row in span.bottom..span.top {
                cells[row * columns + span.left..row * columns + span.right].fill(label);
            }
        }
        Ok(Self {
            name: facade.name.clone(),
            unit: facade.unit.clone(),
            xs,
            ys,
            labels: labels.into_iter().map(str::to_string).collect(),
            cells,
        })
    }
}

/// Indices below `count` that are not equal to the one before.
fn firsts(count: usize, mut equal: impl FnMut(usize) -> bool) -> Vec<usize> {
    (0..count).filter(|&k| k == 0 || !equal(k)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rect, Region};

    fn grid(columns: usize, labels: &[&str], cells: &[u16]) -> LabelGrid {
        let cuts = |n: usize| (0..=n).map(|k| k as f64).collect();
        LabelGrid {
            name: "g".into(),
            unit: "px".into(),
            xs: cuts(columns),
            ys: cuts(cells.len() / columns),
            labels: labels.iter().map(|l| l.to_string()).collect(),
            cells: cells.to_vec(),
        }
    }

    #[test]
    fn merging_keeps_the_picture() {
        let fine = grid(3, &["w", "unused", "a"], &[0, 0, 2, 0, 0, 2, 0, 0, 0]);
        let merged = fine.merged();
        assert_eq!(merged.xs, [0.0, 2.0, 3.0]);
        assert_eq!(merged.ys, [0.0, 2.0, 3.0]);
        assert_eq!(merged.labels, ["a", "w"]);
        assert_eq!(merged.cells, [1, 0, 1, 1]);
        assert_eq!(merged.merged(), merged);
    }

    #[test]
    fn checks_name_the_culprit() {
        let good = grid(2, &["a"], &[0, 0]);
        assert_eq!(good.check(), Ok(()));
        let mut bad = good.clone();
        bad.cells[1] = 3;
        let text = bad.check().unwrap_err().to_string();
        assert!(text.contains("column 1, row 0 has label 3"), "{text}");
        bad = good.clone();
        bad.xs[1] = f64::NAN;
        assert!(
            bad.check()
                .unwrap_err()
                .to_string()
                .contains("xs[1] is NaN")
        );
        bad = good;
        bad.cells.pop();
        assert!(matches!(bad.check(), Err(GridError::CellCount { .. })));
    }

    #[test]
    fn painting_an_element_layout_needs_a_background() {
        let window = Region {
            label: "window".into(),
            rect: Rect::new(1.0, 1.0, 1.0, 2.0),
        };
        let facade = Facade::new("f", "px", 3.0, 4.0, vec![window]).unwrap();
        let bare = LabelGrid::from_facade(&facade, None);
        assert!(matches!(
            bare,
            Err(GridError::Layout(LayoutError::Gap { .. }))
        ));
        let grid = LabelGrid::from_facade(&facade, Some("wall")).unwrap();
        assert_eq!(grid.check(), Ok(()));
        assert_eq!(grid.labels, ["wall", "window"]);
        assert_eq!(grid.cells, [0, 0, 0, 0, 1, 0, 0, 0, 0]);
    }
}
