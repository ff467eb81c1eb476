//! The test for roofs that hide windows or doors.

use edifice_building_exteriors::house::walls::{WallPiece, walls_of_pieces};
use edifice_shape::{
    BoxStyle, Building, ElementStyle, FacadePiece, MassBox, Ridge, RoofStyle, Side,
};

/// The reach of sloped roofs over the walls, and of flat ones; thickness of a roof; height of a porch's beam (m). Each
/// a little more than is built.
const EAVES: f64 = 0.4;
const CORNICE: f64 = 0.15;
const ROOF: f64 = 0.2;
const BEAM: f64 = 0.24;
/// Height of a porch's floor, on which its door begins (m).
const DECK: f64 = 0.2;
/// Clear wall around an element (m), and places along it that are looked at.
const CLEAR: f64 = 0.03;
const PLACES: usize = 16;

/// True if some element of the building is behind or over the roof of some box, or has no wall.
pub(super) fn hides(building: &Building) -> bool {
    let walls = walls_of_pieces(building);
    building.facades.iter().zip(&walls).any(|(piece, wall)| {
        let of_piece = |wall: &WallPiece| covered(building, piece, wall);
        !piece.elements.is_empty() && wall.as_ref().is_none_or(of_piece)
    })
}

fn covered(building: &Building, piece: &FacadePiece, wall: &WallPiece) -> bool {
    piece.elements.iter().any(|e| {
        let low = piece.start + e.x - CLEAR;
        let step = (e.width + 2.0 * CLEAR) / PLACES as f64;
        let floor = match e.style {
            ElementStyle::Door => DECK,
            _ => e.y - CLEAR,
        };
        let (bottom, top) = (piece.base + floor, piece.base + e.y + e.height + CLEAR);
        (0..=PLACES).any(|k| {
            let [x, y] = before(wall, low + k as f64 * step);
            let mut solid = building.boxes.iter().filter_map(|b| occupied(b, x, y));
            solid.any(|[from, to]| from < top && bottom < to)
        })
    })
}

/// A place just outside a wall.
fn before(wall: &WallPiece, along: f64) -> [f64; 2] {
    let out = 1e-3;
    match wall.side {
        Side::Front => [along, wall.at - out],
        Side::Back => [along, wall.at + out],
        Side::Left => [wall.at - out, along],
        Side::Right => [wall.at + out, along],
    }
}

/// Heights that a box with its roof takes up over a place.
fn occupied(b: &MassBox, x: f64, y: f64) -> Option<[f64; 2]> {
    let plan = b.plan();
    let inside = [x - plan.x, plan.right() - x, y - plan.y, plan.top() - y];
    let least = inside.into_iter().fold(f64::INFINITY, f64::min);
    let is_flat = b.roof.style == RoofStyle::Flat || b.roof.pitch == 0.0;
    if least < -(if is_flat { CORNICE } else { EAVES }) {
        return None;
    }
    let across = inside[0].min(inside[1]);
    let along = inside[2].min(inside[3]);
    let run = match (b.roof.style, b.roof.ridge) {
        (RoofStyle::Flat, _) => 0.0,
        (RoofStyle::Gable, Ridge::X) => along,
        (RoofStyle::Gable, Ridge::Y) => across,
        _ => across.min(along),
    };
    let top = b.height + b.roof.pitch.to_radians().tan() * run;
    let from = match b.style {
        _ if least < 0.0 => top - ROOF,
        BoxStyle::Porch => (b.height - BEAM).min(top - ROOF),
        _ => 0.0,
    };
    Some([from, top])
}
