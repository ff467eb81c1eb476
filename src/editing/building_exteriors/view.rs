//! The view of a house, as a page shows it.

use serde_json::{Value, json};

use super::wish::{FIRST_FLAG, given, ranges};
use super::{House, shipped_model};
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::{GROUPS, attributes};
use edifice_building_exteriors::design::Edit;
use edifice_building_exteriors::house::scene::{Placed, scene};
use edifice_building_exteriors::house::{Generated, Model};
use edifice_scene::Scene;
use edifice_shape::{Building, MassBox};

/// The number of the colours of a house, chosen by its name.
pub fn colours(building: &Building) -> usize {
    building.name.bytes().map(usize::from).sum()
}

/// The scene of one house.
pub fn scene_of(building: &Building, model: &Model) -> Scene {
    scene(&[Placed {
        name: &building.name,
        surface: &model.surface,
        at: [0.0; 2],
        colours: colours(building),
    }])
}

/// Which boxes of the house after the edits are those that were added, moved or resized: they have the size and place
/// that the edits gave them.
pub(super) fn touched(before: &Building, edits: &[Edit], after: &Building) -> Vec<bool> {
    let mut known: Vec<Option<[f64; 5]>> = (before.boxes.iter()).map(|_| None).collect();
    let mut boxes: Vec<[f64; 5]> = before.boxes.iter().map(place).collect();
    for edit in edits {
        match *edit {
            Edit::Add(_, size) => {
                boxes.push(size);
                known.push(Some(size));
            }
            Edit::Move(i, [x, y]) => {
                (boxes[i][0], boxes[i][1]) = (x, y);
                known[i] = Some(boxes[i]);
            }
            Edit::Resize(i, [w, d, h]) => {
                (boxes[i][2], boxes[i][3], boxes[i][4]) = (w, d, h);
                known[i] = Some(boxes[i]);
            }
            Edit::Remove(i) => {
                boxes.remove(i);
                known.remove(i);
            }
        }
    }
    let fixed: Vec<[f64; 5]> = known.into_iter().flatten().collect();
    let is_fixed = |b: &MassBox| fixed.contains(&place(b));
    after.boxes.iter().map(is_fixed).collect()
}

fn place(b: &MassBox) -> [f64; 5] {
    [b.x, b.y, b.width, b.depth, b.height]
}

/// Everything there is to show.
pub(super) fn view(house: &House) -> Result<Value> {
    let b = &house.building;
    let row = attributes(b).map_err(Error::method)?;
    let (ranges, wished) = (ranges()?, given(&house.wishes)?);
    let columns: Vec<Value> = GROUPS
        .iter()
        .flat_map(|g| (g.columns().iter().enumerate()).map(move |(k, c)| (g, g.first + k, c)))
        .map(|(group, c, name)| {
            let wanted = house.report.as_ref().map(|r| r.wanted[c]);
            json!({
                "name": name, "group": group.name, "value": row[c], "wanted": wanted, "flag": c >= FIRST_FLAG,
                "low": ranges[c][0], "high": ranges[c][1], "wish": wished[c],
            })
        })
        .collect();
    let report = house.report.as_ref().map(|r| {
        json!({
            "distance": r.max_z, "mass": r.mass_z, "donor": r.donor, "volume": r.volume,
            "triangles": r.triangles, "unplaced": r.unplaced,
        })
    });
    Ok(json!({
        "unit": b.unit, "floorHeight": b.floor_height, "boxes": boxes(b), "locked": house.locked,
        "columns": columns, "report": report, "scene": shown(&scene_of(b, &house.model)),
        "styles": shipped_model()?.model.style_probabilities(), "style": house.style, "keep": house.keep,
        "answers": house.answers.iter().map(answered).collect::<Vec<_>>(), "chosen": house.chosen,
    }))
}

fn boxes(building: &Building) -> Vec<Value> {
    let shown = |b: &MassBox| {
        let mut value = json!(b);
        value["floors"] = json!(building.floors_of(b));
        value
    };
    building.boxes.iter().map(shown).collect()
}

fn answered(house: &Generated) -> Value {
    json!({
        "boxes": boxes(&house.building), "distance": house.report.max_z, "mass": house.report.mass_z,
        "volume": house.report.volume,
    })
}

/// Triangles by material, y up, in millimetres.
fn shown(scene: &Scene) -> Value {
    let meshes: Vec<Value> = scene
        .meshes
        .iter()
        .map(|mesh| {
            let millimetres = |v: &f32| (f64::from(*v) * 1e3).round() as i64;
            let positions: Vec<i64> = mesh.positions.iter().flatten().map(millimetres).collect();
            let parts = mesh.parts.iter().map(|(material, indices)| {
                let material = &scene.materials[*material];
                json!({"finish": material.name, "color": material.color, "indices": indices})
            });
            json!({"positions": positions, "parts": parts.collect::<Vec<_>>()})
        })
        .collect();
    json!(meshes)
}
