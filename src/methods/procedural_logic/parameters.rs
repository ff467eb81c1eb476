//! The three numbers of Eq. 3, and what the text leaves open about them.

use serde::{Deserialize, Serialize};

use edifice_shape::Axis;

/// The reading of "W, the size of the facade" in Eq. 3: the extent by which the terms are divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Extent {
    /// The scope: the mean over the line, a number between 0 and 1 whatever the scope.
    Scope,
    /// The whole facade; pixels outside the scope count nothing, so short lines are cheap.
    Facade,
    /// The whole facade; pixels outside the scope are no edge (`e = 1`), so long lines are cheap
    /// ("rewards splitting along a longer line").
    #[default]
    Line,
}

/// The reading of Eq. 6: the asset that faces an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Facing {
    /// The asset beyond the next edge along the normal: window, across the wall, window.
    #[default]
    Across,
    /// The asset on the other side of the edge itself.
    Adjacent,
}

/// Parameters of the energy, Eq. 3 to 5.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// `alpha`: weight of the edge term against the affinity term, 0..=1.
    pub alpha: f64,
    /// `b_p`: factor on proposals in the direction of the last split, in (0, 1].
    pub parental_bias: f64,
    /// `b_h`: factor on horizontal lines, in (0, 1].
    pub horizontal_bias: f64,
    /// Reading of `W`.
    #[serde(default)]
    pub extent: Extent,
    /// Reading of Eq. 6.
    #[serde(default)]
    pub facing: Facing,
}

/// A parameter out of its range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{name} is {value}, expected a number in {range}")]
pub struct ParameterError {
    /// `alpha`, `b_p` or `b_h`.
    pub name: &'static str,
    /// The value found.
    pub value: f64,
    /// The range allowed.
    pub range: &'static str,
}

impl Parameters {
    /// Section 5.3: used for the compression results.
    pub const COMPRESSION: Self = Self {
        alpha: 0.6,
        parental_bias: 0.25,
        horizontal_bias: 0.5,
        extent: Extent::Line,
        facing: Facing::Across,
    };
    /// Section 5.4: searched for retrieval on ECP2011.
    pub const RETRIEVAL: Self = Self {
        alpha: 0.5,
        parental_bias: 0.0625,
        horizontal_bias: 0.125,
        ..Self::COMPRESSION
    };

    /// Checks `alpha`, `b_p` and `b_h`; the readings are the default ones.
    ///
    /// # Errors
    /// [`ParameterError`] naming the first one out of range.
    pub fn new(
        alpha: f64,
        parental_bias: f64,
        horizontal_bias: f64,
    ) -> Result<Self, ParameterError> {
        Self {
            alpha,
            parental_bias,
            horizontal_bias,
            ..Self::COMPRESSION
        }
        .checked()
    }

    /// The parameters, if all three are in range.
    ///
    /// # Errors
    /// [`ParameterError`] naming the first one out of range.
    pub fn checked(self) -> Result<Self, ParameterError> {
        if !(0.0..=1.0).contains(&self.alpha) {
            return Err(ParameterError {
                name: "alpha",
                value: self.alpha,
                range: "[0, 1]",
            });
        }
        for (name, value) in [("b_p", self.parental_bias), ("b_h", self.horizontal_bias)] {
            if !(value > 0.0 && value <= 1.0) {
                return Err(ParameterError {
                    name,
                    value,
                    range: "(0, 1]",
                });
            }
        }
        Ok(self)
    }

    /// `b^(h) b^(p)` of a proposal that splits along `axis` (Y: a horizontal line), Eq. 4 and 5.
    pub fn bias(&self, axis: Axis, parent: Option<Axis>) -> f64 {
        let horizontal = if axis == Axis::Y {
            self.horizontal_bias
        } else {
            1.0
        };
        let parental = if parent == Some(axis) {
            self.parental_bias
        } else {
            1.0
        };
        horizontal * parental
    }
}
