//! `edifice building check` and `draw`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_building_exteriors::house::model::expected_volume;
use edifice_building_exteriors::house::{Model, model};
use edifice_io::{building_json, gltf, scene_svg, surface_obj, write_atomic};
use edifice_shape::Building;

use super::output::{street, write_png};
use super::produce::RoofOption;
use crate::print;

/// Largest relative difference between the volume of a surface and the integral over its plan.
const VOLUME: f64 = 1e-9;

/// Options of `check`.
#[derive(clap::Args)]
pub struct CheckArgs {
    /// Houses (`*.building.json`, `*.buildings.jsonl`) or surfaces (`*.obj`).
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Roofs of each box, or one joined roof.
    #[arg(long, value_enum, default_value = "boxes")]
    roof: RoofOption,
    /// Print a line of JSON for each house.
    #[arg(long)]
    json: bool,
}

/// Options of `draw`.
#[derive(clap::Args)]
pub struct DrawArgs {
    /// Houses (`*.building.json`, `*.buildings.jsonl`).
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// The drawing: `*.png` a view, `*.svg` elevations and plan, `*.glb` a scene.
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Roofs of each box, or one joined roof.
    #[arg(long, value_enum, default_value = "boxes")]
    roof: RoofOption,
}

/// Houses that are not what they should be.
#[derive(Debug, thiserror::Error)]
#[error("{bad} of {all} houses or surfaces have faults")]
struct Faults {
    bad: usize,
    all: usize,
}

/// Runs `check`.
pub fn check(args: &CheckArgs) -> Result<()> {
    let (mut all, mut bad) = (0, 0);
    for path in &args.files {
        if path.extension().is_some_and(|e| e == "obj") {
            let found = surface_obj::read(path)?.check().map(|r| r.shells);
            let faults = match found {
                Ok(1) => Vec::new(),
                Ok(n) => vec![format!("{n} shells")],
                Err(e) => vec![e.to_string()],
            };
            all += 1;
            bad += usize::from(!faults.is_empty());
            tell(&path.display().to_string(), &faults, args.json)?;
            continue;
        }
        for building in building_json::read(path)? {
            let faults = faults(&building, args.roof);
            all += 1;
            bad += usize::from(!faults.is_empty());
            tell(
                &format!("{}: {}", path.display(), building.name),
                &faults,
                args.json,
            )?;
        }
    }
    if bad > 0 {
        return Err(Error::method(Faults { bad, all }));
    }
    print::message(&format!(
        "{all} closed, one shell each, nothing overlapping or hidden"
    ));
    Ok(())
}

fn tell(name: &str, faults: &[String], json: bool) -> Result<()> {
    if json {
        let line =
            serde_json::json!({ "house": name, "sound": faults.is_empty(), "faults": faults });
        return print::line(&line.to_string());
    }
    faults
        .iter()
        .try_for_each(|fault| print::line(&format!("{name}: {fault}")))
}

/// The faults of a house, one sentence each; none for a sound one.
fn faults(building: &Building, roof: RoofOption) -> Vec<String> {
    let mut faults = Vec::new();
    if !edifice_building_exteriors::mass::is_sound(building) {
        faults.push("the boxes are not in one piece, shut in a courtyard, are thinner than 0.5 m, touch in a corner only, or parts overlap".into());
    }
    match model(building, roof.joining()) {
        Err(e) => faults.push(e.to_string()),
        Ok(made) => {
            if made.report.shells != 1 {
                faults.push(format!("{} shells", made.report.shells));
            }
            let expected = expected_volume(building, roof.joining(), made.openings);
            if (made.report.volume - expected).abs() > VOLUME * expected.abs() {
                let volume = made.report.volume;
                faults.push(format!(
                    "encloses {volume} cubic metres, its plan {expected}"
                ));
            }
            for (piece, element) in made.unplaced {
                faults.push(format!(
                    "facades[{piece}].elements[{element}] is hidden behind a roof, over a corner, or overlaps another"
                ));
            }
        }
    }
    faults
}

/// Runs `draw`.
pub fn draw(args: &DrawArgs) -> Result<()> {
    let mut houses: Vec<(Building, Model)> = Vec::new();
    for path in &args.files {
        for building in building_json::read(path)? {
            let made = model(&building, args.roof.joining());
            let made = made.map_err(|e| Error::content(path, format!("{}: {e}", building.name)))?;
            houses.push((building, made));
        }
    }
    let scene = street(&houses);
    let ending = |name: &str| {
        Path::new(&args.output)
            .extension()
            .is_some_and(|e| e == name)
    };
    match () {
        () if ending("png") => write_png(&scene, &args.output),
        () if ending("svg") => write_atomic(&args.output, scene_svg::elevations(&scene).as_bytes()),
        () if ending("glb") => gltf::write(&scene, &args.output),
        () => Err(Error::option("--output", "must end in .png, .svg or .glb")),
    }
}
