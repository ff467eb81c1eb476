//! Why a list of boxes and facade pieces is not a building.

/// One variant per way to be wrong, with the culprit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildingError {
    /// A unit of length that nobody knows.
    #[error("unit is {unit:?}, expected m, cm, mm, ft or in")]
    Unit {
        /// The unit found.
        unit: String,
    },
    /// A size or coordinate that no building has.
    #[error("{place} is {value}: more than {most:.0}, which no house reaches")]
    TooLarge {
        /// Path of the field.
        place: String,
        /// The value found.
        value: f64,
        /// The largest allowed, in the building's unit.
        most: f64,
    },
    /// A box of more floors than any house has.
    #[error("boxes[{index}].height is {floors:.0} floor heights, expected at most 100")]
    Floors {
        /// Index of the box.
        index: usize,
        /// Its height over the floor height.
        floors: f64,
    },
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
