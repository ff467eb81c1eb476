//! Areas between cut lines, as both axes of the problem see them.

use std::collections::BTreeMap;

use super::axis::Axis;
use super::classes::{Extent, classes};
use super::error::RegularizeError;
use super::lattice::Lattice;
use super::projection::Limits;
use super::resized;
use super::strips::{Run, Strips};
use edifice_shape::{
    Component, Facade, GridError, IndexedLayout, LabelGrid, Span, components, decompose,
    is_background,
};

/// New positions of the cut lines along x and y.
pub(super) type Lines = (Vec<f64>, Vec<f64>);

/// Areas on an irregular grid: connected areas of equal label, or regions of a tiling.
pub(super) struct Areas<'a> {
    grid: &'a LabelGrid,
    /// Area of each cell.
    of_cell: Vec<u32>,
    /// Label of each area, as a number.
    labels: Vec<u16>,
    /// True if an area is a rectangular element, to be served first.
    is_element: Vec<bool>,
    /// True if a stretch of its area may vanish at a cell: background, and the parts of odd elements beside their
    /// [bodies](body).
    yields: Vec<bool>,
    /// Rectangles whose sizes count.
    extents: Vec<Extent>,
}

impl<'a> Areas<'a> {
    /// The connected areas of equal label.
    ///
    /// # Errors
    /// [`GridError`] when the grid is not valid.
    pub(super) fn of_grid(grid: &'a LabelGrid) -> Result<Self, GridError> {
        let mut of_cell = vec![0; grid.cells.len()];
        let areas = components(grid, whole(grid), &mut of_cell);
        let behind: Vec<bool> = grid.labels.iter().map(|l| is_background(l)).collect();
        let front = |label: u16| !behind[usize::from(label)];
        let mut yields: Vec<bool> = of_cell
            .iter()
            .map(|&area| {
                let area = &areas[area as usize];
                !(front(area.label) && area.is_rectangle())
            })
            .collect();
        let size = |area: &Component| {
            let b = area.bounds;
            (grid.xs[b.right] - grid.xs[b.left]) * (grid.ys[b.top] - grid.ys[b.bottom])
        };
        // Of each label of the background, the largest area stays.
        let mut kept: BTreeMap<u16, usize> = BTreeMap::new();
        for (number, area) in areas.iter().enumerate().filter(|(_, a)| !front(a.label)) {
            let largest = kept.entry(area.label).or_insert(number);
            if size(area) > size(&areas[*largest]) {
                *largest = number;
            }
        }
        for (number, area) in areas.iter().enumerate() {
            let odd = front(area.label) && !area.is_rectangle();
            if odd || kept.get(&area.label) == Some(&number) {
                let body = body(grid, &of_cell, number as u32, area.bounds);
                for j in body.bottom..body.top {
                    let row = j * grid.columns();
                    yields[row + body.left..row + body.right].fill(false);
                }
            }
        }
        let elements = areas.iter().filter(|area| front(area.label));
        let mut extents: Vec<Extent> = elements
            .map(|area| Extent {
                behind: false,
                label: area.label,
                strict: true,
                span: area.bounds,
            })
            .collect();
        let tiling = decompose(grid)?.facade;
        let layout = tiling.indexed()?;
        let column = |at: usize| nearest(&grid.xs, layout.xs.values()[at]);
        let row = |at: usize| nearest(&grid.ys, layout.ys.values()[at]);
        extents.extend(layout.spans.iter().map(|s| {
            let span = Span {
                left: column(s.left),
                right: column(s.right),
                bottom: row(s.bottom),
                top: row(s.top),
            };
            let label = grid.at(span.left, span.bottom);
            Extent {
                behind: !front(label),
                label,
                strict: false,
                span,
            }
        }));
        // Whole elements are there already.
        let mut seen = Vec::new();
        extents.retain(|e| {
            let new = !seen.contains(&e.span);
            seen.push(e.span);
            new
        });
        Ok(Self {
            grid,
            yields,
            labels: areas.iter().map(|a| a.label).collect(),
            is_element: areas
                .iter()
                .map(|a| a.is_rectangle() && front(a.label))
                .collect(),
            of_cell,
            extents,
        })
    }

