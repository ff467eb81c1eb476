//! Shipped houses that the completions of Fig. 16 to 19 hold out of model and donors, and the lines of those that are shown.

use std::path::Path;

use super::data;
use edifice_io::building_json;
use edifice_shape::{BoxStyle, Building};

/// Houses of the shipped database that are held out of model and donors.
pub(super) const HELD_OUT: usize = 20;

/// The held-out houses with their lines among the shipped ones.
fn held_out_lines() -> Vec<(usize, Building)> {
    let bytes = edifice_datasets::shipped_bytes(data::HOUSES).unwrap_or_default();
    let houses = building_json::parse_lines(bytes, Path::new(data::HOUSES)).unwrap_or_default();
    let known = houses.len().saturating_sub(HELD_OUT);
    houses.into_iter().enumerate().skip(known).collect()
}

/// The line of the house whose completion Fig. 16 shows.
pub(crate) fn first_held_out() -> Vec<usize> {
    held_out_lines()
        .first()
        .map(|(line, _)| *line)
        .into_iter()
        .collect()
}

/// The line of the house that Fig. 19 begins from.
pub(crate) fn first_without_garage() -> Vec<usize> {
    let houses = held_out_lines();
    let found = houses.iter().find(|(_, house)| has_no_garage(house));
    found.map(|(line, _)| *line).into_iter().collect()
}

/// True for a house without a garage.
pub(super) fn has_no_garage(house: &Building) -> bool {
    house.boxes.iter().all(|b| b.style != BoxStyle::Garage)
}
