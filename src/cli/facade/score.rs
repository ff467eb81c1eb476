//! `edifice facade score`.

use std::path::PathBuf;
use std::time::Instant;

use edifice_base::{Error, Result};
use edifice_structure_completion::model::shipped_model;
use edifice_structure_completion::policy::paper_model;

use super::complete::read_model;
use super::input;
use crate::print;
use crate::reading::Reading;

/// Options of `facade score`.
#[derive(clap::Args)]
#[command(after_help = "Example:
  edifice facade score datasets/facade_grammar/layouts/office_1.facade.json --model mine.completion.json

Each scoring function is at most 0, which is what at least half of the facades of the database reach or fall short of. The
last column says which grid, pair of grids or side of the facade is the least typical.")]
pub(crate) struct Args {
    /// Whole facade: .facade.json, or any other format that `facade convert` reads
    #[arg(value_name = "LAYOUT")]
    input: PathBuf,
    /// Model of `facade train`; the default one was learnt from the shipped layouts
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// End standard output with one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let start = Instant::now();
    let model = match &args.model {
        Some(path) => read_model(path)?,
        None => shipped_model().map_err(Error::method)?,
    };
    let paper = paper_model(&model);
    let paper = paper.ok_or_else(|| Error::option("--model", "has no layout with elements"))?;
    if model.paper.is_none() {
        print::message("warning: the model has no learnt weights: each is 1");
    }
    let layouts = input::layouts(std::slice::from_ref(&args.input), &args.reading)?;
    for layout in &layouts {
        if layout.elements.is_empty() {
            let message = "no window, door, balcony or shop to score";
            return Err(Error::content(&args.input, message));
        }
        let facade = [layout.width, layout.height];
        let evaluation = paper.score.evaluate(facade, &layout.elements);
        let score = paper.score.score(&evaluation.features);
        let lines = paper.score.explain(&evaluation, facade);
        print::line(&format!("{}: score {score:.3}", layout.name))?;
        print::line(&format!(
            "{:<14}{:>9}{:>9}{:>9}  least typical",
            "term", "weight", "feature", "product"
        ))?;
        for line in &lines {
            let product = line.weight * line.feature;
            print::line(&format!(
                "{:<14}{:>9.3}{:>9.3}{:>9.3}  {}",
                line.term.name(),
                line.weight,
                line.feature,
                product,
                line.culprit
            ))?;
        }
        if args.json {
            let terms: Vec<_> = (lines.iter())
                .map(|l| {
                    serde_json::json!({
                        "term": l.term.name(), "weight": l.weight, "feature": l.feature,
                        "least": l.least, "culprit": l.culprit,
                    })
                })
                .collect();
            let about = serde_json::json!({
                "score": score, "terms": terms, "seconds": start.elapsed().as_secs_f64(),
            });
            print::line(&about.to_string())?;
        }
    }
    Ok(())
}
