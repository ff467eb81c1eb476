//! `edifice city draw`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_io_city::picture::{self, Drawing, Drawn, View};

use super::colours::{Colour, Colouring, Read, colouring};
use crate::print::Json;

/// Most pixels along a side.
const MOST: usize = 8192;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A city or a grammar.
    file: PathBuf,
    /// Another, drawn to its left from the same place.
    #[arg(long)]
    beside: Option<PathBuf>,
    /// The picture (PNG).
    #[arg(short, long)]
    output: PathBuf,
    /// Width of each city's picture, in pixels; it is three quarters as high.
    #[arg(long, default_value_t = 1200, conflicts_with = "size")]
    width: usize,
    /// Width and height of each city's picture, in pixels.
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// From above, north at the top.
    #[arg(long)]
    plan: bool,
    /// The plan in black and white: dark where there are buildings, or in their colours.
    #[arg(long, conflicts_with = "plan")]
    figure_ground: bool,
    /// Only buildings around a point, in the coordinates of the city's reference system.
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    at: Option<String>,
    /// Radius around the place, in metres.
    #[arg(long, value_name = "R", requires = "at", default_value_t = 300.0)]
    radius: f64,
    /// The property that colours tell; a legend says what they stand for.
    #[arg(long, value_enum, default_value = "plain")]
    colour: Colour,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let [width, height] = size(args)?;
    let around = match &args.at {
        None => None,
        Some(text) => {
            let point = numbers::<f64>(text, ',').filter(|p| p.iter().all(|v| v.is_finite()));
            let wrong = || Error::option("--at", format!("{text:?} is not X,Y"));
            Some((point.ok_or_else(wrong)?, args.radius))
        }
    };
    if !(args.radius.is_finite() && args.radius > 0.0) {
        let text = format!("{} is no length above 0", args.radius);
        return Err(Error::option("--radius", text));
    }
    let shown = Read::new(&args.file)?;
    let beside = args.beside.as_deref().map(Read::new).transpose()?;
    let Colouring {
        colours,
        beside: others,
        legend,
    } = colouring(args.colour, &shown, beside.as_ref())?;
    let mut cities = Vec::new();
    if let Some(beside) = &beside {
        cities.push(drawn(beside, others.as_deref()));
    }
    cities.push(drawn(&shown, colours.as_deref()));
    let view = match (args.figure_ground, args.plan) {
        (true, _) => View::FigureGround,
        (false, true) => View::Plan,
        (false, false) => View::Oblique,
    };
    let drawing = Drawing {
        width,
        height,
        view,
        around,
    };
    let bytes = picture::draw(&cities, &drawing, &legend);
    edifice_io::write_atomic(
        &args.output,
        &bytes.map_err(|e| Error::content(&args.output, e))?,
    )?;
    let value = serde_json::json!({
        "file": args.output, "buildings": shown.city.buildings.len(), "width": width, "height": height,
    });
    args.json.end(&value)
}

fn drawn<'a>(read: &'a Read, colours: Option<&'a [[u8; 3]]>) -> Drawn<'a> {
    Drawn {
        city: &read.city,
        colours,
    }
}

fn size(args: &Args) -> Result<[usize; 2]> {
    let (option, found) = match &args.size {
        None => ("--width", Some([args.width, args.width * 3 / 4])),
        Some(text) => ("--size", numbers(text, 'x')),
    };
    let usable = |s: &[usize; 2]| s[0] >= 16 && s[1] >= 12 && s.iter().all(|v| *v <= MOST);
    found.filter(usable).ok_or_else(|| {
        let text = format!("expected from 16 to {MOST} pixels, such as 1600x900");
        Error::option(option, text)
    })
}

/// Two numbers.
fn numbers<T: std::str::FromStr>(text: &str, between: char) -> Option<[T; 2]> {
    let (a, b) = text.split_once(between)?;
    Some([a.trim().parse().ok()?, b.trim().parse().ok()?])
}
