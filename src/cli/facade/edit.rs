//! `edifice facade edit`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_editing::structure_completion::{FacadeEdit, edit};
use edifice_io::{facade_json, photograph, write_atomic};

use super::input;
use crate::print::Json;
use crate::reading::Reading;

/// Options of `facade edit`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice facade edit partial.facade.json 'add window@1.5,4,1.2,1.7' 'move #2=6,0' -o edited.facade.json
  edifice facade edit edited.facade.json 'relabel #2=door' 'unknown 0,0,6,9' -o edited.facade.json
  edifice facade edit edited.facade.json --photograph datasets/examples/photo_1.jpg -o edited.facade.json

Edits, made in turn: add LABEL@X,Y,W,H; move ID=X,Y; resize ID=W,H; relabel ID=LABEL; remove ID; unknown X,Y,W,H;
known INDEX (of the unknown rectangles, from 0); outline W,H. ID is an element's id, or #K for the K-th in the file, from 0.
An element that is added, moved, resized or relabelled is observed: `facade complete` keeps it.")]
pub(crate) struct Args {
    /// Layout to read
    #[arg(value_name = "LAYOUT")]
    input: PathBuf,
    /// Edits
    #[arg(required_unless_present_any = ["photograph", "no_photograph"], value_name = "EDIT", value_parser = parse)]
    edits: Vec<FacadeEdit>,
    /// Picture that lies over the outline, kept in the file: .jpg, .png, or a text file with its data: address
    #[arg(long, value_name = "PICTURE", conflicts_with = "no_photograph")]
    photograph: Option<PathBuf>,
    /// Take the picture out of the file
    #[arg(long)]
    no_photograph: bool,
    /// File to write
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    json: Json,
}

fn parse(text: &str) -> std::result::Result<FacadeEdit, String> {
    text.parse()
        .map_err(|e: edifice_editing::CommandError| e.to_string())
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let layout = input::annotated(&args.input, &args.reading)?;
    let mut edited = edit(&layout, &args.edits).map_err(|e| Error::content(&args.input, e))?;
    if let Some(path) = &args.photograph {
        edited.photograph = Some(photograph::read(path)?);
    } else if args.no_photograph {
        edited.photograph = None;
    }
    write_atomic(
        &args.output,
        facade_json::annotated_to_string(&edited).as_bytes(),
    )?;
    let count = edited.facade.regions.len();
    let text = format!("{}: {count} elements", args.output.display());
    let value = serde_json::json!({ "file": args.output, "elements": count });
    args.json.after(&text, &value)
}
