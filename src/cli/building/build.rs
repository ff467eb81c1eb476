//! `edifice building build` and `generate`.

use std::path::PathBuf;

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::{AttributeRow, COLUMNS};
use edifice_building_exteriors::coding::attribute_rows;
use edifice_building_exteriors::data::{self as rows_of, filled};
use edifice_building_exteriors::design::{MOVED, Possible, possible_rows, wanted_rows};
use edifice_building_exteriors::house::Options;
use edifice_building_exteriors::mass::footprint::{decided, distance};
use edifice_building_exteriors::model_file::ModelFile;
use edifice_building_exteriors::observations::cell;
use edifice_editing::building_exteriors::{is_file_name, shipped_model};
use edifice_io::building_csv::{self, TextTable};
use edifice_io::footprint;
use edifice_model::Table;
use edifice_shape::Rect;

use super::data;
use super::draw::{Draw, drawn_table};
use super::produce::{Order, Output, Redraw, produce};
use crate::model::given::evidence;
use crate::print;

/// Options of `build`.
#[derive(clap::Args)]
pub struct BuildArgs {
    /// Attributes, one house a row, as `building attributes` and `building sample` print them. An empty cell, and a
    /// column that is not there, is what the model says given the others.
    attributes: PathBuf,
    /// The model that is asked for missing values (`*.houses.json`); the one that ships by default.
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Take the values for sampled ones: repair what no house could have instead of refusing it.
    #[arg(long)]
    repair: bool,
    #[command(flatten)]
    output: Output,
}

/// Options of `generate`.
#[derive(clap::Args)]
pub struct GenerateArgs {
    /// The model (`*.houses.json`); by default the one that ships, learnt from real houses. `made` is that of the made
    /// houses. Attributes that a model does not know are those of the one that ships.
    model: Option<PathBuf>,
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
    /// Build every sample, also those that no house can have; they are repaired. Without it such samples are drawn anew,
    /// and so are those whose houses miss them by more than a quarter of a deviation or that one would not believe.
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
    let orders = orders(&table, args)?;
    let database = args.output.making.database()?;
    let options = args.output.making.options();
    produce(
        &orders,
        &database,
        &options,
        &args.output,
        Some(&args.attributes),
        None,
    )
}