    /// The regions of a tiling, of which `grid` is the picture.
    pub(super) fn of_facade(facade: &Facade, layout: &IndexedLayout, grid: &'a LabelGrid) -> Self {
        let columns = grid.columns();
        let mut of_cell = vec![0; grid.cells.len()];
        let mut labels = Vec::new();
        for (number, span) in layout.spans.iter().enumerate() {
            for j in span.bottom..span.top {
                of_cell[j * columns + span.left..j * columns + span.right].fill(number as u32);
            }
            labels.push(grid.at(span.left, span.bottom));
        }
        let front = facade.regions.iter().map(|r| !is_background(&r.label));
        let is_element: Vec<bool> = front.collect();
        let extent = |(number, &span): (usize, &Span)| Extent {
            behind: !is_element[number],
            label: labels[number],
            strict: is_element[number],
            span,
        };
        Self {
            grid,
            yields: vec![false; of_cell.len()],
            of_cell,
            extents: layout.spans.iter().enumerate().map(extent).collect(),
            labels,
            is_element,
        }
    }

    /// The same areas with `kinds` for labels: areas of one kind, and of no other, become equal.
    pub(super) fn with_kinds(self, kinds: &[u16]) -> Self {
        Self {
            labels: kinds.to_vec(),
            ..self
        }
    }

    /// New positions of the cut lines within the limits: equal ones have become one
    /// line. `None` when nothing becomes equal.
    ///
    /// # Errors
    /// [`RegularizeError::Qp`].
    pub(super) fn regularize(&self, limits: &Limits) -> Result<Option<Lines>, RegularizeError> {
        let grid = self.grid;
        let lattice = Lattice::of(&grid.xs, &grid.ys);
        let (xs, ys) = (lattice.positions(&grid.xs), lattice.positions(&grid.ys));
        let (along_x, along_y) = classes(&self.extents, &xs, &ys, lattice.same());
        let ((cells, yields), turned) = self.both();
        let range = |ranges: &[(f64, [f64; 2])], line: f64| {
            let at = |k: usize| lattice.units(ranges[k].0);
            let after = (ranges.partition_point(|r| lattice.units(r.0) < line - lattice.same()))
                .min(ranges.len() - 1);
            debug_assert!((at(after) - line).abs() <= lattice.same());
            ranges[after].1.map(|end| lattice.units(end))
        };
        let axis = |cuts: &[f64], across: &[f64], strips: Strips, classes, number: usize| {
            if !limits.axes[number] {
                return Ok(None);
            }
            let (_, weights) = self.runs(cuts, across, strips);
            let ranges = &limits.ranges[number];
            let axis = Axis {
                cuts: cuts.to_vec(),
                weights,
                strips,
                classes,
                reach: lattice.units(limits.reach),
                ranges: cuts.iter().map(|&c| range(ranges, c)).collect(),
                lattice,
            };
            axis.solve()
        };
        let strips = self.strips(cells, yields, xs.len() - 1);
        let new_xs = axis(&xs, &ys, strips, along_x, 0)?;
        let strips = self.strips(&turned.0, &turned.1, ys.len() - 1);
        let new_ys = axis(&ys, &xs, strips, along_y, 1)?;
        if new_xs.is_none() && new_ys.is_none() {
            return Ok(None);
        }
        let coordinates = |old: &[f64], units: &[f64], new: Option<Vec<f64>>| match new {
            None => old.to_vec(),
            Some(new) => (new.into_iter())
                .map(|v| match units.binary_search_by(|u| u.total_cmp(&v)) {
                    // What does not move keeps its last bit.
                    Ok(same) => old[same],
                    Err(_) => lattice.coordinate(v),
                })
                .collect(),
        };
        let moved = (
            coordinates(&grid.xs, &xs, new_xs),
            coordinates(&grid.ys, &ys, new_ys),
        );
        Ok(Some(moved))
    }

