//! `edifice facade train`.

use std::path::PathBuf;

use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_io::write_atomic;
use edifice_structure_completion::layout::scope::in_scope;
use edifice_structure_completion::made::facades;
use edifice_structure_completion::model::Model;

use super::input;
use crate::print;
use crate::reading::Reading;

/// Options of `facade train`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  edifice facade train datasets/facade_grammar/layouts -o mine.completion.json\n  edifice facade train datasets/facade_grammar/layouts/terrace_*.facade.json --made 100 -o few.completion.json\n  edifice facade train datasets/examples/facade.png datasets/examples/facade_2.png datasets/examples/grid.txt -o two.completion.json"
)]
pub(crate) struct Args {
    /// Whole facades, and folders of them (.facade.json, .xml, .png)
    #[arg(required_unless_present = "made", value_name = "LAYOUT")]
    inputs: Vec<PathBuf>,
    /// Learn also from so many facades made by a generator, which help where there are few real ones
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=2000))]
    made: u16,
    /// Model to write
    #[arg(short, long, value_name = "MODEL.completion.json")]
    output: PathBuf,
    /// Seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    reading: Reading,
    /// End standard output with one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let start = std::time::Instant::now();
    let mut layouts = input::layouts(&args.inputs, &args.reading)?;
    layouts.extend(facades::several(args.made.into(), args.seed));
    let read = layouts.len();
    let regular = layouts.iter().filter(|l| in_scope(l)).count();
    let trained = Model::train(layouts, args.seed, &unwatched).map_err(Error::method)?;
    let model = trained.model;
    let used = model.examples.len();
    write_atomic(&args.output, model.to_json().as_bytes())?;
    if used < read {
        print::message(&format!(
            "warning: {} facades without windows were left out",
            read - used
        ));
    }
    if used == 1 {
        print::message(
            "warning: one facade says how its lines are spaced, but not how probable a completed element is; give several",
        );
    }
    if args.json {
        let about = serde_json::json!({
            "facades": used, "regular": regular, "seconds": start.elapsed().as_secs_f64(), "seed": args.seed,
        });
        return print::line(&about.to_string());
    }
    print::line(&format!(
        "{}: learnt from {used} facades, {regular} of them with a regular lattice of windows",
        args.output.display()
    ))
}
