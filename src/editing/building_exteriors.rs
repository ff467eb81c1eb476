//! Houses: boxes added, moved, resized and removed, a house suggested by the learned model around the touched boxes
//! (Fan and Wonka 2016, Fig. 19), and other plans with the same attributes.

pub mod draws;
pub mod redraws;
mod steps;
mod text;
mod view;
mod wish;

use std::path::Path;
use std::sync::{Arc, OnceLock};

use serde::Deserialize;
use serde_json::Value;

pub use text::{add, moved, ordered, resized, words};
pub use view::{colours, scene_of};
pub use wish::{WishError, Wishes, given, ranges, wished};

use super::examples::{Example, Source};
use super::work::Work;
use super::{Applied, CommandError, Editor, Opened, State, ends, parse};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::design::{Edit, EditError, edited, suggested, variants};
use edifice_building_exteriors::house::parts::parts;
use edifice_building_exteriors::house::scene::palette;
use edifice_building_exteriors::house::{
    Database, GenerateError, Generated, HouseReport, Joining, Model, Options, model,
};
use edifice_building_exteriors::model_file::ModelFile;
use edifice_datasets::shipped_bytes;
use edifice_io::{building_json, detailed_gltf, scene_svg, surface_obj};
use edifice_shape::Building;

/// The name of the shipped houses in the program; that of the model learned from them follows.
pub const DATABASE: &str = "building_exteriors/houses.buildings.jsonl";
/// Real houses of Delft, measured from the 3D BAG by `edifice building import`.
const REAL: &str = "building_exteriors/delft.buildings.jsonl";
const MODEL: &str = "building_exteriors/real.houses.json";
/// The name of the model of the made houses on the command line, and its file in the program.
pub const MADE: &str = "made";
const MADE_MODEL: &str = "building_exteriors/made.houses.json";
const ENDING: &str = ".building.json";
const FORMATS: &[&str] = &["glb", "obj", "svg"];

/// Opens `*.building.json`.
pub const EDITOR: Editor = Editor {
    kind: "house",
    open,
    examples: &[
        Example {
            id: "house",
            kind: "house",
            title: "A house without a garage",
            about: "Add, move and resize its boxes; the learned model suggests the rest.",
            source: Source::Line(DATABASE, 57, "house_0058"),
        },
        Example {
            id: "modern",
            kind: "house",
            title: "A modern house",
            about: "Flat roofs on two floors: one of the two hundred made houses.",
            source: Source::Line(DATABASE, 62, "house_0063"),
        },
    ],
};

fn open(path: &Path, bytes: &[u8], _work: &Work) -> Opened {
    ends(path, ENDING).then(|| {
        let building = building_json::parse(bytes, path)?;
        if !is_file_name(&building.name) {
            let message = format!("{:?} cannot name a file", building.name);
            return Err(Error::content(path, message));
        }
        Ok(Arc::new(House::new(building)?) as Arc<dyn State>)
    })
}

/// True if a house's name can name its files.
pub fn is_file_name(name: &str) -> bool {
    let usual = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    !name.is_empty() && name.len() <= 100 && name.chars().all(usual)
}

/// The houses that ship with the project and donate boxes, read once: real ones measured from a city model, then those
/// made by the project, which have porches and facades too.
///
/// # Errors
/// When the data that ships cannot be read; a test keeps it readable.
pub fn shipped_database() -> Result<&'static Database> {
    static READ: OnceLock<Database> = OnceLock::new();
    if let Some(database) = READ.get() {
        return Ok(database);
    }
    let path = Path::new(DATABASE);
    let mut buildings = Vec::new();
    for name in [REAL, DATABASE] {
        buildings.extend(building_json::parse_lines(
            shipped_bytes(name)?,
            Path::new(name),
        )?);
    }
    let database = Database::new(buildings).map_err(|e| Error::content(path, e))?;
    Ok(READ.get_or_init(|| database))
}

/// The model that ships with the project, learned from real houses by `edifice building learn`.
///
/// # Errors
/// As [`shipped_database`].
pub fn shipped_model() -> Result<&'static ModelFile> {
    static READ: OnceLock<ModelFile> = OnceLock::new();
    read_once(&READ, MODEL)
}

/// The model of the made houses, whose truth is known.
///
/// # Errors
/// As [`shipped_database`].
pub fn made_model() -> Result<&'static ModelFile> {
    static READ: OnceLock<ModelFile> = OnceLock::new();
    read_once(&READ, MADE_MODEL)
}

