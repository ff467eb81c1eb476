//! Cities as grammars of instances: sizes of templates and weights of rules are changed, and drawn shapes are filled
//! with new cities of their buildings (Demir et al. 2014). A city of triangles is opened too, and made a grammar of at a level
//! of de-instancing.

mod edits;
mod original;
mod paths;
mod questions;
mod view;

use std::path::Path;
use std::sync::{Arc, OnceLock};

use serde::Deserialize;
use serde_json::Value;

pub use edits::{CityEdit, CityEditError, edit};
use original::Original;

use super::examples::{Example, Source};
use super::script::{Shell, Word};
use super::work::Work;
use super::{Applied, CommandError, Editor, Opened, State, ends, parse};
use edifice_base::{Error, Result, Watch, unwatched};
use edifice_city_proceduralization::synthesis::{Shape, synthesize};
use edifice_grammar::instance::{InstanceDerivation, InstanceGrammar};
use edifice_io_city::{self as city, cityjson, glb, grammar_json, obj};

const ENDING: &str = ".city-grammar.json";
const FORMATS: &[&str] = &["glb", "obj", "city.json"];

/// Cities of triangles.
const CITIES: [&str; 6] = [".npz", ".obj", ".glb", ".gltf", ".city.json", ".city.jsonl"];
/// Most halvings of the number of components.
const DEEPEST: u32 = 12;

/// Opens `*.city-grammar.json`, also as `.gz`, and cities of triangles, which are read again from their path.
pub const EDITOR: Editor = Editor {
    kind: "city",
    open,
    examples: &[Example {
        id: "town",
        kind: "city",
        title: "A made town",
        about: "Five templates: pick a building, change its template, fill a new shape with its like.",
        source: Source::File("city_proceduralization/town.city-grammar.json"),
    }],
};

fn open(path: &Path, bytes: &[u8], work: &Work) -> Opened {
    let is_city = CITIES.iter().any(|ending| ends(path, ending));
    let city = match ends(path, ENDING) {
        true => grammar_json::parse(bytes, path).and_then(City::new),
        false if is_city => (work.tell("reading the city", None).map_err(Error::from))
            .and_then(|()| city::read(path))
            .map(|city| City::of_triangles(Original::new(city, path))),
        false => return None,
    };
    Some(city.map(|city| Arc::new(city) as Arc<dyn State>))
}

/// The greatest width of a shape to be filled, in metres; a square of it takes hours.
pub const WIDEST: f64 = 50_000.0;

/// Why a shape is not filled.
#[derive(Debug, thiserror::Error)]
pub enum FillError {
    /// The shape has fewer than three corners.
    #[error("a shape of {0} corners: expected at least 3")]
    Corners(usize),
    /// The shape reaches farther than [`WIDEST`].
    #[error("a shape {0} m wide: expected at most {WIDEST}")]
    Wide(f64),
    /// No building fits.
    #[error("no building fits into the shape")]
    Full,
    /// The grammar.
    #[error(transparent)]
    Grammar(#[from] edifice_grammar::instance::InstanceGrammarError),
}

/// A new city of a grammar's buildings in a shape of rings in metres.
///
/// # Errors
/// [`FillError`].
pub fn fill(
    grammar: &InstanceGrammar,
    mut shape: Shape,
    seed: u64,
    watch: &Watch,
) -> std::result::Result<(InstanceGrammar, InstanceDerivation), FillError> {
    if let Some((low, high)) = shape.bounds() {
        let width = (high[0] - low[0]).max(high[1] - low[1]);
        if width > WIDEST {
            return Err(FillError::Wide(width));
        }
    }
    // Near the origin, where millimetres are kept.
    let low = shape.bounds().map_or([0.0; 2], |b| b.0.map(f64::floor));
    for p in shape.rings.iter_mut().flatten() {
        *p = [p[0] - low[0], p[1] - low[1]];
    }
    let mut made = synthesize(grammar, &shape, seed, watch)?;
    made.origin = [low[0], low[1], 0.0];
    let derivation = made.derive()?;
    match derivation.buildings.is_empty() {
        true => Err(FillError::Full),
        false => Ok((made, derivation)),
    }
}

/// A city that is being edited.
#[derive(Clone)]
pub struct City {
    name: String,
    /// The triangles that it was made of, where they are known.
    original: Option<Arc<Original>>,
    /// The grammar; a city of triangles has none before a level is chosen.
    made: Option<Made>,
}

/// A grammar with its derivation.
#[derive(Clone)]
struct Made {
    grammar: Arc<InstanceGrammar>,
    derivation: Arc<InstanceDerivation>,
    /// Halvings of the number of components, of a grammar that was made here and not edited since.
    level: Option<u32>,
    /// The difference of each building's volume from the original's, as a share of the original's; unset until it is
    /// asked for.
    errors: Arc<OnceLock<Vec<Option<f64>>>>,
}

/// Why a city cannot do this.
#[derive(Debug, thiserror::Error)]
enum CityError {
    /// It has no grammar yet.
    #[error("this city has no grammar yet: choose a level of de-instancing first")]
    NoGrammar,
    /// Its triangles are not known.
    #[error("the triangles of this city are not known: open the city itself to choose a level")]
    NoOriginal,
    /// There is no such level.
    #[error("level {0}: expected 0 to {DEEPEST}")]
    Level(u32),
}

#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
enum Command {
    Edit {
        edits: Vec<String>,
    },
    Synthesize {
        polygon: Vec<[f64; 2]>,
        #[serde(default = "one")]
        seed: u64,
    },
    Proceduralize {
        level: u32,
    },
}

fn one() -> u64 {
    1
}

impl City {
    /// A city without edits.
    ///
    /// # Errors
    /// When the grammar derives nothing.
    pub fn new(grammar: InstanceGrammar) -> Result<Self> {
        let made = Made::new(grammar, None)?;
        Ok(Self {
            name: made.grammar.name.clone(),
            original: None,
            made: Some(made),
        })
    }

