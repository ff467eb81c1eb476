//! `edifice city tiles`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_io_city::tiles;

use super::data;
use crate::print::Json;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The grammar.
    grammar: PathBuf,
    /// The folder to write `tileset.json` and its tiles to.
    #[arg(short, long)]
    output: PathBuf,
    /// Most instances in a tile.
    #[arg(long, default_value_t = tiles::MOST_INSTANCES)]
    instances: usize,
    /// Write small tiles, with `EXT_meshopt_compression` and `KHR_mesh_quantization`: corners are within 5 cm of their places.
    #[arg(long)]
    compress: bool,
    /// Write no coarse level, which draws instances as boxes from afar.
    #[arg(long)]
    no_boxes: bool,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    if args.instances == 0 {
        return Err(Error::option("--instances", "a tile has at least one"));
    }
    let grammar = data::grammar(&args.grammar)?;
    let derivation = grammar
        .derive()
        .map_err(|e| Error::content(&args.grammar, e))?;
    let mut settings = tiles::Settings::default();
    settings.most_instances = args.instances;
    settings.compress = args.compress;
    settings.boxes = !args.no_boxes;
    let files = tiles::to_files(&grammar, &derivation, &settings)
        .map_err(|e| Error::content(&args.grammar, e))?;
    std::fs::create_dir_all(&args.output).map_err(|e| Error::io(&args.output, "create", e))?;
    // The tileset comes last: it names no tile that is not there.
    for (name, bytes) in &files {
        edifice_io::write_atomic(&args.output.join(name), bytes)?;
    }
    let bytes: usize = files.iter().map(|f| f.1.len()).sum();
    let tiles = files.len() - 1;
    let value = serde_json::json!({ "folder": args.output, "tiles": tiles, "bytes": bytes });
    args.json
        .after(&format!("{tiles} tiles, {bytes} bytes"), &value)
}
