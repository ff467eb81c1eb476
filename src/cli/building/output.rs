//! Files of houses.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_building_exteriors::house::parts::parts;
use edifice_building_exteriors::house::scene::{Placed, colour, palette, scene};
use edifice_building_exteriors::house::street::{self, Fronted};
use edifice_building_exteriors::house::{Database, Model};
use edifice_editing::building_exteriors::{colours, scene_of, shipped_database};
use edifice_io::detailed_cityjson::{self, Place};
use edifice_io::scene_png::picture_png;
use edifice_io::{
    building_json, detailed_gltf, detailed_ifc, scene_svg, surface_obj, write_atomic,
};
use edifice_scene::Scene;
use edifice_scene::trace::{framing, trace};
use edifice_shape::Building;

/// Pixels of a picture of a house, and of a street.
const PICTURE: [usize; 2] = [800, 500];
const STREET: [usize; 2] = [1500, 750];
/// Room between houses of one row (m).
const BETWEEN: f64 = 5.0;

/// A file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Format {
    /// `NAME.building.json`
    Json,
    /// `NAME.obj` with the colours `NAME.mtl`: its parts, z up, in metres
    Obj,
    /// `NAME.glb`: its parts with textures, y up, in metres
    Glb,
    /// `NAME.city.json`: CityJSON 2.0 of level of detail 3
    Cityjson,
    /// `NAME.svg`: elevations and plan
    Svg,
    /// `NAME.png`: a perspective view
    Png,
    /// `NAME.ifc`: IFC4 with walls, roofs, windows and doors as products
    Ifc,
}

impl Format {
    /// Endings of the files of a house.
    pub(super) fn endings(self) -> &'static [&'static str] {
        match self {
            Format::Json => &["building.json"],
            Format::Obj => &["obj", "mtl"],
            Format::Glb => &["glb"],
            Format::Cityjson => &["city.json"],
            Format::Svg => &["svg"],
            Format::Png => &["png"],
            Format::Ifc => &["ifc"],
        }
    }
}

/// Reads the database of donors: a file, or the shipped houses.
pub(super) fn database(path: Option<&Path>) -> Result<Database> {
    let Some(path) = path else {
        return shipped_database().cloned();
    };
    Database::new(building_json::read(path)?).map_err(|e| Error::content(path, e))
}

/// Houses side by side without anything around them.
pub(super) fn row(houses: &[(Building, Model)]) -> Scene {
    let mut x = 0.0;
    let mut all = Vec::new();
    for (building, model) in houses {
        let ends = building.boxes.iter().map(|b| b.x + b.width / 2.0);
        all.push(Placed {
            name: &building.name,
            surface: &model.surface,
            at: [x, 0.0],
            colours: colours(building),
        });
        x += ends.fold(0.0, f64::max) + BETWEEN;
    }
    scene(&all)
}

/// Houses on plots along streets; a single one stands alone. `seed` says where trees stand.
pub(super) fn street(houses: &[(Building, Model)], seed: u64) -> Scene {
    if let [(building, model)] = houses {
        return scene_of(building, model);
    }
    let fronted = houses.iter().map(|(building, model)| Fronted {
        name: &building.name,
        surface: &model.surface,
        colours: colours(building),
    });
    street::street(&fronted.collect::<Vec<_>>(), seed)
}

/// Writes a scene as a picture; one of several groups is a street.
pub(super) fn write_png(scene: &Scene, path: &Path) -> Result<()> {
    let is_street = scene.groups.len() > 1;
    let ([w, h], direction) = match is_street {
        true => (STREET, street::DIRECTION),
        false => (PICTURE, [0.45, -0.42, -0.9]),
    };
    let camera = framing(scene, direction, w as f32 / h as f32);
    let picture = trace(scene, &camera, w, h);
    let bytes = picture_png(&picture).map_err(|e| Error::content(path, e))?;
    write_atomic(path, &bytes)
}

/// Writes a house in all formats asked for, named after it.
pub(super) fn write(
    building: &Building,
    model: &Model,
    folder: &Path,
    formats: &[Format],
) -> Result<()> {
    let file = |ending: &str| folder.join(format!("{}.{ending}", building.name));
    for format in formats {
        match format {
            Format::Json => building_json::write(building, &file("building.json"))?,
            Format::Obj => {
                let materials = format!("{}.mtl", building.name);
                let parts = parts(building, model);
                let text = surface_obj::mtl(&parts, &palette(colours(building)));
                write_atomic(&file("mtl"), text.as_bytes())?;
                let text = surface_obj::parts_text(&parts, Some(&materials));
                write_atomic(&file("obj"), text.as_bytes())?;
            }
            Format::Glb => {
                let palette = palette(colours(building));
                detailed_gltf::write(&parts(building, model), &palette, &file("glb"))?;
            }
            Format::Cityjson => {
                let all = [parts(building, model)];
                let text = detailed_cityjson::to_string(&all, &Place::default());
                write_atomic(&file("city.json"), text.as_bytes())?;
            }
            Format::Svg => {
                let text = scene_svg::elevations(&scene_of(building, model));
                write_atomic(&file("svg"), text.as_bytes())?;
            }
            Format::Png => write_png(&scene_of(building, model), &file("png"))?,
            Format::Ifc => {
                let template = colours(building);
                let colour = |finish| colour(finish, template);
                let text = detailed_ifc::to_text(&parts(building, model), colour);
                write_atomic(&file("ifc"), text.as_bytes())?;
            }
        }
    }
    Ok(())
}

/// Makes the folder of the output.
pub(super) fn folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).map_err(|e| Error::io(path, "create", e))
}
