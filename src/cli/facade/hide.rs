//! `edifice facade hide`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_editing::structure_completion::hiding::hide;
use edifice_io::{facade_json, write_atomic};
use edifice_structure_completion::sights::Sight;

use super::input;
use crate::print;
use crate::reading::Reading;

/// Options of `facade hide`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Whole facade: any format that `facade convert` reads
    input: PathBuf,
    /// The part to hide: all but a random 20 % (r20) or 50 % (r50) of the elements, one half (side50), all but an upper
    /// corner of 0.6 x 0.6 (corner36), the lowest 40 % (bottom40), what a tree or cars cover, or a strip at one side where the
    /// picture ends (cut); `_maskless` does not say which part is unknown
    #[arg(long, value_parser = sight)]
    task: Sight,
    /// Seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Hide by the frozen mask, which the content of the facade alone decides, not its name, the order of its elements or the
    /// seed: that of the leaderboard (`datasets/structure_completion`) and of `reproduce
    /// structure_completion --only benchmark`
    #[arg(long, conflicts_with = "seed")]
    frozen: bool,
    /// Partial layout to write
    #[arg(short, long, value_name = "PARTIAL.facade.json")]
    output: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// End standard output with one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> Result<()> {
    let sight = args.task;
    let whole = input::annotated(&args.input, &args.reading)?;
    let seed = (!args.frozen).then_some(args.seed);
    let made = hide(&whole, sight, seed).map_err(|e| Error::content(&args.input, e))?;
    write_atomic(
        &args.output,
        facade_json::annotated_to_string(&made.partial).as_bytes(),
    )?;
    let seen = made.partial.facade.regions.len();
    if args.json {
        let about = serde_json::json!({
            "task": sight.name(), "observed": seen, "hidden": made.hidden, "seed": args.seed, "frozen": args.frozen,
            "digest": made.digest,
        });
        return print::line(&about.to_string());
    }
    print::line(&format!(
        "{}: {seen} of {} elements observed",
        args.output.display(),
        seen + made.hidden
    ))
}

/// A task as an argument.
fn sight(text: &str) -> std::result::Result<Sight, String> {
    Sight::named(text).ok_or_else(|| {
        let names: Vec<String> = Sight::all().into_iter().map(Sight::name).collect();
        format!("expected one of {}", names.join(", "))
    })
}
