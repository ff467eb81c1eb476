//! `edifice building compare`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::{COLUMNS, attributes};
use edifice_building_exteriors::house::{Database, Joining, model};
use edifice_building_exteriors::mass::is_sound;
use edifice_io::building_json;
use edifice_shape::Building;
use serde_json::json;

use super::produce::ROOFS;
use crate::choice::one_of;
use crate::print;

/// Options of `compare`.
#[derive(clap::Args)]
#[command(after_help = "Example:
  edifice building compare village.buildings.jsonl village.buildings.jsonl --json

Houses are paired in the order of the files. A difference is told in standard deviations of the attribute over TRUTH, in its own unit where
TRUTH is one house or the attribute does not vary.")]
pub(crate) struct Args {
    /// True houses (`*.building.json`, `*.buildings.jsonl`)
    truth: PathBuf,
    /// Houses to judge, as many
    predicted: PathBuf,
    /// Roofs of each box, or one joined roof
    #[arg(long, value_parser = one_of(ROOFS), default_value = "boxes")]
    roof: Joining,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Sets of different sizes.
#[derive(Debug, thiserror::Error)]
#[error("{found} houses, the truth has {truth}")]
struct Count {
    found: usize,
    truth: usize,
}

/// Runs `compare`.
pub(super) fn run(args: &Args) -> Result<()> {
    let truth = building_json::read(&args.truth)?;
    let predicted = building_json::read(&args.predicted)?;
    let (found, wanted) = (predicted.len(), truth.len());
    if found != wanted {
        let truth = wanted;
        return Err(Error::content(&args.predicted, Count { found, truth }));
    }
    let truth = Database::new(truth).map_err(|e| Error::content(&args.truth, e))?;
    let mut houses = Vec::new();
    for (index, house) in predicted.iter().enumerate() {
        let row = attributes(house)
            .map_err(|e| Error::input(&args.predicted, format!("house {}", index + 1), e))?;
        let (mut most, mut worst, mut sum, mut known) = (0.0, "", 0.0, 0);
        let (mut missing, own) = (0, &truth.rows[index]);
        for (column, name) in COLUMNS.iter().enumerate() {
            match (own[column], row[column]) {
                (Some(a), Some(b)) => {
                    let z = (a - b).abs() / truth.deviations[column];
                    known += 1;
                    sum += z;
                    if z > most {
                        (most, worst) = (z, *name);
                    }
                }
                (None, None) => {}
                _ => missing += 1,
            }
        }
        let mean = sum / f64::from(known.max(1));
        let (sound, watertight) = (is_sound(house), is_watertight(house, args.roof));
        print::line(&format!(
            "{}: max {most:.4} ({worst}), mean {mean:.4}, {missing} attributes of only one, sound {sound}, watertight {watertight}",
            house.name
        ))?;
        houses.push(json!({
            "house": house.name, "max_z": most, "worst": worst, "mean_z": mean, "unmatched": missing,
            "sound": sound, "watertight": watertight,
        }));
    }
    match args.json {
        true => print::line(&json!({ "houses": houses }).to_string()),
        false => Ok(()),
    }
}

/// True if the surface of a house is one closed shell.
fn is_watertight(house: &Building, roof: Joining) -> bool {
    model(house, roof).is_ok_and(|made| made.report.shells == 1)
}