    /// New positions of the cut lines of a resized layout.
    ///
    /// # Errors
    /// [`RegularizeError::Qp`].
    pub(super) fn align(&self, reach: f64, tolerance: f64) -> Result<Lines, RegularizeError> {
        let (xs, ys) = (&self.grid.xs, &self.grid.ys);
        let ((cells, yields), turned) = self.both();
        let axis = |cuts: &[f64], across: &[f64], strips: Strips| {
            let (runs, weights) = self.runs(cuts, across, strips);
            resized::solve(cuts, &weights, &runs, reach, tolerance)
        };
        let new_xs = axis(xs, ys, self.strips(cells, yields, xs.len() - 1))?;
        let new_ys = axis(ys, xs, self.strips(&turned.0, &turned.1, ys.len() - 1))?;
        Ok((new_xs, new_ys))
    }

    /// Areas and what yields, row by row, and column by column.
    #[allow(clippy::type_complexity)]
    fn both(&self) -> ((&[u32], &[bool]), (Vec<u32>, Vec<bool>)) {
        let (columns, rows) = (self.grid.columns(), self.grid.rows());
        let turned = (0..columns).flat_map(|i| (0..rows).map(move |j| j * columns + i));
        let turned = turned.map(|cell| (self.of_cell[cell], self.yields[cell]));
        ((&self.of_cell, &self.yields), turned.unzip())
    }

    fn strips<'b>(&'b self, cells: &'b [u32], yields: &'b [bool], length: usize) -> Strips<'b> {
        Strips {
            cells,
            yields,
            length,
            labels: &self.labels,
        }
    }

    /// Along one axis: the runs between `cuts`, which run across `strips`, and the length of edge on each of
    /// them; `across` bounds the strips.
    fn runs(&self, cuts: &[f64], across: &[f64], strips: Strips) -> (Vec<Run>, Vec<f64>) {
        let mut runs: BTreeMap<(bool, u16, usize, usize), f64> = BTreeMap::new();
        let mut weights = vec![0.0; cuts.len()];
        for (strip, row) in strips.rows().enumerate() {
            let thickness = across[strip + 1] - across[strip];
            let mut from = 0;
            for to in 1..=row.len() {
                if to < row.len() && row[to] == row[from] {
                    continue;
                }
                let area = row[from] as usize;
                let key = (!self.is_element[area], self.labels[area], from, to);
                *runs.entry(key).or_default() += thickness;
                weights[to] += thickness;
                from = to;
            }
        }
        let runs = runs
            .into_iter()
            .map(|((behind, label, from, to), weight)| Run {
                behind,
                label,
                from,
                to,
                weight,
            });
        (runs.collect(), weights)
    }
}

/// Index of the line nearest to a coordinate.
fn nearest(cuts: &[f64], at: f64) -> usize {
    let after = cuts.partition_point(|&c| c < at);
    match after {
        0 => 0,
        k if k == cuts.len() || at - cuts[k - 1] <= cuts[k] - at => k - 1,
        k => k,
    }
}

/// The part of an odd element that never vanishes: of the rectangles that reach from end to end of one
/// of its rows and as far up and down as the element does there, the largest.
fn body(grid: &LabelGrid, of_cell: &[u32], area: u32, bounds: Span) -> Span {
    let columns = grid.columns();
    let owns = |i: usize, j: usize| of_cell[j * columns + i] == area;
    let mut largest = (0.0, bounds);
    for j in bounds.bottom..bounds.top {
        let mut left = bounds.left;
        for right in bounds.left..=bounds.right {
            if right < bounds.right && owns(right, j) {
                continue;
            }
            let full = |j: &usize| (left..right).all(|i| owns(i, *j));
            let bottom = j - (bounds.bottom..j).rev().take_while(full).count();
            let top = j + (j..bounds.top).take_while(full).count();
            let size = (grid.xs[right] - grid.xs[left]) * (grid.ys[top] - grid.ys[bottom]);
            if size > largest.0 {
                let span = Span {
                    left,
                    right,
                    bottom,
                    top,
                };
                largest = (size, span);
            }
            left = right + 1;
        }
    }
    largest.1
}

fn whole(grid: &LabelGrid) -> Span {
    Span {
        left: 0,
        right: grid.columns(),
        bottom: 0,
        top: grid.rows(),
    }
}
