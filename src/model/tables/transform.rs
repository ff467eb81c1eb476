//! Monotone transforms of a real column: bounds made soft, heavy tails drawn in.
//!
//! ```text
//! y = x                                          none
//! y = log(1 + x / c)            for x ≥ 0        lengths, areas, counts: nothing below 0
//! y = log((x + c) / (1 - x + c)) for 0 ≤ x ≤ 1   shares
//! z = s asinh((y - m) / s)                       tails: linear near m, logarithmic beyond s
//! ```
//! Outside its bounds `y` goes on along its tangent, so that every real number has an image and a density: one value on
//! the wrong side is unlikely, not impossible. All are differentiable and strictly rising, so that with a density p of z
//! the density of x is `p(z(x)) dz/dx`.
//!
//! Sources: Box and Cox 1964; Johnson 1949 (asinh).

use serde::{Deserialize, Serialize};

/// The bounds of a column's values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bounds {
    /// No bound: `y = x`.
    None,
    /// `y = log(1 + x / c)`.
    Positive {
        /// c, in the column's units.
        offset: f64,
    },
    /// `y = log((x + c) / (1 - x + c))`.
    Share {
        /// c.
        offset: f64,
    },
}

impl Bounds {
    /// y and `log dy/dx`.
    fn forward(self, x: f64) -> (f64, f64) {
        match self {
            Self::None => (x, 0.0),
            Self::Positive { offset: c } => match x < 0.0 {
                true => (x / c, -c.ln()),
                false => ((x / c).ln_1p(), -(x + c).ln()),
            },
            Self::Share { offset: c } => {
                let inside = x.clamp(0.0, 1.0);
                let slope = 1.0 / (inside + c) + 1.0 / (1.0 - inside + c);
                let y = ((inside + c) / (1.0 - inside + c)).ln();
                (y + (x - inside) * slope, slope.ln())
            }
        }
    }

    fn inverse(self, y: f64) -> f64 {
        match self {
            Self::None => y,
            Self::Positive { offset: c } => match y < 0.0 {
                true => y * c,
                false => y.exp_m1() * c,
            },
            Self::Share { offset: c } => {
                let top = ((1.0 + c) / c).ln();
                let inside = y.clamp(-top, top);
                // (1 + c) / (1 + exp(-y)) - c / (1 + exp(y)), from x + c = exp(y) (1 - x + c).
                let x = (1.0 + c) / (1.0 + (-inside).exp()) - c / (1.0 + inside.exp());
                let slope = 1.0 / c + 1.0 / (1.0 + c);
                x + (y - inside) / slope
            }
        }
    }
}

/// Tails that are drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tails {
    /// m.
    pub centre: f64,
    /// s, positive.
    pub scale: f64,
}

/// A monotone transform of a column.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Transform {
    /// x to y.
    pub bounds: Bounds,
    /// y to z.
    pub tails: Option<Tails>,
}

impl Transform {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = Self {
        bounds: Bounds::None,
        tails: None,
    };

    /// z and `log dz/dx`.
    pub fn forward(&self, x: f64) -> (f64, f64) {
        let (y, slope) = self.bounds.forward(x);
        match self.tails {
            None => (y, slope),
            Some(Tails { centre, scale }) => {
                let u = (y - centre) / scale;
                (scale * u.asinh(), slope - u.hypot(1.0).ln())
            }
        }
    }

    /// x with the given z.
    pub fn inverse(&self, z: f64) -> f64 {
        let y = match self.tails {
            None => z,
            Some(Tails { centre, scale }) => centre + scale * (z / scale).sinh(),
        };
        self.bounds.inverse(y)
    }

    /// Number of parameters chosen from data.
    pub fn parameters(&self) -> usize {
        usize::from(self.bounds != Bounds::None) + 2 * usize::from(self.tails.is_some())
    }

    /// True if every parameter is in its range: for transforms from a file.
    pub(super) fn valid(&self) -> bool {
        let positive = |v: f64| v > 0.0 && v.is_finite();
        let bounds = match self.bounds {
            Bounds::None => true,
            Bounds::Positive { offset } | Bounds::Share { offset } => positive(offset),
        };
        bounds
            && self
                .tails
                .is_none_or(|t| t.centre.is_finite() && positive(t.scale))
    }
}
