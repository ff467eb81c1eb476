//! Models on the command line: Bayesian networks, models of tables, and the models of papers that have a [`Shown`].

mod completed;
pub(crate) mod data;
mod drawing;
pub(crate) mod evaluate;
mod fit;
pub(crate) mod learning;
mod network;
mod query;
pub(crate) mod search;
mod structure;
mod tables;

use std::path::{Path, PathBuf};

use clap::Subcommand;
use edifice_base::file::read_bytes;
use edifice_base::{Error, Result};
use edifice_io::json::parse_json;
use edifice_model::ModelError;
use edifice_model::network::{Evidence, FORMAT, Network, OLD_FORMAT};

use super::MODELS;
use super::print::{self, Json};

pub(crate) use tables::TABLE_MODEL;

/// Commands.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// Print the schema that is guessed of a table, to edit.
    #[command(after_help = "Examples:
  cut -d, -f1-4 datasets/building_exteriors/real.houses.csv > plans.csv && edifice model schema plans.csv > plans.schema.json")]
    Schema(tables::SchemaArgs),
    /// Learn a hierarchical model with hidden styles from any table.
    #[command(after_help = "Examples:
  edifice model learn plans.csv --schema plans.schema.json --max-styles 3 -o plans.table-model.json
  edifice model learn plans.csv -o plans.table-model.json --time-limit 2
  edifice model learn plans.csv -o plans.table-model.json --from plans.table-model.json --time-limit 2
  edifice model learn plans.csv -o plans.table-model.json --fit-only --styles 3 --kinds 2")]
    Learn(tables::LearnArgs),
    /// Print the log probability mass of the categories of every row of a table under a model, and the log density of its numbers given these.
    #[command(after_help = "Examples:
  edifice model score plans.table-model.json plans.csv")]
    Score(tables::ScoreArgs),
    /// Sample rows from a model of a table or a Bayesian network; prints CSV.
    #[command(after_help = "Examples:
  edifice model sample plans.table-model.json -n 5 --given source=delft
  edifice model sample datasets/model/asia.bif -n 5 --given smoke=yes")]
    Sample(tables::SampleArgs),
    /// Complete rows whose cells are partly missing; prints CSV.
    #[command(after_help = "Examples:
  edifice model complete plans.table-model.json plans.csv -n 3")]
    Complete(tables::CompleteArgs),
    /// Compare models by the negative log-likelihood of rows they have not seen.
    #[command(after_help = "Examples:
  edifice model evaluate datasets/model/mixture_1.csv --splits 2 --models model_1,gmm")]
    Evaluate(evaluate::Args),
    /// Ask a Bayesian network: posteriors given evidence, or the most probable explanations.
    #[command(after_help = "Examples:
  edifice model query datasets/model/asia.bif --given smoke=yes --of lung,bronc
  edifice model query datasets/model/asia.bif --likely xray=0.2,0.9 --method likelihood-weighting --draws 20000
  edifice model query datasets/model/asia.bif --given dysp=yes --explain 3")]
    Query(query::Args),
    /// Show the variables of a Bayesian network, or the rules and facades of a logic model.
    #[command(after_help = "Examples:
  edifice model show datasets/model/asia.bif
  edifice model show terraces.logic.json --json
`edifice building show` shows models of houses.")]
    Show {
        /// The model (`*.bif`, a network as JSON, or `*.logic.json`).
        model: PathBuf,
        /// Print a line of JSON instead of text.
        #[arg(long)]
        json: bool,
    },
    /// Learn the structure of a Bayesian network from a table of categories.
    #[command(after_help = "Examples:
  edifice model sample datasets/model/asia.bif -n 500 > patients.csv && edifice model structure patients.csv -o patients.bif
  edifice model structure patients.csv --score bic --forbid 'xray>smoke' --tier asia,smoke --tier lung,xray -o patients.svg")]
    Structure(structure::Args),
    /// Learn the parameters of a Bayesian network from a table, by expectation maximisation: variables without a column are hidden,
    /// cells may be missing.
    #[command(after_help = "Examples:
  edifice model fit datasets/model/asia.bif patients.csv -o fitted.bif
  edifice model fit datasets/model/asia.bif patients.csv --from -o fitted.json")]
    Fit(fit::Args),
    /// Convert a Bayesian network between BIF, XMLBIF and JSON, or draw it.
    #[command(after_help = "Examples:
  edifice model convert datasets/model/asia.bif -o asia.json
  edifice model convert datasets/model/asia.bif --given smoke=yes -o asia.svg")]
    Convert {
        /// The network (`*.bif`, `*.xmlbif`, or as JSON).
        network: PathBuf,
        /// The file to write: `*.bif`, `*.xmlbif`, `*.json`, `*.dot`, or `*.svg` with posteriors as bars.
        #[arg(short, long, value_name = "OUT")]
        output: PathBuf,
        /// Evidence of a drawing: VARIABLE=CATEGORY; repeatable.
        #[arg(long)]
        given: Vec<String>,
        #[command(flatten)]
        json: Json,
    },
}

/// A model of one of the kinds that are read here.
enum Any {
    Network(Network),
    Other(&'static Shown, Vec<u8>),
}

/// A kind of model that a method of a paper has, and that `show` shows.
pub(crate) struct Shown {
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
pub(crate) fn run(command: Command) -> Result<()> {
    let lines = match command {
        Command::Schema(args) => return tables::schema(&args),
        Command::Learn(args) => return tables::learn(&args),
        Command::Score(args) => return tables::score(&args),
        Command::Sample(args) => return tables::sample(&args),
        Command::Complete(args) => return tables::complete(&args),
        Command::Evaluate(args) => return evaluate::run(&args),
        Command::Query(args) => return query::run(&args),
        Command::Show { model, json } => match read(&model)? {
            Any::Network(network) => network::show(&network, json).map_err(at(&model))?,
            Any::Other(kind, bytes) => (kind.show)(&bytes, &model, json)?,
        },
        Command::Structure(args) => return structure::run(&args),
        Command::Fit(args) => return fit::run(&args),
        Command::Convert {
            network,
            output,
            given,
            json,
        } => {
            let network = network::network(&network)?;
            let evidence = query::hard(&network, &given, Evidence::new())?;
            let names = given.iter().filter_map(|g| g.split_once('='));
            let names: Vec<String> = names.map(|(name, _)| name.to_owned()).collect();
            network::convert(&network, &output, &evidence, &names)?;
            let variables = network.names().count();
            return json.end(&serde_json::json!({ "file": output, "variables": variables }));
        }
    };
    lines.iter().try_for_each(|line| print::line(line))
}

fn at(path: &Path) -> impl Fn(ModelError) -> Error + '_ {
    move |error| Error::content(path, error)
}

/// The network of a file; `None` for a model of another kind.
fn network_of(path: &Path) -> Result<Option<Network>> {
    match read(path)? {
        Any::Network(network) => Ok(Some(network)),
        Any::Other(..) => Ok(None),
    }
}

fn read(path: &Path) -> Result<Any> {
    #[derive(serde::Deserialize)]
    struct Header {
        format: String,
    }
    if let Some(network) = network::by_extension(path)? {
        return Ok(Any::Network(network));
    }
    let bytes = read_bytes(path)?;
    let text = || std::str::from_utf8(&bytes).map_err(|e| Error::content(path, e));
    let header: Header = parse_json(&bytes, path)?;
    if [FORMAT, OLD_FORMAT].contains(&header.format.as_str()) {
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
