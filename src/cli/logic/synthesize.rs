//! `edifice logic synthesize`.

use std::path::PathBuf;

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_io::write_facade;
use edifice_procedural_logic::{Known, Style, starting_rules};

use super::input::read_model;
use crate::print::Json;

/// Options of `logic synthesize`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  edifice logic synthesize terraces.logic.json --count 10 --sigma 1 -o virtual\n  edifice logic synthesize terraces.logic.json --start 2 --format svg -o virtual"
)]
pub(crate) struct Args {
    /// Model file.
    model: PathBuf,
    /// Facades to draw.
    #[arg(short = 'n', long, value_name = "N", default_value_t = 5)]
    count: u64,
    /// Deviations from the mean facade, as a multiple of those of the examples.
    #[arg(
        long,
        value_name = "S",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    sigma: f64,
    /// Starting rule: 1 is the one of most facades.
    #[arg(long, value_name = "K", default_value_t = 1)]
    start: usize,
    /// Seed of the random draws.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Ending of the files: facade.json, svg or png.
    #[arg(long, default_value = "facade.json", value_parser = ["facade.json", "svg", "png"])]
    format: String,
    /// Folder for the facades.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let model = read_model(&args.model)?;
    let starts = starting_rules(&model);
    let Some(&(start, _)) = args.start.checked_sub(1).and_then(|k| starts.get(k)) else {
        let message = format!("the model has {} starting rules", starts.len());
        return Err(Error::option("--start", message));
    };
    let style = Style::learn(&model, start).map_err(|error| Error::content(&args.model, error))?;
    let folder = &args.output;
    std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
    let mut files = Vec::new();
    for index in 1..=args.count {
        let mut rng = stream(args.seed, "virtual facade", index);
        let instance = style
            .sample(args.sigma, &mut rng)
            .map_err(|error| Error::option("--sigma", error.to_string()))?;
        let facade = Known {
            name: format!("virtual_{index}"),
            unit: style.unit.clone(),
            instance,
        };
        let layout = model.layout(&facade).map_err(Error::method)?;
        let path = folder.join(format!("{}.{}", facade.name, args.format));
        write_facade(&layout, &path)?;
        files.push(path);
    }
    let similar = match style.similar {
        0 => String::new(),
        count => format!(" and {count} of similar structure"),
    };
    let text = format!(
        "{} facades from {} example{}{similar} in {}",
        args.count,
        style.examples,
        if style.examples == 1 { "" } else { "s" },
        folder.display()
    );
    let value = serde_json::json!({
        "files": files, "examples": style.examples, "similar": style.similar, "seed": args.seed,
    });
    args.json.after(&text, &value)
}
