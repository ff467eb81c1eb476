//! A picture as a list of marks, in logical pixels with y down: drawn once, rendered to SVG and PNG.

use super::colour::{Colour, INK};

/// The place of a text relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The point is its left end (or its lower end when vertical).
    Start,
    /// The point is its middle.
    Middle,
    /// The point is its right end.
    End,
}

/// A text with its place.
#[derive(Debug, Clone)]
pub(crate) struct Text {
    /// The point.
    pub at: (f64, f64),
    /// The words.
    pub text: String,
    /// Height of the font in logical pixels.
    pub size: f64,
    /// Along the reading direction; across it, texts are centred on the point.
    pub anchor: Anchor,
    /// Colour.
    pub colour: Colour,
    /// Bold face.
    pub bold: bool,
    /// Reads from bottom to top.
    pub vertical: bool,
}

/// One mark.
#[derive(Debug, Clone)]
pub(crate) enum Mark {
    /// An open line.
    Path {
        /// Its points.
        points: Vec<(f64, f64)>,
        /// Width.
        width: f64,
        /// Colour.
        colour: Colour,
    },
    /// A filled polygon.
    Fill {
        /// Its corners.
        points: Vec<(f64, f64)>,
        /// Colour.
        colour: Colour,
    },
    /// A filled disc.
    Disc {
        /// Centre.
        at: (f64, f64),
        /// Radius.
        radius: f64,
        /// Colour.
        colour: Colour,
    },
    /// A text.
    Text(Text),
}

/// A picture.
#[derive(Debug, Clone)]
pub(crate) struct Drawing {
    /// Width in logical pixels.
    pub width: f64,
    /// Height in logical pixels.
    pub height: f64,
    /// The marks, the first at the back.
    pub marks: Vec<Mark>,
}

/// A rectangle of the drawing: left, top, width, height.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Area {
    /// Left.
    pub x: f64,
    /// Top.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Area {
    /// The area inside margins.
    pub(crate) fn inside(self, left: f64, top: f64, right: f64, bottom: f64) -> Self {
        Self {
            x: self.x + left,
            y: self.y + top,
            width: (self.width - left - right).max(1.0),
            height: (self.height - top - bottom).max(1.0),
        }
    }

    /// Right edge.
    pub(crate) fn right(self) -> f64 {
        self.x + self.width
    }

    /// Bottom edge.
    pub(crate) fn bottom(self) -> f64 {
        self.y + self.height
    }
}

impl Drawing {
    /// An empty picture.
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            marks: Vec::new(),
        }
    }

    /// Adds a line.
    pub(crate) fn path(&mut self, points: Vec<(f64, f64)>, width: f64, colour: Colour) {
        if points.len() > 1 {
            self.marks.push(Mark::Path {
                points,
                width,
                colour,
            });
        }
    }

    /// Adds a dashed line.
    pub(crate) fn dashes(&mut self, points: &[(f64, f64)], width: f64, colour: Colour) {
        const ON: f64 = 5.0;
        const OFF: f64 = 3.5;
        let mut phase = 0.0;
        let mut dash: Vec<(f64, f64)> = Vec::new();
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            let mut at = 0.0;
            while at < length {
                let on = phase < ON;
                let step = (if on { ON - phase } else { ON + OFF - phase }).min(length - at);
                let point = |t: f64| {
                    (
                        a.0 + (b.0 - a.0) * t / length,
                        a.1 + (b.1 - a.1) * t / length,
                    )
                };
                if on {
                    if dash.is_empty() {
                        dash.push(point(at));
                    }
                    dash.push(point(at + step));
                }
                at += step;
                phase += step;
                if on && phase >= ON - 1e-9 {
                    self.path(std::mem::take(&mut dash), width, colour);
                }
                if phase >= ON + OFF - 1e-9 {
                    phase = 0.0;
                }
            }
        }
        self.path(dash, width, colour);
    }

    /// Adds a filled polygon.
    pub(crate) fn fill(&mut self, points: Vec<(f64, f64)>, colour: Colour) {
        self.marks.push(Mark::Fill { points, colour });
    }

    /// Adds a filled rectangle.
    pub(crate) fn rect(&mut self, area: Area, colour: Colour) {
        self.fill(corners(area), colour);
    }

    /// Adds the outline of a rectangle.
    pub(crate) fn outline(&mut self, area: Area, width: f64, colour: Colour) {
        let mut points = corners(area);
        // Closed by hand; the start reaches over the corner that the end leaves open.
        points.push(points[0]);
        points[0].0 -= width / 2.0;
        self.path(points, width, colour);
    }

    /// Adds a disc.
    pub(crate) fn disc(&mut self, at: (f64, f64), radius: f64, colour: Colour) {
        self.marks.push(Mark::Disc { at, radius, colour });
    }

    /// Adds a text in ink.
    pub(crate) fn text(&mut self, at: (f64, f64), text: &str, size: f64, anchor: Anchor) {
        self.label(Text {
            at,
            text: text.to_string(),
            size,
            anchor,
            colour: INK,
            bold: false,
            vertical: false,
        });
    }

    /// Adds a text with everything said.
    pub(crate) fn label(&mut self, text: Text) {
        if !text.text.is_empty() {
            self.marks.push(Mark::Text(text));
        }
    }
}

fn corners(area: Area) -> Vec<(f64, f64)> {
    vec![
        (area.x, area.y),
        (area.right(), area.y),
        (area.right(), area.bottom()),
        (area.x, area.bottom()),
    ]
}
