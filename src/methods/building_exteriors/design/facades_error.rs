//! Why no house is made of facades and a plan.

use edifice_model::ModelError;
use edifice_shape::Side;

use super::left_out::LeftOut;
use crate::attributes::AttributeError;
use crate::house::GenerateError;
use crate::mass::footprint::PlanError;

/// Why no house is made of facades and a plan.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FacadesError {
    /// No facade is given.
    #[error("no facade is given")]
    NoFacade,
    /// Two facades are given for one side.
    #[error("two facades of the {} are given", side.name())]
    Twice {
        /// The side.
        side: Side,
    },
    /// The unit of a layout is no length, and no scale is given.
    #[error("the unit of the {} is {unit:?}, which is no length (m, cm, mm, ft, in): its width or height in metres must be given", side.name())]
    Unit {
        /// The side.
        side: Side,
        /// The unit found.
        unit: String,
    },
    /// A width or height that is given is not a positive number.
    #[error("{value} is no width or height in metres")]
    Scale {
        /// The value found.
        value: f64,
    },
    /// A layout has neither windows nor doors.
    #[error("the {} has no region that is a window or a door", side.name())]
    NoElements {
        /// The side.
        side: Side,
    },
    /// A facade is wider or narrower than its side of the plan by more than 5 %.
    #[error("the {} is {facade:.2} m wide, that side of the footprint {plan:.2} m: more than 5 % apart, check the scale", side.name())]
    Width {
        /// The side.
        side: Side,
        /// Width of the facade, in metres.
        facade: f64,
        /// Width of that side of the plan, in metres.
        plan: f64,
    },
    /// Two facades have other eaves, by more than 5 %.
    #[error("the {} is {facade:.2} m high, the {} {height:.2} m: more than 5 % apart; both reach from the ground to the eaves", side.name(), first.name())]
    Height {
        /// The side.
        side: Side,
        /// Height of its facade, in metres.
        facade: f64,
        /// The side of the first facade.
        first: Side,
        /// Height of that facade, in metres.
        height: f64,
    },
    /// The eaves are too low or too high for a house.
    #[error(
        "the eaves are {eaves:.2} m high; those of a house of one to three storeys {lowest} to {highest} m: check the scale"
    )]
    Eaves {
        /// Height of the eaves, in metres.
        eaves: f64,
        /// The lowest eaves, in metres.
        lowest: f64,
        /// The highest eaves, in metres.
        highest: f64,
    },
    /// More rows of windows than a house has storeys.
    #[error(
        "{rows} rows of windows below eaves of {eaves:.2} m; houses have at most three storeys"
    )]
    Rows {
        /// Number of rows.
        rows: usize,
        /// Height of the eaves, in metres.
        eaves: f64,
    },
    /// No marked window or door has a place on the house.
    #[error("none of {marked} marked windows and doors has a place; the first: {first}")]
    NonePlaced {
        /// Number of windows and doors.
        marked: usize,
        /// The reason why the first one has none.
        first: LeftOut,
    },
    /// The model refuses the evidence.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// No house was found.
    #[error(transparent)]
    Generate(#[from] GenerateError),
}

impl From<PlanError> for FacadesError {
    fn from(error: PlanError) -> Self {
        Self::Generate(error.into())
    }
}

impl From<AttributeError> for FacadesError {
    fn from(error: AttributeError) -> Self {
        Self::Generate(error.into())
    }
}
