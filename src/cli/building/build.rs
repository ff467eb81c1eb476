//! `edifice building build` and `generate`.

use std::collections::HashMap;
use std::path::PathBuf;

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::{AttributeRow, COLUMNS};
use edifice_building_exteriors::design::MOVED;
use edifice_building_exteriors::house::Options;
use edifice_building_exteriors::mass::contradiction::check_known;
use edifice_building_exteriors::observations::cell;
use edifice_editing::building_exteriors::draws::{Draws, Order, Ordered, ordered};
use edifice_editing::building_exteriors::redraws::Redraws;
use edifice_editing::building_exteriors::{is_file_name, shipped_model};
use edifice_io::building_csv::{self, TextTable};
use edifice_io::footprint;

use super::data;
use super::produce::{Output, produce};
use crate::print;

/// Options of `build`.
#[derive(clap::Args)]
pub(crate) struct BuildArgs {
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
pub(crate) struct GenerateArgs {
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
pub(super) fn build(args: &BuildArgs) -> Result<()> {
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
    let mut taken: HashMap<String, usize> = HashMap::new();
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
        if !args.repair {
            let place = || format!("row {}", r + 1);
            check_known(&wanted).map_err(|e| Error::input(path, place(), e))?;
        }
        rows.push(wanted);
        names.push(match name.map(|n| row[n].trim()) {
            Some(name) if is_file_name(name) => {
                if let Some(other) = taken.insert(name.to_owned(), r + 1) {
                    let place = format!("row {}, column `name`", r + 1);
                    let problem = format!("{name:?} is the name of row {other} too");
                    return Err(Error::input(path, place, problem));
                }
                name.to_owned()
            }
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
        rows = model
            .filled(rows, &mut rng)
            .map_err(|e| Error::content(path, e))?;
    }
    if rows.iter().flatten().any(Option::is_none) {
        rows = shipped_model()?
            .filled(rows, &mut rng)
            .map_err(|e| Error::content(path, e))?;
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

/// Runs `generate`.
pub(super) fn generate(args: &GenerateArgs) -> Result<()> {
    let own = args.model.as_deref().map(data::model).transpose()?;
    let file = match &own {
        Some(file) => file,
        None => shipped_model()?,
    };
    let plan = args.footprint.as_deref().map(footprint::read).transpose()?;
    let database = args.output.making.database()?;
    let draws = Draws {
        given: args.given.clone(),
        style: args.style,
        count: args.count,
        most_probable: args.most_probable,
        untruncated: args.untruncated,
        seed: args.output.seed,
    };
    let ordered = ordered(file, &draws, plan.as_deref(), &database)?;
    tell(&ordered, plan.is_some());
    let redraws = Redraws::new(file, &draws, &database, plan.is_some());
    let options = Options {
        footprint: plan,
        ..args.output.making.options()
    };
    let (orders, output) = (&ordered.orders, &args.output);
    produce(orders, &database, &options, output, None, redraws.as_ref())
}

/// Says how many samples were passed over.
fn tell(ordered: &Ordered, on_plan: bool) {
    let houses = ordered.orders.len();
    let what = match on_plan {
        true => "stands on the footprint",
        false => "can have them",
    };
    if ordered.drawn > houses {
        print::message(&format!(
            "{} of {} samples passed over: no house {what} within {MOVED} standard deviations (--untruncated builds them \
             too)",
            ordered.drawn - houses,
            ordered.drawn
        ));
    }
    if ordered.impossible > 0 {
        print::message(&format!(
            "the last {} of {houses} rows were among them: nothing better was drawn; their reports say what is missed",
            ordered.impossible
        ));
    }
}
