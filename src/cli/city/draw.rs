//! `edifice city draw`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_io::city::picture;

use super::data;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// A city or a grammar.
    file: PathBuf,
    /// Another, drawn to its left from the same place.
    #[arg(long)]
    beside: Option<PathBuf>,
    /// The picture (PNG).
    #[arg(short, long)]
    output: PathBuf,
    /// Width of each city's picture, in pixels; it is three quarters as high.
    #[arg(long, default_value_t = 1200)]
    width: usize,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    if !(16..=8192).contains(&args.width) {
        return Err(Error::option(
            "--width",
            format!("{} is not between 16 and 8192", args.width),
        ));
    }
    let mut cities = Vec::new();
    if let Some(path) = &args.beside {
        cities.push(data::city(path)?);
    }
    cities.push(data::city(&args.file)?);
    let cities: Vec<_> = cities.iter().collect();
    let bytes = picture::side_by_side(&cities, args.width, args.width * 3 / 4);
    edifice_io::write_atomic(
        &args.output,
        &bytes.map_err(|e| Error::content(&args.output, e))?,
    )
}
