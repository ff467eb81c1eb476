//! Houses: boxes added, moved, resized and removed, a house suggested by the learned model around the touched boxes
//! (Fan and Wonka 2016, Fig. 19), and other plans with the same attributes.

mod text;
mod view;

use std::path::Path;
use std::sync::{Arc, OnceLock};

use serde::Deserialize;
use serde_json::Value;

pub use text::{add, moved, ordered, resized, words};
pub use view::scene_of;

use super::examples::{Example, Source};
use super::script::Shell;
use super::{CommandError, Editor, Opened, State, Step, answer, count_of_answers, ends, parse};
use crate::experiments::shipped_bytes;
use crate::io::{building_json, gltf, scene_svg, surface_obj};
use crate::methods::building_exteriors::design::{Edit, EditError, edited, suggested, variants};
use crate::methods::building_exteriors::house::{
    Database, GenerateError, Generated, HouseReport, Joining, Model, Options, model,
};
use crate::methods::building_exteriors::model_file::ModelFile;
use crate::model::hierarchy::Hierarchy;
use crate::rng::stream;
use crate::shape::Building;
use crate::{Error, Result};

/// What the shipped houses and the model learned from them are called in the program.
pub const DATABASE: &str = "building_exteriors/houses.buildings.jsonl";
const MODEL: &str = "building_exteriors/default.houses.json";
/// Most answers at once.
const MOST: usize = 12;
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
            about: "Flat roofs on two floors: one of the two hundred houses that the model was learned from.",
            source: Source::Line(DATABASE, 62, "house_0063"),
        },
    ],
};

fn open(path: &Path, bytes: &[u8]) -> Opened {
    ends(path, ENDING).then(|| {
        let building = building_json::parse(bytes, path)?;
        if !is_file_name(&building.name) {
            let message = format!("{:?} cannot name a file", building.name);
            return Err(Error::content(path, message));
        }
        Ok(Arc::new(House::new(building)?) as Arc<dyn State>)
    })
}

/// Whether a house's name can name its files.
pub fn is_file_name(name: &str) -> bool {
    let usual = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    !name.is_empty() && name.len() <= 100 && name.chars().all(usual)
}

/// The houses that ship with the project, read once.
///
/// # Errors
/// When the data that ships cannot be read; a test keeps it readable.
pub fn shipped_database() -> Result<&'static Database> {
    static READ: OnceLock<Database> = OnceLock::new();
    if let Some(database) = READ.get() {
        return Ok(database);
    }
    let path = Path::new(DATABASE);
    let buildings = building_json::parse_lines(shipped_bytes(DATABASE)?, path)?;
    let database = Database::new(buildings).map_err(|e| Error::content(path, e))?;
    Ok(READ.get_or_init(|| database))
}

/// The model that ships with the project, learned from the shipped houses by `edifice building learn`.
///
/// # Errors
/// As [`shipped_database`].
pub fn shipped_model() -> Result<&'static ModelFile> {
    static READ: OnceLock<ModelFile> = OnceLock::new();
    if let Some(model) = READ.get() {
        return Ok(model);
    }
    let path = Path::new(MODEL);
    let text = std::str::from_utf8(shipped_bytes(MODEL)?).map_err(|e| Error::content(path, e))?;
    let model = ModelFile::from_json(text).map_err(|e| Error::content(path, e))?;
    Ok(READ.get_or_init(|| model))
}

/// The house after edits; with a model, the one it suggests.
///
/// # Errors
/// [`EditError`].
pub fn edit(
    house: &Building,
    edits: &[Edit],
    model: Option<&Hierarchy>,
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
    /// How it came about; none for a house that was opened.
    report: Option<HouseReport>,
    /// Boxes that the last edit touched: they stay where the user put them.
    locked: Vec<bool>,
    answers: Vec<Generated>,
    chosen: Option<usize>,
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
        })
    }

    fn made(house: Generated, locked: Vec<bool>) -> Self {
        Self {
            locked,
            building: house.building,
            model: house.model,
            report: Some(house.report),
            answers: Vec::new(),
            chosen: None,
        }
    }

    fn file(&self) -> String {
        format!("{}{ENDING}", self.building.name)
    }

    fn edit(&self, texts: &[String], suggest: bool, seed: u64) -> Result<Step> {
        let edits = text::parse_all(texts)?;
        let database = shipped_database()?;
        let learned = match suggest {
            true => Some(&shipped_model()?.model),
            false => None,
        };
        let made = edit(
            &self.building,
            &edits,
            learned,
            database,
            &Options::default(),
            seed,
        );
        let made = made.map_err(Error::method)?;
        let locked = view::touched(&self.building, &edits, &made.building);
        let mut shell = Shell::new(["building", "edit", "<"]);
        for word in words(&edits) {
            shell = shell.arg(word);
        }
        if suggest {
            shell = shell.arg("--suggest");
        }
        let shell = in_folder(shell, seed).gives("", Some(self.file()));
        let mut said = texts.join(", ");
        if suggest {
            said.push_str(", the rest suggested");
        }
        Ok(Step {
            state: Arc::new(Self::made(made, locked)),
            said,
            shell,
            warnings: Vec::new(),
        })
    }

    fn variations(&self, count: usize, seed: u64) -> Result<Step> {
        let count = count_of_answers(count, MOST)?;
        let options = Options::default();
        let answers = variations(&self.building, count, shipped_database()?, &options, seed);
        let answers = answers.map_err(Error::method)?;
        let found = answers.len();
        let mut warnings = Vec::new();
        if found < count {
            warnings.push(format!(
                "{found} of {count} houses: the search found no more"
            ));
        }
        let shell = Shell::new(["building", "variations", "<"]).option("--count", count);
        Ok(Step {
            state: Arc::new(Self {
                answers,
                chosen: None,
                ..self.clone()
            }),
            said: format!("{found} other plans with the same attributes"),
            shell: in_folder(shell, seed),
            warnings,
        })
    }

    fn choose(&self, wanted: usize) -> Result<Step> {
        let chosen = answer(&self.answers, wanted)?.clone();
        let state = Self {
            answers: self.answers.clone(),
            chosen: Some(wanted),
            ..Self::made(chosen.clone(), vec![false; chosen.building.boxes.len()])
        };
        Ok(Step {
            shell: Shell::default().gives("", Some(state.file())),
            state: Arc::new(state),
            said: format!("take plan {wanted}"),
            warnings: Vec::new(),
        })
    }
}

/// The options that all commands that make houses share.
fn in_folder(shell: Shell, seed: u64) -> Shell {
    let shell = shell.option("--seed", seed).option("--format", "json");
    let output = Shell::new(["--output", ">"]).words;
    Shell {
        words: [shell.words, output].concat(),
        ..shell
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

    fn apply(&self, command: &Value) -> Result<Step> {
        match parse(command)? {
            Command::Edit {
                edits,
                suggest,
                seed,
            } => self.edit(&edits, suggest, seed),
            Command::Variations { count, seed } => self.variations(count, seed),
            Command::Choose { answer } => self.choose(answer),
        }
    }

    fn formats(&self) -> &'static [&'static str] {
        FORMATS
    }

    fn export(&self, format: &str) -> Result<Vec<u8>> {
        let scene = view::scene_of(&self.building, &self.model);
        match format {
            "glb" => gltf::to_bytes(&scene).map_err(Error::method),
            "obj" => {
                Ok(surface_obj::to_text(&self.model.surface, &self.building.name).into_bytes())
            }
            "svg" => Ok(scene_svg::elevations(&scene).into_bytes()),
            other => Err(CommandError::Format(other.to_owned()).into()),
        }
    }
}
