//! `edifice building variations`, `edit` and `wish`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_building_exteriors::design::Edit;
use edifice_editing::building_exteriors::{self as editing, Wishes, is_file_name};
use edifice_editing::work::Work;
use edifice_io::building_json;
use edifice_shape::Building;

use super::data;
use super::produce::Making;
use crate::print;

/// Options of `variations`.
#[derive(clap::Args)]
pub(crate) struct VariationsArgs {
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
pub(crate) struct EditArgs {
    /// The house (`*.building.json`).
    house: PathBuf,
    /// Adds a box: STYLE@X,Y,W,D,H with style main, garage or porch, centre, width, depth and height in metres.
    #[arg(long, value_name = "STYLE@X,Y,W,D,H", value_parser = editing::add)]
    add: Vec<Edit>,
    /// Moves the centre of a box: INDEX=X,Y (the first box is 0).
    #[arg(long = "move", value_name = "INDEX=X,Y", value_parser = editing::moved, allow_hyphen_values = true)]
    shift: Vec<Edit>,
    /// Gives a box another width, depth and height: INDEX=W,D,H.
    #[arg(long, value_name = "INDEX=W,D,H", value_parser = editing::resized)]
    resize: Vec<Edit>,
    /// Removes a box, after all other edits; several from the last on.
    #[arg(long, value_name = "INDEX")]
    remove: Vec<usize>,
    /// Let this model (`*.houses.json`) suggest a house in which the edited boxes stay; without it all boxes stay.
    #[arg(long)]
    model: Option<PathBuf>,
    /// Let the model that ships suggest it, learned from the shipped houses.
    #[arg(long, conflicts_with = "model")]
    suggest: bool,
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

/// Options of `wish`.
#[derive(clap::Args)]
pub(crate) struct WishArgs {
    /// The house (`*.building.json`).
    house: PathBuf,
    /// A wish: COLUMN=VALUE, for example bbox.w=14 or roof.hip=yes; repeatable.
    #[arg(long, value_name = "COLUMN=VALUE")]
    given: Vec<String>,
    /// A style of the model that ships, the first is 1.
    #[arg(long, conflicts_with = "keep")]
    style: Option<usize>,
    /// All other attributes stay as they are; without it they are the model's.
    #[arg(long)]
    keep: bool,
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
pub(super) fn variations(args: &VariationsArgs) -> Result<()> {
    if args.count == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    let house = house(&args.house)?;
    let (database, options) = (args.making.database()?, args.making.options());
    let made = editing::variations(&house, args.count, &database, &options, args.seed);
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
pub(super) fn edit(args: &EditArgs) -> Result<()> {
    let mut edits: Vec<Edit> = Vec::new();
    for own in [&args.add, &args.shift, &args.resize] {
        edits.extend(own);
    }
    edits.extend(args.remove.iter().copied().map(Edit::Remove));
    let edits = editing::ordered(edits);
    if edits.is_empty() {
        return Err(Error::option("--add", "nothing to edit"));
    }
    let house = house(&args.house)?;
    let (database, options) = (args.making.database()?, args.making.options());
    let own = args.model.as_deref().map(data::model).transpose()?;
    let model = match (&own, args.suggest) {
        (Some(file), _) => Some(file),
        (None, true) => Some(editing::shipped_model()?),
        (None, false) => None,
    };
    let made = editing::edit(&house, &edits, model, &database, &options, args.seed);
    let made = made.map_err(|e| Error::content(&args.house, e))?;
    args.making.write(&[made], &args.output, args.json)
}

/// Runs `wish`.
pub(super) fn wish(args: &WishArgs) -> Result<()> {
    let given = editing::given(&args.given);
    let wishes = Wishes {
        given: given.map_err(|e| Error::option("--given", e.to_string()))?,
        style: args.style,
        keep: args.keep,
    };
    if args.given.is_empty() && args.style.is_none() {
        return Err(Error::option("--given", "nothing is wished"));
    }
    let house = house(&args.house)?;
    let (database, options) = (args.making.database()?, args.making.options());
    let known = (editing::shipped_model()?, &database);
    let made = editing::wished(
        &house,
        &wishes,
        known,
        &options,
        args.seed,
        &Work::default(),
    );
    let made = made.map_err(|e| Error::content(&args.house, e))?;
    args.making.write(&[made], &args.output, args.json)
}
