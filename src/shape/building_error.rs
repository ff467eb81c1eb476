//! Why a list of boxes and facade pieces is not a building.

/// One variant per way to be wrong, with the culprit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BuildingError {
    /// The mass model is empty.
    #[error("the building has no boxes")]
    NoBoxes,
    /// A coordinate is NaN or infinite.
    #[error("{place} is {value}, expected a finite number")]
    NotFinite {
        /// Path of the field.
        place: String,
        /// The value found.
        value: f64,
    },
    /// A size is not a positive number.
    #[error("{place} is {value}, expected a number above zero")]
    NotPositive {
        /// Path of the field.
        place: String,
        /// The value found.
        value: f64,
    },
    /// A roof too steep, or sloping the wrong way.
    #[error("boxes[{index}].roof.pitch is {value}, expected degrees from 0 to below 90")]
    Pitch {
        /// Index of the box.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A facade piece starts below the ground.
    #[error("facades[{index}].base is {base}: below the ground")]
    Underground {
        /// Index of the piece.
        index: usize,
        /// Its base.
        base: f64,
    },
    /// A window or door reaches outside its piece of wall.
    #[error(
        "facades[{piece}].elements[{element}] reaches outside its facade piece of {width} x {height}"
    )]
    ElementOutside {
        /// Index of the piece.
        piece: usize,
        /// Index of the element.
        element: usize,
        /// Width of the piece.
        width: f64,
        /// Height of the piece.
        height: f64,
    },
}
