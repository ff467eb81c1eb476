//! `edifice building build` and `generate`.

use std::path::{Path, PathBuf};

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_building_exteriors::design::{MOVED, Possible, possible_rows, wanted_rows};
use edifice_building_exteriors::house::Options;
use edifice_building_exteriors::mass::footprint::decided;
use edifice_building_exteriors::model_file::ModelFile;
use edifice_editing::building_exteriors::is_file_name;
use edifice_io::building_csv::{self, TextTable};
use edifice_io::footprint;
use edifice_model::Table;
use edifice_shape::Rect;

use super::data;
use super::draw::{Draw, drawn_table};
use super::produce::{Order, Output, produce};
use crate::model::given::evidence;
use crate::print;

/// Options of `build`.
#[derive(clap::Args)]
pub struct BuildArgs {
    /// Attributes, one house a row, as `building attributes` and `building sample` print them.
    attributes: PathBuf,
    /// Take the values for sampled ones: repair what no house could have instead of refusing it.
    #[arg(long)]
    repair: bool,
    #[command(flatten)]
    output: Output,
}

/// Options of `generate`.
#[derive(clap::Args)]
pub struct GenerateArgs {
    /// The model (`*.houses.json`).
    model: PathBuf,
    /// Evidence: COLUMN=VALUE, ATTRIBUTE=VALUE,VALUE,... or ATTRIBUTE=none (all zero); repeatable.
    #[arg(long)]
    given: Vec<String>,
    /// Sample from this style only (the first is 1).
    #[arg(long, conflicts_with_all = ["given", "most_probable"])]
    style: Option<usize>,
    /// Houses to generate.
    #[arg(short = 'n', long, default_value_t = 10)]
    count: usize,
    /// Draw many and keep the most probable that differ.
    #[arg(long)]
    most_probable: bool,
    /// Build every sample, also those that no house can have; they are repaired. Without it such samples are drawn anew.
    #[arg(long, conflicts_with = "most_probable")]
    untruncated: bool,
    /// Footprint of all houses: one rectilinear polygon without holes, in degrees or metres (GeoJSON).
    #[arg(long, value_name = "FILE", conflicts_with = "style")]
    footprint: Option<PathBuf>,
    #[command(flatten)]
    output: Output,
}

/// Runs `build`.
pub fn build(args: &BuildArgs) -> Result<()> {
    let table = building_csv::read(&args.attributes)?;
    let orders = orders(&table, &args.attributes, !args.repair)?;
    let database = args.output.making.database()?;
    let options = args.output.making.options();
    produce(&orders, &database, &options, &args.output)
}

/// The rows of a table of all 49 columns; a column `name` names the houses.
fn orders(table: &TextTable, path: &Path, given: bool) -> Result<Vec<Order>> {
    let mut places = [0; 49];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        let found = table.header.iter().position(|h| h == column);
        *place = found
            .ok_or_else(|| Error::content(path, format!("the table has no column `{column}`")))?;
    }
    let name = table.header.iter().position(|h| h == "name");
    let mut orders = Vec::with_capacity(table.rows.len());
    for (r, row) in table.rows.iter().enumerate() {
        let mut wanted = [0.0; 49];
        for (c, value) in wanted.iter_mut().enumerate() {
            let text = row[places[c]].trim();
            let number = match text {
                "yes" | "true" => Some(1.0),
                "no" | "false" => Some(0.0),
                text => text.parse().ok().filter(|v: &f64| v.is_finite()),
            };
            *value = number.ok_or_else(|| {
                let place = format!("row {}, column `{}`", r + 1, COLUMNS[c]);
                Error::input(path, place, format!("{text:?} is not a number"))
            })?;
        }
        let name = match name.map(|n| row[n].trim()) {
            Some(name) if is_file_name(name) => name.to_owned(),
            Some(name) => {
                let place = format!("row {}, column `name`", r + 1);
                return Err(Error::input(
                    path,
                    place,
                    format!("{name:?} cannot name a file"),
                ));
            }
            None => format!("house_{:04}", r + 1),
        };
        orders.push(Order {
            name,
            wanted,
            given: [given; 49],
        });
    }
    Ok(orders)
}

