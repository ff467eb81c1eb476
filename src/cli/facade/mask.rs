//! A mask image as unknown rectangles.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_io as io;
use edifice_io::label_map::Key;
use edifice_io::pixels::Pixels;
use edifice_shape::Rect;

/// Most cells of a mask along one axis.
const CELLS: usize = 128;

/// The light part of an image, laid over an outline, as rectangles: cells of at most 128 a side are unknown where the
/// pixel at their centre is at least half as light as the lightest one; runs of one row and equal runs of neighbouring rows are joined.
pub(super) fn unknown(path: &Path, width: f64, height: f64) -> Result<Vec<Rect>> {
    let pixels = Pixels::decode(&io::read_bytes(path)?).map_err(|e| Error::content(path, e))?;
    let (columns, rows) = (pixels.width.min(CELLS), pixels.height.min(CELLS));
    let grey: Vec<u32> = (0..rows * columns)
        .map(|cell| {
            let line = pixels.row((2 * (cell / columns) + 1) * pixels.height / (2 * rows));
            let at = (2 * (cell % columns) + 1) * pixels.width / (2 * columns) * pixels.stride;
            match pixels.color(&line[at..at + pixels.stride]) {
                Some(Key::Color(rgb)) => rgb.iter().map(|&c| u32::from(c)).sum(),
                _ => 0,
            }
        })
        .collect();
    // Images of one bit have white at 1.
    let white = grey.iter().copied().max().unwrap_or(0);
    let light = |row: usize, column: usize| {
        let value = grey[row * columns + column];
        value > 0 && 2 * value >= white
    };
    let (dx, dy) = (width / columns as f64, height / rows as f64);
    let mut done: Vec<Rect> = Vec::new();
    let mut open: Vec<(usize, usize, usize)> = Vec::new();
    let close = |(from, to, top): (usize, usize, usize), row: usize| {
        let y = height - row as f64 * dy;
        Rect::new(
            from as f64 * dx,
            y,
            (to - from) as f64 * dx,
            (row - top) as f64 * dy,
        )
    };
    for row in 0..=rows {
        let runs = if row < rows {
            runs(columns, |c| light(row, c))
        } else {
            Vec::new()
        };
        let (kept, ended): (Vec<_>, Vec<_>) = open
            .into_iter()
            .partition(|&(from, to, _)| runs.contains(&(from, to)));
        done.extend(ended.into_iter().map(|run| close(run, row)));
        let new = runs
            .into_iter()
            .filter(|r| !kept.iter().any(|k| (k.0, k.1) == *r));
        let new: Vec<_> = new.map(|(from, to)| (from, to, row)).collect();
        open = kept;
        open.extend(new);
    }
    Ok(done)
}

/// Runs of true values, as half-open ranges.
fn runs(length: usize, value: impl Fn(usize) -> bool) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut start = None;
    for k in 0..=length {
        match (k < length && value(k), start) {
            (true, None) => start = Some(k),
            (false, Some(from)) => {
                runs.push((from, k));
                start = None;
            }
            _ => {}
        }
    }
    runs
}
