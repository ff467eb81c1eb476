//! `edifice building complete --facades`: windows and doors for the buildings of a city model.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_building_exteriors::dress::{Settings, dress, openings};
use edifice_building_exteriors::model_file::ModelFile;
use edifice_building_exteriors::survey::Candidate;
use edifice_io::detailed_cityjson::{self, Place};
use edifice_io::{city, write_atomic};
use edifice_shape::PartKind;
use serde_json::json;

use crate::print;

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
    let dressed = dress(&buildings, model, settings).map_err(Error::method)?;
    let place = Place {
        origin: own.origin,
        reference_system: own.reference_system,
    };
    let text = detailed_cityjson::to_string(&dressed, &place);
    write_atomic(output, text.as_bytes())?;
    let count = |kind| {
        let all = dressed.iter().flat_map(openings);
        all.filter(|p| p.kind == kind).count()
    };
    let (windows, doors) = (count(PartKind::Window), count(PartKind::Door));
    let all = dressed.iter().flat_map(openings);
    let expected: f64 = all
        .filter_map(|p| p.attributes.get("probability")?.as_f64())
        .sum();
    if as_json {
        let line = json!({ "buildings": dressed.len(), "windows": windows, "doors": doors,
            "mean_probability": expected / (windows + doors).max(1) as f64 });
        print::line(&line.to_string())?;
    }
    print::message(&format!(
        "{} buildings with {windows} windows and {doors} doors, of mean probability {:.2}, in {}",
        dressed.len(),
        expected / (windows + doors).max(1) as f64,
        output.display()
    ));
    Ok(())
}
