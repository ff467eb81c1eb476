//! Documents and their edits as values: what `edifice studio` does by hand and the commands do one at a time.
//!
//! A document has a [`State`]: a house, a facade that is being completed, a grammar, a city. A command takes a state to
//! the next one; the [`Document`](history::Document) keeps the list of commands, so that undo and redo are places in that
//! list. Every command is also a line of shell ([`script`]): the same functions serve both, so that the script of a
//! document, run without the studio, writes the same bytes as saving it.
//!
//! # Commands
//! A command is a JSON object; `do` names it. Edits inside it are written as on the command line.
//!
//! | kind | `do` | fields | command line |
//! | --- | --- | --- | --- |
//! | `house` | `edit` | `edits` (`add garage@X,Y,W,D,H`, `move 0=X,Y`, `resize 0=W,D,H`, `remove 0`), `suggest`, `seed` | `building edit` |
//! | | `variations` | `count`, `seed` | `building variations` |
//! | | `wish` | `given` (`bbox.w=14`, `roof.hip=yes`), `style`, `keep`, `seed` | `building wish` |
//! | | `choose` | `answer`, from 1 | the file of that answer |
//! | `completion` | `edit` | `edits` (`add door@X,Y,W,H`, `move ID=X,Y`, `resize ID=W,H`, `relabel ID=window`, `remove ID`, `unknown X,Y,W,H`, `known INDEX`, `outline W,H`) | `facade edit` |
//! | | `complete` | `count`, `seed`, `method`, `pins`, `forbid` | `facade complete` |
//! | | `choose` | `answer`, from 1 | the file of that answer |
//! | | `photograph` | `picture`, a JPEG or PNG picture as a `data:` address, or null for none | `facade edit --photograph` |
//! | | `straighten` | `corners` of the facade in a photograph, four `[x, y]` in pixels, upper left first, clockwise; `picture` as above, or null for the one that was opened; `height` in metres for a new outline, or null | `facade straighten` |
//! | `grammar` | `edit` | `edits` (`resize RULE.PART=SIZE`, `border RULE.PART=SHIFT`, `symbol RULE.PART=NAME`, `insert RULE.PART=NAME:SIZE`, `insert RULE.PART=SIZE`, `remove RULE.PART`, `grow RULE.PART`, `shrink RULE.PART`, `repeat RULE`, `weight RULE=W`, `outline W,H`; PART is a part `0`, a column `c0` or a row `r0` of a grid) | `grammar edit` |
//! | | `merge` | `facades`, the texts of `.facade.json` files | `grammar merge` |
//! | `city` | `edit` | `edits` (`scale NAME=FX,FY,FZ`, `move NAME=DX,DY,DZ`, `turn NAME=DEGREES`, `remove NAME`, `weight RULE=W`) | `city edit` |
//! | | `synthesize` | `polygon`, `seed` | `city synthesize` |
//! | | `proceduralize` | `level` | `city proceduralize` |

pub mod building_exteriors;
pub mod city_proceduralization;
mod example;
pub mod examples;
pub mod facade_grammar;
pub mod history;
pub mod script;
pub mod split_grammar;
pub mod structure_completion;
pub mod work;

use std::path::Path;
use std::sync::Arc;

use serde_json::Value;

use edifice_base::{Error, Result};
use example::Example;
use script::Shell;
use work::{Stopped, Work};

/// The kinds of documents that can be opened, tried in this order.
pub const EDITORS: &[Editor] = &[
    building_exteriors::EDITOR,
    city_proceduralization::EDITOR,
    structure_completion::EDITOR,
    facade_grammar::EDITOR,
];

/// The result of an editor that was offered a file; `None` if the file is for another editor.
pub type Opened = Option<Result<Arc<dyn State>>>;

/// A kind of document.
pub struct Editor {
    /// Its kind, as states name it.
    pub kind: &'static str,
    /// Reads a file that it suits; `None` for one that is of another kind. The path only names the file.
    pub open: fn(&Path, &[u8], &Work) -> Opened,
    /// Documents to begin with.
    pub examples: &'static [Example],
}

/// A document at one moment: a value that commands take to the next one.
pub trait State: Send + Sync {
    /// `house`, `completion`, `grammar` or `city`.
    fn kind(&self) -> &'static str;

    /// The document's name.
    fn name(&self) -> &str;

    /// The ending of the names of its files, for example `.building.json`.
    fn ending(&self) -> &'static str;

    /// Its file.
    ///
    /// # Errors
    /// When a value cannot be written in the format.
    fn bytes(&self) -> Result<Vec<u8>>;

    /// All that a page shows of it.
    ///
    /// # Errors
    /// When it cannot be measured or drawn.
    fn view(&self) -> Result<Value>;