fn read_once(known: &'static OnceLock<ModelFile>, name: &str) -> Result<&'static ModelFile> {
    if let Some(model) = known.get() {
        return Ok(model);
    }
    let path = Path::new(name);
    let text = std::str::from_utf8(shipped_bytes(name)?).map_err(|e| Error::content(path, e))?;
    let model = ModelFile::from_json(text).map_err(|e| Error::content(path, e))?;
    Ok(known.get_or_init(|| model))
}

/// The house after edits; with a model, the one it suggests.
///
/// # Errors
/// [`EditError`].
pub fn edit(
    house: &Building,
    edits: &[Edit],
    model: Option<&ModelFile>,
    database: &Database,
    options: &Options,
    seed: u64,
) -> Result<Generated, EditError> {
    let mut rng = stream(seed, "building/edit", 0);
    match model {
        None => edited(house, edits, database, options, &mut rng),
        Some(model) => suggested(house, edits, model, database, options, &mut rng),
    }
}

/// Other houses with the attributes of a house.
///
/// # Errors
/// [`GenerateError`].
pub fn variations(
    house: &Building,
    count: usize,
    database: &Database,
    options: &Options,
    seed: u64,
) -> Result<Vec<Generated>, GenerateError> {
    let mut rng = stream(seed, "building/variations", 0);
    variants(house, count, database, options, &mut rng)
}

/// A house that is being edited.
#[derive(Clone)]
pub struct House {
    building: Building,
    /// Its surface.
    model: Model,
    /// The report on its making; `None` for a house that was opened.
    report: Option<HouseReport>,
    /// Boxes that the last edit touched: they stay where the user put them.
    locked: Vec<bool>,
    answers: Vec<Generated>,
    chosen: Option<usize>,
    /// The wishes of the last edit.
    wishes: Vec<String>,
    style: Option<usize>,
    keep: bool,
}

#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
enum Command {
    Edit {
        edits: Vec<String>,
        #[serde(default)]
        suggest: bool,
        #[serde(default = "one")]
        seed: u64,
    },
    Variations {
        count: usize,
        #[serde(default = "one")]
        seed: u64,
    },
    Wish {
        given: Vec<String>,
        #[serde(default)]
        style: Option<usize>,
        #[serde(default)]
        keep: bool,
        #[serde(default = "one")]
        seed: u64,
    },
    Choose {
        answer: usize,
    },
}

fn one() -> u64 {
    1
}

impl House {
    /// A house without edits.
    ///
    /// # Errors
    /// When its boxes have no closed surface.
    pub fn new(building: Building) -> Result<Self> {
        let model = model(&building, Joining::default()).map_err(Error::method)?;
        Ok(Self {
            locked: vec![false; building.boxes.len()],
            model,
            building,
            report: None,
            answers: Vec::new(),
            chosen: None,
            wishes: Vec::new(),
            style: None,
            keep: true,
        })
    }

    /// A house made from this one; what was wished is remembered.
    fn made(&self, house: Generated, locked: Vec<bool>) -> Self {
        Self {
            locked,
            building: house.building,
            model: house.model,
            report: Some(house.report),
            answers: Vec::new(),
            chosen: None,
            wishes: self.wishes.clone(),
            style: self.style,
            keep: self.keep,
        }
    }

    fn file(&self) -> String {
        format!("{}{ENDING}", self.building.name)
    }
}

impl State for House {
    fn kind(&self) -> &'static str {
        EDITOR.kind
    }

    fn name(&self) -> &str {
        &self.building.name
    }

    fn ending(&self) -> &'static str {
        ENDING
    }

    fn bytes(&self) -> Result<Vec<u8>> {
        let text = building_json::to_string(&self.building);
        Ok(text.map_err(Error::method)?.into_bytes())
    }

    fn view(&self) -> Result<Value> {
        view::view(self)
    }

    fn apply(&self, command: &Value, work: &Work) -> Result<Applied> {
        match parse(command)? {
            Command::Edit {
                edits,
                suggest,
                seed,
            } => self.edit(&edits, suggest, seed),
            Command::Variations { count, seed } => {
                work.tell("looking for other plans", None)?;
                self.variations(count, seed)
            }
            Command::Wish {
                given,
                style,
                keep,
                seed,
            } => self.wish(given, style, keep, seed, work),
            Command::Choose { answer } => self.choose(answer),
        }
    }

    fn formats(&self) -> &'static [&'static str] {
        FORMATS
    }

    fn export(&self, format: &str) -> Result<Vec<u8>> {
        let parts = || parts(&self.building, &self.model);
        match format {
            "glb" => detailed_gltf::to_bytes(&parts(), &palette(colours(&self.building)))
                .map_err(Error::method),
            // One file alone, without materials beside it.
            "obj" => Ok(surface_obj::parts_text(&parts(), None).into_bytes()),
            "svg" => {
                let scene = scene_of(&self.building, &self.model);
                Ok(scene_svg::elevations(&scene).into_bytes())
            }
            other => Err(CommandError::Format(other.to_owned()).into()),
        }
    }
}
