//! `edifice grammar town`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_editing::facade_grammar::city::{Settings, city};
use edifice_io::scene_png::scene_png;
use edifice_io::{gltf, read_grammar, write_atomic};

use crate::print::Json;

/// Options of `edifice grammar town`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar infer datasets/facade_grammar/layouts/boulevard_1.facade.json -o a.cga
  edifice grammar infer datasets/facade_grammar/layouts/boulevard_2.facade.json -o b.cga
  edifice grammar combine a.cga b.cga -o boulevard.cga
  edifice grammar town boulevard.cga --buildings 60 --view street -o town.png

Buildings are boxes whose facades are derived from the grammars, each at its own size and with its own choices, along
streets with roofs, trees and parks (Wu et al. 2014, Fig. 15 and 16). As .glb the whole town is written, as .png a view.")]
pub(crate) struct Args {
    /// Grammars, each facade of one a kind of building: .grammar.json or .cga, also as .gz
    #[arg(required = true, value_name = "GRAMMAR")]
    grammars: Vec<PathBuf>,
    /// Number of buildings
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    buildings: u32,
    /// Height in metres of facades that are in pixels
    #[arg(long, value_name = "H", default_value_t = Settings::default().height, value_parser = super::positive)]
    height: f64,
    /// Seed of the choices of the grammars, and of sizes and places
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// View of a picture
    #[arg(long, value_enum, default_value = "above")]
    view: View,
    /// Width of a picture in pixels, which is nine sixteenths as high
    #[arg(long, value_name = "PIXELS", default_value_t = 1280, value_parser = clap::value_parser!(u32).range(64..=8192))]
    size: u32,
    /// File to write: .glb or .png
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Views of a town.
#[derive(Clone, Copy, clap::ValueEnum)]
enum View {
    /// Over the roofs.
    Above,
    /// In a street.
    Street,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let grammars = args.grammars.iter().map(|path| read_grammar(path));
    let grammars = grammars.collect::<Result<Vec<_>>>()?;
    let settings = Settings {
        buildings: args.buildings as usize,
        height: args.height,
        ..Settings::default()
    };
    let town = city(&grammars, &settings, args.seed).map_err(Error::method)?;
    let extension = args.output.extension().unwrap_or_default();
    let bytes = match extension.to_ascii_lowercase().to_str() {
        Some("glb") => gltf::to_bytes(&town.scene).map_err(Error::method)?,
        Some("png") => {
            let camera = match args.view {
                View::Above => town.from_above(),
                View::Street => town.in_the_street(),
            };
            let [width, height] = [args.size, args.size * 9 / 16].map(|n| n as usize);
            scene_png(&town.scene, &camera, width, height).map_err(Error::method)?
        }
        _ => {
            let text = "expected a file .glb or .png".to_owned();
            return Err(Error::content(&args.output, text));
        }
    };
    write_atomic(&args.output, &bytes)?;
    let value = serde_json::json!({
        "file": args.output, "grammars": grammars.len(), "buildings": town.buildings, "facades": town.facades,
        "triangles": town.triangles,
    });
    let text = format!(
        "{}: {} buildings with {} different facades, {} triangles",
        args.output.display(),
        town.buildings,
        town.facades,
        town.triangles
    );
    args.json.after(&text, &value)
}
