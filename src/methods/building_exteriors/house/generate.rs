//! From a row of attributes to a house.

use rand::Rng;
use serde::Serialize;

use super::Database;
use super::model::{Model, model};
use super::roofs::Joining;
use super::solids::prisms;
use crate::methods::building_exteriors::attributes::{AttributeError, attributes};
use crate::methods::building_exteriors::facade::{FacadeTarget, furnish};
use crate::methods::building_exteriors::mass::repair::{Change, Contradiction, check, repair};
use crate::methods::building_exteriors::mass::{
    MASS, MassError, MassModel, MassTarget, Search, max_z, search,
};
use crate::shape::solid::{SurfaceError, faces};
use crate::shape::{BoxStyle, Building, MassBox, Ridge, RoofStyle, Special};

/// Continuous columns: mass and facades.
const NUMBERS: usize = 39;

/// How to generate.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Limits of the search for mass models.
    pub search: Search,
    /// How roofs are joined.
    pub joining: Joining,
    /// Whether no strip of a facade may be cut in two.
    pub no_cuts: bool,
}

/// Why there is no house.
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {
    /// Given values contradict each other.
    #[error(transparent)]
    Contradiction(#[from] Contradiction),
    /// No mass model was found.
    #[error(transparent)]
    Mass(#[from] MassError),
    /// The surface is not closed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The house has no attributes.
    #[error(transparent)]
    Attributes(#[from] AttributeError),
}

/// A generated house.
#[derive(Debug, Clone)]
pub struct Generated {
    /// Its parameters.
    pub building: Building,
    /// Its surface.
    pub model: Model,
    /// How it came about.
    pub report: HouseReport,
}

/// Wanted, repaired and reached.
#[derive(Debug, Clone, Serialize)]
pub struct HouseReport {
    /// Name of the house.
    pub house: String,
    /// The 49 columns asked for.
    pub wanted: Vec<f64>,
    /// Sampled values that no house could have, and what took their place.
    pub repaired: Vec<Change>,
    /// The 49 columns measured on the house.
    pub reached: Vec<f64>,
    /// Largest distance from the wanted mass columns in standard deviations.
    pub mass_z: f64,
    /// The same of all 39 numbers.
    pub max_z: f64,
    /// Mean distance of the 39 numbers.
    pub mean_z: f64,
    /// The same largest distance, from the repaired row.
    pub repaired_z: f64,
    /// Whether all ten styles are as wanted.
    pub styles: bool,
    /// Name of the house of the database whose boxes it has; none for a random arrangement.
    pub donor: Option<String>,
    /// How often attributes were measured.
    pub evaluations: u64,
    /// Triangles of the surface.
    pub triangles: usize,
    /// Connected parts of the surface: 1.
    pub shells: usize,
    /// Enclosed volume.
    pub volume: f64,
    /// Windows and doors that no wall has room for: 0.
    pub unplaced: usize,
}

/// Makes a house with the wanted attributes. `given` says which columns must not be changed: all of them given must
/// be free of contradictions, others are repaired.
///
/// # Errors
/// [`GenerateError`].
pub fn generate(
    name: &str,
    wanted: &[f64; 49],
    given: &[bool; 49],
    database: &Database,
    options: &Options,
    rng: &mut impl Rng,
) -> Result<Generated, GenerateError> {
    let mut row = *wanted;
    if given.iter().all(|g| *g) {
        check(&row)?;
    }
    let repaired = repair(&mut row, given, &database.deviations);
    let target = MassTarget::new(std::array::from_fn(|c| row[c]));
    let mass = search(&target, &[], database, &options.search, rng)?;
    finish(name, wanted, &row, repaired, mass, database, options)
}

/// Puts roofs and facades on a mass model.
///
/// # Errors
/// [`GenerateError`].
pub fn finish(
    name: &str,
    wanted: &[f64; 49],
    row: &[f64; 49],
    repaired: Vec<Change>,
    mass: MassModel,
    database: &Database,
    options: &Options,
) -> Result<Generated, GenerateError> {
    let flag = |c: usize| row[c] > 0.5;
    let mut building = mass.building;
    building.name = name.into();
    building.unit = "m".into();
    roof(&mut building.boxes, [flag(39), flag(40), flag(41)]);
    let special = [(47, Special::Chimney), (48, Special::Tower)];
    building.special = special
        .into_iter()
        .filter(|(c, _)| flag(*c))
        .map(|(_, s)| s)
        .collect();
    let shell = faces(&prisms(&building, options.joining));
    let facades = furnish(
        &building,
        &shell,
        &FacadeTarget {
            wanted: std::array::from_fn(|k| row[MASS + k]),
            windows: std::array::from_fn(|k| flag(42 + k)),
            cuts: !options.no_cuts,
        },
        &database.deviations[MASS..NUMBERS],
    );
    building.facades = facades.pieces;
    let model = model(&building, options.joining)?;
    let reached: Vec<f64> = attributes(&building)?
        .into_iter()
        .map(|v| v.unwrap_or(0.0))
        .collect();
    let z = |c: usize| ((reached[c] - wanted[c]) / database.deviations[c]).abs();
    let deviations = &database.deviations;
    let report = HouseReport {
        house: name.into(),
        mass_z: max_z(&reached[..MASS], &wanted[..MASS], deviations),
        max_z: max_z(&reached[..NUMBERS], &wanted[..NUMBERS], deviations),
        mean_z: (0..NUMBERS).map(z).sum::<f64>() / NUMBERS as f64,
        repaired_z: max_z(&reached[..NUMBERS], &row[..NUMBERS], deviations),
        styles: (NUMBERS..49).all(|c| (reached[c] > 0.5) == (wanted[c] > 0.5)),
        donor: mass.donor.map(|d| database.buildings[d].name.clone()),
        evaluations: mass.evaluations + facades.evaluations,
        triangles: model.report.triangles,
        shells: model.report.shells,
        volume: model.report.volume,
        unplaced: model.unplaced.len(),
        wanted: wanted.to_vec(),
        repaired,
        reached,
    };
    Ok(Generated {
        building,
        model,
        report,
    })
}

/// Gives every box a roof so that the flagged styles (flat, gable, hip), and no others, occur: the one that most of
/// the area has already is the main one, the others go to porches, the garage and small boxes. Ridges run along the
/// longer side. Without any flag all roofs are sheds, which no attribute tells.
fn roof(boxes: &mut [MassBox], flags: [bool; 3]) {
    let styles = [RoofStyle::Flat, RoofStyle::Gable, RoofStyle::Hip];
    let flagged: Vec<RoofStyle> = styles
        .into_iter()
        .zip(flags)
        .filter(|(_, f)| *f)
        .map(|(s, _)| s)
        .collect();
    let area = |b: &MassBox| b.width * b.depth;
    let shown = |s: RoofStyle| {
        let own = boxes
            .iter()
            .filter(|b| b.roof.style == s && b.style == BoxStyle::Main);
        own.map(area).sum::<f64>()
    };
    let main = flagged
        .iter()
        .copied()
        .max_by(|a, b| shown(*a).total_cmp(&shown(*b)))
        .unwrap_or(RoofStyle::Shed);
    for b in boxes.iter_mut() {
        b.roof.style = main;
        b.roof.ridge = if b.width >= b.depth {
            Ridge::X
        } else {
            Ridge::Y
        };
    }
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let rank = |b: &MassBox| match b.style {
        BoxStyle::Porch => 0,
        BoxStyle::Garage => 1,
        BoxStyle::Main => 2,
    };
    order.sort_by(|&i, &j| {
        let (a, b) = (&boxes[i], &boxes[j]);
        rank(a).cmp(&rank(b)).then(area(a).total_cmp(&area(b)))
    });
    let others: Vec<RoofStyle> = flagged.into_iter().filter(|s| *s != main).collect();
    for (style, i) in others.into_iter().zip(order) {
        boxes[i].roof.style = style;
    }
    for b in boxes.iter_mut() {
        b.roof.pitch = match b.roof.style {
            RoofStyle::Flat => 0.0,
            RoofStyle::Shed => 12.0,
            _ if b.roof.pitch > 5.0 => b.roof.pitch,
            _ => 30.0,
        };
    }
}
