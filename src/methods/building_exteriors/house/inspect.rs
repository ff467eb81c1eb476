//! Findings on a house: faults that no sound house has, and what one would not believe.
//!
//! Each finding names its place in the file. Faults: the unit, magnitudes, boxes that are degenerate, doubled, apart or
//! overlapping, facades that are missing or stand on no wall, elements that are out of place, surfaces that are not
//! closed. Implausible is what a house may have but hardly any has: stubs, steep or several pitches, storeys of unusual
//! height, a porch without a door, windows of unusual size.
//!
//! # Deviations and readings
//! - A house is incomplete, not at fault, in what it calls unobserved ([`edifice_shape::Building::unobserved`]).
//! - Bounds of what is plausible hold 95 % of the real houses measured (Delft; window sizes: 101,549 windows of audited
//!   Canadian houses), except that real houses have several pitches more often.

use super::model::{expected_volume, model};
use super::roofs::Joining;
use super::walls::walls_of_pieces;
use crate::mass::THINNEST;
use crate::mass::contradiction::STOREY;
use edifice_shape::{
    BoxStyle, Building, ElementStyle, Hidden, MassBox, PlanUnion, RoofStyle, Side,
};

/// Largest relative difference between the volume of a surface and the integral over its plan.
const VOLUME: f64 = 1e-9;
/// Least extent of a box, least and greatest height of a box and of a floor (m), and steepest roof (degrees).
const THIN: f64 = 0.3;
const HEIGHTS: [f64; 2] = [1.0, 40.0];
const STEEPEST: f64 = 80.0;
/// Least size of an element (m); narrowest and lowest door, and how far above its floor it may begin.
const SMALLEST: f64 = 0.1;
const DOOR: [f64; 2] = [0.6, 1.6];
const DOOR_SILL: f64 = 0.6;
/// Most floors that the attributes describe.
const MOST_FLOORS: usize = 3;

/// Faults of a house, each with its place; none for a sound house.
pub fn faults(building: &Building, joining: Joining) -> Vec<String> {
    let mut found = Vec::new();
    general(building, &mut found);
    for (i, b) in building.boxes.iter().enumerate() {
        box_faults(i, b, &mut found);
        for (j, other) in building.boxes.iter().enumerate().skip(i + 1) {
            if b == other {
                found.push(format!("boxes[{j}] is boxes[{i}] again"));
            }
        }
    }
    mass(building, &mut found);
    facades(building, &mut found);
    // A surface is built of what can be built.
    if found.is_empty() {
        surface(building, joining, &mut found);
    }
    found
}

fn general(building: &Building, found: &mut Vec<String>) {
    if building.name.trim().is_empty() {
        found.push("name is empty".into());
    }
    if building.unit != "m" {
        found.push(format!(
            "unit is {:?}: houses are built in m",
            building.unit
        ));
    }
    let [low, high] = STOREY;
    if !(low..=high).contains(&building.floor_height) {
        found.push(format!(
            "floor_height is {}, expected {low} to {high} m",
            building.floor_height
        ));
    }
    let floors = building.floors();
    if floors > MOST_FLOORS {
        let highest = (0..building.boxes.len())
            .max_by_key(|&i| building.floors_of(&building.boxes[i]))
            .unwrap_or(0);
        found.push(format!(
            "boxes[{highest}] has {floors} floors, expected at most 3"
        ));
    }
    for (k, special) in building.special.iter().enumerate() {
        if building.special[..k].contains(special) {
            found.push(format!("special[{k}] is there twice"));
        }
    }
}

fn box_faults(i: usize, b: &MassBox, found: &mut Vec<String>) {
    for (field, value) in [("width", b.width), ("depth", b.depth)] {
        if value < THIN {
            found.push(format!(
                "boxes[{i}].{field} is {value}, expected at least {THIN} m"
            ));
        }
    }
    let [low, high] = HEIGHTS;
    if !(low..=high).contains(&b.height) {
        found.push(format!(
            "boxes[{i}].height is {}, expected {low} to {high} m",
            b.height
        ));
    }
    if b.roof.pitch > STEEPEST {
        found.push(format!(
            "boxes[{i}].roof.pitch is {}, expected at most {STEEPEST} degrees",
            b.roof.pitch
        ));
    }
}

