//! Many houses from rows of attributes: in parallel, resumable, one report each.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_building_exteriors::house::inspect::faults;
use edifice_building_exteriors::house::{
    Database, Generated, HouseReport, Joining, Method, Options,
};
use edifice_editing::building_exteriors::draws::Order;
use edifice_editing::building_exteriors::redraws::{Redraws, believable};
use edifice_io::{gltf, write_atomic};
use edifice_shape::Building;
use rayon::prelude::*;

use super::origin::{Before, Origin};
use super::output::{self, Format};
use crate::choice::{Choice, one_of};
use crate::print;

/// Most houses that are in memory and written together.
const CHUNK: usize = 64;

/// The joining of roofs.
#[rustfmt::skip]
pub(super) const ROOFS: &[Choice<Joining>] = &[
    ("boxes", "Each box has its own", Joining::Boxes),
    ("merged", "One for all boxes of a height", Joining::Merged),
];

#[rustfmt::skip]
const METHODS: &[Choice<Method>] = &[
    ("best", "Boxes of similar houses fitted by least squares, facades side by side: reaches the attributes in milliseconds", Method::Best),
    ("paper", "Simulated annealing and a genetic algorithm as in the paper: seconds a house", Method::Paper),
];

/// The folder of the houses, and their form.
#[derive(clap::Args)]
pub(super) struct Output {
    /// Folder of the output; it is made when it does not exist.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    #[command(flatten)]
    pub making: Making,
    /// Also write all houses of this run on plots along streets: `DIR/street.glb`, and the picture `DIR/street.png`.
    #[arg(long)]
    pub street: bool,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Print a line of JSON for each house.
    #[arg(long)]
    pub json: bool,
}

/// The making of houses, and the files of them that are written.
#[derive(clap::Args)]
pub(super) struct Making {
    /// Files for each house.
    #[arg(long, value_delimiter = ',', value_enum, default_values_t = [Format::Json, Format::Glb])]
    pub format: Vec<Format>,
    /// Houses that donate boxes (`*.buildings.jsonl`); the shipped ones by default.
    #[arg(long, value_name = "FILE")]
    pub database: Option<PathBuf>,
    /// Roofs of each box, or one joined roof for all boxes of a height.
    #[arg(long, value_parser = one_of(ROOFS), default_value = "boxes")]
    pub roof: Joining,
    /// Method for mass models and facades.
    #[arg(long, value_parser = one_of(METHODS), default_value = "best")]
    pub method: Method,
    /// Never cut a strip of wall in two for the sake of symmetry.
    #[arg(long)]
    pub no_cuts: bool,
}

impl Making {
    /// The database of donors.
    pub(super) fn database(&self) -> Result<Database> {
        output::database(self.database.as_deref())
    }

    /// Writes houses with their reports into a folder, in their order; with `json`, prints a line for each.
    pub(super) fn write(&self, houses: &[Generated], folder: &Path, json: bool) -> Result<()> {
        output::folder(folder)?;
        for house in houses {
            output::write(&house.building, &house.model, folder, &self.format)?;
            let line = report(&house.report, None)?;
            let path = folder.join(format!("{}.report.json", house.building.name));
            write_atomic(&path, format!("{line}\n").as_bytes())?;
            if json {
                print::line(&line)?;
            }
        }
        Ok(())
    }

    /// The settings of generation.
    pub(super) fn options(&self) -> Options {
        Options {
            joining: self.roof,
            no_cuts: self.no_cuts,
            method: self.method,
            ..Options::default()
        }
    }
}

impl Output {
    fn report_file(&self, name: &str) -> PathBuf {
        self.output.join(format!("{name}.report.json"))
    }

    /// Writes a house and its report, which it returns.
    fn write(&self, house: &Generated, seconds: f64, making: &Before) -> Result<String> {
        let (building, model) = (&house.building, &house.model);
        output::write(building, model, &self.output, &self.making.format)?;
        let mut value = report_value(&house.report, Some(seconds))?;
        making.note(&mut value, &self.making.format);
        let text = value.to_string();
        let path = self.report_file(&building.name);
        write_atomic(&path, format!("{text}\n").as_bytes())?;
        Ok(text)
    }
}

