//! `edifice city convert`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_io_city::{cityjson, obj};

use super::data;
use crate::print::Json;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A city in any format, or a grammar.
    input: PathBuf,
    /// The city to write: `.obj` or `.city.json`.
    #[arg(short, long)]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let extension = args.output.extension().and_then(|e| e.to_str());
    if !matches!(extension, Some("obj" | "json")) {
        let text = "expected a name with .obj or .city.json";
        return Err(Error::option("--output", text));
    }
    let city = data::city(&args.input)?;
    match extension {
        Some("obj") => obj::write(&city, &args.output)?,
        _ => edifice_io::write_atomic(&args.output, cityjson::to_string(&city).as_bytes())?,
    }
    let text = format!(
        "{}: {} buildings, {} triangles, {}",
        args.output.display(),
        city.buildings.len(),
        city.triangles(),
        city.reference_system
            .as_deref()
            .unwrap_or("no reference system")
    );
    let value = serde_json::json!({
        "file": args.output, "buildings": city.buildings.len(), "triangles": city.triangles(),
        "reference_system": city.reference_system,
    });
    args.json.after(&text, &value)
}
