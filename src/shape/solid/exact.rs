//! Exact plane geometry: points and lines in homogeneous integer coordinates.
//!
//! Lengths are whole [`UNIT`]s, slopes whole thousandths, so that the sides of a plan and the lines in which two
//! roof planes meet have integer coefficients. Every vertex is the crossing of two of these lines, never of
//! derived ones, so that numbers stay small: with coordinates up to 10^6 units and slopes up to 10, below 10^31,
//! far within 128 bits. Whether a point lies on a line, left or right of it is thus decided without rounding.

use std::cmp::Ordering;

/// A length of one unit in metres: a tenth of a millimetre.
pub const UNIT: f64 = 1e-4;
/// Slopes are whole multiples of one over this.
pub const SLOPES: i128 = 1000;

/// The line `a x + b y + c = 0`, coefficients without common factor; left of it is positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Line {
    /// Coefficient of x.
    pub a: i128,
    /// Coefficient of y.
    pub b: i128,
    /// Constant.
    pub c: i128,
}

impl Line {
    /// A line from any coefficients, `a` and `b` not both zero.
    pub fn new(a: i128, b: i128, c: i128) -> Self {
        let g = gcd(gcd(a, b), c).max(1);
        Self {
            a: a / g,
            b: b / g,
            c: c / g,
        }
    }

    /// The line with the sign of its coefficients made standard, the same for both directions.
    pub fn undirected(self) -> Self {
        match self.a < 0 || (self.a == 0 && self.b < 0) {
            true => self.reversed(),
            false => self,
        }
    }

    /// The same points with left and right exchanged.
    pub fn reversed(self) -> Self {
        Self {
            a: -self.a,
            b: -self.b,
            c: -self.c,
        }
    }

    /// On which side a point lies: `Greater` is positive.
    pub fn side(&self, p: &Point) -> Ordering {
        (self.a * p.x + self.b * p.y + self.c * p.w).cmp(&0)
    }

    /// The point where two lines cross; `None` if they are parallel.
    pub fn crossing(&self, other: &Line) -> Option<Point> {
        let w = self.a * other.b - other.a * self.b;
        (w != 0).then(|| {
            let x = self.b * other.c - other.b * self.c;
            let y = other.a * self.c - self.a * other.c;
            Point::new(x, y, w)
        })
    }

    /// Order of two points of the line along it.
    pub fn along(&self, p: &Point, q: &Point) -> Ordering {
        let t = |p: &Point| self.b * p.x - self.a * p.y;
        (t(p) * q.w).cmp(&(t(q) * p.w))
    }
}

/// The point `(x / w, y / w)`, without common factor, `w` positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Point {
    /// First coordinate.
    pub x: i128,
    /// Second coordinate.
    pub y: i128,
    /// Denominator.
    pub w: i128,
}

impl Point {
    /// A point from any homogeneous coordinates, `w` not zero.
    pub fn new(x: i128, y: i128, w: i128) -> Self {
        // The denominator is the smallest number as a rule, and 1 where both lines run along the axes.
        let g = gcd(gcd(w, x), y) * w.signum();
        Self {
            x: x / g,
            y: y / g,
            w: w / g,
        }
    }

    /// Coordinates in metres, rounded once.
    pub fn metres(&self) -> [f64; 2] {
        [self.x, self.y].map(|v| v as f64 / self.w as f64 * UNIT)
    }
}

/// The plane `z = (a x + b y + c) / SLOPES`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Plane {
    /// Slope along x in thousandths.
    pub a: i128,
    /// Slope along y in thousandths.
    pub b: i128,
    /// Height at the origin in thousandths of units.
    pub c: i128,
}

impl Plane {
    /// The level plane at a height in units.
    pub const fn level(height: i128) -> Self {
        Self {
            a: 0,
            b: 0,
            c: SLOPES * height,
        }
    }

    /// The plane that rises by `slope` thousandths along `(dx, dy)` from `height` at the point `(x, y)`.
    pub const fn rising(slope: i128, [dx, dy]: [i128; 2], [x, y]: [i128; 2], height: i128) -> Self {
        let (a, b) = (slope * dx, slope * dy);
        Self {
            a,
            b,
            c: SLOPES * height - a * x - b * y,
        }
    }

    /// The plane moved up by units.
    pub const fn raised(self, by: i128) -> Self {
        Self {
            c: self.c + SLOPES * by,
            ..self
        }
    }

    /// Height at a point times `SLOPES w`, to compare planes at one point.
    pub fn at(&self, p: &Point) -> i128 {
        self.a * p.x + self.b * p.y + self.c * p.w
    }

    /// Height at a point in metres.
    pub fn metres(&self, p: &Point) -> f64 {
        self.at(p) as f64 / (p.w * SLOPES) as f64 * UNIT
    }

    /// The line on whose left this plane is above the other; `None` for parallel planes.
    pub fn above(&self, other: &Plane) -> Option<Line> {
        let (a, b) = (self.a - other.a, self.b - other.b);
        (a != 0 || b != 0).then(|| Line::new(a, b, self.c - other.c))
    }
}

/// Greatest common divisor, not negative.
fn gcd(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    if a == 1 || b == 1 {
        return 1;
    }
    while b != 0 {
        // Most numbers fit 64 bits, where division is much faster.
        if let (Ok(p), Ok(q)) = (u64::try_from(a), u64::try_from(b)) {
            return i128::from(gcd64(p, q));
        }
        (a, b) = (b, a % b);
    }
    a
}

fn gcd64(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// Whole units nearest to a length in metres.
pub fn units(metres: f64) -> i128 {
    (metres / UNIT).round() as i128
}
