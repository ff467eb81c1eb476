//! The precision in which the numbers of a grammar are written.

use super::settings::Precision;
use edifice_grammar::instance::Grid;

/// The precision in which the numbers of a grammar are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Detail {
    /// Steps of lengths in a metre.
    pub(super) length: f64,
    /// Steps of turns in a degree.
    pub(super) angle: f64,
    /// Steps of a template's box.
    pub(super) box_steps: f64,
    /// Coplanar triangles of a template are joined within this share of its box.
    pub(super) coplanar: f64,
}

impl From<Precision> for Detail {
    fn from(precision: Precision) -> Self {
        match precision {
            Precision::Millimetre => Self::MILLIMETRE,
            Precision::Centimetre => Self::CENTIMETRE,
            Precision::Decimetre => Self::DECIMETRE,
        }
    }
}

impl Detail {
    /// At least centimetres, and hundredths of degrees: what rules compute is rounded so, and is found again in a city that was
    /// derived from them.
    pub(super) fn at_least_centimetre(self) -> Self {
        Self {
            length: self.length.max(Self::CENTIMETRE.length),
            angle: self.angle.max(Self::CENTIMETRE.angle),
            ..self
        }
    }

    /// The grid of what stands under the axiom.
    pub(super) fn grid(&self) -> Grid {
        Grid {
            length: self.length,
            turn: self.angle,
        }
    }

    /// Centimetres, hundredths of degrees, 12 bits: where templates stand for others, nothing finer is seen.
    pub(super) const CENTIMETRE: Self = Self {
        length: 100.0,
        angle: 100.0,
        box_steps: 4095.0,
        coplanar: 1e-3,
    };
    /// Millimetres, ten-thousandths of degrees, 16 bits: where each component has its own template.
    pub(super) const MILLIMETRE: Self = Self {
        length: 1000.0,
        angle: 10_000.0,
        box_steps: 65_535.0,
        coplanar: 2e-5,
    };
    /// Decimetres, half degrees, 7 bits: where few bytes count.
    pub(super) const DECIMETRE: Self = Self {
        length: 10.0,
        angle: 2.0,
        box_steps: 127.0,
        coplanar: 4e-3,
    };
}
