//! Figures: panels in a grid.

use std::io::ErrorKind;
use std::path::Path;

use super::drawing::{Area, Drawing};
use super::{Bars, Chart, Dendrogram, HeatMap, Ranking, Tiles, render};
use edifice_base::{Error, Result};

/// One panel of a figure.
#[derive(Debug, Clone)]
pub enum Panel {
    /// Lines and points.
    Chart(Chart),
    /// Grouped bars.
    Bars(Bars),
    /// A matrix.
    HeatMap(HeatMap),
    /// A tree.
    Dendrogram(Dendrogram),
    /// A layout.
    Tiles(Tiles),
    /// A critical-difference diagram.
    Ranking(Ranking),
}

impl Panel {
    /// The height that the panel takes where a width and a height are offered.
    fn height(&self, cell: (f64, f64)) -> f64 {
        match self {
            Panel::Dendrogram(tree) => tree.height(cell),
            _ => cell.1,
        }
    }
}

macro_rules! panel {
    ($($kind:ident),*) => {$(
        impl From<$kind> for Panel {
            fn from(panel: $kind) -> Self {
                Panel::$kind(panel)
            }
        }
    )*};
}
panel!(Chart, Bars, HeatMap, Dendrogram, Tiles, Ranking);

/// Panels in a grid, filled row by row.
#[derive(Debug, Clone)]
pub struct Figure {
    caption: String,
    columns: usize,
    cell: (f64, f64),
    panels: Vec<Panel>,
}

impl Figure {
    /// A figure with `columns` panels a row, each 480 x 340 logical pixels.
    pub fn new(caption: impl Into<String>, columns: usize) -> Self {
        Self {
            caption: caption.into(),
            columns: columns.max(1),
            cell: (480.0, 340.0),
            panels: Vec::new(),
        }
    }

    /// A figure of one panel, 680 x 420 logical pixels.
    pub fn single(caption: impl Into<String>, panel: impl Into<Panel>) -> Self {
        Self::new(caption, 1).cell(680.0, 420.0).panel(panel)
    }

    /// Sets the size of each panel in logical pixels; a tree of many leaves is higher.
    pub fn cell(mut self, width: f64, height: f64) -> Self {
        self.cell = (width, height);
        self
    }

    /// Adds a panel.
    pub fn panel(mut self, panel: impl Into<Panel>) -> Self {
        self.panels.push(panel.into());
        self
    }

    /// The caption, for readers who cannot see the figure.
    pub fn caption(&self) -> &str {
        &self.caption
    }

    fn draw(&self) -> Drawing {
        const MARGIN: f64 = 10.0;
        let columns = self.columns.min(self.panels.len().max(1));
        let (width, height) = self.cell;
        let needed = |row: &[Panel]| {
            row.iter()
                .map(|p| p.height(self.cell))
                .fold(height, f64::max)
        };
        let heights: Vec<f64> = self.panels.chunks(columns).map(needed).collect();
        let mut out = Drawing::new(
            columns as f64 * width + 2.0 * MARGIN,
            heights.iter().sum::<f64>().max(height) + 2.0 * MARGIN,
        );
        for (i, panel) in self.panels.iter().enumerate() {
            let area = Area {
                x: MARGIN + (i % columns) as f64 * width,
                y: MARGIN + heights[..i / columns].iter().sum::<f64>(),
                width,
                height: panel.height(self.cell),
            };
            match panel {
                Panel::Chart(p) => p.draw(&mut out, area),
                Panel::Bars(p) => p.draw(&mut out, area),
                Panel::HeatMap(p) => p.draw(&mut out, area),
                Panel::Dendrogram(p) => p.draw(&mut out, area),
                Panel::Tiles(p) => p.draw(&mut out, area),
                Panel::Ranking(p) => p.draw(&mut out, area),
            }
        }
        out
    }
}

/// Longest SVG that a report holds, in bytes: layouts of thousands of rectangles make megabytes of
/// text that no browser shows well, and the repository stays small.
pub const MOST_SVG_BYTES: usize = 30_000;

/// Writes `<name>.svg` and `<name>.png` into a folder.
///
/// # Errors
/// [`edifice_base::Error::Io`] when a file cannot be written, [`edifice_base::Error::Method`] when plotters cannot draw.
pub fn write_figure(folder: &Path, name: &str, figure: &Figure) -> Result<()> {
    write_within(folder, name, figure, usize::MAX).map(|_| ())
}

/// As [`write_figure`], without an SVG above [`MOST_SVG_BYTES`]; one that an earlier run left is
/// removed. Returns the names of the files.
///
/// # Errors
/// As [`write_figure`].
pub fn write_report_figure(folder: &Path, name: &str, figure: &Figure) -> Result<Vec<String>> {
    write_within(folder, name, figure, MOST_SVG_BYTES)
}

fn write_within(folder: &Path, name: &str, figure: &Figure, most: usize) -> Result<Vec<String>> {
    let drawing = figure.draw();
    let mut files = Vec::new();
    let (vector, pixels) = (format!("{name}.svg"), format!("{name}.png"));
    let svg = render::svg(&drawing)?;
    let path = folder.join(&vector);
    if svg.len() <= most {
        edifice_base::file::write_atomic(&path, svg.as_bytes())?;
        files.push(vector);
    } else if let Err(e) = std::fs::remove_file(&path)
        && e.kind() != ErrorKind::NotFound
    {
        return Err(Error::io(&path, "remove", e));
    }
    let png = render::png(&drawing)?;
    edifice_base::file::write_atomic(&folder.join(&pixels), &png)?;
    files.push(pixels);
    Ok(files)
}

#[cfg(test)]
mod tests;
