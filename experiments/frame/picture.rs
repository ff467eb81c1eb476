//! Layouts as pictures.

use edifice_io::palette::leading_word;
use edifice_report::{Colour, Tile, Tiles, category};
use edifice_shape::Facade;

/// Colour of a material, muted so that elements stand out from the wall.
pub fn material(label: &str) -> Colour {
    let [r, g, b] = match leading_word(label).as_str() {
        "wall" => [0xe9, 0xdf, 0xcd],
        "window" | "glass" => [0x7d, 0xa3, 0xbd],
        "frame" | "trim" => [0xfb, 0xf9, 0xf4],
        "blind" => [0xb9, 0xb3, 0xa6],
        "shutter" => [0x5f, 0x7f, 0x6a],
        "sill" | "lintel" | "molding" | "cornice" => [0xc9, 0xbc, 0xa4],
        "balcony" => [0x4a, 0x4f, 0x57],
        "door" => [0x7a, 0x4a, 0x32],
        "shop" => [0x9c, 0xc3, 0xcf],
        "sign" => [0xb5, 0x3f, 0x35],
        "awning" => [0xd9, 0x8a, 0x3d],
        "base" | "plinth" | "capital" | "deco" => [0xa8, 0x9f, 0x8f],
        "pilaster" | "pillar" => [0xf3, 0xec, 0xdf],
        "roof" => [0x6d, 0x6f, 0x7b],
        "dormer" => [0xa7, 0xa9, 0xb4],
        "chimney" => [0x8b, 0x5a, 0x4a],
        "sky" | "background" => [0xd8, 0xe8, 0xf3],
        _ => {
            let sum: usize = label.bytes().map(usize::from).sum();
            return category(sum);
        }
    };
    Colour::new(r, g, b)
}

/// A layout as a panel.
pub fn tiles(title: impl Into<String>, facade: &Facade) -> Tiles {
    let tiles = facade.regions.iter().map(|region| Tile {
        x: region.rect.x,
        y: region.rect.y,
        width: region.rect.width,
        height: region.rect.height,
        colour: material(&region.label),
    });
    Tiles::new(title, facade.width, facade.height, tiles.collect())
}