    /// The state after a command.
    ///
    /// # Errors
    /// [`CommandError`] for a command that is none, or what its method says of a command that cannot be done.
    fn apply(&self, command: &Value, work: &Work) -> Result<Applied>;

    /// Answers a question about the state, which stays as it is.
    ///
    /// # Errors
    /// [`CommandError::Form`] for what is no question of this kind of document.
    fn ask(&self, question: &Value) -> Result<Value> {
        parse::<NoQuestion>(question).map(|none| match none {})
    }

    /// The unit of a document that can be merged with others of its kind and unit; `None` if it cannot be merged.
    fn merges_in(&self) -> Option<&str> {
        None
    }

    /// Formats of [`State::export`], as endings of file names.
    fn formats(&self) -> &'static [&'static str];

    /// The document in another format.
    ///
    /// # Errors
    /// [`CommandError::Format`] for an unknown format.
    fn export(&self, format: &str) -> Result<Vec<u8>>;
}

/// The questions of a document that has none.
#[derive(serde::Deserialize)]
enum NoQuestion {}

/// The result of a command.
pub struct Applied {
    /// The new state.
    pub state: Arc<dyn State>,
    /// The command in words.
    pub said: String,
    /// The same as a line of shell.
    pub shell: Shell,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// Why a command cannot be done.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// It is no command of this kind of document.
    #[error("not a command of this document: {0}")]
    Form(#[from] serde_json::Error),
    /// An edit cannot be read.
    #[error("{edit:?}: {message}")]
    Edit {
        /// The edit.
        edit: String,
        /// The reason.
        message: String,
    },
    /// There is no such answer.
    #[error("there is no answer {wanted}: there are {count}")]
    Answer {
        /// Number of the answer, from 1.
        wanted: usize,
        /// Number of answers.
        count: usize,
    },
    /// A count out of range.
    #[error("{count} answers: expected 1 to {most}")]
    Count {
        /// Answers asked for.
        count: usize,
        /// The most there can be.
        most: usize,
    },
    /// More regions than a page can show.
    #[error("{count} regions: more than the {most} that are shown")]
    Regions {
        /// Regions of the facade.
        count: usize,
        /// The most that are shown.
        most: usize,
    },
    /// A document has no such format.
    #[error("this document cannot be written as {0:?}")]
    Format(String),
    /// The list of commands is empty.
    #[error("nothing to edit")]
    Nothing,
    /// The work was stopped.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<CommandError> for Error {
    fn from(error: CommandError) -> Self {
        Self::method(error)
    }
}

impl From<Stopped> for Error {
    fn from(error: Stopped) -> Self {
        CommandError::from(error).into()
    }
}

/// Opens a file in the editor that suits it; the path only names the file.
///
/// # Errors
/// [`Error::Content`] for a file that no editor knows, or what its reader says.
pub fn open(path: &Path, bytes: &[u8], work: &Work) -> Result<Arc<dyn State>> {
    let opened = EDITORS.iter().find_map(|e| (e.open)(path, bytes, work));
    opened.unwrap_or_else(|| {
        Err(Error::content(
            path,
            "no editor knows this kind of file: expected .facade.json, .grammar.json, .cga, .building.json, .city-grammar.json, a \
             photograph (.jpg, .png), or a city (.npz, .obj, .glb, .gltf, .city.json, .city.jsonl)",
        ))
    })
}

/// Reads a command.
fn parse<T: serde::de::DeserializeOwned>(command: &Value) -> Result<T> {
    Ok(T::deserialize(command).map_err(CommandError::from)?)
}

/// Numbers with commas between them.
pub(crate) fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let read = |t: &str| t.trim().parse().ok().filter(|v: &f64| v.is_finite());
    let values: Option<Vec<f64>> = text.split(',').map(read).collect();
    let values = values.and_then(|v| v.try_into().ok());
    values.ok_or_else(|| format!("{text:?}: expected {N} numbers"))
}

/// Numbers as they are written in edits; they read back to the same bits.
fn written(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(f64::to_string).collect();
    texts.join(",")
}

/// Answer `wanted`, counted from 1.
fn answer<T>(answers: &[T], wanted: usize) -> Result<&T> {
    let found = wanted.checked_sub(1).and_then(|k| answers.get(k));
    let count = answers.len();
    Ok(found.ok_or(CommandError::Answer { wanted, count })?)
}

/// Checks a number of answers.
fn count_of_answers(count: usize, most: usize) -> Result<usize> {
    match (1..=most).contains(&count) {
        true => Ok(count),
        false => Err(CommandError::Count { count, most }.into()),
    }
}

/// True if a file's name, without `.gz`, ends with this ending.
fn ends(path: &Path, ending: &str) -> bool {
    let name = path.to_string_lossy().to_lowercase();
    name.trim_end_matches(".gz").ends_with(ending)
}
