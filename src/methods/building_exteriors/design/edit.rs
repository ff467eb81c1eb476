//! Edits of a house's boxes, and the house that a model suggests after them (Sec. 7, Fig. 19).

use rand::Rng;

use super::complete::around;
use super::error::CompleteError;
use super::observed::wanted_rows;
use crate::attributes::{AttributeRow, COLUMNS, attributes};
use crate::data::table;
use crate::house::{Database, Draft, Frozen, GenerateError, Generated, Options, Wish, draft};
use crate::mass::target::{PARTS, bounds};
use crate::mass::{MASS, MassModel, SearchLimits, is_sound};
use crate::model_file::ModelFile;
use edifice_shape::{BoxStyle, Building, BuildingError, MassBox, Ridge, Roof, RoofStyle};

/// One edit of a house.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edit {
    /// Adds a box: centre x and y, width, depth, height.
    Add(BoxStyle, [f64; 5]),
    /// Moves the centre of a box.
    Move(usize, [f64; 2]),
    /// Gives a box another width, depth and height.
    Resize(usize, [f64; 3]),
    /// Removes the box of this index.
    Remove(usize),
}

/// Why an edit cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// There is no such box.
    #[error("there is no boxes[{index}]: the house has {count} boxes")]
    NoBox {
        /// The index that was given.
        index: usize,
        /// Number of boxes of the house.
        count: usize,
    },
    /// The boxes are no house: a size that is not positive, or none left.
    #[error(transparent)]
    Building(#[from] BuildingError),
    /// The edited boxes cannot be built.
    #[error("after the edit {0}")]
    Unsound(&'static str),
    /// No house was found.
    #[error(transparent)]
    Complete(#[from] CompleteError),
}

impl From<GenerateError> for EditError {
    fn from(error: GenerateError) -> Self {
        Self::Complete(error.into())
    }
}

/// Answers of the model to choose from: few, since an edit has to be quick.
const POOL: usize = 300;
const TRIES: usize = 4;
/// Rounds of random arrangements for an answer, and the distance in standard deviations at which to stop.
const ROUNDS: usize = 5;
const NEAR: f64 = 0.05;

/// Applies edits in turn; returns the boxes, without facades, and which of them were added, moved or resized.
fn apply(house: &Building, edits: &[Edit]) -> Result<(Building, Vec<bool>), EditError> {
    let mut boxes = house.boxes.clone();
    let mut touched = vec![false; boxes.len()];
    for edit in edits {
        let count = boxes.len();
        let known = |index: usize| match index < count {
            true => Ok(index),
            false => Err(EditError::NoBox { index, count }),
        };
        match *edit {
            Edit::Add(style, size) => {
                boxes.push(added(house, style, size));
                touched.push(true);
            }
            Edit::Move(index, [x, y]) => {
                let i = known(index)?;
                (boxes[i].x, boxes[i].y, touched[i]) = (x, y, true);
            }
            Edit::Resize(index, [w, d, h]) => {
                let i = known(index)?;
                (boxes[i].width, boxes[i].depth, boxes[i].height) = (w, d, h);
                touched[i] = true;
            }
            Edit::Remove(index) => {
                boxes.remove(known(index)?);
                touched.remove(index);
            }
        }
    }
    let special = house.special.clone();
    let name = house.name.clone();
    let edited = Building::new(name, "m", house.floor_height, boxes, Vec::new(), special)?;
    Ok((edited, touched))
}

/// A box with the roof that most of the house has.
fn added(house: &Building, style: BoxStyle, [x, y, width, depth, height]: [f64; 5]) -> MassBox {
    let largest = house.boxes.iter().max_by(|a, b| {
        let area = |b: &MassBox| b.width * b.depth;
        area(a).total_cmp(&area(b))
    });
    let plain = Roof {
        style: RoofStyle::Gable,
        pitch: 30.0,
        ridge: Ridge::X,
    };
    let roof = Roof {
        ridge: if width >= depth { Ridge::X } else { Ridge::Y },
        ..largest.map_or(plain, |b| b.roof)
    };
    MassBox {
        style,
        x,
        y,
        width,
        depth,
        height,
        roof,
    }
}

/// The attributes of edited boxes, with facades and styles of the house before.
fn wanted(before: &Building, boxes: &Building) -> Result<[f64; 49], EditError> {
    let measured = |b| attributes(b).map_err(GenerateError::from);
    let (old, new) = (measured(before)?, measured(boxes)?);
    Ok(std::array::from_fn(|c| {
        let row = if c < MASS { &new } else { &old };
        row[c].unwrap_or(0.0)
    }))
}

/// The house after the edits: all other boxes stay as they are, the facades are laid out anew for the facade
/// attributes that the house had.
///
/// # Errors
/// [`EditError`].
pub fn edited(
    house: &Building,
    edits: &[Edit],
    database: &Database,
    options: &Options,
    rng: &mut impl Rng,
) -> Result<Generated, EditError> {
    let (boxes, _) = apply(house, edits)?;
    sound(&boxes)?;
    let row = wanted(house, &boxes)?;
    let options = Options {
        frozen: Frozen {
            boxes: boxes.boxes.clone(),
            pieces: Vec::new(),
            corner: None,
        },
        ..options.clone()
    };
    let mass = MassModel {
        building: boxes,
        max_z: 0.0,
        evaluations: 0,
        donor: None,
    };
    let wish = Wish {
        name: &house.name,
        wanted: &row,
        row: &row,
        repaired: Vec::new(),
    };
    let house = draft(wish, mass, database, &options, rng)?;
    Ok(house.build()?)
}

fn sound(boxes: &Building) -> Result<(), EditError> {
    match is_sound(boxes) {
        true => Ok(()),
        false => Err(EditError::Unsound(
            "the boxes are not in one piece, shut in a courtyard, are thinner than 0.5 m, touch in a corner only, or parts overlap",
        )),
    }
}

/// The house that the model suggests after the edits: the touched boxes stay as they are; bounding box, garage,
/// porches and styles are given as they are after the edits, all else is the model's most probable answer that can be
/// built, from the boxes of the house itself where they can be fitted.
///
/// # Errors
/// [`EditError`].
pub fn suggested(
    house: &Building,
    edits: &[Edit],
    model: &ModelFile,
    database: &Database,
    options: &Options,
    rng: &mut impl Rng,
) -> Result<Generated, EditError> {
    let (boxes, touched) = apply(house, edits)?;
    let row = wanted(house, &boxes)?;
    let kept =
        |c: usize| c < 3 || PARTS.iter().any(|(_, p, _)| (*p..p + 6).contains(&c)) || c >= 39;
    let evidence: AttributeRow = (0..COLUMNS.len())
        .map(|c| kept(c).then_some(row[c]))
        .collect();
    let table = table(&[evidence]).map_err(CompleteError::from)?;
    let draws = model
        .most_probable(&table, TRIES, POOL, 0.0, rng)
        .map_err(CompleteError::from)?;
    let mut own = boxes.clone();
    own.boxes = boxes
        .boxes
        .iter()
        .zip(&touched)
        .filter(|(_, t)| **t)
        .map(|(b, _)| *b)
        .collect();
    own.special.clear();
    let donor = alone(&boxes, database);
    let [[x, _], [y, _]] = bounds(&boxes);
    let given: [bool; 49] = std::array::from_fn(|c| !(2..39).contains(&c));
    let rows = wanted_rows(&draws.table);
    let mut failed = None;
    // From the boxes of the house itself, then from those of any house.
    for (database, rounds) in [(&donor, 0), (database, ROUNDS)] {
        let options = Options {
            search: SearchLimits {
                rounds,
                ..options.search.clone()
            },
            frozen: Frozen {
                corner: Some([x, y]),
                ..Frozen::default()
            },
            ..options.clone()
        };
        let mut best: Option<Draft> = None;
        for wanted in &rows {
            let name = &house.name;
            match around(name, &own, wanted, &given, database, &options, rng) {
                Ok(found) => {
                    let z = found.repaired_z();
                    if best.as_ref().is_none_or(|b| z < b.repaired_z()) {
                        best = Some(found);
                    }
                    if z <= NEAR {
                        break;
                    }
                }
                Err(e) => failed = failed.or(Some(e)),
            }
        }
        if let Some(best) = best {
            return Ok(best.build()?);
        }
    }
    Err(failed.unwrap_or(CompleteError::Hidden).into())
}

/// The house as the only donor, distances measured as in the database.
fn alone(house: &Building, database: &Database) -> Database {
    let rows = attributes(house).into_iter().collect();
    Database {
        buildings: vec![house.clone()],
        rows,
        deviations: database.deviations,
    }
}
