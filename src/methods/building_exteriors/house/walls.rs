//! The walls of a building: where its facade pieces are.

use edifice_shape::solid;
use edifice_shape::{BoxStyle, Building, FacadePiece, MassBox, PlanEdge, PlanUnion, Rect, Side};

/// The wall of one floor between two corners of the outline of any floor, on one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallPiece {
    /// The side it looks to.
    pub side: Side,
    /// Its coordinate across: y for front and back, x for left and right.
    pub at: f64,
    /// Its start along the side, in metres.
    pub start: f64,
    /// Its end along the side, in metres.
    pub end: f64,
    /// Index of its floor, 0 for the ground floor.
    pub floor: usize,
}

impl WallPiece {
    /// The plane that it lies in.
    pub fn wall(&self) -> solid::Wall {
        wall(self.side, self.at)
    }
}

/// The wall of a side at a coordinate.
pub fn wall(side: Side, at: f64) -> solid::Wall {
    solid::Wall {
        axis: usize::from(matches!(side, Side::Front | Side::Back)),
        at,
        positive: matches!(side, Side::Back | Side::Right),
    }
}

/// Outline of the walls of floor `k`: porches have none.
fn outline(building: &Building, k: usize) -> Vec<PlanEdge> {
    let walls = building
        .boxes
        .iter()
        .filter(|b| b.style != BoxStyle::Porch && building.floors_of(b) > k);
    let plans: Vec<Rect> = walls.map(MassBox::plan).collect();
    PlanUnion::new(&plans).outline()
}

/// All wall pieces by side, strip, floor and depth. A strip of a side lies between two corners of its outlines.
pub fn wall_pieces(building: &Building) -> Vec<WallPiece> {
    let outlines: Vec<_> = (0..building.floors())
        .map(|k| outline(building, k))
        .collect();
    let mut pieces = Vec::new();
    for side in Side::ALL {
        let edges = || {
            let floors = outlines.iter().enumerate();
            floors.flat_map(move |(k, edges)| {
                let own = edges.iter().filter(move |e| e.side == side);
                own.map(move |e| (k, e))
            })
        };
        let mut corners: Vec<f64> = edges().flat_map(|(_, e)| [e.start, e.end]).collect();
        corners.sort_by(f64::total_cmp);
        corners.dedup_by(|next, kept| *next - *kept < 1e-3);
        for strip in corners.windows(2) {
            let middle = (strip[0] + strip[1]) / 2.0;
            let here = edges().filter(|(_, e)| e.start < middle && middle < e.end);
            pieces.extend(here.map(|(floor, e)| WallPiece {
                side,
                at: e.at,
                start: strip[0],
                end: strip[1],
                floor,
            }));
        }
    }
    pieces
}

/// The wall that each facade piece of a building lies on: pieces say no depth, so that the walls of their side and
/// floor that reach over them are given out from the smallest coordinate on; `None` where there is none.
pub fn walls_of_pieces(building: &Building) -> Vec<Option<WallPiece>> {
    let walls = wall_pieces(building);
    let mut seen: Vec<(Side, i64, usize, usize)> = Vec::new();
    let place = |piece: &FacadePiece| {
        let floor = (piece.base / building.floor_height).round() as usize;
        let middle = piece.start + piece.width / 2.0;
        let before = (piece.side, (piece.start * 1e3).round() as i64, floor);
        (before, floor, middle)
    };
    let mut found = Vec::with_capacity(building.facades.len());
    for piece in &building.facades {
        let ((side, start, _), floor, middle) = place(piece);
        let known = seen
            .iter_mut()
            .find(|s| (s.0, s.1, s.2) == (side, start, floor));
        let turn = match known {
            Some(s) => {
                s.3 += 1;
                s.3
            }
            None => {
                seen.push((side, start, floor, 0));
                0
            }
        };
        let mut over = walls
            .iter()
            .filter(|w| w.side == side && w.floor == floor && w.start < middle && middle < w.end);
        found.push(over.nth(turn).copied());
    }
    found
}
