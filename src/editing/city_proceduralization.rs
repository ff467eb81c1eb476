//! Cities as grammars of instances: sizes of templates and weights of rules are changed, and drawn shapes are filled
//! with new cities of their buildings (Demir et al. 2014).

mod edits;
mod view;

use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use serde_json::Value;

pub use edits::{CityEdit, CityEditError, edit};

use super::examples::{Example, Source};
use super::script::Shell;
use super::{CommandError, Editor, Opened, State, Step, ends, parse};
use crate::grammar::instance::{InstanceDerivation, InstanceGrammar};
use crate::io::city::{cityjson, glb, grammar_json, obj};
use crate::methods::city_proceduralization::synthesis::{Shape, synthesize};
use crate::{Error, Result};

const ENDING: &str = ".city-grammar.json";
const FORMATS: &[&str] = &["glb", "obj", "city.json"];

/// Opens `*.city-grammar.json`, also as `.gz`.
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

fn open(path: &Path, bytes: &[u8]) -> Opened {
    ends(path, ENDING).then(|| {
        let city = City::new(grammar_json::parse(bytes, path)?)?;
        Ok(Arc::new(city) as Arc<dyn State>)
    })
}

/// Why a shape is not filled.
#[derive(Debug, thiserror::Error)]
pub enum FillError {
    /// Fewer than three corners.
    #[error("a shape of {0} corners: expected at least 3")]
    Corners(usize),
    /// Nothing fits.
    #[error("no building fits into the shape")]
    Full,
    /// The grammar.
    #[error(transparent)]
    Grammar(#[from] crate::grammar::instance::InstanceGrammarError),
}

/// A new city of a grammar's buildings in a shape of rings in metres.
///
/// # Errors
/// [`FillError`].
pub fn fill(
    grammar: &InstanceGrammar,
    mut shape: Shape,
    seed: u64,
) -> std::result::Result<(InstanceGrammar, InstanceDerivation), FillError> {
    // Near the origin, where millimetres are kept.
    let low = shape.bounds().map_or([0.0; 2], |b| b.0.map(f64::floor));
    for p in shape.rings.iter_mut().flatten() {
        *p = [p[0] - low[0], p[1] - low[1]];
    }
    let mut made = synthesize(grammar, &shape, seed)?;
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
    grammar: Arc<InstanceGrammar>,
    derivation: Arc<InstanceDerivation>,
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
        // As it is in its file, which keeps so many digits, and from which the next command of a script would start.
        let text = grammar_json::to_string(&grammar).map_err(Error::method)?;
        let grammar = grammar_json::parse(text.as_bytes(), Path::new(&grammar.name))?;
        let derivation = grammar.derive().map_err(Error::method)?;
        Ok(Self {
            grammar: Arc::new(grammar),
            derivation: Arc::new(derivation),
        })
    }

    fn edit(&self, texts: &[String]) -> Result<Step> {
        let edits: std::result::Result<Vec<CityEdit>, CommandError> =
            texts.iter().map(|t| t.parse()).collect();
        let edits = edits?;
        if edits.is_empty() {
            return Err(CommandError::Nothing.into());
        }
        let state = Self::new(edit(&self.grammar, &edits).map_err(Error::method)?)?;
        let mut shell = Shell::new(["city", "edit", "--output", ">", "--", "<"]);
        for text in texts {
            shell = shell.arg(text);
        }
        Ok(Step {
            state: Arc::new(state),
            said: texts.join(", "),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: Vec::new(),
        })
    }

    fn synthesize(&self, polygon: Vec<[f64; 2]>, seed: u64) -> Result<Step> {
        if polygon.len() < 3 {
            return Err(Error::method(FillError::Corners(polygon.len())));
        }
        let corners = super::written(&polygon.concat());
        let shape = Shape {
            rings: vec![polygon],
        };
        let (grammar, derivation) = fill(&self.grammar, shape, seed).map_err(Error::method)?;
        let count = derivation.buildings.len();
        let shell = Shell::new(["city", "synthesize", "<"])
            .option("--polygon", corners)
            .option("--seed", seed);
        let output = Shell::new(["--output", ">"]).words;
        let shell = Shell {
            words: [shell.words, output].concat(),
            ..shell
        };
        Ok(Step {
            state: Arc::new(Self::new(grammar)?),
            said: format!("fill a drawn shape with {count} buildings, seed {seed}"),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: Vec::new(),
        })
    }
}

impl State for City {
    fn kind(&self) -> &'static str {
        EDITOR.kind
    }

    fn name(&self) -> &str {
        &self.grammar.name
    }

    fn ending(&self) -> &'static str {
        ENDING
    }

    fn bytes(&self) -> Result<Vec<u8>> {
        let text = grammar_json::to_string(&self.grammar);
        Ok(text.map_err(Error::method)?.into_bytes())
    }

    fn view(&self) -> Result<Value> {
        Ok(view::view(&self.grammar, &self.derivation))
    }

    fn apply(&self, command: &Value) -> Result<Step> {
        match parse(command)? {
            Command::Edit { edits } => self.edit(&edits),
            Command::Synthesize { polygon, seed } => self.synthesize(polygon, seed),
        }
    }

    fn formats(&self) -> &'static [&'static str] {
        FORMATS
    }

    fn export(&self, format: &str) -> Result<Vec<u8>> {
        let city = || self.derivation.city(&self.grammar);
        match format {
            "glb" => glb::to_bytes(&self.grammar, &self.derivation, true).map_err(Error::method),
            "obj" => Ok(obj::to_string(&city()).into_bytes()),
            "city.json" => Ok(cityjson::to_string(&city()).into_bytes()),
            other => Err(CommandError::Format(other.to_owned()).into()),
        }
    }
}
