//! Why a file is no CityGML, and what is left out of one.

/// Deepest nesting of elements.
pub(super) const DEEPEST: usize = 256;

/// Why a file is no CityGML.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CityGmlError {
    /// Malformed XML.
    #[error(transparent)]
    Xml(#[from] quick_xml::Error),
    /// The file ends inside an element.
    #[error("the file ends inside <{0}>")]
    Truncated(String),
    /// Elements nest too deeply.
    #[error("elements nest more than {DEEPEST} deep")]
    TooDeep,
    /// The outermost element is another.
    #[error("<{0}>, expected <CityModel>")]
    NoModel(String),
    /// Coordinates that are none.
    #[error("{0:?} is no coordinate")]
    Coordinate(String),
    /// Coordinates that do not come in twos or threes.
    #[error("{count} numbers are no corners of {dimension} coordinates")]
    Dimension {
        /// Number of the coordinates.
        count: usize,
        /// Of each corner.
        dimension: usize,
    },
}

/// Numbers of elements that were left out, by cause.
#[derive(Default)]
pub(super) struct Dropped {
    pub(super) others: usize,
    pub(super) empty: usize,
    pub(super) implicit: usize,
    pub(super) rooms: usize,
    pub(super) references: usize,
    pub(super) degenerate: usize,
}
