//! `edifice city derive`.

use std::path::PathBuf;

use edifice::io::city::{cityjson, glb, obj};
use edifice::{Error, Result};

use super::data;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// The grammar.
    grammar: PathBuf,
    /// The city to write: `.glb`, `.obj` or `.city.json`.
    #[arg(short, long)]
    output: PathBuf,
    /// Write a glTF node for each instance, for viewers without EXT_mesh_gpu_instancing.
    #[arg(long)]
    no_instancing: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let path = &args.output;
    let grammar = data::grammar(&args.grammar)?;
    let derivation = grammar
        .derive()
        .map_err(|e| Error::content(&args.grammar, e))?;
    let bytes = match path.extension().and_then(|e| e.to_str()) {
        Some("glb") => glb::to_bytes(&grammar, &derivation, !args.no_instancing)
            .map_err(|e| Error::content(&args.grammar, e))?,
        Some("obj") => obj::to_string(&derivation.city(&grammar)).into_bytes(),
        Some("json") => cityjson::to_string(&derivation.city(&grammar)).into_bytes(),
        _ => {
            return Err(Error::option(
                "--output",
                "expected a name with .glb, .obj or .city.json",
            ));
        }
    };
    edifice::io::write_atomic(path, &bytes)
}
