//! `edifice logic parse`.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_grammar::Grammar;
use edifice_io::write_grammar;
use edifice_procedural_logic::{Model, NaryTree, Parameters, split_grammar};
use edifice_shape::LabelGrid;

use super::input::{Energy, Facades, read_model};
use crate::print::{self, Json};

/// Options of `logic parse`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  edifice logic parse datasets/examples/facade.png -o parsed.grammar.json\n  edifice logic parse datasets/examples/facade.png --model terraces.logic.json -o parsed.cga\n  edifice logic parse datasets/facade_grammar/layouts -o grammars"
)]
pub(crate) struct Args {
    #[command(flatten)]
    facades: Facades,
    /// Model whose affinities and parameters to use; without one, those of the facades given.
    #[arg(long, value_name = "MODEL", conflicts_with_all = ["alpha", "parental_bias", "horizontal_bias"])]
    model: Option<PathBuf>,
    #[command(flatten)]
    energy: Energy,
    /// Grammar file to write (.grammar.json or .cga); a folder for several facades.
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let grids = args.facades.read()?;
    let mut model = match &args.model {
        Some(path) => read_model(path)?,
        None => {
            let parameters = args.energy.parameters(Parameters::COMPRESSION)?;
            Model::fit(&grids, parameters).map_err(Error::method)?
        }
    };
    if let [grid] = grids.as_slice() {
        let found = write(&parse(&mut model, grid)?, &args.output)?;
        return args.json.end(&serde_json::json!({ "grammars": [found] }));
    }
    let mut names = HashSet::new();
    if let Some(twice) = grids.iter().find(|grid| !names.insert(&grid.name)) {
        return Err(Error::content(&args.output, SameName(twice.name.clone())));
    }
    let folder = &args.output;
    std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
    let mut found = Vec::new();
    for grid in &grids {
        let grammar = parse(&mut model, grid)?;
        let path = folder.join(format!("{}.grammar.json", grid.name));
        found.push(write(&grammar, &path)?);
    }
    args.json.end(&serde_json::json!({ "grammars": found }))
}

/// Two facades whose grammars would go to one file.
#[derive(Debug, thiserror::Error)]
#[error("two facades are called {0}; each grammar is a file of that name")]
struct SameName(String);

fn parse(model: &mut Model, grid: &LabelGrid) -> Result<Grammar> {
    let tree = NaryTree::from_binary(&model.parse(grid).map_err(Error::method)?);
    Ok(split_grammar(
        &tree,
        &model.alphabet,
        &grid.name,
        &grid.unit,
    ))
}

/// Writes a grammar, and says so to people and to programs.
fn write(grammar: &Grammar, path: &Path) -> Result<serde_json::Value> {
    write_grammar(grammar, path)?;
    let rules = grammar.rules.len();
    print::line(&format!("{}: {rules} rules", path.display()))?;
    Ok(serde_json::json!({ "file": path, "rules": rules }))
}
