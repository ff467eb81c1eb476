//! Label images: PNG files in which every pixel's colour or number is a label, and images whose colours
//! are only near those of labels.
//!
//! Image rows go down, a facade's y goes up: the last row of the image is the lowest row of the grid.
//! Pixels are units, so an image of W x H pixels is a grid W wide and H high.

use std::path::Path;

use super::label_map::{ECP, Key, LabelMap};
use super::nearest_colour::{NearestColours, NearestSearch};
use super::pixels::{JPEG_MAGIC, Pixels};
use super::{file_stem, read_bytes};
use edifice_base::{Error, Result};
use edifice_shape::LabelGrid;

/// A pixel that the label map does not name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("unknown {key}: the label map does not name it")]
pub struct UnknownPixel {
    /// Column from the left, from 0.
    pub column: usize,
    /// Row from the top, from 0.
    pub row: usize,
    /// Its colour or number.
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
    let exact = |map: &LabelMap, name| label_pixels(&pixels, map, name, &mut |_, _| None);
    let labelled = match map {
        Some(map) => exact(map, name),
        None => {
            let colored = exact(&LabelMap::colors(), name.clone());
            if colored.is_err() && pixels.is_numbered() {
                exact(&LabelMap::cmp(), name)
            } else {
                colored
            }
        }
    };
    labelled.map_err(|unknown| unknown.at(path))
}

/// Parses the bytes of a label image whose colours were blended or compressed, a PNG or a JPEG: a pixel
/// of a colour that the map does not name takes the label of the nearest colour, by the distance of red,
/// green and blue, the first in the map where two are equally near. Without a `map`, the colours of ECP
/// and Graz are candidates, and those of [`LabelMap::colors`] are known. The second value tells what was
/// changed; it is `None` when [`parse`] reads the image.
///
/// # Errors
/// As [`read`], but for unknown colours; a map without colours.
pub fn parse_nearest(
    bytes: &[u8],
    path: &Path,
    map: Option<&LabelMap>,
) -> Result<(LabelGrid, Option<NearestColours>)> {
    let pixels = if bytes.starts_with(JPEG_MAGIC) {
        Pixels::decode_jpeg(bytes)
    } else if let Ok(grid) = parse(bytes, path, map) {
        return Ok((grid, None));
    } else {
        Pixels::decode(bytes)
    };
    let pixels = pixels.map_err(|e| Error::content(path, e))?;
    let known = map.cloned().unwrap_or_else(LabelMap::colors);
    // Colours of ours for labels that only CMP has lie between those of ECP: they are no candidates.
    let candidates = match map {
        Some(map) => map.colours(),
        None => LabelMap::colors().colours()[..ECP.len()].to_vec(),
    };
    if candidates.is_empty() {
        let message = "the label map names no colours";
        return Err(Error::option("--nearest-colour", message));
    }
    let mut search = NearestSearch::new(candidates);
    let mut nearest = |place, key| match key {
        Key::Color(color) => Some(search.label(place, color)),
        Key::Id(_) => None,
    };
    let grid = label_pixels(&pixels, &known, file_stem(path), &mut nearest);
    let grid = grid.map_err(|unknown| unknown.at(path))?;
    Ok((grid, search.found(&known)))
}

impl UnknownPixel {
    fn at(self, path: &Path) -> Error {
        let place = format!("pixel ({}, {})", self.column, self.row);
        Error::input(path, place, self)
    }
}

/// Called for a pixel, at a column and row, that the map does not name: gives its label, or `None` for an error.
type Otherwise<'o> = &'o mut dyn FnMut((usize, usize), Key) -> Option<u16>;

