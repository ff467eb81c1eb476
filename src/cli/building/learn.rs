//! `edifice building learn`.

use std::path::PathBuf;
use std::time::Instant;

use edifice_base::Error;
use edifice_building_exteriors::coding::Coding;
use edifice_building_exteriors::model_file::ModelFile;

use super::data::Input;
use crate::model::learning::Learning;
use crate::print;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    input: Input,
    /// File of the model (`*.houses.json`).
    #[arg(short, long)]
    output: PathBuf,
    #[command(flatten)]
    learning: Learning,
    /// The paper's model: every attribute a Gaussian variable, absent parts zeros, derived numbers drawn. Without it the
    /// presence of parts and the number of floors are discrete variables, and what follows from others is computed.
    #[arg(long)]
    as_published: bool,
    /// Print a line of JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> edifice_base::Result<()> {
    let begun = Instant::now();
    let (data, coding) = match args.as_published || args.input.schema.is_some() {
        true => (args.input.known()?, Coding::Published),
        false => (args.input.coded()?, Coding::Presence),
    };
    let start = args
        .learning
        .from
        .as_deref()
        .map(super::data::model)
        .transpose()?;
    let start = start.as_ref().map(|file| &file.model);
    let settings = args.learning.search.settings(0.0)?;
    let found = (args.learning).learn(&data, &settings, start, &args.input.input, begun)?;
    let model = found.model;
    let (styles, edges) = (model.styles(), model.lateral_edges().len());
    let cardinalities = model.cardinalities();
    let groups = data.groups;
    let file = ModelFile {
        groups,
        coding,
        model,
    };
    let text = file.to_json().map_err(Error::method)?;
    edifice_io::write_atomic(&args.output, text.as_bytes())?;
    let houses = data.table.rows();
    print::message(&format!(
        "{houses} houses: {styles} styles, kinds {cardinalities:?}, {edges} lateral edges, Cheeseman-Stutz score {:.1}, {:.1} s",
        found.score, found.seconds
    ));
    if args.json {
        let summary = serde_json::json!({
            "houses": houses, "styles": styles, "cardinalities": cardinalities,
            "lateral_edges": edges, "score": found.score, "bic": found.bic,
            "interrupted": found.interrupted, "seconds": found.seconds, "seed": args.learning.search.seed,
        });
        print::line(&summary.to_string())?;
    }
    Ok(())
}
