//! Axis-parallel rectangles.

use serde::{Deserialize, Serialize};

/// Direction along which a rectangle is split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Left to right.
    X,
    /// Bottom to top.
    Y,
}

impl Axis {
    /// Both axes, x first.
    pub const BOTH: [Axis; 2] = [Axis::X, Axis::Y];

    /// The other axis.
    pub fn other(self) -> Self {
        match self {
            Axis::X => Axis::Y,
            Axis::Y => Axis::X,
        }
    }

    /// `"x"` or `"y"`.
    pub fn name(self) -> &'static str {
        match self {
            Axis::X => "x",
            Axis::Y => "y",
        }
    }
}

/// A rectangle by its lower-left corner and size, in the unit of its facade.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rect {
    /// Left edge.
    pub x: f64,
    /// Bottom edge.
    pub y: f64,
    /// Extent along x, not negative.
    pub width: f64,
    /// Extent along y, not negative.
    pub height: f64,
}

impl Rect {
    /// The rectangle with lower-left corner `(x, y)` and the given size.
    pub fn new(x: f64, y: f64, width: f64, height: f64) -> Self {
        Self {
            x,
            y,
            width,
            height,
        }
    }

    /// Right edge.
    #[inline]
    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    /// Top edge.
    #[inline]
    pub fn top(&self) -> f64 {
        self.y + self.height
    }

    /// Area in squared units.
    pub fn area(&self) -> f64 {
        self.width * self.height
    }

    /// Abscissa and ordinate of the centre.
    pub fn centre(&self) -> (f64, f64) {
        (self.x + self.width / 2.0, self.y + self.height / 2.0)
    }

    /// True if a point lies in the rectangle, its lower and left edges included.
    pub fn contains(&self, x: f64, y: f64) -> bool {
        (self.x..self.right()).contains(&x) && (self.y..self.top()).contains(&y)
    }

    /// Area that two rectangles share.
    pub fn overlap(&self, other: &Rect) -> f64 {
        let width = self.right().min(other.right()) - self.x.max(other.x);
        let height = self.top().min(other.top()) - self.y.max(other.y);
        width.max(0.0) * height.max(0.0)
    }

    /// Intersection over union; 0 where neither has an area.
    pub fn iou(&self, other: &Rect) -> f64 {
        let shared = self.overlap(other);
        let union = self.area() + other.area() - shared;
        if union > 0.0 { shared / union } else { 0.0 }
    }

    /// Lower coordinate along `axis`.
    pub fn start(&self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.x,
            Axis::Y => self.y,
        }
    }

    /// Extent along `axis`.
    pub fn extent(&self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.width,
            Axis::Y => self.height,
        }
    }

    /// Upper coordinate along `axis`.
    pub fn end(&self, axis: Axis) -> f64 {
        self.start(axis) + self.extent(axis)
    }

    /// The part of the rectangle from `start` over `extent` along `axis` (absolute coordinates).
    pub fn strip(&self, axis: Axis, start: f64, extent: f64) -> Self {
        match axis {
            Axis::X => Self {
                x: start,
                width: extent,
                ..*self
            },
            Axis::Y => Self {
                y: start,
                height: extent,
                ..*self
            },
        }
    }
}
