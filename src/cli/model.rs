//! Model files on the command line: Bayesian networks, and the models of papers that have a [`Shown`].

use std::path::{Path, PathBuf};

use clap::Subcommand;
use edifice::file::{read_bytes, write_atomic};
use edifice::io::json::parse_json;
use edifice::model::ModelError;
use edifice::model::network::{FORMAT, Network};
use edifice::{Error, Result};

use super::{MODELS, print};

/// Commands.
#[derive(Subcommand)]
pub enum Command {
    /// Show the variables of a Bayesian network, or the rules and facades of a logic model.
    #[command(after_help = "Examples:
  edifice model show datasets/model/asia.bif
  edifice model show ecp.logic.json --json
`edifice building show` shows models of houses.")]
    Show {
        /// The model (`*.bif`, a network as JSON, or `*.logic.json`).
        model: PathBuf,
        /// Print a line of JSON instead of text.
        #[arg(long)]
        json: bool,
    },
    /// Convert a Bayesian network between BIF and JSON.
    #[command(after_help = "Examples:
  edifice model convert datasets/model/asia.bif -o asia.json")]
    Convert {
        /// The network (`*.bif`, or as JSON).
        network: PathBuf,
        /// The file to write: `*.bif` or `*.json`.
        #[arg(short, long, value_name = "OUT")]
        output: PathBuf,
    },
}

/// A model of one of the kinds that are read here.
enum Any {
    Network(Network),
    Other(&'static Shown, Vec<u8>),
}

/// A kind of model that a method of a paper has, and that `show` shows.
pub struct Shown {
    /// The value of the key `format` of its files.
    pub format: &'static str,
    /// The lines to print, from the bytes and the path of a file; as JSON when asked for.
    pub show: fn(&[u8], &Path, bool) -> Result<Vec<String>>,
}

/// A file of another kind.
#[derive(Debug, thiserror::Error)]
#[error("unknown format {found:?}, expected a .bif file, {expected}")]
struct UnknownFormat {
    found: String,
    expected: String,
}

/// A model where a network is needed.
#[derive(Debug, thiserror::Error)]
#[error("a model of another kind, expected a Bayesian network")]
struct NotANetwork;

/// Runs the command.
pub fn run(command: Command) -> Result<()> {
    let lines = match command {
        Command::Show { model, json } => match read(&model)? {
            Any::Network(network) => show_network(&network, json).map_err(at(&model))?,
            Any::Other(kind, bytes) => (kind.show)(&bytes, &model, json)?,
        },
        Command::Convert { network, output } => {
            convert(&network, &output)?;
            Vec::new()
        }
    };
    lines.iter().try_for_each(|line| print::line(line))
}

fn at(path: &Path) -> impl Fn(ModelError) -> Error + '_ {
    move |error| Error::content(path, error)
}

fn is_bif(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("bif"))
}

fn read(path: &Path) -> Result<Any> {
    #[derive(serde::Deserialize)]
    struct Header {
        format: String,
    }
    let bytes = read_bytes(path)?;
    let text = || std::str::from_utf8(&bytes).map_err(|e| Error::content(path, e));
    if is_bif(path) {
        let network = Network::from_bif(text()?).map_err(at(path))?;
        return Ok(Any::Network(network));
    }
    let header: Header = parse_json(&bytes, path)?;
    if header.format == FORMAT {
        return Ok(Any::Network(Network::from_json(text()?).map_err(at(path))?));
    }
    match MODELS.iter().find(|kind| kind.format == header.format) {
        Some(kind) => Ok(Any::Other(kind, bytes)),
        None => {
            let formats = std::iter::once(FORMAT).chain(MODELS.iter().map(|kind| kind.format));
            let formats: Vec<String> = formats.map(|format| format!("{format:?}")).collect();
            let unknown = UnknownFormat {
                found: header.format,
                expected: formats.join(" or "),
            };
            Err(Error::content(path, unknown))
        }
    }
}

fn show_network(network: &Network, json: bool) -> Result<Vec<String>, ModelError> {
    let mut lines = Vec::new();
    let mut variables = Vec::new();
    for name in network.names() {
        let (categories, parents) = (network.categories(name)?, network.parents(name)?);
        let kind = match categories {
            [] => "real".to_string(),
            _ => categories.join(", "),
        };
        let given = match &parents[..] {
            [] => String::new(),
            _ => format!(", given {}", parents.join(", ")),
        };
        lines.push(format!("{name}: {kind}{given}"));
        variables.push(serde_json::json!({
            "name": name, "categories": categories, "parents": parents,
        }));
    }
    match json {
        true => Ok(vec![
            serde_json::json!({"variables": variables}).to_string(),
        ]),
        false => Ok(lines),
    }
}

fn convert(from: &Path, to: &Path) -> Result<()> {
    let Any::Network(network) = read(from)? else {
        return Err(Error::content(from, NotANetwork));
    };
    let text = if is_bif(to) {
        network.to_bif().map_err(at(to))?
    } else if to
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("json"))
    {
        network.to_json().map_err(at(to))? + "\n"
    } else {
        let message = format!("unknown format {:?}, expected .bif or .json", to.display());
        return Err(Error::option("--output", message));
    };
    write_atomic(to, text.as_bytes())
}
