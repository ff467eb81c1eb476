//! Many houses from rows of attributes: in parallel, resumable, one report each.

use std::path::{Path, PathBuf};

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_building_exteriors::design::MOVED;
use edifice_building_exteriors::house::inspect::implausible;
use edifice_building_exteriors::house::{
    Database, Generated, HouseReport, Joining, Method, Options, generate,
};
use edifice_building_exteriors::mass::contradiction::check_given;
use edifice_building_exteriors::mass::footprint::reconcile;
use edifice_io::{gltf, write_atomic};
use edifice_shape::Building;
use rayon::prelude::*;

use super::output::{self, Format};
use crate::print;

/// Most houses that are in memory and written together.
const CHUNK: usize = 64;
/// Rows drawn at most in the place of one whose house is not believable.
const ATTEMPTS: u64 = 12;

/// The folder of the houses, and their form.
#[derive(clap::Args)]
pub struct Output {
    /// Folder of the output; it is made when it does not exist.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    #[command(flatten)]
    pub making: Making,
    /// Also write all houses of this run as one scene, a street: `DIR/street.glb`.
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
pub struct Making {
    /// Files for each house.
    #[arg(long, value_delimiter = ',', value_enum, default_values_t = [Format::Json, Format::Glb])]
    pub format: Vec<Format>,
    /// Houses that donate boxes (`*.buildings.jsonl`); the shipped ones by default.
    #[arg(long, value_name = "FILE")]
    pub database: Option<PathBuf>,
    /// Roofs of each box, or one joined roof for all boxes of a height.
    #[arg(long, value_enum, default_value = "boxes")]
    pub roof: RoofOption,
    /// Method for mass models and facades.
    #[arg(long, value_enum, default_value = "best")]
    pub method: MethodOption,
    /// Never cut a strip of wall in two for the sake of symmetry.
    #[arg(long)]
    pub no_cuts: bool,
}

/// The joining of roofs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum RoofOption {
    /// Each box has its own.
    Boxes,
    /// One for all boxes of a height.
    Merged,
}

impl RoofOption {
    /// As the library knows it.
    pub fn joining(self) -> Joining {
        match self {
            Self::Boxes => Joining::Boxes,
            Self::Merged => Joining::Merged,
        }
    }
}

/// The method for mass models and facades.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum MethodOption {
    /// Boxes of similar houses fitted by least squares, facades side by side: reaches the attributes in milliseconds.
    Best,
    /// Simulated annealing and a genetic algorithm as in the paper: seconds a house.
    Paper,
}

/// A house to make.
pub struct Order {
    /// Its name, and that of its files.
    pub name: String,
    /// The 49 columns.
    pub wanted: [f64; 49],
    /// Columns that must stay.
    pub given: [bool; 49],
}

impl Making {
    /// The database of donors.
    pub fn database(&self) -> Result<Database> {
        output::database(self.database.as_deref())
    }

    /// Writes houses with their reports into a folder, in their order; with `json`, prints a line for each.
    pub fn write(&self, houses: &[Generated], folder: &Path, json: bool) -> Result<()> {
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
    pub fn options(&self) -> Options {
        Options {
            joining: self.roof.joining(),
            no_cuts: self.no_cuts,
            method: match self.method {
                MethodOption::Best => Method::Best,
                MethodOption::Paper => Method::Paper,
            },
            ..Options::default()
        }
    }
}

impl Output {
    fn report_file(&self, name: &str) -> PathBuf {
        self.output.join(format!("{name}.report.json"))
    }