/// The rows of a table; a column `name` names the houses, the model fills what is missing.
fn orders(table: &TextTable, args: &BuildArgs) -> Result<Vec<Order>> {
    let path = &args.attributes;
    let places = COLUMNS.map(|column| table.header.iter().position(|h| h == column));
    if places.iter().all(Option::is_none) {
        let problem = "no column of the table is an attribute, for example `bbox.w`";
        return Err(Error::content(path, problem));
    }
    let name = table.header.iter().position(|h| h == "name");
    let (mut rows, mut names) = (Vec::new(), Vec::new());
    for (r, row) in table.rows.iter().enumerate() {
        let mut wanted: AttributeRow = Vec::with_capacity(COLUMNS.len());
        for (c, place) in places.iter().enumerate() {
            let text = place.map_or("", |p| row[p].as_str());
            let value = cell(text).map_err(|expected| {
                let place = format!("row {}, column `{}`", r + 1, COLUMNS[c]);
                Error::input(path, place, format!("{text:?} is not {expected}"))
            })?;
            wanted.push(value);
        }
        rows.push(wanted);
        names.push(match name.map(|n| row[n].trim()) {
            Some(name) if is_file_name(name) => name.to_owned(),
            Some(name) => {
                let place = format!("row {}, column `name`", r + 1);
                let problem = format!("{name:?} cannot name a file");
                return Err(Error::input(path, place, problem));
            }
            None => format!("house_{:04}", r + 1),
        });
    }
    let given = |row: &AttributeRow| std::array::from_fn(|c| !args.repair && row[c].is_some());
    let given: Vec<[bool; 49]> = rows.iter().map(given).collect();
    let own = args.model.as_deref().map(data::model).transpose()?;
    let mut rng = stream(args.output.seed, "building/fill", 0);
    if let Some(model) = &own {
        rows = filled(rows, model, &mut rng).map_err(|e| Error::content(path, e))?;
    }
    if rows.iter().flatten().any(Option::is_none) {
        rows = filled(rows, shipped_model()?, &mut rng).map_err(|e| Error::content(path, e))?;
    }
    let orders = names.into_iter().zip(rows).zip(given);
    Ok(orders
        .map(|((name, row), given)| Order {
            name,
            wanted: std::array::from_fn(|c| row[c].unwrap_or(0.0)),
            given,
        })
        .collect())
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
            let draws = file.sample_style(index, args.count, &mut rng);
            let draws = draws.map_err(|e| Error::option("--style", e.to_string()))?;
            Ok(draws.table)
        };
        return Ok((Box::new(batch), Table::new()));
    }
    let kinds = file.sample(1, &mut rng).map_err(Error::method)?;
    let mut given = evidence(&file.attributes(), &kinds.table, &args.given)
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
    let own = args.model.as_deref().map(data::model).transpose()?;
    let file = match &own {
        Some(file) => file,
        None => shipped_model()?,
    };
    if args.count == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    let plan = args.footprint.as_deref().map(footprint::read).transpose()?;
    let (mut draw, given) = sampler(args, file, plan.as_deref())?;
    let is_given: [bool; 49] = std::array::from_fn(|c| given.column(COLUMNS[c]).is_ok());
    let database = args.output.making.database()?;
    let mut rng = stream(args.output.seed, "building/fill", 0);
    let mut whole = || whole(draw()?, &given, &mut rng);
    let rows = match args.most_probable || args.untruncated {
        true => wanted_rows(&whole()?),
        false => {
            let deviations = &database.deviations;
            let reach = |row: &[f64; 49]| match &plan {
                Some(plan) => distance(row, &is_given, plan, deviations),
                None => 0.0,
            };
            let possible = possible_rows(args.count, &is_given, deviations, reach, &mut whole)?;
            tell(&possible, plan.is_some());
            possible.rows
        }
    };
    let mut again = |count| {
        let deviations = &database.deviations;
        let none = |_: &[f64; 49]| 0.0;
        Ok(possible_rows(count, &is_given, deviations, none, &mut whole)?.rows)
    };
    // On a footprint the house is as near as it can be; the other two say which rows are built.
    let redraws = plan.is_none() && !args.most_probable && !args.untruncated;
    let redraw: Option<&mut Redraw> = match redraws {
        true => Some(&mut again),
        false => None,
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
    produce(&orders, &database, &options, &args.output, None, redraw)
}

/// Says how many samples were passed over.
fn tell(possible: &Possible, on_plan: bool) {
    let houses = possible.rows.len();
    let what = match on_plan {
        true => "stands on the footprint",
        false => "can have them",
    };
    if possible.drawn > houses {
        print::message(&format!(
            "{} of {} samples passed over: no house {what} within {MOVED} standard deviations (--untruncated builds them \
             too)",
            possible.drawn - houses,
            possible.drawn
        ));
    }
    if possible.impossible > 0 {
        print::message(&format!(
            "the last {} of {houses} rows were among them: nothing better was drawn; their reports say what is missed",
            possible.impossible
        ));
    }
}

/// A table of draws that has all columns: what the model does not know is completed by the one that ships, what is given
/// counting too.
fn whole(table: Table, given: &Table, rng: &mut impl rand::Rng) -> Result<Table> {
    if COLUMNS.iter().all(|name| table.column(name).is_ok()) {
        return Ok(table);
    }
    let known = attribute_rows(given).pop();
    let mut rows = attribute_rows(&table);
    for row in &mut rows {
        for (value, known) in row.iter_mut().zip(known.iter().flatten()) {
            *value = known.or(*value);
        }
    }
    let rows = filled(rows, shipped_model()?, rng).map_err(Error::method)?;
    rows_of::table(&rows).map_err(Error::method)
}
