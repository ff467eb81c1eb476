//! `edifice building variations` and `edit`.

use std::path::{Path, PathBuf};

use edifice::io::building_json;
use edifice::methods::building_exteriors::design::{Edit, edited, suggested, variants};
use edifice::rng::stream;
use edifice::shape::{BoxStyle, Building};
use edifice::{Error, Result};

use super::build::is_file_name;
use super::data;
use super::produce::Making;
use crate::cli::print;

/// Options of `variations`.
#[derive(clap::Args)]
pub struct VariationsArgs {
    /// The house (`*.building.json`).
    house: PathBuf,
    /// Houses to make.
    #[arg(short = 'n', long, default_value_t = 8)]
    count: usize,
    /// Folder of the output; it is made when it does not exist.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    making: Making,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print a line of JSON for each house.
    #[arg(long)]
    json: bool,
}

/// Options of `edit`.
#[derive(clap::Args)]
pub struct EditArgs {
    /// The house (`*.building.json`).
    house: PathBuf,
    /// Adds a box: STYLE@X,Y,W,D,H with style main, garage or porch, centre, width, depth and height in metres.
    #[arg(long, value_name = "STYLE@X,Y,W,D,H", value_parser = add)]
    add: Vec<Edit>,
    /// Moves the centre of a box: INDEX=X,Y (the first box is 0).
    #[arg(long = "move", value_name = "INDEX=X,Y", value_parser = shift, allow_hyphen_values = true)]
    shift: Vec<Edit>,
    /// Gives a box another width, depth and height: INDEX=W,D,H.
    #[arg(long, value_name = "INDEX=W,D,H", value_parser = resize)]
    resize: Vec<Edit>,
    /// Removes a box, after all other edits; several from the last on.
    #[arg(long, value_name = "INDEX")]
    remove: Vec<usize>,
    /// Let this model (`*.houses.json`) suggest a house in which the edited boxes stay; without it all boxes stay.
    #[arg(long)]
    model: Option<PathBuf>,
    /// Folder of the output; it is made when it does not exist.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    making: Making,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print a line of JSON for the house.
    #[arg(long)]
    json: bool,
}

/// The one house of a file.
fn house(path: &Path) -> Result<Building> {
    let mut houses = building_json::read(path)?;
    let count = houses.len();
    let one = houses.pop().filter(|_| count == 1);
    let one = one.ok_or_else(|| Error::content(path, format!("{count} houses, expected one")))?;
    if !is_file_name(&one.name) {
        return Err(Error::content(
            path,
            format!("{:?} cannot name a file", one.name),
        ));
    }
    Ok(one)
}

/// Runs `variations`.
pub fn variations(args: &VariationsArgs) -> Result<()> {
    if args.count == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    let house = house(&args.house)?;
    let mut rng = stream(args.seed, "building/variations", 0);
    let (database, options) = (args.making.database()?, args.making.options());
    let made = variants(&house, args.count, &database, &options, &mut rng);
    let made = made.map_err(|e| Error::content(&args.house, e))?;
    args.making.write(&made, &args.output, args.json)?;
    print::message(&format!(
        "{} houses in {}, all within 0.05 standard deviations of the mass attributes, plans at least 5 % apart",
        made.len(),
        args.output.display()
    ));
    Ok(())
}

/// Runs `edit`.
pub fn edit(args: &EditArgs) -> Result<()> {
    let mut edits: Vec<Edit> = Vec::new();
    for own in [&args.add, &args.shift, &args.resize] {
        edits.extend(own);
    }
    let mut removed = args.remove.clone();
    removed.sort_unstable_by(|a, b| b.cmp(a));
    edits.extend(removed.into_iter().map(Edit::Remove));
    if edits.is_empty() {
        return Err(Error::option("--add", "nothing to edit"));
    }
    let house = house(&args.house)?;
    let mut rng = stream(args.seed, "building/edit", 0);
    let (database, options) = (args.making.database()?, args.making.options());
    let made = match &args.model {
        None => edited(&house, &edits, &database, &options, &mut rng),
        Some(path) => {
            let file = data::model(path)?;
            suggested(&house, &edits, &file.model, &database, &options, &mut rng)
        }
    };
    let made = made.map_err(|e| Error::content(&args.house, e))?;
    args.making.write(&[made], &args.output, args.json)
}

fn numbers<const N: usize>(text: &str) -> std::result::Result<[f64; N], String> {
    let read = |t: &str| t.trim().parse().ok().filter(|v: &f64| v.is_finite());
    let values: Option<Vec<f64>> = text.split(',').map(read).collect();
    let values = values.and_then(|v| v.try_into().ok());
    values.ok_or_else(|| format!("{text:?}: expected {N} numbers"))
}

fn indexed<const N: usize>(text: &str) -> std::result::Result<(usize, [f64; N]), String> {
    let parts = text.split_once('=');
    let (index, rest) = parts.ok_or_else(|| format!("{text:?}: expected INDEX=NUMBERS"))?;
    let index = index.trim().parse();
    let index = index.map_err(|_| format!("{text:?}: the index is not a number"))?;
    Ok((index, numbers(rest)?))
}

fn add(text: &str) -> std::result::Result<Edit, String> {
    let parts = text.split_once('@');
    let (style, rest) = parts.ok_or_else(|| format!("{text:?}: expected STYLE@X,Y,W,D,H"))?;
    let style = match style {
        "main" => BoxStyle::Main,
        "garage" => BoxStyle::Garage,
        "porch" => BoxStyle::Porch,
        other => return Err(format!("{other:?}: expected main, garage or porch")),
    };
    Ok(Edit::Add(style, numbers(rest)?))
}

fn shift(text: &str) -> std::result::Result<Edit, String> {
    indexed(text).map(|(index, to)| Edit::Move(index, to))
}

fn resize(text: &str) -> std::result::Result<Edit, String> {
    indexed(text).map(|(index, to)| Edit::Resize(index, to))
}
