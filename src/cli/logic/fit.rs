//! `edifice logic fit`.

use std::collections::HashSet;
use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_procedural_logic::{Model, Parameters, fewest_rules, search_axes};
use edifice_shape::LabelGrid;

use super::input::{Energy, Facades, read_model, write_model};
use crate::print;

/// More rules per facade than this are a sign of noisy labels: exact ones of ECP2011 need less than one, of
/// Graz2012 and the shipped layouts less than ten.
const MANY_RULES: usize = 10;

/// Options of `logic fit`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  edifice logic fit datasets/facade_grammar/layouts/terrace_*.facade.json -o terraces.logic.json\n  edifice logic fit datasets/facade_grammar/layouts/t*.facade.json --search -o found.logic.json\n  edifice logic fit datasets/examples/facade.png datasets/examples/facade_2.png --clean -o clean.logic.json\n  edifice logic fit datasets/examples/facade.png --into clean.logic.json -o more.logic.json"
)]
pub(crate) struct Args {
    #[command(flatten)]
    facades: Facades,
    /// Model to add the facades to, with its parameters and affinities as they are.
    #[arg(long, value_name = "MODEL", conflicts_with_all = ["search", "alpha", "parental_bias", "horizontal_bias"])]
    into: Option<PathBuf>,
    #[command(flatten)]
    energy: Energy,
    /// Search the parameters that give the fewest rules.
    #[arg(long, conflicts_with_all = ["alpha", "parental_bias", "horizontal_bias"])]
    search: bool,
    /// Model file to write.
    #[arg(short, long, value_name = "MODEL")]
    output: PathBuf,
    /// End standard output with one JSON object.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let grids = args.facades.read()?;
    let model = match &args.into {
        Some(path) => {
            let mut model = read_model(path)?;
            tell_known(&model, &grids);
            model.add_all(&grids).map_err(Error::method)?;
            model
        }
        None => {
            let mut parameters = args.energy.parameters(Parameters::COMPRESSION)?;
            if args.search {
                let found = fewest_rules(&grids, &search_axes()).map_err(Error::method)?;
                parameters = Parameters {
                    alpha: found.best[0],
                    parental_bias: found.best[1],
                    horizontal_bias: found.best[2],
                    ..parameters
                };
            }
            Model::fit(&grids, parameters).map_err(Error::method)?
        }
    };
    write_model(&model, &args.output)?;
    hint(args, &model);
    let inference = &model.inference;
    let p = model.parameters;
    print::message(&format!(
        "alpha {}, b_p {}, b_h {}",
        p.alpha, p.parental_bias, p.horizontal_bias
    ));
    if args.json {
        return print::line(
            &serde_json::json!({
                "facades": inference.facades,
                "binary_splits": inference.binary_splits,
                "nary_splits": inference.nary_splits,
                "rules": inference.rules.len(),
                "alpha": p.alpha,
                "parental_bias": p.parental_bias,
                "horizontal_bias": p.horizontal_bias,
            })
            .to_string(),
        );
    }
    print::line(&format!(
        "{} facades: {} binary splits, {} n-ary splits, {} rules",
        inference.facades,
        inference.binary_splits,
        inference.nary_splits,
        inference.rules.len()
    ))
}

/// Says which names the model already has: those facades are added once more.
fn tell_known(model: &Model, grids: &[LabelGrid]) {
    let names: HashSet<&str> = model.facades.iter().map(|f| f.name.as_str()).collect();
    for grid in grids
        .iter()
        .filter(|grid| names.contains(grid.name.as_str()))
    {
        print::message(&format!(
            "warning: the model already has a facade called {}; it is added once more",
            grid.name
        ));
    }
}

/// Points to `--clean` when there are so many rules that the labels look noisy.
fn hint(args: &Args, model: &Model) {
    let (rules, facades) = (model.inference.rules.len(), model.facades.len());
    if !args.facades.is_clean() && rules > MANY_RULES * facades {
        print::message(&format!(
            "{rules} rules for {facades} facades: if the labels come from a segmentation, --clean makes them regular"
        ));
    }
}
