//! Layouts and label images as coloured rectangles.

use super::colour::{Colour, FRAME, INK};
use super::drawing::{Anchor, Area, Drawing};
use super::frame::{self, SMALL};

/// A coloured rectangle in the layout's unit, origin at the lower left, y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tile {
    /// Left.
    pub x: f64,
    /// Bottom.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
    /// Colour.
    pub colour: Colour,
}

/// The outline of a rectangle, with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Left, bottom, width, height.
    pub rect: [f64; 4],
    /// Colour.
    pub colour: Colour,
    /// Drawn in its middle; may be empty.
    pub name: String,
}

/// A layout, drawn as large as its panel allows with its proportions kept.
#[derive(Debug, Clone, Default)]
pub struct Tiles {
    title: String,
    width: f64,
    height: f64,
    tiles: Vec<Tile>,
    outlines: Vec<Outline>,
    borders: bool,
    caption: String,
}

impl Tiles {
    /// A layout of the given size.
    pub fn new(title: impl Into<String>, width: f64, height: f64, tiles: Vec<Tile>) -> Self {
        Self {
            title: title.into(),
            width,
            height,
            tiles,
            borders: true,
            ..Self::default()
        }
    }

    /// Adds outlines, for example of the regions that share a symbol.
    pub fn outlines(mut self, outlines: Vec<Outline>) -> Self {
        self.outlines = outlines;
        self
    }

    /// Leaves out the thin lines between tiles.
    pub fn without_borders(mut self) -> Self {
        self.borders = false;
        self
    }

    /// A line of text below.
    pub fn caption(mut self, text: impl Into<String>) -> Self {
        self.caption = text.into();
        self
    }

    pub(super) fn draw(&self, out: &mut Drawing, area: Area) {
        let area = frame::title(out, area, &self.title);
        let foot = if self.caption.is_empty() { 6.0 } else { 24.0 };
        let area = area.inside(8.0, 2.0, 8.0, foot);
        let unit = (area.width / self.width).min(area.height / self.height);
        let width = self.width * unit;
        let left = area.x + (area.width - width) / 2.0;
        // A single picture stands on the ground of its panel, so that a row of them lines up.
        let bottom = area.bottom();
        let place = |x: f64, y: f64, w: f64, h: f64| Area {
            x: left + x * unit,
            y: bottom - (y + h) * unit,
            width: w * unit,
            height: h * unit,
        };
        for tile in &self.tiles {
            let area = place(tile.x, tile.y, tile.width, tile.height);
            out.rect(area, tile.colour);
            if self.borders && area.width.min(area.height) > 3.0 {
                out.outline(area, 0.5, INK.with_opacity(0.35));
            }
        }
        out.outline(place(0.0, 0.0, self.width, self.height), 1.0, FRAME);
        for outline in &self.outlines {
            let [x, y, w, h] = outline.rect;
            let area = place(x, y, w, h);
            out.outline(area, 2.0, outline.colour);
            let middle = (area.x + area.width / 2.0, area.y + area.height / 2.0);
            out.text(middle, &outline.name, SMALL, Anchor::Middle);
        }
        let middle = (left + width / 2.0, bottom + 14.0);
        frame::muted(out, middle, &self.caption, SMALL, Anchor::Middle);
    }
}
