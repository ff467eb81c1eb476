//! The legend in the corner of a picture: colours, and what they stand for.

use super::Legend;
use super::glyphs::glyph;
use edifice_scene::render::Picture;

/// Columns and rows of a letter with the space after it.
const CELL: [usize; 2] = [6, 9];

/// Writes a legend into the upper left corner of a picture, as far as there is room.
pub(super) fn write(picture: &mut Picture, legend: &Legend) {
    let scale = (picture.width / 500).max(1);
    for (line, (colour, text)) in legend.iter().enumerate() {
        let top = scale * (3 + line * (CELL[1] + 1));
        let left = scale * 3;
        let columns = 10 + 2 + text.chars().count() * CELL[0];
        fill(
            picture,
            [left, top],
            [columns * scale, (CELL[1] + 1) * scale],
            [255; 3],
        );
        fill(
            picture,
            [left + scale, top + scale],
            [8 * scale, 8 * scale],
            *colour,
        );
        for (k, letter) in text.chars().enumerate() {
            for (column, bits) in glyph(letter).into_iter().enumerate() {
                for row in (0..8).filter(|row| bits >> row & 1 == 1) {
                    let x = left + scale * (12 + k * CELL[0] + column);
                    fill(picture, [x, top + scale * (1 + row)], [scale; 2], [20; 3]);
                }
            }
        }
    }
}

/// Fills a rectangle, clipped to the picture.
fn fill(picture: &mut Picture, [left, top]: [usize; 2], [w, h]: [usize; 2], colour: [u8; 3]) {
    for y in top..(top + h).min(picture.height) {
        for x in left..(left + w).min(picture.width) {
            let at = (y * picture.width + x) * 3;
            picture.rgb[at..at + 3].copy_from_slice(&colour);
        }
    }
}
