//! `edifice city synthesize`.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use edifice_base::{Error, Progress, Result};
use edifice_city_proceduralization::synthesis::Shape;
use edifice_editing::city_proceduralization::fill;
use edifice_io_city::{geojson, grammar_file};

use super::{data, derive};
use crate::print;

/// The time after which progress is told.
const PATIENCE: Duration = Duration::from_secs(5);

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The grammar.
    grammar: PathBuf,
    /// The shape to fill: a polygon in metres (GeoJSON).
    #[arg(long, required_unless_present = "polygon")]
    shape: Option<PathBuf>,
    /// The same as numbers, corner by corner: `X,Y,X,Y,...`.
    #[arg(
        long,
        value_name = "X,Y,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        conflicts_with = "shape"
    )]
    polygon: Vec<f64>,
    /// Seed.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The new city: a grammar (`*.city-grammar.json` or `.bin`), `.glb`, `.obj` or `.city.json`.
    #[arg(short, long)]
    output: PathBuf,
    /// End with a line of JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let is_grammar = data::is_grammar(&args.output);
    if !is_grammar {
        derive::check_output(&args.output)?;
    }
    let grammar = data::grammar(&args.grammar)?;
    let mut rings = match &args.shape {
        Some(path) => geojson::read(path)?,
        None => vec![corners(&args.polygon)?],
    };
    // The shape is in the coordinates of the reference system.
    for p in rings.iter_mut().flatten() {
        *p = [0, 1].map(|k| p[k] - grammar.origin[k]);
    }
    let shape = Shape { rings };
    let area = shape.area();
    let told = Mutex::new(Instant::now());
    let tell = |progress: Progress| {
        let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
        if told.elapsed() > PATIENCE {
            *told = Instant::now();
            let most = progress.most.unwrap_or_default();
            print::message(&format!("{}: {} of {most}", progress.stage, progress.done));
        }
        ControlFlow::Continue(())
    };
    let (made, derivation) =
        fill(&grammar, shape, args.seed, &tell).map_err(|e| Error::content(&args.grammar, e))?;
    let count = derivation.count();
    match is_grammar {
        true => grammar_file::write(&made, &args.output)?,
        false => derive::write(&made, &derivation, &args.output, derive::Style::Instanced)?,
    }
    if args.json {
        let summary = serde_json::json!({
            "buildings": count, "area": area, "seed": args.seed,
        });
        return print::line(&summary.to_string());
    }
    print::line(&format!("{count} buildings on {:.0} m2", area))
}

/// The corners of a polygon.
fn corners(numbers: &[f64]) -> Result<Vec<[f64; 2]>> {
    let (corners, rest) = numbers.as_chunks::<2>();
    match corners.len() >= 3 && rest.is_empty() && numbers.iter().all(|v| v.is_finite()) {
        true => Ok(corners.to_vec()),
        false => Err(Error::option(
            "--polygon",
            "expected X,Y of at least three corners",
        )),
    }
}