/// A house of a run.
struct Made {
    /// Its report.
    line: String,
    /// The house, unless it was there already.
    house: Option<New>,
}

/// A house that was made now.
struct New {
    house: Generated,
    /// True if it has another row than its own.
    other: bool,
    /// True if `building check` finds something.
    faulty: bool,
}

/// Makes and writes the houses; `source` is the file of their rows, for errors. Those that are there already, with all files
/// asked for and made from the same row by the same settings, are left as they are. With `redraws`, a house that misses its row
/// or that one would not believe gives way to one of another row.
pub(super) fn produce(
    orders: &[Order],
    database: &Database,
    options: &Options,
    output: &Output,
    source: Option<&Path>,
    redraws: Option<&Redraws>,
) -> Result<()> {
    let wrong = |message: String| match source {
        Some(path) => Error::content(path, message),
        None => Error::method(message),
    };
    // Nothing is written when some row cannot be a house.
    for order in orders {
        order.check(options).map_err(wrong)?;
    }
    output::folder(&output.output)?;
    let origin = Origin::new(database, options, output.seed, redraws)?;
    let make = |(number, order): (usize, &Order)| -> Result<Made> {
        let before = Before::read(&output.report_file(&order.name), origin.of(number, order));
        if let (false, Some(line)) = (
            output.street,
            before.line(&output.output, &order.name, &output.making.format),
        ) {
            let line = line.to_owned();
            return Ok(Made { line, house: None });
        }
        let start = std::time::Instant::now();
        let made = believable(order, number, database, options, output.seed, redraws);
        let (house, other) = made.map_err(wrong)?;
        let seconds = start.elapsed().as_secs_f64();
        let line = output.write(&house, seconds, &before)?;
        Ok(Made {
            line,
            house: Some(New {
                faulty: !faults(&house.building, options.joining).is_empty(),
                house,
                other,
            }),
        })
    };
    let mut street: Vec<(Building, edifice_building_exteriors::house::Model)> = Vec::new();
    let (mut done, mut there, mut near, mut replaced, mut bad) = (0, 0, 0, 0, 0);
    for (chunk, orders) in orders.chunks(CHUNK).enumerate() {
        let numbered = orders.par_iter().enumerate();
        let made = numbered.map(|(k, order)| make((chunk * CHUNK + k, order)));
        let made: Vec<Result<Made>> = made.collect();
        for made in made {
            done += 1;
            let made = made?;
            if output.json {
                print::line(&made.line)?;
            }
            let Some(New {
                house,
                other,
                faulty,
            }) = made.house
            else {
                there += 1;
                continue;
            };
            replaced += usize::from(other);
            bad += usize::from(faulty);
            near += usize::from(house.report.repaired_z <= 0.05);
            if output.street {
                street.push((house.building, house.model));
            }
        }
        if orders.len() > CHUNK {
            print::message(&format!("{done} of {} houses", orders.len()));
        }
    }
    if output.street {
        let scene = output::street(&street, output.seed);
        gltf::write(&scene, &output.output.join("street.glb"))?;
        output::write_png(&scene, &output.output.join("street.png"))?;
    }
    if replaced > 0 {
        print::message(&format!(
            "{replaced} houses missed their samples or were implausible and gave way to others"
        ));
    }
    if bad > 0 {
        print::message(&format!(
            "{bad} houses have faults, which `building check` names"
        ));
    }
    let known = match there {
        0 => String::new(),
        there => format!(", {there} were there already"),
    };
    print::message(&format!(
        "{done} houses in {}, {near} made now within 0.05 standard deviations of their attributes{known}",
        output.output.display()
    ));
    Ok(())
}

/// A report as one line of JSON.
pub(super) fn report(report: &HouseReport, seconds: Option<f64>) -> Result<String> {
    Ok(report_value(report, seconds)?.to_string())
}

fn report_value(report: &HouseReport, seconds: Option<f64>) -> Result<serde_json::Value> {
    let mut value = serde_json::to_value(report).map_err(Error::method)?;
    value["seconds"] = serde_json::json!(seconds);
    value["columns"] = serde_json::json!(&COLUMNS[..]);
    Ok(value)
}
