//! Heat maps with a colour bar.

use super::axis::Scale;
use super::colour::{FRAME, INK, ramp};
use super::drawing::{Anchor, Area, Drawing, Text};
use super::frame::{self, LABEL, SMALL};
use super::render::text_width;

/// A matrix as colours; row 0 on top.
#[derive(Debug, Clone)]
pub struct HeatMap {
    title: String,
    /// `values[row][column]`.
    values: Vec<Vec<f64>>,
    rows: Vec<String>,
    columns: Vec<String>,
    label: String,
    range: Option<(f64, f64)>,
}

impl HeatMap {
    /// A heat map of `values[row][column]`; `label` names the colours.
    pub fn new(title: impl Into<String>, values: Vec<Vec<f64>>, label: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            values,
            rows: Vec::new(),
            columns: Vec::new(),
            label: label.into(),
            range: None,
        }
    }

    /// Names rows and columns; names that would overlap are left out.
    pub fn names(mut self, rows: Vec<String>, columns: Vec<String>) -> Self {
        self.rows = rows;
        self.columns = columns;
        self
    }

    /// Fixes the values of the first and the last colour.
    pub fn range(mut self, from: f64, to: f64) -> Self {
        self.range = Some((from, to));
        self
    }

    pub(super) fn draw(&self, out: &mut Drawing, area: Area) {
        let area = frame::title(out, area, &self.title);
        let height = self.values.len();
        let width = self.values.iter().map(Vec::len).max().unwrap_or(0);
        if height == 0 || width == 0 {
            return;
        }
        let longest = |names: &[String]| {
            names
                .iter()
                .map(|n| text_width(n, SMALL))
                .fold(0.0, f64::max)
        };
        let (left, foot) = (longest(&self.rows) + 12.0, longest(&self.columns) + 12.0);
        let plot = area.inside(left, 2.0, 96.0, foot);
        let cell = (plot.width / width as f64, plot.height / height as f64);
        let all = || {
            self.values
                .iter()
                .flatten()
                .copied()
                .filter(|v| v.is_finite())
        };
        let (low, high) = self.range.unwrap_or_else(|| {
            (
                all().fold(f64::INFINITY, f64::min),
                all().fold(f64::NEG_INFINITY, f64::max),
            )
        });
        let span = if high > low { high - low } else { 1.0 };
        for (r, row) in self.values.iter().enumerate() {
            for (c, value) in row.iter().enumerate().filter(|(_, v)| v.is_finite()) {
                // Edges are shared, so that no ground shows between cells.
                let (x0, x1) = (plot.x + c as f64 * cell.0, plot.x + (c + 1) as f64 * cell.0);
                let (y0, y1) = (plot.y + r as f64 * cell.1, plot.y + (r + 1) as f64 * cell.1);
                out.rect(
                    Area {
                        x: x0,
                        y: y0,
                        width: x1 - x0,
                        height: y1 - y0,
                    },
                    ramp((value - low) / span),
                );
            }
        }
        out.outline(plot, 1.0, FRAME);
        if cell.1 >= SMALL {
            for (r, name) in self.rows.iter().enumerate() {
                let at = (plot.x - 6.0, plot.y + (r as f64 + 0.5) * cell.1);
                out.text(at, name, SMALL, Anchor::End);
            }
        }
        if cell.0 >= SMALL {
            for (c, name) in self.columns.iter().enumerate() {
                out.label(Text {
                    at: (plot.x + (c as f64 + 0.5) * cell.0, plot.bottom() + 6.0),
                    text: name.clone(),
                    size: SMALL,
                    anchor: Anchor::End,
                    colour: INK,
                    bold: false,
                    vertical: true,
                });
            }
        }
        self.colour_bar(out, plot, low, low + span);
    }

    fn colour_bar(&self, out: &mut Drawing, plot: Area, low: f64, high: f64) {
        let bar = Area {
            x: plot.right() + 14.0,
            y: plot.y,
            width: 14.0,
            height: plot.height,
        };
        const STEPS: usize = 64;
        for i in 0..STEPS {
            let (from, to) = (i as f64 / STEPS as f64, (i + 1) as f64 / STEPS as f64);
            out.rect(
                Area {
                    y: bar.bottom() - to * bar.height,
                    height: (to - from) * bar.height,
                    ..bar
                },
                ramp((from + to) / 2.0),
            );
        }
        out.outline(bar, 1.0, FRAME);
        let scale = Scale::new("").range(low, high).fit(std::iter::empty());
        let mut widest = 0.0_f64;
        for (place, text) in scale.ticks() {
            let y = bar.bottom() - place * bar.height;
            out.path(vec![(bar.right(), y), (bar.right() + 4.0, y)], 1.0, FRAME);
            out.text((bar.right() + 7.0, y), text, SMALL, Anchor::Start);
            widest = widest.max(text_width(text, SMALL));
        }
        out.label(Text {
            at: (bar.right() + widest + 20.0, bar.y + bar.height / 2.0),
            text: self.label.clone(),
            size: LABEL,
            anchor: Anchor::Middle,
            colour: INK,
            bold: false,
            vertical: true,
        });
    }
}
