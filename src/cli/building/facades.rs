//! `edifice building complete --facades`: windows and doors for the buildings of a city model.

use std::path::Path;
use std::time::{Duration, Instant};

use edifice_base::{Error, Result};
use edifice_building_exteriors::dress::{Dresser, Settings, openings};
use edifice_building_exteriors::model_file::ModelFile;
use edifice_building_exteriors::survey::Candidate;
use edifice_io::detailed_cityjson::{Document, Place};
use edifice_io::write_atomic;
use edifice_io_city as city;
use edifice_shape::{DetailedBuilding, PartKind};
use serde_json::json;

use crate::print;

/// Buildings that are dressed at once, and the time after which the number of finished ones is told.
const AT_ONCE: usize = 128;
const PATIENCE: Duration = Duration::from_secs(5);

/// Dresses a city model and writes it as CityJSON.
pub(super) fn run(
    model: &ModelFile,
    input: &Path,
    output: &Path,
    settings: &Settings,
    as_json: bool,
) -> Result<()> {
    if !output.to_string_lossy().ends_with(".city.json") {
        let problem = "with --facades the output is a CityJSON file, `*.city.json`";
        return Err(Error::option("--output", problem));
    }
    if settings.draws == 0 {
        return Err(Error::option("--draws", "must be at least 1"));
    }
    let mut own = city::read(input)?;
    own.number_duplicates();
    let buildings = own.buildings.iter().map(|b| Candidate {
        name: &b.id,
        mesh: &b.mesh,
        attributes: &b.attributes,
    });
    let buildings: Vec<Candidate> = buildings.collect();
    print::message(&format!(
        "{} buildings read; {} draws for each",
        buildings.len(),
        settings.draws
    ));
    let dresser = Dresser::new(&buildings, model, settings).map_err(Error::method)?;
    let mut document = Document::default();
    let mut sum = Sum::default();
    let mut told = Instant::now();
    for start in (0..buildings.len()).step_by(AT_ONCE) {
        if told.elapsed() > PATIENCE {
            told = Instant::now();
            let windows = sum.windows;
            print::message(&format!(
                "{start} of {} buildings, {windows} windows",
                buildings.len()
            ));
        }
        let dressed = dresser.dressed(start..start + AT_ONCE);
        for building in dressed.map_err(Error::method)? {
            sum.add(&building);
            document.add(&building);
        }
    }
    let place = Place {
        origin: own.origin,
        reference_system: own.reference_system,
    };
    write_atomic(output, document.finish(&place).as_bytes())?;
    let Sum { windows, doors, .. } = sum;
    if as_json {
        let line = json!({ "buildings": buildings.len(), "windows": windows, "doors": doors,
            "mean_probability": sum.mean() });
        print::line(&line.to_string())?;
    }
    print::message(&format!(
        "{} buildings with {windows} windows and {doors} doors, of mean probability {:.2}, in {}",
        buildings.len(),
        sum.mean(),
        output.display()
    ));
    Ok(())
}

/// The openings so far.
#[derive(Default)]
struct Sum {
    windows: usize,
    doors: usize,
    probability: f64,
}

impl Sum {
    fn add(&mut self, building: &DetailedBuilding) {
        for part in openings(building) {
            match part.kind {
                PartKind::Door => self.doors += 1,
                _ => self.windows += 1,
            }
            let probability = part.attributes.get("probability");
            self.probability += probability.and_then(|p| p.as_f64()).unwrap_or(0.0);
        }
    }

    fn mean(&self) -> f64 {
        self.probability / (self.windows + self.doors).max(1) as f64
    }
}
