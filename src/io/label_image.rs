//! Label images: PNG files in which every pixel's colour or number is a label.
//!
//! Image rows go down, a facade's y goes up: the last row of the image is the lowest row of the grid.
//! Pixels are units, so an image of W x H pixels is a grid W wide and H high.

use std::path::Path;

use super::label_map::{Key, LabelMap};
use super::pixels::Pixels;
use super::{file_stem, read_bytes};
use crate::shape::LabelGrid;
use crate::{Error, Result};

/// A pixel that the label map does not name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("unknown {key}: the label map does not name it")]
pub struct UnknownPixel {
    /// Column from the left, from 0.
    pub column: usize,
    /// Row from the top, from 0.
    pub row: usize,
    /// What it says.
    pub key: Key,
}

/// Reads a label image. Without a `map`, colours are those of [`LabelMap::colors`]; a palette or grey
/// image that has other colours than those has the numbers of [`LabelMap::cmp`].
///
/// # Errors
/// Names the file, and the pixel (column and row from the upper left, from 0) of an unknown colour.
/// An image above [`MAX_PIXELS`](super::pixels::MAX_PIXELS) is refused from its header.
pub fn read(path: &Path, map: Option<&LabelMap>) -> Result<LabelGrid> {
    parse(&read_bytes(path)?, path, map)
}

/// Parses the bytes of a label image; `path` names the grid, and the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path, map: Option<&LabelMap>) -> Result<LabelGrid> {
    let pixels = Pixels::decode(bytes).map_err(|e| Error::content(path, e))?;
    let name = file_stem(path);
    let labelled = match map {
        Some(map) => label_pixels(&pixels, map, name),
        None => {
            let colored = label_pixels(&pixels, &LabelMap::colors(), name.clone());
            if colored.is_err() && pixels.is_numbered() {
                label_pixels(&pixels, &LabelMap::cmp(), name)
            } else {
                colored
            }
        }
    };
    labelled.map_err(|unknown| {
        let place = format!("pixel ({}, {})", unknown.column, unknown.row);
        Error::input(path, place, unknown)
    })
}

/// The merged grid of labels of an image.
fn label_pixels(pixels: &Pixels, map: &LabelMap, name: String) -> Result<LabelGrid, UnknownPixel> {
    let (width, height) = (pixels.width, pixels.height);
    let mut ys = Vec::new();
    let mut cells = Vec::new();
    for y in 0..height {
        let row = height - 1 - y;
        // Equal neighbouring rows are kept once right away: images are large, layouts are not.
        if y > 0 && pixels.row(row) == pixels.row(row + 1) {
            continue;
        }
        ys.push(y as f64);
        let mut last: Option<(&[u8], u16)> = None;
        for (column, pixel) in pixels.row(row).chunks_exact(pixels.stride).enumerate() {
            let label = match last {
                Some((bytes, label)) if bytes == pixel => label,
                _ => {
                    label_of(pixels, pixel, map).map_err(|key| UnknownPixel { column, row, key })?
                }
            };
            last = Some((pixel, label));
            cells.push(label);
        }
    }
    ys.push(height as f64);
    let grid = LabelGrid {
        name,
        unit: "px".into(),
        xs: (0..=width).map(|x| x as f64).collect(),
        ys,
        labels: map.names().map(str::to_string).collect(),
        cells,
    };
    Ok(grid.merged())
}

/// Label of one pixel: by its number if the map names that, else by its colour; or what it says.
fn label_of(pixels: &Pixels, pixel: &[u8], map: &LabelMap) -> Result<u16, Key> {
    let keys = [pixels.number(pixel), pixels.color(pixel)];
    let known = keys.into_iter().flatten().find_map(|key| map.find(key));
    let says = if map.has_colors() {
        pixels.color(pixel)
    } else {
        None
    };
    known.ok_or(says.or(keys[0]).or(keys[1]).unwrap_or(Key::Id(0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PNG of the given colour type and raw rows.
    fn png(width: u32, height: u32, color: png::ColorType, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(color);
        if color == png::ColorType::Indexed {
            encoder.set_palette(vec![9, 9, 9, 7, 7, 7, 255, 0, 0]);
        }
        encoder
            .write_header()
            .unwrap()
            .write_image_data(data)
            .unwrap();
        bytes
    }

    fn message(bytes: &[u8], map: Option<&LabelMap>) -> String {
        parse(bytes, "a.png".as_ref(), map).unwrap_err().to_string()
    }

    const WALL: [u8; 3] = [255, 255, 0];
    const WINDOW: [u8; 3] = [255, 0, 0];

    #[test]
    fn the_last_image_row_is_the_lowest() {
        let data = [WALL, WALL, WALL, WINDOW, WALL, WALL].concat();
        let bytes = png(2, 3, png::ColorType::Rgb, &data);
        let grid = parse(&bytes, "dir/monge_4.png".as_ref(), None).unwrap();
        assert_eq!(grid.check(), Ok(()));
        assert_eq!(grid.name, "monge_4");
        assert_eq!(grid.labels, ["wall", "window"]);
        assert_eq!((grid.at(0, 0), grid.at(1, 1), grid.at(1, 2)), (0, 1, 0));
    }

    #[test]
    fn palette_images_have_numbers_or_colours() {
        let bytes = png(2, 1, png::ColorType::Indexed, &[1, 2]);
        let grid = parse(&bytes, "a.png".as_ref(), None).unwrap();
        assert_eq!(grid.labels, ["background", "facade"]);
        let map = LabelMap::parse(br#"{"x": [255, 0, 0], "y": 1}"#, "m".as_ref()).unwrap();
        let grid = parse(&bytes, "a.png".as_ref(), Some(&map)).unwrap();
        assert_eq!(grid.labels, ["x", "y"]);
    }

    #[test]
    fn unknown_colours_name_the_pixel() {
        let data = [WALL, [1, 2, 3], WALL, WALL].concat();
        let text = message(&png(2, 2, png::ColorType::Rgb, &data), None);
        let expected = "a.png: pixel (1, 0): unknown colour [1, 2, 3]";
        assert!(text.starts_with(expected), "{text}");
        let text = message(&png(1, 1, png::ColorType::Indexed, &[0]), None);
        assert!(text.contains("pixel (0, 0): unknown number 0"), "{text}");
    }

    #[test]
    fn dishonest_and_damaged_images_are_refused() {
        let good = png(2, 2, png::ColorType::Rgb, &[WALL; 4].concat());
        for length in 0..good.len() - 12 {
            message(&good[..length], None);
        }
        assert!(message(b"no image", None).contains("not a readable PNG"));
        let claim = |side: u32| {
            let mut huge = good.clone();
            huge[16..20].copy_from_slice(&side.to_be_bytes());
            huge[20..24].copy_from_slice(&side.to_be_bytes());
            let crc = crc32(&huge[12..29]).to_be_bytes();
            huge[29..33].copy_from_slice(&crc);
            message(&huge, None)
        };
        let text = claim(60_000);
        assert!(text.contains("claims 60000 x 60000 pixels"), "{text}");
        let text = claim(8_000);
        assert!(text.contains("truncated"), "{text}");
    }

    fn crc32(bytes: &[u8]) -> u32 {
        let mut crc = flate2::Crc::new();
        crc.update(bytes);
        crc.sum()
    }
}
