//! From a row of attributes to a house.

use rand::{Rng, RngExt};
use serde::Serialize;

use super::Database;
use super::inspect::implausible;
use super::model::{Model, furnished};
use super::roof_styles::roof;
use super::roofs::Joining;
use super::solids::prisms;
use crate::attributes::{AttributeError, attributes};
use crate::facade::{FacadeTarget, Facades, FixedPiece, breed, elements, furnish};
use crate::mass::anneal::{AnnealSettings, anneal};
use crate::mass::contradiction::{Contradiction, check_given};
use crate::mass::footprint::{DECIDED, PlanError, reconcile, stand};
use crate::mass::repair::{Change, changes, repair};
use crate::mass::{
    MASS, MassError, MassModel, MassTarget, SearchLimits, max_z, search, variations,
};
use edifice_optim::annealing::AnnealingError;
use edifice_optim::genetic::{GeneticError, Settings};
use edifice_shape::solid::{Faces, SurfaceError, faces};
use edifice_shape::{Building, MassBox, Rect, Special};

/// Continuous columns: mass and facades.
const NUMBERS: usize = 39;
/// A house within this distance of its row (standard deviations) is near enough.
const NEAR: f64 = 0.05;
/// Standard deviations that a plausible house may be further away than one with something that one would not believe.
const FINDING: f64 = 0.25;
/// Findings that a missing style counts as: styles are asked for by name, so that a house without one is not what was ordered.
const STYLE: usize = 4;
/// Other plans tried else, their least 1 - IoU, and rounds of random arrangements over four to find them.
const OTHERS: usize = 8;
const APART: f64 = 0.02;
const ROUNDS: usize = 2;
/// Generations of the genetic algorithm; the paper prints none.
const GENERATIONS: u64 = 200;

/// The method of finding mass models and facades.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Donors and least squares, and facades side by side.
    #[default]
    Best,
    /// Annealing and a genetic algorithm, as printed.
    Paper,
}

/// The parts of a house that stay as they are, to the bit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Frozen {
    /// Boxes with their roofs.
    pub boxes: Vec<MassBox>,
    /// Pieces of facades with their walls.
    pub pieces: Vec<FixedPiece>,
    /// Left front corner of the bounding box of the whole house, where it is known.
    pub corner: Option<[f64; 2]>,
}

/// Options of generation.
#[derive(Debug, Clone)]
pub struct Options {
    /// Limits of the search for mass models.
    pub search: SearchLimits,
    /// The way in which roofs are joined.
    pub joining: Joining,
    /// True if no strip of a facade may be cut in two.
    pub no_cuts: bool,
    /// The method of finding mass models and facades.
    pub method: Method,
    /// Annealing of method `paper`.
    pub annealing: AnnealSettings,
    /// Generations of method `paper`.
    pub generations: u64,
    /// The parts that stay as they are; roofs and facades keep clear of them.
    pub frozen: Frozen,
    /// The ground plan, rectangles from the origin on, that the house has to cover exactly.
    pub footprint: Option<Vec<Rect>>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            search: SearchLimits::default(),
            joining: Joining::default(),
            no_cuts: false,
            method: Method::default(),
            annealing: AnnealSettings::default(),
            generations: GENERATIONS,
            frozen: Frozen::default(),
            footprint: None,
        }
    }
}

