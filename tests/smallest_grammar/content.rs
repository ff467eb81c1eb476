//! The content of a region: labelled tiles in integer coordinates from its lower left corner.

use std::fmt;

use edifice_shape::{Axis, Facade, Rect, Region};

/// A terminal region: origin and extent along x and y, and a label.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Tile {
    /// Lower left corner, by axis.
    pub at: [u32; 2],
    /// Width and height.
    pub extent: [u32; 2],
    /// Label.
    pub label: u8,
}

/// Tiles that fill a rectangle, sorted: equal contents are equal values.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Content {
    /// Width and height.
    pub extent: [u32; 2],
    tiles: Vec<Tile>,
}

/// Index of an axis in pairs.
pub(super) fn along(axis: Axis) -> usize {
    match axis {
        Axis::X => 0,
        Axis::Y => 1,
    }
}

impl Content {
    /// The tiles in any order.
    pub fn new(extent: [u32; 2], mut tiles: Vec<Tile>) -> Self {
        tiles.sort_unstable();
        Self { extent, tiles }
    }

    /// One tile.
    pub fn tile(extent: [u32; 2], label: u8) -> Self {
        let at = [0, 0];
        Self::new(extent, vec![Tile { at, extent, label }])
    }

    /// A row of cells of width 1, one for each byte of `labels`.
    pub fn row(labels: &str) -> Self {
        let cells = labels.bytes().map(|label| Self::tile([1, 1], label));
        Self::joined(Axis::X, &cells.collect::<Vec<_>>())
    }

    /// Parts side by side.
    pub fn joined(axis: Axis, parts: &[Self]) -> Self {
        let d = along(axis);
        let mut extent = parts[0].extent;
        extent[d] = 0;
        let mut tiles = Vec::new();
        for part in parts {
            assert_eq!(part.extent[1 - d], extent[1 - d]);
            tiles.extend(part.tiles.iter().map(|tile| {
                let mut tile = *tile;
                tile.at[d] += extent[d];
                tile
            }));
            extent[d] += part.extent[d];
        }
        Self::new(extent, tiles)
    }

    /// The mirror image, from end to end of the axis.
    pub fn mirrored(&self, axis: Axis) -> Self {
        let d = along(axis);
        let tiles = self.tiles.iter().map(|tile| {
            let mut tile = *tile;
            tile.at[d] = self.extent[d] - tile.at[d] - tile.extent[d];
            tile
        });
        Self::new(self.extent, tiles.collect())
    }

    /// The tiles, sorted.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    /// The label of a single tile.
    pub fn label(&self) -> Option<u8> {
        match self.tiles[..] {
            [tile] => Some(tile.label),
            _ => None,
        }
    }

    /// Both ends, and every position between at which a straight line from side to side cuts no tile.
    pub fn lines(&self, axis: Axis) -> Vec<u32> {
        let d = along(axis);
        let cuts = |at: u32, tile: &Tile| tile.at[d] < at && at < tile.at[d] + tile.extent[d];
        (0..=self.extent[d])
            .filter(|&at| !self.tiles.iter().any(|tile| cuts(at, tile)))
            .collect()
    }

    /// The content between two lines.
    pub fn strip(&self, axis: Axis, from: u32, to: u32) -> Self {
        let d = along(axis);
        let mut extent = self.extent;
        extent[d] = to - from;
        let inside = self
            .tiles
            .iter()
            .filter(|tile| from <= tile.at[d] && tile.at[d] < to);
        let tiles = inside.map(|tile| {
            let mut tile = *tile;
            tile.at[d] -= from;
            tile
        });
        Self::new(extent, tiles.collect())
    }

    /// The layout of which this is the content; a label is written as a letter.
    pub fn facade(&self, name: &str) -> Facade {
        let region = |tile: &Tile| {
            let [x, y] = tile.at.map(f64::from);
            let [width, height] = tile.extent.map(f64::from);
            Region {
                label: char::from(tile.label).to_string(),
                rect: Rect::new(x, y, width, height),
            }
        };
        let [width, height] = self.extent.map(f64::from);
        let regions = self.tiles.iter().map(region).collect();
        Facade::new(name, "cell", width, height, regions).expect("contents are tilings")
    }
}

impl fmt::Display for Content {
    /// Unit cells as letters, row by row from the top; a tile's first cell at the lower left is a capital.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = (0..self.extent[1]).rev().map(|y| {
            let cell = |x: u32| {
                let inside = |tile: &&Tile| {
                    (0..2).all(|d| {
                        let at = [x, y][d];
                        tile.at[d] <= at && at < tile.at[d] + tile.extent[d]
                    })
                };
                let tile = self.tiles.iter().find(inside);
                let letter = |tile: &Tile| match tile.at == [x, y] {
                    true => char::from(tile.label.to_ascii_uppercase()),
                    false => char::from(tile.label),
                };
                tile.map_or('?', letter)
            };
            (0..self.extent[0]).map(cell).collect::<String>()
        });
        f.write_str(&rows.collect::<Vec<_>>().join(" / "))
    }
}
