//! Square cells of the plan that hold a number each, stored where there are any: a city may have a building far from all others.

use rustc_hash::FxHashMap;

/// Cells along the side of a tile.
const TILE: i64 = 64;

/// Cells with a byte each; 0 where nothing was written.
#[derive(Debug, Default)]
pub(super) struct Raster {
    /// Side of a cell, in metres.
    side: f64,
    tiles: FxHashMap<[i64; 2], Box<[u8]>>,
}

impl Raster {
    /// An empty raster; cells have a side of so many metres.
    pub(super) fn new(side: f64) -> Self {
        let tiles = FxHashMap::default();
        Self { side, tiles }
    }

    /// The cell that a point lies in.
    pub(super) fn cell(&self, p: [f64; 2]) -> [i64; 2] {
        p.map(|v| (v / self.side).floor() as i64)
    }

    /// The byte at a point.
    pub(super) fn at(&self, p: [f64; 2]) -> u8 {
        let cell = self.cell(p);
        let tile = self.tiles.get(&cell.map(|v| v.div_euclid(TILE)));
        tile.map_or(0, |t| t[within(cell)])
    }

    /// The byte of the cell that a point lies in, to be changed.
    pub(super) fn at_mut(&mut self, p: [f64; 2]) -> &mut u8 {
        let cell = self.cell(p);
        let tile = self.tiles.entry(cell.map(|v| v.div_euclid(TILE)));
        let empty = || vec![0; (TILE * TILE) as usize].into_boxed_slice();
        &mut tile.or_insert_with(empty)[within(cell)]
    }
}

fn within([x, y]: [i64; 2]) -> usize {
    (y.rem_euclid(TILE) * TILE + x.rem_euclid(TILE)) as usize
}
