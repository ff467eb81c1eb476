//! `edifice building check` and `draw`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_building_exteriors::house::inspect::{faults, implausible};
use edifice_building_exteriors::house::{Joining, Model, model};
use edifice_io::{building_json, detailed_cityjson, gltf, scene_svg, surface_obj, write_atomic};
use edifice_shape::Building;

use super::output::{row, street, write_png};
use super::produce::ROOFS;
use crate::choice::one_of;
use crate::print::{self, Json};

/// Options of `check`.
#[derive(clap::Args)]
pub(crate) struct CheckArgs {
    /// Houses (`*.building.json`, `*.buildings.jsonl`), surfaces (`*.obj`), or buildings of level of detail 3
    /// (`*.city.json`, as `build --format cityjson` and `complete --facades` write them).
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Roofs of each box, or one joined roof.
    #[arg(long, value_parser = one_of(ROOFS), default_value = "boxes")]
    roof: Joining,
    /// Also list what a house may have but hardly any has: stubs, several pitches, porches without a door, windows of
    /// unusual size.
    #[arg(long)]
    plausible: bool,
    /// Print a line of JSON for each house.
    #[arg(long)]
    json: bool,
}

/// Options of `draw`.
#[derive(clap::Args)]
pub(crate) struct DrawArgs {
    /// Houses (`*.building.json`, `*.buildings.jsonl`).
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// The drawing: `*.png` a view, `*.svg` elevations and plan, `*.glb` a scene.
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Roofs of each box, or one joined roof.
    #[arg(long, value_parser = one_of(ROOFS), default_value = "boxes")]
    roof: Joining,
    #[command(flatten)]
    json: Json,
}

/// Houses that are not what they should be.
#[derive(Debug, thiserror::Error)]
#[error("{bad} of {all} houses or surfaces have faults")]
struct Faults {
    bad: usize,
    all: usize,
}

/// Runs `check`.
pub(super) fn check(args: &CheckArgs) -> Result<()> {
    let (mut all, mut bad, mut open) = (0, 0, 0);
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
        if path.to_string_lossy().ends_with(".city.json") {
            for shell in detailed_cityjson::shells(path)? {
                let faults = detailed_cityjson::faults(&shell);
                all += 1;
                open += usize::from(!shell.is_solid);
                bad += usize::from(!faults.is_empty());
                tell(&shell.name, &faults, args.json)?;
            }
            continue;
        }
        let mut names = std::collections::HashSet::new();
        for building in building_json::read(path)? {
            let mut faults = faults(&building, args.roof);
            if !names.insert(building.name.clone()) {
                faults.push("name: another house of the file has it".into());
            }
            if args.plausible {
                faults.extend(implausible(&building));
            }
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
    let surfaces = match open {
        0 => String::new(),
        open => format!(", {open} sets of surfaces, which need not be closed"),
    };
    print::message(&format!(
        "{} closed, one shell each{surfaces}, nothing overlapping or hidden{}",
        all - open,
        if args.plausible { ", plausible" } else { "" }
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

/// Runs `draw`.
pub(super) fn draw(args: &DrawArgs) -> Result<()> {
    let mut houses: Vec<(Building, Model)> = Vec::new();
    for path in &args.files {
        for building in building_json::read(path)? {
            let made = model(&building, args.roof);
            let made = made.map_err(|e| Error::content(path, format!("{}: {e}", building.name)))?;
            houses.push((building, made));
        }
    }
    let ending = |name: &str| {
        Path::new(&args.output)
            .extension()
            .is_some_and(|e| e == name)
    };
    match () {
        () if ending("png") => write_png(&street(&houses, 0), &args.output),
        () if ending("svg") => {
            let text = scene_svg::elevations(&row(&houses));
            write_atomic(&args.output, text.as_bytes())
        }
        () if ending("glb") => gltf::write(&street(&houses, 0), &args.output),
        () => Err(Error::option("--output", "must end in .png, .svg or .glb")),
    }?;
    let value = serde_json::json!({ "file": args.output, "houses": houses.len() });
    args.json.end(&value)
}
