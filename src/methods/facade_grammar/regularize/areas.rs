//! Areas between cut lines, as both axes of the problem see them.

use std::collections::{BTreeMap, BTreeSet};

use super::RegularizeError;
use super::axis::{self, Run, Strips};
use super::resized;
use crate::shape::{Facade, IndexedLayout, LabelGrid, Span, components, is_background};

/// Why edges may move, and how far, in the unit of the layout.
#[derive(Debug, Clone, Copy)]
pub enum Freedom {
    /// Annotations are off by so much: lines merge, then sizes become equal.
    Noise {
        /// Longest move.
        tolerance: f64,
    },
    /// The layout was resized: sizes become equal, then lines merge as far as sizes allow.
    Resized {
        /// Longest move that makes sizes equal.
        reach: f64,
        /// Longest further move that aligns edges.
        tolerance: f64,
    },
}

/// Areas on an irregular grid: connected areas of equal label, or regions of a tiling.
pub struct Areas<'a> {
    grid: &'a LabelGrid,
    /// Area of each cell.
    of_cell: Vec<u32>,
    /// Label of each area, as a number.
    labels: Vec<u16>,
    /// Whether an area is a rectangular element, to be served first.
    is_element: Vec<bool>,
    /// Whether a stretch of its area may vanish at a cell: background, and what odd elements have
    /// beside their [bodies](body).
    yields: Vec<bool>,
}

impl<'a> Areas<'a> {
    /// The connected areas of equal label.
    pub fn of_grid(grid: &'a LabelGrid) -> Self {
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
        for (number, area) in areas.iter().enumerate() {
            if front(area.label) && !area.is_rectangle() {
                let body = body(grid, &of_cell, number as u32, area.bounds);
                for j in body.bottom..body.top {
                    let row = j * grid.columns();
                    yields[row + body.left..row + body.right].fill(false);
                }
            }
        }
        Self {
            grid,
            yields,
            labels: areas.iter().map(|a| a.label).collect(),
            is_element: areas
                .iter()
                .map(|a| a.is_rectangle() && front(a.label))
                .collect(),
            of_cell,
        }
    }

    /// The regions of a tiling, of which `grid` is the picture.
    pub fn of_facade(facade: &Facade, layout: &IndexedLayout, grid: &'a LabelGrid) -> Self {
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
        Self {
            grid,
            yields: vec![false; of_cell.len()],
            of_cell,
            labels,
            is_element: front.collect(),
        }
    }

    /// The same areas with `kinds` for labels: areas of one kind, and of no other, become equal.
    pub fn with_kinds(self, kinds: &[u16]) -> Self {
        Self {
            labels: kinds.to_vec(),
            ..self
        }
    }

    /// New positions of the cut lines along x and y; equal ones have become one line.
    pub fn solve(&self, freedom: Freedom) -> Result<(Vec<f64>, Vec<f64>), RegularizeError> {
        let grid = self.grid;
        let (columns, rows) = (grid.columns(), grid.rows());
        let turned = (0..columns).flat_map(|i| (0..rows).map(move |j| j * columns + i));
        let (cells, yields): (Vec<u32>, Vec<bool>) = turned
            .map(|cell| (self.of_cell[cell], self.yields[cell]))
            .unzip();
        let along_x = self.strips(&self.of_cell, &self.yields, columns);
        let along_y = self.strips(&cells, &yields, rows);
        let xs = self.solve_axis(&grid.xs, &grid.ys, along_x, freedom)?;
        let ys = self.solve_axis(&grid.ys, &grid.xs, along_y, freedom)?;
        Ok((xs, ys))
    }

    fn strips<'b>(&'b self, cells: &'b [u32], yields: &'b [bool], length: usize) -> Strips<'b> {
        Strips {
            cells,
            yields,
            length,
            labels: &self.labels,
        }
    }

    /// Along one axis: `cuts` run across `strips`, `across` bounds the strips.
    fn solve_axis(
        &self,
        cuts: &[f64],
        across: &[f64],
        strips: Strips,
        freedom: Freedom,
    ) -> Result<Vec<f64>, RegularizeError> {
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
        let runs: Vec<Run> = runs
            .into_iter()
            .map(|((behind, label, from, to), weight)| Run {
                behind,
                label,
                from,
                to,
                weight,
            })
            .collect();
        match freedom {
            Freedom::Noise { tolerance } => axis::solve(cuts, &weights, &runs, strips, tolerance),
            Freedom::Resized { reach, tolerance } => {
                resized::solve(cuts, &weights, &runs, reach, tolerance)
            }
        }
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

/// Counts distinct sizes under each label; sizes within a billionth of the facade are one.
struct SizeCount {
    unit: f64,
    sizes: BTreeMap<String, BTreeSet<(i64, i64)>>,
}

impl SizeCount {
    fn new(width: f64, height: f64) -> Self {
        Self {
            unit: 1e-9 * width.max(height),
            sizes: BTreeMap::new(),
        }
    }

    fn add(&mut self, label: &str, width: f64, height: f64) {
        let round = |v: f64| (v / self.unit).round() as i64;
        let size = (round(width), round(height));
        self.sizes
            .entry(label.to_string())
            .or_default()
            .insert(size);
    }

    fn counts(self) -> BTreeMap<String, usize> {
        self.sizes
            .into_iter()
            .map(|(label, sizes)| (label, sizes.len()))
            .collect()
    }
}

/// Number of distinct sizes of the areas of each label; of those that are not rectangles, the sizes of
/// the rectangles around them.
pub fn sizes(grid: &LabelGrid) -> BTreeMap<String, usize> {
    let mut count = SizeCount::new(grid.xs[grid.columns()], grid.ys[grid.rows()]);
    for area in components(grid, whole(grid), &mut vec![0; grid.cells.len()]) {
        let b = area.bounds;
        let width = grid.xs[b.right] - grid.xs[b.left];
        let height = grid.ys[b.top] - grid.ys[b.bottom];
        count.add(&grid.labels[usize::from(area.label)], width, height);
    }
    count.counts()
}

/// Number of distinct sizes of the regions of each label.
pub fn region_sizes(facade: &Facade) -> BTreeMap<String, usize> {
    let mut count = SizeCount::new(facade.width, facade.height);
    for region in &facade.regions {
        count.add(&region.label, region.rect.width, region.rect.height);
    }
    count.counts()
}
