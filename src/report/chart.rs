//! Lines and points over two axes: curves with error bands, scatter plots, CDF and CMC curves.

use super::axis::{Fitted, Scale};
use super::colour::{Colour, MUTED, category};
use super::drawing::{Anchor, Area, Drawing};
use super::frame::{self, Corner, Key, SMALL};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Line,
    Dashed,
    Marked,
    Points,
    Steps,
}

/// One set of points of a chart.
#[derive(Debug, Clone)]
pub struct Series {
    name: String,
    points: Vec<(f64, f64)>,
    band: Vec<(f64, f64, f64)>,
    kind: Kind,
    colour: Option<Colour>,
}

impl Series {
    fn new(name: impl Into<String>, points: Vec<(f64, f64)>, kind: Kind) -> Self {
        Self {
            name: name.into(),
            points,
            band: Vec::new(),
            kind,
            colour: None,
        }
    }

    /// A line. An empty name keeps it out of the legend.
    pub fn line(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self::new(name, points, Kind::Line)
    }

    /// A dashed line, for references.
    pub fn dashed(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self::new(name, points, Kind::Dashed)
    }

    /// A line with a dot at each point.
    pub fn marked(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self::new(name, points, Kind::Marked)
    }

    /// Points alone.
    pub fn points(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self::new(name, points, Kind::Points)
    }

    /// A staircase, for cumulative distributions: each value holds until the next point.
    pub fn steps(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self::new(name, points, Kind::Steps)
    }

    /// Shades between a lower and an upper value at each x: `(x, low, high)`.
    pub fn band(mut self, band: Vec<(f64, f64, f64)>) -> Self {
        self.band = band;
        self
    }

    /// Fixes the colour; otherwise the n-th series has the n-th colour.
    pub fn colour(mut self, colour: Colour) -> Self {
        self.colour = Some(colour);
        self
    }
}

/// Series over two axes.
#[derive(Debug, Clone)]
pub struct Chart {
    title: String,
    x: Scale,
    y: Scale,
    series: Vec<Series>,
    legend: Corner,
    levels: Vec<(f64, String)>,
}

impl Chart {
    /// A chart without series.
    pub fn new(title: impl Into<String>, x: Scale, y: Scale) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            legend: Corner::default(),
            levels: Vec::new(),
        }
    }

    /// Adds a series.
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Places the legend.
    pub fn legend(mut self, corner: Corner) -> Self {
        self.legend = corner;
        self
    }

    /// Adds a dashed horizontal line with a name, for example the paper's number.
    pub fn level(mut self, value: f64, name: impl Into<String>) -> Self {
        self.levels.push((value, name.into()));
        self
    }

    pub(super) fn draw(&self, out: &mut Drawing, area: Area) {
        let area = frame::title(out, area, &self.title);
        let entries: Vec<_> = self
            .series
            .iter()
            .enumerate()
            .map(|(i, s)| {
                let key = match s.kind {
                    Kind::Dashed => Key::Dashes,
                    Kind::Points => Key::Dot,
                    _ => Key::Line,
                };
                (key, s.shade(i), s.name.as_str())
            })
            .collect();
        let area = frame::legend_above(out, area, self.legend, &entries);
        let x = self.x.fit(self.xs());
        let y = self.y.fit(self.ys());
        let plot = frame::axes(out, area, (&x, &self.x), (&y, &self.y));
        let place = Axes { plot, x, y };
        for (value, name) in &self.levels {
            if let Some(at) = place.y.place(*value) {
                let y = plot.bottom() - at * plot.height;
                out.dashes(&[(plot.x, y), (plot.right(), y)], 1.3, MUTED);
                frame::muted(out, (plot.right() - 6.0, y - 8.0), name, SMALL, Anchor::End);
            }
        }
        for (i, series) in self.series.iter().enumerate() {
            series.shade_band(out, &place, i);
        }
        for (i, series) in self.series.iter().enumerate() {
            series.draw(out, &place, i);
        }
        frame::legend(out, plot, self.legend, &entries);
    }

    fn xs(&self) -> impl Iterator<Item = f64> {
        self.series.iter().flat_map(|s| {
            s.points
                .iter()
                .map(|p| p.0)
                .chain(s.band.iter().map(|b| b.0))
        })
    }

    fn ys(&self) -> impl Iterator<Item = f64> {
        let bands = |s: &'_ Series| s.band.iter().flat_map(|b| [b.1, b.2]).collect::<Vec<_>>();
        self.series
            .iter()
            .flat_map(move |s| s.points.iter().map(|p| p.1).chain(bands(s)))
            .chain(self.levels.iter().map(|l| l.0))
    }
}

struct Axes {
    plot: Area,
    x: Fitted,
    y: Fitted,
}

impl Axes {
    fn at(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        let (x, y) = (self.x.place(x)?, self.y.place(y)?);
        Some((
            self.plot.x + x * self.plot.width,
            self.plot.bottom() - y * self.plot.height,
        ))
    }
}

impl Series {
    fn shade(&self, i: usize) -> Colour {
        self.colour.unwrap_or_else(|| category(i))
    }

    fn shade_band(&self, out: &mut Drawing, place: &Axes, i: usize) {
        let upper = self.band.iter().filter_map(|b| place.at((b.0, b.2)));
        let lower = self.band.iter().rev().filter_map(|b| place.at((b.0, b.1)));
        let outline: Vec<_> = upper.chain(lower).collect();
        if outline.len() > 2 {
            out.fill(outline, self.shade(i).with_opacity(0.16));
        }
    }

    fn draw(&self, out: &mut Drawing, place: &Axes, i: usize) {
        let colour = self.shade(i);
        let points: Vec<_> = self.points.iter().filter_map(|&p| place.at(p)).collect();
        match self.kind {
            Kind::Line => out.path(points, 2.0, colour),
            Kind::Dashed => out.dashes(&points, 1.6, colour),
            Kind::Steps => {
                let corners = points.windows(2).flat_map(|w| [w[0], (w[1].0, w[0].1)]);
                let path = corners.chain(points.last().copied()).collect();
                out.path(path, 2.0, colour);
            }
            Kind::Points => {
                for at in points {
                    out.disc(at, 3.2, colour.with_opacity(0.75));
                }
            }
            Kind::Marked => {
                out.path(points.clone(), 2.0, colour);
                for at in points {
                    out.disc(at, 3.4, colour);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_abscissas_of_a_chart_are_those_of_its_points_and_bands() {
        let line = Series::line("a", vec![(10.0, 1.0), (20.0, 2.0)]);
        let chart = Chart::new("title", Scale::new("x"), Scale::new("y"))
            .series(line.band(vec![(5.0, 0.0, 1.0)]));
        assert_eq!(chart.xs().collect::<Vec<f64>>(), [10.0, 20.0, 5.0]);
    }
}