/// Checks that the boxes make one plan on every floor.
fn mass(building: &Building, found: &mut Vec<String>) {
    let ground = PlanUnion::new(&building.floor_plan(0)).soundness();
    if ground.parts > 1 {
        let apart = (0..building.boxes.len()).find(|&i| {
            let one: Vec<_> = (building.boxes.iter().enumerate())
                .filter(|(j, _)| *j != i)
                .map(|(_, b)| b.plan())
                .collect();
            !one.is_empty() && PlanUnion::new(&one).soundness().parts < ground.parts
        });
        let place = apart.map_or("boxes".into(), |i| format!("boxes[{i}]"));
        found.push(format!(
            "{place}: the boxes stand in {} pieces",
            ground.parts
        ));
    }
    if ground.courtyard {
        found.push("boxes: the ground floor shuts in a courtyard".into());
    }
    for k in 0..building.floors().min(MOST_FLOORS) {
        let floor = PlanUnion::new(&building.floor_plan(k)).soundness();
        if floor.pinches > 0 {
            found.push(format!("boxes: floor {k} touches itself in a corner only"));
        }
        if floor.thickness < THINNEST - 1e-9 {
            found.push(format!(
                "boxes: floor {k} is {:.3} m thin, expected at least {THINNEST} m",
                floor.thickness
            ));
        }
    }
    for (i, a) in building.boxes.iter().enumerate() {
        for (j, b) in building.boxes.iter().enumerate().skip(i + 1) {
            let parts = a.style != BoxStyle::Main && b.style != BoxStyle::Main;
            let (p, q) = (a.plan(), b.plan());
            let x = p.right().min(q.right()) - p.x.max(q.x);
            let y = p.top().min(q.top()) - p.y.max(q.y);
            if parts && a.style != b.style && x.min(y) > 1e-6 {
                found.push(format!(
                    "boxes[{i}] and boxes[{j}], garage and porch, overlap"
                ));
            }
        }
    }
}

fn facades(building: &Building, found: &mut Vec<String>) {
    let hidden = building.is_unobserved(Hidden::Facades);
    if building.facades.is_empty() && !hidden {
        found.push(
            "facades: none; a house without them says `\"unobserved\": [\"facades\"]`".into(),
        );
    }
    let sides = Side::ALL.map(|side| building.facades.iter().any(|p| p.side == side));
    let elements = || building.facades.iter().flat_map(|p| &p.elements);
    if sides == [true; 4] && !hidden && elements().all(|e| e.style != ElementStyle::Door) {
        found.push("facades: no door".into());
    }
    let walls = walls_of_pieces(building);
    for (i, (piece, wall)) in building.facades.iter().zip(&walls).enumerate() {
        if wall.is_none() {
            found.push(format!(
                "facades[{i}] stands on no wall of the {}",
                piece.side.name()
            ));
        }
        let floor = piece.base / building.floor_height;
        if (floor - floor.round()).abs() > 0.1 {
            found.push(format!("facades[{i}].base is {}: on no floor", piece.base));
        }
        if piece.height > 1.5 * building.floor_height {
            found.push(format!(
                "facades[{i}].height is {}: more than a floor",
                piece.height
            ));
        }
        if let Some(wall) = wall {
            let slack = 0.02;
            if piece.start < wall.start - slack || piece.start + piece.width > wall.end + slack {
                let whole = extent(building, piece.side);
                if piece.start < whole[0] - slack || piece.start + piece.width > whole[1] + slack {
                    found.push(format!("facades[{i}] reaches beyond the house"));
                }
            }
        }
        for (k, e) in piece.elements.iter().enumerate() {
            let place = format!("facades[{i}].elements[{k}]");
            for (field, value) in [("width", e.width), ("height", e.height)] {
                if value < SMALLEST {
                    found.push(format!(
                        "{place}.{field} is {value}, expected at least {SMALLEST} m"
                    ));
                }
            }
            if e.style != ElementStyle::Door {
                continue;
            }
            if e.y > DOOR_SILL {
                found.push(format!("{place}.y is {}: a door above its floor", e.y));
            }
            if e.width < DOOR[0] || e.height < DOOR[1] {
                found.push(format!(
                    "{place} is a door of {} m x {} m",
                    e.width, e.height
                ));
            }
        }
    }
}

/// Lower and upper end of the house along a side.
fn extent(building: &Building, side: Side) -> [f64; 2] {
    let ends = building.boxes.iter().flat_map(|b| {
        let p = b.plan();
        match side {
            Side::Front | Side::Back => [p.x, p.right()],
            Side::Left | Side::Right => [p.y, p.top()],
        }
    });
    ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| {
        [l.min(v), h.max(v)]
    })
}

