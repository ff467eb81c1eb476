//! `edifice building learn`.

use std::path::PathBuf;

use edifice::Error;
use edifice::methods::building_exteriors::model_file::ModelFile;
use edifice::model::hierarchy::{Constant, Settings, Variant, learn};
use edifice::model::{Cell, Table};

use super::data::Input;
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

/// How to learn.
#[derive(clap::Args)]
pub struct Search {
    /// Fewest styles tried.
    #[arg(long, default_value_t = 2)]
    min_styles: usize,
    /// Most styles tried.
    #[arg(long, default_value_t = 25)]
    max_styles: usize,
    /// Most kinds of one attribute.
    #[arg(long, default_value_t = 25)]
    max_kinds: usize,
    /// Leave out lateral edges (the paper's Model 1).
    #[arg(long)]
    no_lateral_edges: bool,
    /// Refuse columns that are constant, instead of keeping them.
    #[arg(long)]
    refuse_constant: bool,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

impl Search {
    /// The settings of the model layer.
    pub fn settings(&self) -> edifice::Result<Settings> {
        if self.min_styles < 1 || self.min_styles > self.max_styles {
            return Err(Error::option(
                "--min-styles",
                "must be from 1 to --max-styles",
            ));
        }
        if self.max_kinds < 2 {
            return Err(Error::option("--max-kinds", "must be at least 2"));
        }
        let variant = if self.no_lateral_edges {
            Variant::NoLateral
        } else {
            Variant::Full
        };
        let constant = if self.refuse_constant {
            Constant::Refuse
        } else {
            Constant::Keep
        };
        Ok(Settings {
            variant,
            styles: self.min_styles..=self.max_styles,
            most_states: self.max_kinds,
            constant,
            ..Settings::default()
        })
    }
}

/// What was learned all the same, but says little: constant columns, fewer houses than parameters.
fn warnings(table: &Table, parameters: usize) -> Vec<String> {
    let mut warnings = Vec::new();
    for column in table.columns() {
        let cells = (0..table.rows()).map(|row| column.cell(row));
        let mut seen = cells.filter(|cell| *cell != Cell::Missing);
        let first = seen.next();
        if seen.all(|cell| Some(cell) == first) {
            let name = column.name();
            warnings.push(format!(
                "column `{name}` is constant: it is kept with unit scale"
            ));
        }
    }
    let houses = table.rows();
    if houses < parameters {
        warnings.push(format!(
            "{houses} houses for {parameters} free parameters: where houses do not tell, the prior decides"
        ));
    }
    warnings
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
