//! `edifice building learn`.

use std::path::PathBuf;

use edifice::Error;
use edifice::methods::building_exteriors::model_file::ModelFile;
use edifice::model::hierarchy::learn;

use super::data::Input;
use crate::cli::model::search::{Search, warnings};
use crate::cli::print;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    input: Input,
    /// Where the model goes (`*.houses.json`).
    #[arg(short, long)]
    output: PathBuf,
    #[command(flatten)]
    search: Search,
    /// Print a line of JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> edifice::Result<()> {
    let data = args.input.read()?;
    let settings = args.search.settings()?;
    let start = std::time::Instant::now();
    let learned = learn(&data.table, &data.groups, &settings, args.search.seed)
        .map_err(|e| Error::content(&args.input.input, e))?;
    let seconds = start.elapsed().as_secs_f64();
    let model = learned.model;
    for warning in warnings(&data.table, model.free_parameters()) {
        print::message(&format!("warning: {warning}"));
    }
    let (styles, edges) = (model.styles(), model.lateral_edges().len());
    let cardinalities = model.cardinalities();
    let groups = data.groups;
    let file = ModelFile { groups, model };
    let text = file.to_json().map_err(Error::method)?;
    edifice::io::write_atomic(&args.output, text.as_bytes())?;
    let houses = data.table.rows();
    print::message(&format!(
        "{houses} houses: {styles} styles, kinds {cardinalities:?}, {edges} lateral edges, Cheeseman-Stutz score {:.1}, {seconds:.1} s",
        learned.score
    ));
    if args.json {
        let summary = serde_json::json!({
            "houses": houses, "styles": styles, "cardinalities": cardinalities,
            "lateral_edges": edges, "score": learned.score, "bic": learned.bic,
            "seconds": seconds, "seed": args.search.seed,
        });
        print::line(&summary.to_string())?;
    }
    Ok(())
}