    /// Writes a house and its report.
    fn write(&self, house: &Generated, seconds: f64) -> Result<()> {
        let (building, model) = (&house.building, &house.model);
        output::write(building, model, &self.output, &self.making.format)?;
        let text = report(&house.report, Some(seconds))?;
        let path = self.report_file(&building.name);
        write_atomic(&path, format!("{text}\n").as_bytes())
    }
}

/// Makes and writes the houses; `source` is the file of their rows, for errors. Those whose report is there with the same
/// attributes are left as they are. With `redraw`, a house that misses its row or that one would not believe gives way to
/// one of another row.
pub fn produce(
    orders: &[Order],
    database: &Database,
    options: &Options,
    output: &Output,
    source: Option<&Path>,
    mut redraw: Option<&mut Redraw>,
) -> Result<()> {
    let named = |house: &str, e: String| match source {
        Some(path) => Error::content(path, format!("{house}: {e}")),
        None => Error::method(format!("{house}: {e}")),
    };
    // Nothing is written when some row cannot be a house.
    for order in orders {
        let named = |e: String| named(&order.name, e);
        check_given(&order.wanted, &order.given).map_err(|e| named(e.to_string()))?;
        if let Some(plan) = &options.footprint {
            reconcile(&mut order.wanted.clone(), &order.given, plan)
                .map_err(|e| named(e.to_string()))?;
        }
    }
    output::folder(&output.output)?;
    let made = |order: &Order, attempt: u64| -> Made {
        let name = format!("building/generate/{}", order.name);
        let mut rng = stream(output.seed, &name, attempt);
        let start = std::time::Instant::now();
        let (name, wanted) = (&order.name, &order.wanted);
        let house = generate(name, wanted, &order.given, database, options, &mut rng)
            .map_err(|e| named(&order.name, e.to_string()))?;
        Ok(Some((house, start.elapsed().as_secs_f64())))
    };
    let mut street: Vec<(Building, edifice_building_exteriors::house::Model)> = Vec::new();
    let (mut done, mut near, mut replaced) = (0, 0, 0);
    for chunk in orders.chunks(CHUNK) {
        let first = chunk.par_iter().map(|order| {
            match !output.street && is_done(&output.report_file(&order.name), order) {
                true => Ok(None),
                false => made(order, 0),
            }
        });
        let mut houses: Vec<Made> = first.collect();
        if let Some(redraw) = redraw.as_deref_mut() {
            replaced += replace(chunk, &mut houses, redraw, &made)?;
        }
        let houses = houses.into_iter().collect::<Result<Vec<_>>>()?;
        houses
            .par_iter()
            .flatten()
            .try_for_each(|(house, seconds)| output.write(house, *seconds))?;
        done += houses.len();
        for (house, seconds) in houses.into_iter().flatten() {
            near += usize::from(house.report.repaired_z <= 0.05);
            if output.json {
                print::line(&report(&house.report, Some(seconds))?)?;
            }
            if output.street {
                street.push((house.building, house.model));
            }
        }
        if orders.len() > CHUNK {
            print::message(&format!("{done} of {} houses", orders.len()));
        }
    }
    if output.street {
        gltf::write(&output::street(&street), &output.output.join("street.glb"))?;
    }
    if replaced > 0 {
        print::message(&format!(
            "{replaced} houses missed their samples or were implausible and gave way to others"
        ));
    }
    print::message(&format!(
        "{done} houses in {}, {near} made now within 0.05 standard deviations of their attributes",
        output.output.display()
    ));
    Ok(())
}

/// Draws rows of attributes anew.
pub type Redraw<'a> = dyn FnMut(usize) -> Result<Vec<[f64; 49]>> + 'a;

/// A house and the seconds that it took; none where it had been made before.
type Made = Result<Option<(Generated, f64)>>;

/// True if a house has its attributes and nothing that one would not believe.
fn is_believable(made: &Made) -> bool {
    match made {
        Ok(Some((house, _))) => {
            let report = &house.report;
            report.max_z <= MOVED && report.styles && implausible(&house.building).is_empty()
        }
        Ok(None) => true,
        Err(_) => false,
    }
}

/// Makes houses of other rows in the place of those that are not believable; returns their number.
fn replace(
    orders: &[Order],
    houses: &mut [Made],
    redraw: &mut Redraw,
    made: &(impl Fn(&Order, u64) -> Made + Sync),
) -> Result<usize> {
    let mut count = 0;
    for attempt in 1..=ATTEMPTS {
        let bad = |i: &usize| !is_believable(&houses[*i]);
        let bad: Vec<usize> = (0..houses.len()).filter(bad).collect();
        if bad.is_empty() {
            break;
        }
        let rows = redraw(bad.len())?;
        count += rows.len();
        let others: Vec<(usize, Made)> = (bad.into_par_iter().zip(rows))
            .map(|(i, wanted)| {
                let order = Order {
                    name: orders[i].name.clone(),
                    wanted,
                    given: orders[i].given,
                };
                (i, made(&order, attempt))
            })
            .collect();
        for (i, other) in others {
            // Of none that is believable the first is kept, unless there is no house of it.
            if is_believable(&other) || houses[i].is_err() {
                houses[i] = other;
            }
        }
    }
    Ok(count)
}

fn is_done(path: &Path, order: &Order) -> bool {
    #[derive(serde::Deserialize)]
    struct Wanted {
        wanted: Vec<f64>,
    }
    let known = std::fs::read(path).ok();
    let known = known.and_then(|b| serde_json::from_slice::<Wanted>(&b).ok());
    known.is_some_and(|k| k.wanted == order.wanted)
}

/// A report as one line of JSON.
fn report(report: &HouseReport, seconds: Option<f64>) -> Result<String> {
    let mut value = serde_json::to_value(report).map_err(Error::method)?;
    value["seconds"] = serde_json::json!(seconds);
    value["columns"] = serde_json::json!(&COLUMNS[..]);
    Ok(value.to_string())
}