/// Why there is no house.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// Given values contradict each other.
    #[error(transparent)]
    Contradiction(#[from] Contradiction),
    /// No house stands on the footprint.
    #[error(transparent)]
    Footprint(#[from] PlanError),
    /// No mass model was found.
    #[error(transparent)]
    Mass(#[from] MassError),
    /// The surface is not closed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The house has no attributes.
    #[error(transparent)]
    Attributes(#[from] AttributeError),
    /// Bad settings of the annealing.
    #[error(transparent)]
    Annealing(#[from] AnnealingError),
    /// Bad settings of the genetic algorithm.
    #[error(transparent)]
    Genetic(#[from] GeneticError),
}

/// A generated house.
#[derive(Debug, Clone)]
pub struct Generated {
    /// Its parameters.
    pub building: Building,
    /// Its surface.
    pub model: Model,
    /// The attributes wanted, repaired and reached.
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
    /// True if all ten styles are as wanted.
    pub styles: bool,
    /// Name of the house of the database whose boxes it has; none for a random arrangement.
    pub donor: Option<String>,
    /// Number of times that attributes were measured.
    pub evaluations: u64,
    /// Triangles of the surface.
    pub triangles: usize,
    /// Connected parts of the surface: 1.
    pub shells: usize,
    /// Enclosed volume in cubic metres.
    pub volume: f64,
    /// Windows and doors that no wall has room for: 0.
    pub unplaced: usize,
}

/// Makes a house with the wanted attributes. `given` says which columns must not be changed: they must be free of
/// contradictions, others are repaired.
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
    check_given(&row, given)?;
    let mut known = *given;
    if let Some(plan) = &options.footprint {
        reconcile(&mut row, given, plan)?;
        DECIDED.iter().for_each(|c| known[*c] = true);
    }
    repair(&mut row, &known, &database.deviations);
    let repaired = changes(wanted, &row);
    let target = MassTarget::new(std::array::from_fn(|c| row[c]));
    let mass = match (&options.footprint, options.method) {
        (Some(plan), _) => stand(&row, given, plan, &database.deviations[..MASS])?,
        (None, Method::Best) => search(&target, &[], database, &options.search, rng)?,
        (None, Method::Paper) => {
            let deviations = &database.deviations[..MASS];
            anneal(&target, deviations, &options.annealing, rng.random())?.0
        }
    };
    let wish = Wish {
        name,
        wanted,
        row: &row,
        repaired,
    };
    let first = mass.building.clone();
    let mut best = draft(wish.clone(), mass, database, options, rng)?;
    let searched = options.footprint.is_none() && options.method == Method::Best;
    if !searched || best.is_good() {
        return best.build();
    }
    // The walls have no room for the wanted facades, or one would not believe the house: other plans may do better. What is given comes before
    // what is believed.
    let misses = |draft: &Draft| {
        let reached = draft.report.reached.iter().zip(&row);
        let mut z = reached.zip(&database.deviations).zip(given).take(NUMBERS);
        z.any(|(((reached, row), s), given)| *given && ((reached - row) / s).abs() > NEAR)
    };
    let few = SearchLimits {
        rounds: ROUNDS,
        ..options.search.clone()
    };
    let unlike = [first];
    for mass in variations(&target, OTHERS, APART, &unlike, database, &few, rng) {
        let other = draft(wish.clone(), mass, database, options, rng)?;
        let spent = best.report.evaluations + other.report.evaluations;
        if (misses(&other), other.cost()) < (misses(&best), best.cost()) {
            best = other;
        }
        best.report.evaluations = spent;
        if best.is_good() {
            break;
        }
    }
    best.build()
}

/// The attributes that a mass model is to reach.
#[derive(Debug, Clone)]
pub struct Wish<'a> {
    /// Name of the house.
    pub name: &'a str,
    /// The 49 columns asked for.
    pub wanted: &'a [f64; 49],
    /// The columns to reach: those asked for, with repairs.
    pub row: &'a [f64; 49],
    /// The sampled values that were moved.
    pub repaired: Vec<Change>,
}

/// A house with roofs and facades, measured, but without its surface: what alternatives are compared by, since the
/// exact surface costs more than all the rest.
#[derive(Debug, Clone)]
pub struct Draft {
    /// Its parameters.
    pub building: Building,
    /// Its walls and roofs without openings.
    shell: Faces,
    /// The numbers of the surface are still 0.
    report: HouseReport,
    /// Number of [findings](implausible) that one would not believe; a missing style counts as [`STYLE`] of them.
    findings: usize,
}

impl Draft {
    /// Largest distance from the repaired row in standard deviations.
    pub fn repaired_z(&self) -> f64 {
        self.report.repaired_z
    }

    /// True if the house has its attributes and nothing that one would not believe.
    fn is_good(&self) -> bool {
        self.report.repaired_z <= NEAR && self.findings == 0
    }

    /// Distance from the repaired row, each finding counted as [`FINDING`].
    fn cost(&self) -> f64 {
        self.report.repaired_z + FINDING * self.findings as f64
    }

    /// The house with its surface.
    ///
    /// # Errors
    /// [`GenerateError::Surface`].
    pub fn build(self) -> Result<Generated, GenerateError> {
        let Self {
            building,
            shell,
            mut report,
            ..
        } = self;
        let model = furnished(&building, shell)?;
        report.triangles = model.report.triangles;
        report.shells = model.report.shells;
        report.volume = model.report.volume;
        report.unplaced = model.unplaced.len();
        Ok(Generated {
            building,
            model,
            report,
        })
    }
}

/// Puts roofs and facades on a mass model.
///
/// # Errors
/// [`GenerateError`].
pub fn draft(
    wish: Wish,
    mass: MassModel,
    database: &Database,
    options: &Options,
    rng: &mut impl Rng,
) -> Result<Draft, GenerateError> {
    let Wish {
        name, wanted, row, ..
    } = wish;
    let flag = |c: usize| row[c] > 0.5;
    let mut building = mass.building;
    building.name = name.into();
    building.unit = "m".into();
    let flags = [flag(39), flag(40), flag(41)];
    roof(&mut building.boxes, flags, &options.frozen.boxes);
    let special = [(47, Special::Chimney), (48, Special::Tower)];
    building.special = special
        .into_iter()
        .filter(|(c, _)| flag(*c))
        .map(|(_, s)| s)
        .collect();
    let shell = faces(&prisms(&building, options.joining));
    let facades = facades(&building, &shell, row, database, options, rng)?;
    building.facades = facades.pieces;
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
        triangles: 0,
        shells: 0,
        volume: 0.0,
        unplaced: 0,
        wanted: wanted.to_vec(),
        repaired: wish.repaired,
        reached,
    };
    Ok(Draft {
        findings: implausible(&building).len() + STYLE * usize::from(!report.styles),
        building,
        shell,
        report,
    })
}

/// The facades of a method.
fn facades(
    building: &Building,
    shell: &Faces,
    row: &[f64; 49],
    database: &Database,
    options: &Options,
    rng: &mut impl Rng,
) -> Result<Facades, GenerateError> {
    let flag = |c: usize| row[c] > 0.5;
    let target = FacadeTarget {
        wanted: std::array::from_fn(|k| row[MASS + k]),
        windows: std::array::from_fn(|k| flag(42 + k)),
        cuts: !options.no_cuts,
        fixed: options.frozen.pieces.clone(),
    };
    let deviations = &database.deviations[MASS..NUMBERS];
    if options.method == Method::Best {
        return Ok(furnish(building, shell, &target, deviations));
    }
    let flags = std::array::from_fn(|k| flag(NUMBERS + k));
    let own = elements(database, &flags, options.search.leave_out, rng);
    let settings = Settings {
        generations: options.generations,
        ..Settings::default()
    };
    let seed = rng.random();
    Ok(breed(building, shell, &target, &own, deviations, settings, seed)?.0)
}
