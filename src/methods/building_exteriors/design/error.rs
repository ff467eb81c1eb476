//! Why observed parts cannot be completed.

use crate::house::GenerateError;
use edifice_model::ModelError;

/// Why observed parts cannot be completed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompleteError {
    /// An observed box does not fit into the given bounding box.
    #[error(
        "boxes[{index}] of the partial house reaches from {low:.3} to {high:.3} m, outside 0 to {bound} m ({column})"
    )]
    Outside {
        /// Index of the box.
        index: usize,
        /// Its lower end, in metres.
        low: f64,
        /// Its upper end, in metres.
        high: f64,
        /// Column of the bounding box.
        column: &'static str,
        /// Value of that column, in metres.
        bound: f64,
    },
    /// An observed box has more floors than the house is to have.
    #[error(
        "boxes[{index}] of the partial house has {floors} floors, the shares of the floors (arf) ask for {wanted}"
    )]
    Floors {
        /// Index of the box.
        index: usize,
        /// Number of its floors.
        floors: usize,
        /// Number of floors of the house.
        wanted: usize,
    },
    /// An observed facade piece stands on no wall of the observed boxes.
    #[error("facades[{index}] of the partial house stands on no wall of its boxes")]
    NoWall {
        /// Index of the facade piece.
        index: usize,
    },
    /// No arrangement of further boxes leaves the observed facades free.
    #[error(
        "every arrangement of boxes found hides an observed facade piece or cuts the house apart"
    )]
    Hidden,
    /// No answer of the model could be built.
    #[error("none of {tried} answers of the model fits the observed parts; the first: {first}")]
    NoAnswer {
        /// Number of answers tried.
        tried: usize,
        /// The reason why the first one fails.
        first: Box<CompleteError>,
    },
    /// The model refuses the evidence.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// No house was found.
    #[error(transparent)]
    Generate(#[from] GenerateError),
}
