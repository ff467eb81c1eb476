//! Random small layouts with structure: rows of cells, grids of cells, and blocks that are split, repeated,
//! alternated and mirrored.

use edifice_base::rng::Stream;
use edifice_shape::Axis;
use rand::RngExt;

use super::content::{Content, Tile, along};

/// One to three layouts, each of `least` to `most` tiles. Later ones are often variants of the first.
pub fn random_layouts(rng: &mut Stream, count: usize, least: usize, most: usize) -> Vec<Content> {
    let mut layouts: Vec<Content> = Vec::new();
    while layouts.len() < count {
        let new = match layouts.first() {
            Some(first) if rng.random_bool(0.7) => variant(rng, first),
            _ => random_layout(rng, most),
        };
        if (least..=most).contains(&new.tiles().len()) {
            layouts.push(new);
        }
    }
    layouts
}

fn random_layout(rng: &mut Stream, most: usize) -> Content {
    let labels = rng.random_range(1..=4);
    match rng.random_range(0..3) {
        0 => row(rng, most, labels),
        1 => cells(rng, most, labels),
        _ => {
            let extent = [0, 1].map(|_| [4, 6, 8, 9, 12][rng.random_range(0..5)]);
            let depth = rng.random_range(2..=4);
            block(rng, extent, labels, depth)
        }
    }
}

/// Numbers below `labels` that repeat, mirror and alternate in part.
fn sequence(rng: &mut Stream, length: usize, labels: u8) -> Vec<u8> {
    let mut out: Vec<u8> = Vec::new();
    while out.len() < length {
        let before = out.len();
        let from = match before {
            0 => 0,
            n => rng.random_range(0..n),
        };
        let motif = out[from..(from + rng.random_range(1..=4)).min(before)].to_vec();
        match rng.random_range(0..5) {
            0 => out.extend(motif),
            1 => out.extend(motif.iter().rev()),
            2 => {
                for _ in 0..rng.random_range(1..=3) {
                    out.extend(&motif);
                }
            }
            3 if before > 1 => out.extend(out.clone().iter().rev()),
            _ => out.push(rng.random_range(0..labels)),
        }
    }
    out.truncate(length);
    out
}

fn letter(number: u8) -> u8 {
    b'a' + number
}

/// A row or a column of tiles, whose sizes follow from a label or vary.
fn row(rng: &mut Stream, most: usize, labels: u8) -> Content {
    let axis = Axis::BOTH[rng.random_range(0..2)];
    let length = rng.random_range(1..=most);
    let sizes: Vec<u32> = match rng.random_range(0..3) {
        0 => vec![1; 8],
        _ => (0..8).map(|_| rng.random_range(1..=2)).collect(),
    };
    let parts: Vec<Content> = sequence(rng, length, 2 * labels)
        .into_iter()
        .map(|number| {
            let mut extent = [1, 1];
            extent[along(axis)] = sizes[usize::from(number)];
            Content::tile(extent, letter(number % labels))
        })
        .collect();
    Content::joined(axis, &parts)
}

/// Columns and rows of cells, in which rows repeat.
fn cells(rng: &mut Stream, most: usize, labels: u8) -> Content {
    let across = rng.random_range(1..=most.clamp(1, 6));
    let up = rng.random_range(1..=(most / across).clamp(1, 6));
    let sizes = |rng: &mut Stream, n: usize| -> Vec<u32> {
        let vary = rng.random_bool(0.3);
        (0..n)
            .map(|_| if vary { rng.random_range(1..=2) } else { 1 })
            .collect()
    };
    let (widths, heights) = (sizes(rng, across), sizes(rng, up));
    let kinds = rng.random_range(1..=3);
    let rows: Vec<Vec<u8>> = (0..kinds).map(|_| sequence(rng, across, labels)).collect();
    let order = sequence(rng, up, kinds);
    let strips: Vec<Content> = order
        .iter()
        .zip(&heights)
        .map(|(&kind, &height)| {
            let row = rows[usize::from(kind)].iter().zip(&widths);
            let tiles = row.map(|(&number, &width)| Content::tile([width, height], letter(number)));
            Content::joined(Axis::X, &tiles.collect::<Vec<_>>())
        })
        .collect();
    Content::joined(Axis::Y, &strips)
}

/// A block that some rule makes of blocks.
fn block(rng: &mut Stream, extent: [u32; 2], labels: u8, depth: u32) -> Content {
    let axis = Axis::BOTH[rng.random_range(0..2)];
    let d = along(axis);
    let length = extent[d];
    if depth == 0 || length < 2 || rng.random_bool(0.1) {
        return Content::tile(extent, letter(rng.random_range(0..labels)));
    }
    let part = |rng: &mut Stream, size: u32| {
        let mut extent = extent;
        extent[d] = size;
        block(rng, extent, labels, depth - 1)
    };
    let parts = match rng.random_range(0..6) {
        0 | 1 => {
            let divisors: Vec<u32> = (1..length).filter(|n| length.is_multiple_of(*n)).collect();
            let size = divisors[rng.random_range(0..divisors.len())];
            vec![part(rng, size); (length / size) as usize]
        }
        2 => {
            let size = rng.random_range(1..=length / 2);
            let outer = part(rng, size);
            let mirror = match rng.random_bool(0.5) {
                true => outer.mirrored(axis),
                false => outer.clone(),
            };
            match length - 2 * size {
                0 => vec![outer, mirror],
                middle => vec![outer, part(rng, middle), mirror],
            }
        }
        3 if length > 4 && length % 2 == 1 => {
            let (a, b) = (part(rng, 1), part(rng, 1));
            let order = (0..length).map(|i| if i % 2 == 0 { &a } else { &b });
            order.cloned().collect()
        }
        _ => {
            let at = rng.random_range(1..length);
            vec![part(rng, at), part(rng, length - at)]
        }
    };
    Content::joined(axis, &parts)
}

/// The same layout, a mirror image, a part, twice the layout, or the layout with a label changed.
fn variant(rng: &mut Stream, layout: &Content) -> Content {
    let axis = Axis::BOTH[rng.random_range(0..2)];
    let lines = layout.lines(axis);
    match rng.random_range(0..8) {
        0 => layout.clone(),
        1 => layout.mirrored(axis),
        2 => Content::joined(axis, &[layout.clone(), layout.clone()]),
        3 | 4 => {
            let from = rng.random_range(0..lines.len() - 1);
            let to = rng.random_range(from + 1..lines.len());
            layout.strip(axis, lines[from], lines[to])
        }
        _ => {
            let mut tiles: Vec<Tile> = layout.tiles().to_vec();
            let changed = rng.random_range(0..tiles.len());
            tiles[changed].label = letter(rng.random_range(0..4));
            Content::new(layout.extent, tiles)
        }
    }
}