/// Draws a batch of samples at each call.
type Sampler<'a> = Box<dyn FnMut() -> Result<Table> + 'a>;

/// The source of the samples of `generate`, and the values that are given.
fn sampler<'a>(
    args: &'a GenerateArgs,
    file: &'a ModelFile,
    plan: Option<&[Rect]>,
) -> Result<(Sampler<'a>, Table)> {
    let mut rng = stream(args.output.seed, "building/sample", 0);
    if let Some(style) = args.style {
        let index = style.checked_sub(1);
        let index = index.ok_or_else(|| Error::option("--style", "the first style is 1"))?;
        let batch = move || {
            let draws = file.model.sample_style(index, args.count, &mut rng);
            let draws = draws.map_err(|e| Error::option("--style", e.to_string()))?;
            Ok(draws.table)
        };
        return Ok((Box::new(batch), Table::new()));
    }
    let kinds = file.model.sample(1, &mut rng).map_err(Error::method)?;
    let mut given = evidence(&file.groups, &kinds.table, &args.given)
        .map_err(|e| Error::option("--given", e.to_string()))?;
    for (c, value) in plan.into_iter().flat_map(decided) {
        // What --given says of the plan is checked against it when the houses are made.
        if given.column(COLUMNS[c]).is_err() {
            given = given
                .real(COLUMNS[c], [Some(value)])
                .map_err(Error::method)?;
        }
    }
    let draw = Draw::new(args.count, args.most_probable, args.output.seed);
    let (evidence, mut batches) = (given.clone(), 0..);
    let batch = move || drawn_table(file, &evidence, &draw, batches.next().unwrap_or(0));
    Ok((Box::new(batch), given))
}

/// Runs `generate`.
pub fn generate(args: &GenerateArgs) -> Result<()> {
    let file = data::model(&args.model)?;
    if args.count == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    let plan = args.footprint.as_deref().map(footprint::read).transpose()?;
    let (mut draw, given) = sampler(args, &file, plan.as_deref())?;
    let is_given: [bool; 49] = std::array::from_fn(|c| given.column(COLUMNS[c]).is_ok());
    let database = args.output.making.database()?;
    let rows = match args.most_probable || args.untruncated {
        true => wanted_rows(&whole(draw()?, &args.model)?),
        false => {
            let deviations = &database.deviations;
            let whole = || whole(draw()?, &args.model);
            let possible = possible_rows(args.count, &is_given, deviations, whole)?;
            tell(&possible);
            possible.rows
        }
    };
    let orders: Vec<Order> = rows
        .iter()
        .enumerate()
        .map(|(row, wanted)| Order {
            name: format!("house_{:04}", row + 1),
            wanted: *wanted,
            given: is_given,
        })
        .collect();
    let options = Options {
        footprint: plan,
        ..args.output.making.options()
    };
    produce(&orders, &database, &options, &args.output)
}

/// Says how many samples were passed over.
fn tell(possible: &Possible) {
    let houses = possible.rows.len();
    if possible.drawn > houses {
        print::message(&format!(
            "{} of {} samples passed over: no house can have them within {MOVED} standard deviations (--untruncated \
             builds them too)",
            possible.drawn - houses,
            possible.drawn
        ));
    }
    if possible.impossible > 0 {
        print::message(&format!(
            "the last {} of {houses} rows were among them: nothing better was drawn",
            possible.impossible
        ));
    }
}

/// A table of draws that has all columns.
fn whole(table: Table, model: &Path) -> Result<Table> {
    match COLUMNS.iter().find(|name| table.column(name).is_err()) {
        None => Ok(table),
        Some(name) => Err(Error::content(
            model,
            format!("the model has no column `{name}`: houses need all 49"),
        )),
    }
}
