//! The layouts that are regularized: label pictures and tilings.

use std::collections::BTreeMap;

use super::areas::Areas;
use super::counts;
use super::error::RegularizeError;
use super::projection::{Layout, Limits, Projected};
use super::square::square;
use edifice_shape::{
    Facade, IndexedLayout, LabelGrid, LayoutError, Rect, Region, decompose, is_background,
};

/// A label picture.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    /// The picture with as few cells as possible.
    pub grid: LabelGrid,
    /// Distinct sizes of the areas of each label; of background labels, of the pieces in the tiling.
    pub sizes: BTreeMap<String, usize>,
    /// Areas of each label.
    areas: BTreeMap<String, usize>,
    /// Distinct sizes of each label in the tiling that it decomposes into, and regions in all.
    tiling: (BTreeMap<String, usize>, usize),
}

impl Picture {
    /// A picture, with what there is to keep.
    ///
    /// # Errors
    /// [`RegularizeError`] for a grid that is not valid.
    pub(super) fn new(grid: &LabelGrid) -> Result<Self, RegularizeError> {
        let grid = grid.merged();
        let (mut sizes, areas) = counts::of_areas(&grid);
        let tiling = decompose(&grid)?.facade;
        let pieces = counts::of_regions(&tiling);
        // Of the background the pieces count: its areas are whatever elements leave between them.
        for (label, count) in pieces.iter().filter(|(label, _)| is_background(label)) {
            sizes.insert(label.clone(), *count);
        }
        Ok(Self {
            sizes,
            areas,
            tiling: (pieces, tiling.regions.len()),
            grid,
        })
    }
}

impl Layout for Picture {
    fn step(&self, limits: &Limits) -> Result<Option<Projected<Self>>, RegularizeError> {
        let (squared, nicks) = square(&self.grid, limits.depth);
        let moved = Areas::of_grid(&squared)?.regularize(limits)?;
        if moved.is_none() && nicks.count == 0 {
            return Ok(None);
        }
        let (xs, ys) = moved.unwrap_or_else(|| (squared.xs.clone(), squared.ys.clone()));
        Ok(Some(Projected {
            layout: Self::new(&moved_grid(&squared, &xs, &ys))?,
            moved: [pairs(&squared.xs, &xs), pairs(&squared.ys, &ys)],
            filled: nicks.deepest,
            squared: nicks.count,
        }))
    }

    fn lines(&self) -> [&[f64]; 2] {
        [&self.grid.xs, &self.grid.ys]
    }

    fn keeps(&self, made: &Self) -> bool {
        let elements = |(label, count): (&String, &usize)| {
            let now = made.areas.get(label).copied().unwrap_or(0);
            now == *count || is_background(label) && now > 0
        };
        self.areas.iter().all(elements)
            && none_more(&self.sizes, &made.sizes)
            && none_more(&self.tiling.0, &made.tiling.0)
            && made.tiling.1 <= self.tiling.1
    }

    fn complexity(&self) -> usize {
        self.tiling.0.values().sum::<usize>() + lines(&self.grid)
    }
}

/// A tiling.
#[derive(Debug, Clone)]
pub(super) struct Tiling {
    /// The tiling.
    pub facade: Facade,
    /// The same on the grid of its cut lines.
    pub layout: IndexedLayout,
    /// The picture of it.
    pub grid: LabelGrid,
    /// Distinct sizes of the regions of each label.
    pub sizes: BTreeMap<String, usize>,
}

impl Tiling {
    /// A tiling, with what there is to keep.
    ///
    /// # Errors
    /// [`RegularizeError`] for a layout that is not a tiling.
    pub(super) fn new(facade: Facade) -> Result<Self, RegularizeError> {
        Ok(Self {
            grid: LabelGrid::from_facade(&facade, None)?,
            layout: facade.indexed()?,
            sizes: counts::of_regions(&facade),
            facade,
        })
    }

    /// The facade with its cut lines elsewhere.
    ///
    /// # Errors
    /// [`LayoutError`] when lines that bound a region have met.
    pub(super) fn moved(&self, xs: &[f64], ys: &[f64]) -> Result<Facade, LayoutError> {
        let regions = self.facade.regions.iter().zip(&self.layout.spans);
        let moved = |(region, s): (&Region, &edifice_shape::Span)| {
            let (x, y) = (xs[s.left], ys[s.bottom]);
            Region {
                label: region.label.clone(),
                rect: Rect::new(x, y, xs[s.right] - x, ys[s.top] - y),
            }
        };
        Facade::new(
            self.facade.name.clone(),
            self.facade.unit.clone(),
            xs[xs.len() - 1],
            ys[ys.len() - 1],
            regions.map(moved).collect(),
        )
    }
}

impl Layout for Tiling {
    fn step(&self, limits: &Limits) -> Result<Option<Projected<Self>>, RegularizeError> {
        let areas = Areas::of_facade(&self.facade, &self.layout, &self.grid);
        let Some((xs, ys)) = areas.regularize(limits)? else {
            return Ok(None);
        };
        Ok(Some(Projected {
            layout: Self::new(self.moved(&xs, &ys)?)?,
            moved: [pairs(&self.grid.xs, &xs), pairs(&self.grid.ys, &ys)],
            filled: 0.0,
            squared: 0,
        }))
    }

    fn lines(&self) -> [&[f64]; 2] {
        [&self.grid.xs, &self.grid.ys]
    }

    fn keeps(&self, made: &Self) -> bool {
        none_more(&self.sizes, &made.sizes)
    }

    fn complexity(&self) -> usize {
        self.sizes.values().sum::<usize>() + lines(&self.grid)
    }
}

/// True if there are no more sizes than before.
fn none_more(before: &BTreeMap<String, usize>, after: &BTreeMap<String, usize>) -> bool {
    after.values().sum::<usize>() <= before.values().sum()
}

fn pairs(before: &[f64], after: &[f64]) -> Vec<(f64, f64)> {
    before.iter().copied().zip(after.iter().copied()).collect()
}

/// The cells between moved cut lines, without those that have vanished.
fn moved_grid(grid: &LabelGrid, xs: &[f64], ys: &[f64]) -> LabelGrid {
    let kept = |cuts: &[f64]| -> Vec<usize> {
        (0..cuts.len() - 1)
            .filter(|&k| cuts[k + 1] > cuts[k])
            .collect()
    };
    let (columns, rows) = (kept(xs), kept(ys));
    let boundaries = |kept: &[usize], cuts: &[f64]| {
        kept.iter()
            .map(|&k| cuts[k])
            .chain([cuts[cuts.len() - 1]])
            .collect()
    };
    let cells = rows
        .iter()
        .flat_map(|&j| columns.iter().map(move |&i| grid.at(i, j)));
    LabelGrid {
        xs: boundaries(&columns, xs),
        ys: boundaries(&rows, ys),
        cells: cells.collect(),
        name: grid.name.clone(),
        unit: grid.unit.clone(),
        labels: grid.labels.clone(),
    }
}

/// The longest way of any line.
pub(super) fn largest(grid: &LabelGrid, xs: &[f64], ys: &[f64]) -> f64 {
    let old = grid.xs.iter().chain(&grid.ys);
    let moves = old.zip(xs.iter().chain(ys)).map(|(a, b)| (a - b).abs());
    moves.fold(0.0, f64::max)
}

/// Number of cut lines, both axes together.
pub(super) fn lines(grid: &LabelGrid) -> usize {
    grid.xs.len() + grid.ys.len()
}
