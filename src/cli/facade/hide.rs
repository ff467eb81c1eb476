//! `edifice facade hide`.

use std::path::PathBuf;

use edifice_base::{Error, Result, rng};
use edifice_io::{facade_json, write_atomic};
use edifice_shape::{AnnotatedFacade, Facade, Rect};
use edifice_structure_completion::frozen::Digest;
use edifice_structure_completion::task::Task;

use super::input;
use crate::print;
use crate::reading::Reading;

/// Options of `facade hide`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Whole facade: any format that `facade convert` reads
    input: PathBuf,
    /// The part to hide: all but a random 20 % (r20) or 50 % (r50) of the elements, one half (side50), all but an upper
    /// corner of 0.6 x 0.6 (corner36), the lowest 40 % (bottom40)
    #[arg(long, value_parser = Task::ALL.map(Task::name))]
    task: String,
    /// Seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Hide by the frozen mask, which the content of the facade alone decides, not its name, the order of its elements or the
    /// seed: that of the leaderboard (`datasets/structure_completion`)
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
pub(super) fn run(args: &Args) -> Result<()> {
    let Some(task) = Task::named(&args.task) else {
        return Err(Error::option("--task", "unknown task"));
    };
    let whole = input::annotated(&args.input, &args.reading)?;
    let facade = &whole.facade;
    if facade.regions.is_empty() {
        return Err(Error::content(
            &args.input,
            "the facade has no elements to hide",
        ));
    }
    let rects: Vec<Rect> = facade.regions.iter().map(|r| r.rect).collect();
    let named = facade.regions.iter().map(|r| (r.label.as_str(), r.rect));
    let named: Vec<(&str, Rect)> = named.collect();
    let (width, height) = (facade.width, facade.height);
    let (hidden, unknown) = match args.frozen {
        true => task.split_frozen(width, height, &named),
        false => {
            let mut stream = rng::stream(args.seed, "facade hide", 0);
            task.split(width, height, &rects, &mut stream)
        }
    };
    let mut partial = AnnotatedFacade {
        facade: Facade {
            regions: Vec::new(),
            ..facade.clone()
        },
        notes: Vec::new(),
        unknown,
        photograph: whole.photograph.clone(),
    };
    for ((region, note), hidden) in facade.regions.iter().zip(&whole.notes).zip(&hidden) {
        if !hidden {
            partial.facade.regions.push(region.clone());
            partial.notes.push(note.clone());
        }
    }
    write_atomic(
        &args.output,
        facade_json::annotated_to_string(&partial).as_bytes(),
    )?;
    let (seen, all) = (partial.facade.regions.len(), rects.len());
    if args.json {
        let about = serde_json::json!({
            "task": task.name(), "observed": seen, "hidden": all - seen, "seed": args.seed, "frozen": args.frozen,
            "digest": format!("{:016x}", Digest::new(width, height, &named).value),
        });
        return print::line(&about.to_string());
    }
    print::line(&format!(
        "{}: {seen} of {all} elements observed",
        args.output.display()
    ))
}
