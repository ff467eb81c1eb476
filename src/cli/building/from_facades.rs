//! `edifice building from-facades`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_building_exteriors::design::{
    FacadeHouse, Facades, FacadesError, MarkedFacade, eaves, from_facades, in_metres,
};
use edifice_editing::building_exteriors::{is_file_name, shipped_model};
use edifice_editing::structure_completion::annotated;
use edifice_io::{Source, footprint, read_bytes, write_atomic};
use edifice_shape::{Facade, Side};
use serde_json::{Value, json};

use super::produce::{Making, report};
use super::{data, output};
use crate::print;
use crate::reading::{self, Reading};

/// Options of `from-facades`.
#[derive(clap::Args)]
#[command(group = clap::ArgGroup::new("facades").args(["front", "back", "left", "right"]).required(true).multiple(true))]
pub(crate) struct Args {
    /// The front with its windows and doors, as it is seen from outside: from corner to corner, from the ground to the
    /// eaves.
    #[arg(long, value_name = "FACADE")]
    front: Option<PathBuf>,
    /// The back.
    #[arg(long, value_name = "FACADE")]
    back: Option<PathBuf>,
    /// The left side, as seen by one who stands before the front.
    #[arg(long, value_name = "FACADE")]
    left: Option<PathBuf>,
    /// The right side.
    #[arg(long, value_name = "FACADE")]
    right: Option<PathBuf>,
    /// Footprint of the walls: one rectilinear polygon without holes, in degrees or metres (GeoJSON); the front looks to
    /// smaller y, which is south.
    #[arg(long, value_name = "FILE")]
    footprint: PathBuf,
    /// Width in metres of the first facade given (front, back, left, right), for a layout in pixels.
    #[arg(long, value_name = "METRES")]
    width: Option<f64>,
    /// Height of the eaves in metres, for a first facade in pixels; further ones in pixels reach to the same eaves.
    #[arg(long, value_name = "METRES")]
    height: Option<f64>,
    /// The model that completes the house (`*.houses.json`); the one that ships by default.
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Houses to make: the model's most probable answers, the most believable first.
    #[arg(short = 'n', long, default_value_t = 1)]
    count: usize,
    #[command(flatten)]
    reading: Reading,
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

impl Args {
    /// The facades that are given, with their files, in the order of the attributes.
    fn given(&self) -> Vec<(Side, &Path)> {
        let files = [&self.front, &self.back, &self.left, &self.right];
        let sides = Side::ALL.into_iter().zip(files);
        sides
            .filter_map(|(side, file)| Some((side, file.as_deref()?)))
            .collect()
    }

    /// The layouts in metres.
    fn facades(&self) -> Result<Vec<MarkedFacade>> {
        let mut facades: Vec<MarkedFacade> = Vec::new();
        for (side, path) in self.given() {
            let layout = self.layout(path)?;
            let scaled = |width, height| in_metres(side, &layout, width, height);
            let scaled = match facades.first() {
                None => scaled(self.width, self.height),
                // All facades reach to the same eaves.
                Some(first) => {
                    scaled(None, None).or_else(|_| scaled(None, Some(first.layout.height)))
                }
            };
            let layout = scaled.map_err(|e| match e {
                FacadesError::Scale { .. } => Error::option("--width, --height", e.to_string()),
                FacadesError::Unit { .. } => {
                    Error::content(path, format!("{e} (--height METRES or --width METRES)"))
                }
                e => Error::content(path, e),
            })?;
            facades.push(MarkedFacade { side, layout });
        }
        Ok(facades)
    }

    /// The windows and doors of a file below its roof, in its unit.
    fn layout(&self, path: &Path) -> Result<Facade> {
        let source = reading::source(path, &self.reading.options()?)?;
        let told = match &source {
            Source::Layout(facade) => Some((facade.unit.clone(), eaves(facade))),
            Source::Picture(_) | Source::Cmp(..) => None,
        };
        let layout = annotated(source, &read_bytes(path)?, path)?.facade;
        let (unit, height) = told.unwrap_or(("px".into(), layout.height));
        Ok(Facade {
            unit,
            height: height.min(layout.height),
            ..layout
        })
    }
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    if args.count == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    let plan = footprint::read(&args.footprint)?;
    let facades = args.facades()?;
    let own = args.model.as_deref().map(data::model).transpose()?;
    let model = match &own {
        Some(file) => file,
        None => shipped_model()?,
    };
    let name = facades.first().map(|f| f.layout.name.as_str());
    let wanted = Facades {
        name: name.filter(|n| is_file_name(n)).unwrap_or("house"),
        facades: &facades,
        plan: &plan,
        count: args.count,
        seed: args.seed,
    };
    let (database, options) = (args.making.database()?, args.making.options());
    let houses = from_facades(&wanted, model, &database, &options);
    let houses = houses.map_err(|e| placed(args, e))?;
    output::folder(&args.output)?;
    for made in &houses {
        tell(made, &facades);
        let (building, model) = (&made.house.building, &made.house.model);
        output::write(building, model, &args.output, &args.making.format)?;
        let line = line(made)?;
        let path = args.output.join(format!("{}.report.json", building.name));
        write_atomic(&path, format!("{line}\n").as_bytes())?;
        if args.json {
            print::line(&line)?;
        }
    }
    print::message(&format!(
        "{} houses in {}",
        houses.len(),
        args.output.display()
    ));
    Ok(())
}

/// The error with the file of the side that it is about.
fn placed(args: &Args, error: FacadesError) -> Error {
    let side = match &error {
        FacadesError::NoElements { side }
        | FacadesError::Width { side, .. }
        | FacadesError::Height { side, .. } => Some(*side),
        FacadesError::Generate(_) => return Error::content(&args.footprint, error),
        FacadesError::Model(_) => return Error::method(error),
        _ => None,
    };
    let files = args.given();
    let own = files.iter().find(|f| side.is_none_or(|side| f.0 == side));
    match own {
        Some((_, path)) => Error::content(path, error),
        None => Error::method(error),
    }
}

/// Says what became of the marks.
fn tell(made: &FacadeHouse, facades: &[MarkedFacade]) {
    let name = &made.house.building.name;
    for facade in facades {
        let own = || made.marked.iter().filter(|m| m.side == facade.side);
        let off = own().filter_map(|m| m.placed.as_ref().ok());
        let side = facade.side.name();
        print::message(&format!(
            "{name}: {side}: {} of {} elements stand where they are marked, to {:.1} cm",
            off.clone().count(),
            own().count(),
            100.0 * off.fold(0.0, |most: f64, v| most.max(*v))
        ));
        for mark in own() {
            if let Err(reason) = &mark.placed {
                let (region, label) = (mark.region, &mark.label);
                print::message(&format!(
                    "{name}: {side}: regions[{region}] ({label}) is left out: {reason}"
                ));
            }
        }
    }
    for finding in &made.findings {
        print::message(&format!("{name}: implausible: {finding}"));
    }
}

/// The report of a house as one line of JSON, with its elements.
fn line(made: &FacadeHouse) -> Result<String> {
    let mut value: Value =
        serde_json::from_str(&report(&made.house.report, None)?).map_err(Error::method)?;
    let elements = made.marked.iter().map(|m| {
        json!({
            "side": m.side.name(), "region": m.region, "label": m.label,
            "off": m.placed.as_ref().ok(),
            "reason": m.placed.as_ref().err().map(ToString::to_string),
        })
    });
    value["elements"] = elements.collect();
    value["storeys"] = json!(made.storeys);
    value["implausible"] = json!(made.findings);
    Ok(value.to_string())
}
