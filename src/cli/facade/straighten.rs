//! `edifice facade straighten`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_editing::structure_completion::{Outline, straightened};
use edifice_io::photograph::read_file;
use edifice_io::{facade_json, write_atomic};

use super::input;
use crate::print::Json;
use crate::reading::Reading;

/// Options of `facade straighten`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice facade straighten datasets/examples/photo_1.jpg --corners 12,9,228,14,225,168,15,172 --height 11.5 -o straight.facade.json
  edifice facade straighten datasets/examples/photo_1.jpg --height 11.5 -o taken_whole.facade.json

The corners are those of the facade in the picture, in pixels from its upper left corner: upper left, upper right, lower right,
lower left; without them the picture is taken whole. Width over height follows from the perspective (Zhang and He 2007), or, where
the camera was held level so that it does not follow, with the focal length of a phone's camera; one length gives the scale. The
file holds the rectangle as a photograph to draw over: `edifice studio straight.facade.json`.")]
pub(crate) struct Args {
    /// Photograph to read: .jpg, .png, or a text file with its data: address
    #[arg(value_name = "PHOTOGRAPH")]
    input: PathBuf,
    /// Corners of the facade in pixels, upper left first, clockwise
    #[arg(long, value_name = "X,Y,X,Y,X,Y,X,Y", value_parser = places, allow_hyphen_values = true)]
    corners: Option<Places>,
    /// Height of the facade in metres
    #[arg(long, value_name = "M", required_unless_present_any = ["width", "into"])]
    height: Option<f64>,
    /// Width of the facade in metres
    #[arg(long, value_name = "M", conflicts_with_all = ["height", "into"])]
    width: Option<f64>,
    /// Drawing that the photograph is laid under: its outline and its elements stay
    #[arg(long, value_name = "LAYOUT", conflicts_with_all = ["height", "name"])]
    into: Option<PathBuf>,
    /// Name of the facade [default: that of the file]
    #[arg(long)]
    name: Option<String>,
    /// File to write
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    json: Json,
}

/// Four places in a picture.
type Places = [[f64; 2]; 4];

fn places(text: &str) -> std::result::Result<Places, String> {
    let numbers: Vec<f64> = (text.split(','))
        .map(|t| t.trim().parse().map_err(|_| format!("{t:?} is no number")))
        .collect::<std::result::Result<_, String>>()?;
    match numbers.as_chunks() {
        ([a, b, c, d], []) => Ok([*a, *b, *c, *d]),
        _ => Err(format!("{} numbers: expected 8", numbers.len())),
    }
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let bytes = read_file(&args.input)?;
    let outline = match (args.height, args.width, &args.into) {
        (Some(height), ..) => Outline::Height(height),
        (None, Some(width), _) => Outline::Width(width),
        (None, None, Some(path)) => Outline::Of(Box::new(input::annotated(path, &args.reading)?)),
        // The command line asks for one of the three.
        (None, None, None) => Outline::Height(edifice_editing::structure_completion::USUAL_HEIGHT),
    };
    let stem = args.input.file_stem().unwrap_or_default().to_string_lossy();
    let name = args.name.clone().unwrap_or_else(|| stem.into_owned());
    let made = straightened(&name, &bytes, args.corners, outline)
        .map_err(|e| Error::content(&args.input, e))?;
    write_atomic(
        &args.output,
        facade_json::annotated_to_string(&made).as_bytes(),
    )?;
    let (width, height) = (made.facade.width, made.facade.height);
    let text = format!(
        "{}: {width} x {height} {}",
        args.output.display(),
        made.facade.unit
    );
    let value = serde_json::json!({ "file": args.output, "width": width, "height": height });
    args.json.after(&text, &value)
}
