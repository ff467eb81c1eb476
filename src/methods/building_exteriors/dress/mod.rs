//! Windows and doors for the buildings of a city model: level of detail 2 becomes level of detail 3, with probabilities.
//!
//! The surface of a building is kept, corner by corner; openings are cut into its walls. They are drawn from a model of
//! houses (Fan and Wonka 2016, Sec. 4): its window to wall ratios, symmetry and alignment of the four sides.
//!
//! 1. **Walls.** Upright triangles that hang together in one plane (`walls`).
//! 2. **Room.** A place on a wall has room when it lies inside the wall and no other building stands before it
//!    (`exposure`).
//! 3. **Draws.** Each draw takes one set of attributes, one window, one door, one height of the storeys and one front
//!    for a building, and fills the storeys of every wall with equal bays (`draw`):
//!
//!    ```text
//!    bays = wwr * length * storey / (width * height),  rounded at random
//!    ```
//!
//! 4. **Choice.** The draw that agrees best with all others, by the mean F1 of elements that match at an intersection
//!    over union of at least .5 (minimum Bayes risk); the probability of an element is the share of draws that have
//!    one there (`choice`).
//! 5. **Openings.** The elements of that draw are set into the walls (`cut`).
//!
//! # Deviations and readings
//! - The paper completes a house from parts of it that a person gives; a city model gives the whole mass of a building
//!   and none of its openings. Detached houses that [`crate::survey`] can measure are completed given their mass
//!   attributes; for others the attributes are drawn from the model as it is, since it knows houses only.
//! - The front is drawn among the sides in proportion to the wall that is free.
//! - All windows of a draw have one size, that of a real window. A wall is symmetric, and its rows aligned, with the
//!   probability that the model gives for its side; else its windows stand anywhere in their bays.
//! - Nothing is known of walls without windows but the ratio of their side: a wall that nobody would cut a window into
//!   is dressed like its neighbours.

mod choice;
mod cut;
mod draw;
mod exposure;
mod grid;
mod walls;

use std::ops::Range;

use edifice_base::rng::stream;
use edifice_model::ModelError;
use edifice_shape::{DetailedBuilding, Part};
use rayon::prelude::*;

use crate::attributes::{AttributeRow, attributes};
use crate::model_file::ModelFile;
use crate::survey::{Candidate, Known, Limits, Refused, Surveyed, survey_all};
use exposure::Roofs;

pub use draw::WINDOWS;
pub use grid::{Grid, plain_grid};

/// The number of draws, and the seed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Draws for each building, at least 1.
    pub draws: usize,
    /// Seed of all random streams.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            draws: 100,
            seed: 1,
        }
    }
}

/// Rows of attributes that are drawn once for all buildings that are no houses.
const POOL: usize = 500;

/// Dresses the buildings of a city, in their order; coordinates are those of the meshes. Each window and door has
/// `probability`, the share of draws that have it, among its attributes.
///
/// Complexity: for each building, draws squared times elements; buildings in parallel, with the same result for any
/// number of threads.
///
/// # Errors
/// [`ModelError`] when the model cannot be asked.
pub fn dress(
    city: &[Candidate],
    model: &ModelFile,
    settings: &Settings,
) -> Result<Vec<DetailedBuilding>, ModelError> {
    Dresser::new(city, model, settings)?.dressed(0..city.len())
}

/// A city that is dressed in pieces: of a large one, not all openings are in memory at once.
pub struct Dresser<'a> {
    city: &'a [Candidate<'a>],
    model: &'a ModelFile,
    settings: Settings,
    roofs: Roofs,
    /// Rows of attributes for buildings that are no houses.
    pool: Vec<AttributeRow>,
    houses: Vec<Result<Surveyed, Refused>>,
}

impl<'a> Dresser<'a> {
    /// Measures the houses of a city and draws from the model what all of its buildings share.
    ///
    /// # Errors
    /// [`ModelError`] when the model cannot be asked.
    pub fn new(
        city: &'a [Candidate<'a>],
        model: &'a ModelFile,
        settings: &Settings,
    ) -> Result<Self, ModelError> {
        let rng = &mut stream(settings.seed, "building/dress/pool", 0);
        Ok(Self {
            city,
            model,
            settings: *settings,
            roofs: Roofs::new(city.iter().map(|b| b.mesh)),
            pool: draw::rows(model, None, POOL, rng)?,
            houses: survey_all(city, &Limits::default()),
        })
    }

    /// Some buildings of the city as [`dress`] has them; those beyond its end are none.
    ///
    /// # Errors
    /// [`ModelError`] when the model cannot be asked.
    pub fn dressed(&self, buildings: Range<usize>) -> Result<Vec<DetailedBuilding>, ModelError> {
        let end = buildings.end.min(self.city.len());
        let numbers = (buildings.start.min(end)..end).into_par_iter();
        numbers.map(|number| self.one(number)).collect()
    }

    fn one(&self, number: usize) -> Result<DetailedBuilding, ModelError> {
        let own = &self.city[number];
        let draws = self.settings.draws;
        let mut rng = stream(self.settings.seed, "building/dress", number as u64);
        let rows = match self.houses[number].as_ref().ok().and_then(mass_of) {
            Some(mass) => draw::rows(self.model, Some(mass), draws, &mut rng)?,
            None => draw::some_of(&self.pool, draws, &mut rng),
        };
        let mut faces = walls::faces(own.mesh, |p| self.roofs.covers(number, p));
        self.roofs.note(number, &mut faces.walls);
        let storeys = Known::new(own.attributes).storeys;
        let building = draw::Site::new(&faces, storeys);
        let drawn = (rows.iter().map(|row| building.draw(row, &mut rng))).collect::<Vec<_>>();
        let chosen = choice::choose(drawn);
        Ok(cut::dressed(own, &faces, &chosen))
    }
}

/// The attributes of the mass of a measured house.
fn mass_of(house: &Surveyed) -> Option<AttributeRow> {
    attributes(&house.building).ok()
}

/// The windows and doors of a building.
pub fn openings(building: &DetailedBuilding) -> impl Iterator<Item = &Part> {
    building.parts.iter().filter(|p| p.kind.is_opening())
}
