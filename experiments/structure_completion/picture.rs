//! Layouts of elements as panels.

use edifice_frame::picture::material;
use edifice_report::{Colour, Outline, Tile, Tiles};
use edifice_structure_completion::layout::Element;

/// A panel of a wall with elements; the outlined ones were added.
pub(crate) fn panel(
    title: String,
    width: f64,
    height: f64,
    observed: &[Element],
    added: &[Element],
) -> Tiles {
    let wall = Tile {
        x: 0.0,
        y: 0.0,
        width,
        height,
        colour: material("wall"),
    };
    let tile = |e: &Element| Tile {
        x: e.rect.x,
        y: e.rect.y,
        width: e.rect.width,
        height: e.rect.height,
        colour: material(e.class.name()),
    };
    let tiles = std::iter::once(wall)
        .chain(observed.iter().chain(added).map(tile))
        .collect();
    let outline = |e: &Element| Outline {
        rect: [e.rect.x, e.rect.y, e.rect.width, e.rect.height],
        colour: Colour::new(0xc0, 0x30, 0x20),
        name: String::new(),
    };
    Tiles::new(title, width, height, tiles).outlines(added.iter().map(outline).collect())
}
