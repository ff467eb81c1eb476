//! `edifice city synthesize`.

use std::path::PathBuf;

use edifice::io::city::{geojson, grammar_json};
use edifice::methods::city_proceduralization::synthesis::{Shape, synthesize};
use edifice::{Error, Result};

use super::{data, derive};
use crate::cli::print;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// The grammar.
    grammar: PathBuf,
    /// The shape to fill: a polygon in metres (GeoJSON).
    #[arg(long)]
    shape: PathBuf,
    /// Seed.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The new city: a grammar (`*.city-grammar.json`), `.glb`, `.obj` or `.city.json`.
    #[arg(short, long)]
    output: PathBuf,
    /// End with a line of JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let is_grammar = data::is_grammar(&args.output);
    if !is_grammar {
        derive::check_output(&args.output)?;
    }
    let grammar = data::grammar(&args.grammar)?;
    let mut shape = Shape {
        rings: geojson::read(&args.shape)?,
    };
    // Near the origin, where millimetres are kept.
    let low = shape.bounds().map_or([0.0; 2], |b| b.0.map(f64::floor));
    for p in shape.rings.iter_mut().flatten() {
        *p = [p[0] - low[0], p[1] - low[1]];
    }
    let mut made =
        synthesize(&grammar, &shape, args.seed).map_err(|e| Error::content(&args.grammar, e))?;
    made.origin = [low[0], low[1], 0.0];
    let derivation = made
        .derive()
        .map_err(|e| Error::content(&args.grammar, e))?;
    let count = derivation.buildings.len();
    if count == 0 {
        return Err(Error::content(
            &args.shape,
            "no building fits into the shape",
        ));
    }
    match is_grammar {
        true => grammar_json::write(&made, &args.output)?,
        false => derive::write(&made, &derivation, &args.output, true)?,
    }
    if args.json {
        let summary = serde_json::json!({
            "buildings": count, "area": shape.area(), "seed": args.seed,
        });
        return print::line(&summary.to_string());
    }
    print::line(&format!("{count} buildings on {:.0} m2", shape.area()))
}