    fn of_triangles(original: Original) -> Self {
        Self {
            name: original.city.name.clone(),
            original: Some(Arc::new(original)),
            made: None,
        }
    }

    fn made(&self) -> Result<&Made> {
        self.made
            .as_ref()
            .ok_or_else(|| Error::method(CityError::NoGrammar))
    }

    fn with(&self, grammar: InstanceGrammar, level: Option<u32>) -> Result<Arc<Self>> {
        Ok(Arc::new(Self {
            made: Some(Made::new(grammar, level)?),
            ..self.clone()
        }))
    }

    fn proceduralize(&self, level: u32, work: &Work) -> Result<Applied> {
        let original = self.original.as_ref();
        let original = original.ok_or_else(|| Error::method(CityError::NoOriginal))?;
        if level > DEEPEST {
            return Err(Error::method(CityError::Level(level)));
        }
        let grammar = original.proceduralized(level, work)?;
        work.tell("deriving the city", Some(0.9))?;
        let templates = grammar.templates.len();
        let mut shell = Shell::new(["city", "proceduralize"]);
        shell.words.push(Word::Beside(original.file.clone()));
        let mut shell = shell.option("--level", level);
        shell.words.extend(Shell::new(["--output", ">"]).words);
        Ok(Applied {
            state: self.with(grammar, Some(level))?,
            said: format!("level {level}: {templates} templates"),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: Vec::new(),
        })
    }

    fn edit(&self, texts: &[String]) -> Result<Applied> {
        let edits: std::result::Result<Vec<CityEdit>, CommandError> =
            texts.iter().map(|t| t.parse()).collect();
        let edits = edits?;
        if edits.is_empty() {
            return Err(CommandError::Nothing.into());
        }
        let edited = edit(&self.made()?.grammar, &edits, true).map_err(Error::method)?;
        let mut shell = Shell::new(["city", "edit", "--output", ">", "--", "<"]);
        for text in texts {
            shell = shell.arg(text);
        }
        Ok(Applied {
            state: self.with(edited, None)?,
            said: texts.join(", "),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: Vec::new(),
        })
    }

    fn synthesize(&self, polygon: Vec<[f64; 2]>, seed: u64) -> Result<Applied> {
        if polygon.len() < 3 {
            return Err(Error::method(FillError::Corners(polygon.len())));
        }
        let corners = super::written(&polygon.concat());
        let shape = Shape {
            rings: vec![polygon],
        };
        let (grammar, derivation) =
            fill(&self.made()?.grammar, shape, seed, &unwatched).map_err(Error::method)?;
        let count = derivation.buildings.len();
        let shell = Shell::new(["city", "synthesize", "<"])
            .option("--polygon", corners)
            .option("--seed", seed);
        let output = Shell::new(["--output", ">"]).words;
        let shell = Shell {
            words: [shell.words, output].concat(),
            ..shell
        };
        Ok(Applied {
            state: Arc::new(Self::new(grammar)?),
            said: format!("fill a drawn shape with {count} buildings, seed {seed}"),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: Vec::new(),
        })
    }
}

impl Made {
    fn new(grammar: InstanceGrammar, level: Option<u32>) -> Result<Self> {
        // As it is in its file, which keeps so many digits, and from which the next command of a script would start.
        let text = grammar_json::to_string(&grammar).map_err(Error::method)?;
        let grammar = grammar_json::parse(text.as_bytes(), Path::new(&grammar.name))?;
        let derivation = grammar.derive().map_err(Error::method)?;
        Ok(Self {
            grammar: Arc::new(grammar),
            derivation: Arc::new(derivation),
            level,
            errors: Arc::default(),
        })
    }
}

impl State for City {
    fn kind(&self) -> &'static str {
        EDITOR.kind
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn ending(&self) -> &'static str {
        ENDING
    }

    fn bytes(&self) -> Result<Vec<u8>> {
        let text = grammar_json::to_string(&self.made()?.grammar);
        Ok(text.map_err(Error::method)?.into_bytes())
    }

    fn view(&self) -> Result<Value> {
        view::view(self)
    }

    fn apply(&self, command: &Value, work: &Work) -> Result<Applied> {
        match parse(command)? {
            Command::Edit { edits } => self.edit(&edits),
            Command::Synthesize { polygon, seed } => {
                work.tell("filling the shape", None)?;
                self.synthesize(polygon, seed)
            }
            Command::Proceduralize { level } => self.proceduralize(level, work),
        }
    }

    fn ask(&self, question: &Value) -> Result<Value> {
        questions::answer(self, question)
    }

    fn formats(&self) -> &'static [&'static str] {
        FORMATS
    }

    fn export(&self, format: &str) -> Result<Vec<u8>> {
        if format == original::FORMAT {
            let original = self.original.as_ref();
            let original = original.ok_or_else(|| Error::method(CityError::NoOriginal))?;
            return Ok(original.packed());
        }
        let Made {
            grammar,
            derivation,
            ..
        } = self.made()?;
        let city = || derivation.city(grammar);
        match format {
            "glb" => glb::to_bytes(grammar, derivation, true).map_err(Error::method),
            "obj" => Ok(obj::to_string(&city()).into_bytes()),
            "city.json" => Ok(cityjson::to_string(&city()).into_bytes()),
            other => Err(CommandError::Format(other.to_owned()).into()),
        }
    }
}