fn surface(building: &Building, joining: Joining, found: &mut Vec<String>) {
    let made = match model(building, joining) {
        Ok(made) => made,
        Err(e) => return found.push(format!("surface: {e}")),
    };
    if made.report.shells != 1 {
        found.push(format!("surface: {} shells", made.report.shells));
    }
    let expected = expected_volume(building, joining, made.openings);
    if (made.report.volume - expected).abs() > VOLUME * expected.abs() {
        let volume = made.report.volume;
        found.push(format!(
            "surface: encloses {volume} cubic metres, its plan {expected}"
        ));
    }
    for (piece, element) in made.unplaced {
        found.push(format!(
            "facades[{piece}].elements[{element}] is hidden behind a roof, over a corner, or overlaps another"
        ));
    }
}

/// Narrowest room (m), flattest and steepest roof of two or four slopes (degrees), greatest difference of two pitches.
const ROOM: f64 = 1.2;
const PITCHES: [f64; 2] = [10.0, 65.0];
const SAME_PITCH: f64 = 1.0;
/// Usual heights of a storey (m), sizes of windows (m) and their number, most boxes.
const STOREYS: [f64; 2] = [2.1, 4.6];
const WINDOWS: [f64; 2] = [0.3, 3.6];
const COUNT: [usize; 2] = [2, 60];
const BOXES: usize = 14;

/// Properties of a house that one would not believe, each with its place; none for a plausible one.
pub fn implausible(building: &Building) -> Vec<String> {
    let mut found = Vec::new();
    let [low, high] = STOREYS;
    if !(low..=high).contains(&building.floor_height) {
        found.push(format!(
            "floor_height is {:.2} m, usual are {low} to {high}",
            building.floor_height
        ));
    }
    if building.boxes.len() > BOXES {
        found.push(format!(
            "boxes: {}, usual are at most {BOXES}",
            building.boxes.len()
        ));
    }
    let mut pitch: Option<(usize, f64)> = None;
    for (i, b) in building.boxes.iter().enumerate() {
        let thin = b.width.min(b.depth);
        if b.style == BoxStyle::Main && thin < ROOM {
            found.push(format!("boxes[{i}] is {thin:.2} m narrow: a stub"));
        }
        let two_slopes = matches!(b.roof.style, RoofStyle::Gable | RoofStyle::Hip);
        if b.style != BoxStyle::Main || !two_slopes {
            continue;
        }
        let [low, high] = PITCHES;
        if !(low..=high).contains(&b.roof.pitch) {
            found.push(format!(
                "boxes[{i}].roof.pitch is {:.1} degrees",
                b.roof.pitch
            ));
        }
        match pitch {
            Some((first, known)) if (known - b.roof.pitch).abs() > SAME_PITCH => {
                found.push(format!(
                    "boxes[{i}].roof.pitch is {:.1} degrees, that of boxes[{first}] {known:.1}",
                    b.roof.pitch
                ));
            }
            Some(_) => {}
            None => pitch = Some((i, b.roof.pitch)),
        }
    }
    if !building.facades.is_empty() {
        openings(building, &mut found);
    }
    found
}

fn openings(building: &Building, found: &mut Vec<String>) {
    let sides = Side::ALL
        .iter()
        .filter(|s| building.facades.iter().any(|p| p.side == **s));
    let whole = sides.count() == 4;
    let mut windows = 0;
    let mut doors: Vec<(Side, f64)> = Vec::new();
    for (i, piece) in building.facades.iter().enumerate() {
        for (k, e) in piece.elements.iter().enumerate() {
            if e.style == ElementStyle::Door {
                doors.push((piece.side, piece.start + e.x + e.width / 2.0));
                if piece.width < 1.2 {
                    found.push(format!(
                        "facades[{i}].elements[{k}]: a door on a stub of wall"
                    ));
                }
                continue;
            }
            windows += 1;
            let [low, high] = WINDOWS;
            if e.width.min(e.height) < low || e.width.max(e.height) > high {
                found.push(format!(
                    "facades[{i}].elements[{k}] is a window of {:.2} m x {:.2} m",
                    e.width, e.height
                ));
            }
        }
    }
    if !whole {
        return;
    }
    if !(COUNT[0]..=COUNT[1]).contains(&windows) {
        found.push(format!("facades: {windows} windows"));
    }
    if doors.is_empty() {
        found.push("facades: no door".into());
    }
    let middle = {
        let [low, high] = extent(building, Side::Left);
        (low + high) / 2.0
    };
    for (i, b) in building.boxes.iter().enumerate() {
        if b.style != BoxStyle::Porch {
            continue;
        }
        let p = b.plan();
        let leads = doors.iter().any(|(side, at)| match side {
            Side::Front => b.y < middle && p.x < *at && *at < p.right(),
            Side::Back => b.y >= middle && p.x < *at && *at < p.right(),
            Side::Left | Side::Right => p.y < *at && *at < p.top(),
        });
        if !leads {
            found.push(format!("boxes[{i}] is a porch without a door"));
        }
    }
}