/// The merged grid of labels of an image.
fn label_pixels(
    pixels: &Pixels,
    map: &LabelMap,
    name: String,
    otherwise: Otherwise<'_>,
) -> Result<LabelGrid, UnknownPixel> {
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
                    let unknown = |key| otherwise((column, row), key).ok_or(key);
                    label_of(pixels, pixel, map)
                        .or_else(unknown)
                        .map_err(|key| UnknownPixel { column, row, key })?
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

    #[test]
    fn blended_colours_take_the_nearest_label() {
        let near = |[r, g, b]: [u8; 3]| [r ^ 3, g ^ 2, b ^ 1];
        let data = [near(WALL), WALL, WINDOW, near(WINDOW), near(WALL), WINDOW].concat();
        let bytes = png(3, 2, png::ColorType::Rgb, &data);
        let text = message(&bytes, None);
        assert!(
            text.contains("pixel (0, 1): unknown colour [252, 2, 1]"),
            "{text}"
        );
        let (grid, found) = parse_nearest(&bytes, "a.png".as_ref(), None).unwrap();
        let exact = [WALL, WALL, WINDOW, WINDOW, WALL, WINDOW].concat();
        let exact = png(3, 2, png::ColorType::Rgb, &exact);
        let (same, none) = parse_nearest(&exact, "a.png".as_ref(), None).unwrap();
        assert_eq!((&grid, none), (&same, None));
        assert_eq!(grid, parse(&exact, "a.png".as_ref(), None).unwrap());
        let found = found.unwrap();
        assert_eq!(found.colours, 2);
        assert!((found.distance - 14f64.sqrt()).abs() < 1e-12);
        // Rows are read from the lowest, so the window of the last row comes first.
        assert_eq!((found.place, found.label.as_str()), ((0, 1), "window"));
        assert_eq!(
            found.to_string(),
            "2 colours are not in the label map; the furthest, [252, 2, 1] at pixel (0, 1), is 3.7 from that of window"
        );
    }

    #[test]
    fn maps_say_which_colours_are_near() {
        let data = [[250, 128, 2], [0, 100, 1]].concat();
        let bytes = png(2, 1, png::ColorType::Rgb, &data);
        // Without a map the colours that we chose for CMP are no candidates.
        let (grid, _) = parse_nearest(&bytes, "a.png".as_ref(), None).unwrap();
        assert_eq!(grid.labels, ["door", "void"]);
        let map = LabelMap::parse(
            br#"{"a": [250, 120, 0], "b": [9, 99, 9], "c": 7}"#,
            "m".as_ref(),
        );
        let (grid, found) = parse_nearest(&bytes, "a.png".as_ref(), Some(&map.unwrap())).unwrap();
        assert_eq!(grid.labels, ["a", "b"]);
        assert_eq!(found.unwrap().label, "b");
        let numbers = parse_nearest(&bytes, "a.png".as_ref(), Some(&LabelMap::cmp()));
        let text = numbers.unwrap_err().to_string();
        assert_eq!(text, "--nearest-colour: the label map names no colours");
    }

    #[test]
    fn jpeg_colours_are_read_as_the_nearest() {
        let mut image = image::RgbImage::from_pixel(64, 48, image::Rgb(WALL));
        for (x, y) in (0..16).flat_map(|x| (0..16).map(move |y| (x, y))) {
            image.put_pixel(16 + x, 16 + y, image::Rgb(WINDOW));
        }
        let mut jpeg = Vec::new();
        let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, 90);
        image.write_with_encoder(encoder).unwrap();
        let map = br#"{"wall": [255, 255, 0], "window": [255, 0, 0]}"#;
        let map = LabelMap::parse(map, "m".as_ref()).unwrap();
        let (grid, found) = parse_nearest(&jpeg, "a.jpg".as_ref(), Some(&map)).unwrap();
        assert_eq!(
            (grid.xs, grid.ys),
            (vec![0.0, 16.0, 32.0, 64.0], vec![0.0, 16.0, 32.0, 48.0])
        );
        assert_eq!(grid.cells, [0, 0, 0, 0, 1, 0, 0, 0, 0]);
        assert!(found.unwrap().distance > 0.0);
        let text = parse_nearest(&jpeg[..200], "a.jpg".as_ref(), None)
            .unwrap_err()
            .to_string();
        assert!(text.starts_with("a.jpg: not a readable JPEG"), "{text}");
        // The size stands behind the marker of the frame: claims of it are checked before decoding.
        let frame = jpeg.windows(2).position(|w| w == [0xff, 0xc0]).unwrap();
        let mut huge = jpeg.clone();
        huge[frame + 5..frame + 9].copy_from_slice(&[0x23, 0x28, 0x23, 0x28]);
        let text = parse_nearest(&huge, "a.jpg".as_ref(), None)
            .unwrap_err()
            .to_string();
        assert!(text.contains("claims 9000 x 9000 pixels"), "{text}");
        huge[frame + 5..frame + 9].copy_from_slice(&[0x1f, 0xff, 0x1f, 0xff]);
        let text = parse_nearest(&huge, "a.jpg".as_ref(), None)
            .unwrap_err()
            .to_string();
        assert!(text.contains("truncated"), "{text}");
    }

    fn crc32(bytes: &[u8]) -> u32 {
        let mut crc = flate2::Crc::new();
        crc.update(bytes);
        crc.sum()
    }
}
