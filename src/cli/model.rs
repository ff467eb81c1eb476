//! Model files on the command line: Bayesian networks, and the procedural logic of facades.

use std::path::{Path, PathBuf};

use clap::Subcommand;
use edifice::file::{read_bytes, write_atomic};
use edifice::io::json::parse_json;
use edifice::methods::procedural_logic::{MODEL_FORMAT, Model, ModelFile};
use edifice::model::ModelError;
use edifice::model::network::{FORMAT, Network};
use edifice::{Error, Result};

use super::print;

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
    Logic(Box<Model>),
}

/// A file of another kind.
#[derive(Debug, thiserror::Error)]
#[error("unknown format {0:?}, expected a .bif file, {FORMAT:?} or {MODEL_FORMAT:?}")]
struct UnknownFormat(String);

/// A model where a network is needed.
#[derive(Debug, thiserror::Error)]
#[error("a logic model, expected a Bayesian network")]
struct NotANetwork;

/// Runs the command.
pub fn run(command: Command) -> Result<()> {
    let lines = match command {
        Command::Show { model, json } => match read(&model)? {
            Any::Network(network) => show_network(&network, json).map_err(at(&model))?,
            Any::Logic(model) => show_logic(&model, json),
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
    match header.format.as_str() {
        FORMAT => Ok(Any::Network(Network::from_json(text()?).map_err(at(path))?)),
        MODEL_FORMAT => {
            let file: ModelFile = parse_json(&bytes, path)?;
            let model = Model::try_from(file).map_err(|e| Error::content(path, e))?;
            Ok(Any::Logic(Box::new(model)))
        }
        _ => Err(Error::content(path, UnknownFormat(header.format))),
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

fn show_logic(model: &Model, json: bool) -> Vec<String> {
    let (labels, rules) = (model.alphabet.names(), &model.inference.rules);
    let facades: Vec<&str> = model.facades.iter().map(|f| f.name.as_str()).collect();
    if json {
        let summary = serde_json::json!({
            "labels": labels, "rules": rules.len(), "facades": facades,
        });
        return vec![summary.to_string()];
    }
    vec![
        format!("{} labels: {}", labels.len(), labels.join(", ")),
        format!("{} rules", rules.len()),
        format!("{} facades: {}", facades.len(), facades.join(", ")),
    ]
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
